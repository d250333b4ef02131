//! Passages: a page's paragraphs, tables, quotations and list items, and the places of their text.

use std::ops::Range;

use pulldown_cmark::{Event, HeadingLevel, Options, Parser, Tag, TagEnd};

/// The sections that are skipped: exercises have tests of their own, and sources have page numbers.
const LEFT_OUT: [&str; 2] = ["Try it", "Sources"];

/// A paragraph, table, quotation or item of a list.
#[derive(Debug, Default)]
pub struct Passage {
    /// True for a table or a quotation, false for the page's own sentences.
    pub is_set_apart: bool,
    /// The places of its text on the page, in bytes, without code, formulas, links and the heads of rows and
    /// columns.
    pub text: Vec<Range<usize>>,
}

/// The line, from 1, of a place in a text.
pub fn line(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// A page's passages.
pub fn all(text: &str) -> Vec<Passage> {
    let mut found: Vec<Passage> = Vec::new();
    let (mut hidden, mut quotes, mut label, mut left_out) = (0, 0, false, false);
    let mut heading: Option<String> = None;
    let options = Options::ENABLE_TABLES | Options::ENABLE_MATH;
    for (event, span) in Parser::new_ext(text, options).into_offset_iter() {
        match event {
            Event::Start(Tag::Heading { level, .. }) => {
                heading = (level == HeadingLevel::H2).then(String::new);
                hidden += 1;
            }
            Event::End(TagEnd::Heading(level)) => {
                if level == HeadingLevel::H2 {
                    left_out = heading.take().is_some_and(|title| LEFT_OUT.contains(&title.trim()));
                }
                hidden -= 1;
            }
            Event::Start(
                Tag::Link { .. } | Tag::Image { .. } | Tag::CodeBlock(_) | Tag::TableHead,
            ) => hidden += 1,
            Event::End(TagEnd::Link | TagEnd::Image | TagEnd::CodeBlock | TagEnd::TableHead) => {
                hidden -= 1
            }
            // A row's first cell is its label.
            Event::Start(Tag::TableRow) => label = true,
            Event::End(TagEnd::TableCell) => label = false,
            Event::Start(Tag::Table(_) | Tag::BlockQuote(_)) => {
                quotes += i32::from(matches!(event, Event::Start(Tag::BlockQuote(_))));
                found.push(Passage { is_set_apart: true, ..Passage::default() });
            }
            Event::End(TagEnd::BlockQuote(_)) => quotes -= 1,
            Event::Start(Tag::Paragraph | Tag::Item) if quotes == 0 => {
                found.push(Passage::default())
            }
            Event::Text(_) if label => {}
            Event::Text(word) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&word);
                }
                if let Some(block) = found.last_mut().filter(|_| hidden == 0 && !left_out) {
                    match block.text.last_mut().filter(|part| part.end == span.start) {
                        Some(part) => part.end = span.end,
                        None => block.text.push(span),
                    }
                }
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_passage_has_its_own_text() {
        let text = "# T 15\n\nA 1.5 `2.5` $3.5$ [4.5](x.md) **5.5**.\n\n\
                    | h 6.5 | 7.5 |\n|---|---|\n| 8.5 | 9.5 |\n\n> Q 3.\n>\n> R 4.\n\n\
                    - one 10.5\n- two 11.5\n\n## Try it\n\n13.5\n\n## End\n\n14.5\n";
        let passages = all(text).into_iter().filter(|passage| !passage.text.is_empty());
        let told = |passage: Passage| {
            let words = passage.text.into_iter().map(|part| text[part].trim().to_owned());
            (passage.is_set_apart, words.collect::<Vec<_>>().join(" "))
        };
        let expected = [
            (false, "A 1.5    5.5 ."),
            (true, "9.5"),
            (true, "Q 3. R 4."),
            (false, "one 10.5"),
            (false, "two 11.5"),
            (false, "14.5"),
        ];
        let expected = expected.map(|(apart, words)| (apart, words.to_owned()));
        assert_eq!(passages.map(told).collect::<Vec<_>>(), expected);
    }
}
