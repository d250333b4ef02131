//! A page: Markdown with generated blocks, between comments that a code host does not show.
//!
//! ````markdown
//! <!-- snippet samples/02_basic/main.rs#trace -->
//! ```rust
//! … filled in by `chapters sync`
//! ```
//! <!-- /snippet -->
//! <!-- picture -->
//! ```sh
//! cargo run --bin 02_basic -- --headless --out basic.png
//! ```
//! <!-- picture 02_views -->
//! ```sh
//! # the panel on the left
//! cargo run --bin 02_basic -- --headless --set show=hit --out hit.png
//! # the panel on the right
//! cargo run --bin 02_basic -- --headless --set show=normal --out normal.png
//! ```
//! ````

use std::ops::Range;

use crate::fault::Fault;

/// The content of a generated block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A part of a source file: `snippet FILE#ANCHOR`.
    Snippet,
    /// The changes between two chapters: `diff OLD NEW FILE#ANCHOR`; or between two files: `diff OLD NEW`.
    Diff,
    /// A chapter's controls: `controls NAME`.
    Controls,
    /// The picture, title and line of every chapter: `gallery`.
    Gallery,
    /// The ways through the book, or the parents of chapters: `map ways`, `map chapters`.
    Map,
    /// All report cards that were sent in: `devices`.
    Devices,
    /// All classic mistakes: `mistakes`.
    Mistakes,
    /// All classic mistakes by symptom: `symptoms`.
    Symptoms,
    /// A chapter's exercises: `exercises NAME`.
    Exercises,
    /// The devices and dates of the page's figures: `stamp`.
    Stamp,
    /// A table of measured values, from the page's template of this name: `table NAME`.
    Table,
}

impl Kind {
    /// Each with the word in its marker, a noun for messages, and the marker's arguments.
    const ALL: [(Self, &str, &str, &str); 11] = [
        (Self::Snippet, "snippet", "snippet", "FILE#ANCHOR -->"),
        (Self::Diff, "diff", "diff", "OLD NEW FILE#ANCHOR -->, the file being optional"),
        (Self::Controls, "controls", "table of controls", "NN_name -->"),
        (Self::Gallery, "gallery", "gallery", "-->"),
        (Self::Map, "map", "part of the map", "ways -->, or chapters"),
        (Self::Devices, "devices", "table of devices", "-->"),
        (Self::Mistakes, "mistakes", "gallery of mistakes", "-->"),
        (Self::Symptoms, "symptoms", "table of symptoms", "-->"),
        (Self::Exercises, "exercises", "list of exercises", "NN_name -->"),
        (Self::Stamp, "stamp", "stamp", "-->"),
        (Self::Table, "table", "table of values", "NAME -->"),
    ];

    fn named(word: &str) -> Option<Self> {
        Self::ALL.iter().find(|kind| kind.1 == word).map(|kind| kind.0)
    }

    /// The word in the marker.
    pub fn word(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// A noun for messages.
    pub fn noun(self) -> &'static str {
        Self::ALL[self as usize].2
    }

    /// The form of the marker.
    pub fn form(self) -> String {
        format!("<!-- {} {}", self.word(), Self::ALL[self as usize].3)
    }
}

/// A generated block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The content.
    pub kind: Kind,
    /// The words after the kind.
    pub words: Vec<String>,
    /// Its opening marker's line, from 1.
    pub line: usize,
    /// The lines between the markers, from 0.
    pub body: Range<usize>,
}

/// A command that makes a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureMark {
    /// The marker's line, from 1.
    pub line: usize,
    /// The picture's name, where it is not the page's.
    pub name: Option<String>,
    /// The step of the reader's own program after which it is rendered: `picture NAME STEP`.
    pub step: Option<String>,
    /// The text of the fenced block below it.
    pub command: String,
}

/// A parsed page.
pub struct Page {
    /// Its path, from the project's root.
    pub path: String,
    /// Its lines.
    pub lines: Vec<String>,
    /// Its generated blocks.
    pub blocks: Vec<Block>,
    /// Its pictures' commands.
    pub pictures: Vec<PictureMark>,
    /// The faults of its markers.
    pub faults: Vec<Fault>,
}

impl Page {
    /// Parses a page's markers, except for those inside fenced blocks, which are examples.
    pub fn parse(path: &str, text: &str) -> Self {
        let lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let mut page =
            Self { path: path.to_owned(), lines, blocks: vec![], pictures: vec![], faults: vec![] };
        let mut index = 0;
        while index < page.lines.len() {
            let end = fence_end(&page.lines, index);
            if end > index {
                index = end;
            } else {
                index = page.marker_at(index);
            }
        }
        page
    }

    /// Parses the marker on a line, if there is one, and returns the line to continue with.
    fn marker_at(&mut self, index: usize) -> usize {
        let Some(words) = marker(&self.lines[index]) else { return index + 1 };
        let line = index + 1;
        let words: Vec<String> = words.split_whitespace().map(str::to_owned).collect();
        let Some((word, rest)) = words.split_first() else { return line };
        let mut fault = |what: String, remedy: String| {
            self.faults.push(Fault::new(&*self.path, line, what, remedy));
            line
        };
        if let Some(closed) = word.strip_prefix('/') {
            let what = format!("<!-- /{closed} --> closes nothing");
            return fault(what, format!("remove it, or write <!-- {closed} … --> above"));
        }
        if word == "picture" {
            let fence = self.lines.get(line).is_some_and(|line| line.trim() == "```sh");
            let end = fence_end(&self.lines, line);
            if !fence || end < line + 2 {
                let what = "no command follows <!-- picture -->".to_owned();
                return fault(what, "put it on the line before the ```sh block".to_owned());
            }
            let command = self.lines[line + 1..end - 1].join("\n");
            let (name, step) = (rest.first().cloned(), rest.get(1).cloned());
            self.pictures.push(PictureMark { line, name, step, command });
            return end;
        }
        let Some(kind) = Kind::named(word) else {
            return line;
        };
        // A block ends at its marker rather than its fence, so that one with a lost fence can still be
        // repaired.
        let closer = format!("/{word}");
        let following = self.lines[line..].iter().map(|line| marker(line));
        let close = following.clone().position(|words| words == Some(&*closer));
        let next = following.clone().position(|words| words.is_some_and(opens));
        let Some(close) = close.filter(|&close| next.is_none_or(|next| close < next)) else {
            let what = format!("<!-- {} --> is never closed", words.join(" "));
            return fault(what, format!("add <!-- {closer} --> on a line of its own"));
        };
        let body = line..line + close;
        let next = body.end + 1;
        self.blocks.push(Block { kind, words: rest.to_vec(), line, body });
        next
    }

    /// The name of its file, without folder and extension.
    pub fn stem(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default().trim_end_matches(".md")
    }

    /// The page with new bodies in its blocks; a block with `None`, or without an entry, is unchanged.
    pub fn with_bodies(&self, bodies: &[Option<String>]) -> String {
        let mut text = String::new();
        let mut copied = 0;
        for (block, body) in self.blocks.iter().zip(bodies) {
            if let Some(body) = body {
                text.extend(ended(&self.lines[copied..block.body.start]));
                text.push_str(body);
                copied = block.body.end;
            }
        }
        text.extend(ended(&self.lines[copied..]));
        text
    }

    /// The author's text: the page with every generated line left empty.
    pub fn written(&self) -> String {
        let generated = |index: usize| self.blocks.iter().any(|block| block.body.contains(&index));
        let line = |(index, line)| if generated(index) { "\n".to_owned() } else { line };
        ended(&self.lines).enumerate().map(line).collect()
    }

    /// The page with some places of the author's text replaced, none of which spans two lines.
    pub fn edited(&self, mut changes: Vec<(Range<usize>, String)>) -> Self {
        let text = self.written();
        let mut lines = self.lines.clone();
        changes.sort_by_key(|(span, _)| span.start);
        // From the end, because a change moves the text after it.
        for (span, new) in changes.into_iter().rev() {
            let before = &text[..span.start];
            let start = before.rfind('\n').map_or(0, |at| at + 1);
            let line = before.matches('\n').count();
            lines[line].replace_range(span.start - start..span.end - start, &new);
        }
        Self::parse(&self.path, &ended(&lines).collect::<String>())
    }

    /// The page's prose, each line with its number from 1: without generated lines, markers and fenced
    /// blocks.
    pub fn prose(&self) -> Vec<(usize, &str)> {
        let mut found = Vec::new();
        let mut index = 0;
        while let Some(line) = self.lines.get(index) {
            let block = self.blocks.iter().find(|block| block.body.contains(&index));
            let end = block.map_or_else(|| fence_end(&self.lines, index), |block| block.body.end);
            if end == index && marker(line).is_none() {
                found.push((index + 1, &**line));
            }
            index = end.max(index + 1);
        }
        found
    }
}

fn ended(lines: &[String]) -> impl Iterator<Item = String> {
    lines.iter().map(|line| format!("{line}\n"))
}

/// The contents of a comment that fills a line.
fn marker(line: &str) -> Option<&str> {
    Some(line.trim().strip_prefix("<!--")?.strip_suffix("-->")?.trim())
}

fn opens(words: &str) -> bool {
    words.split_whitespace().next().and_then(Kind::named).is_some()
}

/// The line after the fenced block that begins on line `start`; `start` itself if there is no such block.
fn fence_end(lines: &[String], start: usize) -> usize {
    let fence = |line: &str| {
        let line = line.trim_start();
        let mark = line.chars().next().filter(|mark| ['`', '~'].contains(mark))?;
        let length = line.chars().take_while(|c| *c == mark).count();
        (length >= 3).then(|| (mark, length, line[length..].trim().to_owned()))
    };
    let Some((mark, length, _)) = lines.get(start).and_then(|line| fence(line)) else {
        return start;
    };
    let closes = |line: &String| {
        fence(line).is_some_and(|(m, l, rest)| m == mark && l >= length && rest.is_empty())
    };
    let close = lines[start + 1..].iter().position(closes);
    close.map_or(lines.len(), |close| start + 1 + close + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> Vec<String> {
        Page::parse("p.md", text).faults.iter().map(Fault::to_string).collect()
    }

    #[test]
    fn blocks_have_kind_words_and_body() {
        let text = "# T\n<!-- snippet a/b.rs#c -->\n```rust\nx\n```\n<!-- /snippet -->\n\
                    <!--controls 02_basic-->\n<!-- /controls -->\n";
        let page = Page::parse("p.md", text);
        assert!(page.faults.is_empty());
        let [snippet, controls] = &page.blocks[..] else { panic!("{:?}", page.blocks) };
        assert_eq!((snippet.kind, snippet.line, snippet.body.clone()), (Kind::Snippet, 2, 2..5));
        assert_eq!(snippet.words, ["a/b.rs#c"]);
        assert_eq!((controls.kind, controls.body.clone()), (Kind::Controls, 7..7));
        assert_eq!(page.with_bodies(&[None, None]), text);
        let filled = page.with_bodies(&[None, Some("new\n".to_owned())]);
        assert_eq!(filled, text.replace("02_basic-->\n", "02_basic-->\nnew\n"));
        let short = page.with_bodies(&[Some(String::new()), None]);
        assert_eq!(short, text.replace("```rust\nx\n```\n", ""));
        assert_eq!(page.written(), text.replace("```rust\nx\n```\n", "\n\n\n"));
    }

    #[test]
    fn a_block_with_a_lost_fence_ends_where_its_marker_says() {
        let text = "<!-- snippet a -->\n```rust\nx\n<!-- /snippet -->\n<!-- gallery -->\n<!-- /gallery -->\n";
        let page = Page::parse("p.md", text);
        assert_eq!(page.blocks.len(), 2);
        assert_eq!(page.blocks[0].body, 1..3);
    }

    #[test]
    fn markers_in_fences_are_examples() {
        let page =
            Page::parse("p.md", "````md\n<!-- snippet a -->\n```\n<!-- /nonsense -->\n````\n");
        assert!(page.blocks.is_empty() && page.faults.is_empty());
    }

    #[test]
    fn wrong_markers_are_named_with_their_line() {
        let open = faults("x\n<!-- snippet a -->\n<!-- controls b -->\n<!-- /controls -->\n");
        assert_eq!(open.len(), 1);
        assert!(open[0].starts_with("p.md:2: <!-- snippet a --> is never closed; add <!-- /sn"));
        assert!(faults("<!-- /diff -->\n")[0].starts_with("p.md:1: <!-- /diff --> closes nothing"));
        assert!(faults("<!-- picture -->\n\n```sh\nx\n```\n")[0].contains("no command follows"));
        assert!(faults("<!-- a note -->\n").is_empty());
    }

    #[test]
    fn prose_is_neither_generated_nor_code() {
        let text = "# T\n<!-- snippet a -->\n```rust\nx\n<!-- /snippet -->\na\n```sh\nb\n```\nc\n";
        let page = Page::parse("p.md", text);
        assert_eq!(page.prose(), [(1, "# T"), (6, "a"), (10, "c")]);
    }

    #[test]
    fn a_picture_has_the_command_below_it() {
        let page = Page::parse("p.md", "<!-- picture two -->\n```sh\na \\\n  b\n```\n");
        let [mark] = &page.pictures[..] else { panic!("{:?}", page.faults) };
        assert_eq!((mark.name.as_deref(), &*mark.command), (Some("two"), "a \\\n  b"));
    }
}
