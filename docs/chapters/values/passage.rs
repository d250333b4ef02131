//! Passages: a page's paragraphs, tables, quotations and items, with the numbers and the comments of each.

use std::ops::Range;

use pulldown_cmark::{Event, HeadingLevel, Options, Parser, Tag, TagEnd};

use super::number::{self, Number};

/// The sections of which nothing is asked: exercises have tests of their own, sources have pages.
const LEFT_OUT: [&str; 2] = ["Try it", "Sources"];

/// A paragraph, table, quotation or item of a list.
#[derive(Debug, Default)]
pub struct Passage {
    /// Whether it is a table or a quotation, where small numbers are figures, too.
    pub counts_small: bool,
    /// Where its text stands on the page, in bytes: without code, formulas, links and the heads of rows
    /// and columns.
    pub text: Vec<Range<usize>>,
    /// The heads of a table's rows.
    pub rows: Vec<String>,
    /// The comments below it, with their lines.
    pub comments: Vec<(usize, Comment)>,
}

/// What a comment says of the numbers above it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Comment {
    /// They come from measurements: of each the name, and the values' names.
    Figures(Vec<(String, Vec<String>)>),
    /// No run gave these.
    Explains(Vec<String>),
}

impl Passage {
    /// Its numbers, those of a note left out.
    pub fn numbers(&self, text: &str, notes: &[Range<usize>]) -> Vec<Number> {
        let mut numbers: Vec<Number> =
            self.text.iter().flat_map(|part| number::found(text, part.clone())).collect();
        numbers.retain(|number| !notes.iter().any(|note| note.contains(&number.span.start)));
        numbers
    }
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
            // A row's first cell says what the row is about.
            Event::Start(Tag::TableRow) => {
                label = true;
                found.last_mut().into_iter().for_each(|table| table.rows.push(String::new()));
            }
            Event::End(TagEnd::TableCell) => label = false,
            Event::Start(Tag::Table(_) | Tag::BlockQuote(_)) => {
                quotes += i32::from(matches!(event, Event::Start(Tag::BlockQuote(_))));
                found.push(Passage { counts_small: true, ..Passage::default() });
            }
            Event::End(TagEnd::BlockQuote(_)) => quotes -= 1,
            Event::Start(Tag::Paragraph | Tag::Item) if quotes == 0 => {
                found.push(Passage::default())
            }
            Event::Text(word) | Event::Code(word) if label => {
                let row = found.last_mut().and_then(|table| table.rows.last_mut());
                row.into_iter().for_each(|row| row.push_str(&word));
            }
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
            Event::Html(_) | Event::InlineHtml(_) => {
                let at = line(text, span.start);
                let comment = comment(&text[span]);
                if let (Some(block), Some(comment)) = (found.last_mut(), comment) {
                    block.comments.push((at, comment));
                }
            }
            _ => {}
        }
    }
    found
}

/// What a comment says of numbers, if it does.
fn comment(html: &str) -> Option<Comment> {
    let says = html.trim().strip_prefix("<!--")?.strip_suffix("-->")?.trim();
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect();
    match says.split_once(' ')? {
        ("explains", numbers) => Some(Comment::Explains(words(numbers))),
        ("figures", groups) => {
            let group = |group: &str| {
                let (name, values) = group.split_once(':').unwrap_or((group, ""));
                (name.trim().to_owned(), words(values))
            };
            Some(Comment::Figures(groups.split(';').map(group).collect()))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of each passage with text or comments: whether small numbers count, its numbers, its comments.
    fn told(text: &str) -> Vec<(bool, String, usize)> {
        let passages =
            all(text).into_iter().filter(|p| !p.text.is_empty() || !p.comments.is_empty());
        let numbers = |passage: &Passage| {
            let numbers = passage.numbers(text, &[]);
            numbers.into_iter().map(|number| number.written).collect::<Vec<_>>().join(" ")
        };
        passages.map(|p| (p.counts_small, numbers(&p), p.comments.len())).collect()
    }

    #[test]
    fn every_kind_of_passage_has_its_own_numbers_and_comments() {
        let text = "# T 15\n\nA 1.5 `2.5` $3.5$ [4.5](x.md) **5.5**.\n<!-- explains 1.5 -->\n\n\
                    | h 6.5 | 7.5 |\n|---|---|\n| 8.5 | 9.5 |\n| 1 | 2 |\n<!-- figures a -->\n\
                    <!-- explains 9.5 -->\n\n> Q 3.\n>\n> R 4.\n<!-- figures b -->\n\n\
                    - one 10.5\n- two 11.5\n  <!-- figures c -->\n\nLast 12.5.\n\n## Try it\n\n13.5\n\n## End\n\n14.5\n";
        let expected = [
            (false, "1.5 5.5", 1),
            (true, "9.5 2", 2),
            (true, "3 4", 1),
            (false, "10.5", 0),
            (false, "11.5", 1),
            (false, "12.5", 0),
            (false, "14.5", 0),
        ];
        assert_eq!(
            told(text),
            expected.map(|(small, text, marks)| (small, text.to_owned(), marks))
        );
    }

    #[test]
    fn a_table_s_rows_have_heads() {
        let table = "| h | a |\n|---|---|\n| S0 `x` | 1 |\n| **S5** 64 bits | |\n";
        let heads: Vec<Vec<String>> = all(table).into_iter().map(|table| table.rows).collect();
        assert_eq!(heads, [["S0 x", "S5 64 bits"]]);
    }

    #[test]
    fn a_comment_names_values_or_numbers() {
        let some = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let figures = vec![("a".to_owned(), some("x y")), ("b/c".to_owned(), vec![])];
        assert_eq!(comment("<!-- figures a: x y; b/c -->\n"), Some(Comment::Figures(figures)));
        assert_eq!(comment("<!-- explains 3 1e6 -->"), Some(Comment::Explains(some("3 1e6"))));
        assert_eq!(comment("<!-- picture -->"), None);
    }
}
