//! Marks: comments for the site, which a code host does not show.

use std::ops::Range;

use crate::color::escaped;
use crate::link;
use crate::page::Composer;

/// The kind of a mark above a picture, and its content.
pub(super) enum Above {
    Slider(String),
    Figure(String),
}

impl Above {
    /// The mark's word.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Slider(_) => "slider",
            Self::Figure(_) => "touch",
        }
    }
}

impl Composer<'_> {
    /// A comment is a mark or is dropped; other HTML is unchanged.
    pub(super) fn html(&mut self, index: usize, span: Range<usize>) {
        let comment = self.text[span.clone()].trim();
        let Some(words) = comment.strip_prefix("<!--").and_then(|rest| rest.strip_suffix("-->"))
        else {
            return;
        };
        let (word, rest) = words.trim().split_once(' ').unwrap_or((words.trim(), ""));
        let shown = match word {
            "snippet" => self.caption(index, rest.trim()),
            "diff" => self.change(index, rest),
            "picture" => {
                self.folded = true;
                String::new()
            }
            "slider" | "touch" => {
                let rest = rest.split_whitespace().collect::<Vec<_>>().join(" ");
                let above = if word == "slider" { Above::Slider } else { Above::Figure };
                self.above = Some((index, above(rest)));
                String::new()
            }
            _ => String::new(),
        };
        // The whole line is removed: a blank line would make a list loose.
        let start = self.text[..span.start].rfind('\n').map_or(0, |at| at + 1);
        let end = if shown.is_empty() { String::new() } else { format!("{shown}\n") };
        self.edits.push((start..span.end, end));
    }

    /// The line above a piece of code: its file, linked to the whole listing.
    fn caption(&mut self, index: usize, source: &str) -> String {
        let (file, anchor) =
            source.split_once('#').map_or((source, None), |(file, anchor)| (file, Some(anchor)));
        if !self.project.has(file) {
            self.fault(index, format!("the marker names '{file}', which is no file"), "correct it");
            return String::new();
        }
        let address = link::shown(self.project, self.entries, self.entry, file, anchor);
        if link::own(self.project, file).is_none() {
            self.done.files.insert(file.to_owned());
        }
        self.want(index, &address);
        format!("<div class=\"source\"><a href=\"{address}\">{}</a></div>", escaped(file))
    }

    /// The line above a diff: the two chapters, linked to the whole listing.
    fn change(&mut self, index: usize, words: &str) -> String {
        let words: Vec<&str> = words.split_whitespace().collect();
        let [old, new, source] = words[..] else { return String::new() };
        let role = source.split('#').next().unwrap_or_default();
        let number = |name: &str| name.split('_').next().unwrap_or_default().to_owned();
        let candidates = [format!("samples/{new}/{role}"), format!("shaders/{new}/{role}")];
        let Some(file) = candidates.into_iter().find(|file| self.project.has(file)) else {
            return String::new();
        };
        let address = link::shown(self.project, self.entries, self.entry, &file, None);
        self.want(index, &address);
        format!(
            "<div class=\"source\"><a href=\"{address}\">{}</a>: {} against {}</div>",
            escaped(&file),
            number(new),
            number(old)
        )
    }
}
