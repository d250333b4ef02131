//! Checks that a page can be read in one sitting: the words of the page, and of each section without a break.

use manuscript::fault::Fault;
use manuscript::page::{Kind, Page};
use manuscript::project::Project;

use crate::values::binding::stripped;

/// The largest number of words on a chapter's page, without captions, exercises and sources: ten minutes'
/// reading. Captions are read while looking at their pictures.
const MOST: usize = 2000;

/// The largest number of words in a section without a drawing, a snippet or a table.
const UNBROKEN: usize = 250;

/// The sections that are not part of the text.
const APART: [&str; 3] = ["## Controls", "## Try it", "## Sources"];

/// The length of a page.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Breath {
    /// Its words, including comments in snippets, without captions, tables and code.
    pub words: usize,
    /// Its tables.
    pub tables: usize,
    /// The section without a break that has the most words: its line, from 1, and its words.
    pub longest: (usize, usize),
}

impl Breath {
    /// Counts a page.
    pub fn of(page: &Page) -> Self {
        let mut found = Self::default();
        let mut section = (1, 0, false);
        let (mut fence, mut apart, mut in_table) = (None::<bool>, false, false);
        let mut in_comment = false;
        let lines = page.lines.iter().enumerate();
        let list = |index| {
            let mut lists = page.blocks.iter().filter(|block| block.kind == Kind::Exercises);
            lists.any(|block| block.body.contains(&index))
        };
        for (index, line) in lines.filter(|(index, _)| !list(*index)) {
            let text = line.trim();
            if let Some(word) = text.strip_prefix("```") {
                section.2 |= !apart;
                fence = match fence {
                    Some(_) => None,
                    None => Some(!["sh", "diff", "text"].contains(&word)),
                };
                continue;
            }
            if in_comment || fence.is_none() && text.starts_with("<!--") {
                in_comment = !text.contains("-->");
                continue;
            }
            let is_row = fence.is_none() && text.starts_with('|');
            found.tables += usize::from(is_row && !in_table && !apart);
            in_table = is_row;
            if fence.is_none() && line.starts_with('#') {
                found.ends(section);
                section = (index + 1, 0, false);
                apart = APART.contains(&text) || (apart && line.starts_with("### "));
                continue;
            }
            let is_caption = fence.is_none()
                && text.len() > 1
                && !text.starts_with("**")
                && text.starts_with('*')
                && text.ends_with('*');
            section.2 |= is_row || fence.is_none() && text.contains("![");
            let counted = match fence {
                _ if apart || is_row || is_caption => 0,
                Some(true) => text.split_once("//").map_or(0, |(_, comment)| words(comment)),
                Some(false) => 0,
                None => words(text),
            };
            found.words += counted;
            section.1 += counted;
        }
        found.ends(section);
        found
    }

    fn ends(&mut self, (line, words, broken): (usize, usize, bool)) {
        if !broken && words > self.longest.1 {
            self.longest = (line, words);
        }
    }
}

/// The words of a line, without the targets of links and the comments that bind numbers.
fn words(line: &str) -> usize {
    let line = stripped(line);
    let parts = line.split("](").enumerate();
    let shown = parts.map(|(index, part)| match (index, part.split_once(')')) {
        (0, _) | (_, None) => part,
        (_, Some((_, rest))) => rest,
    });
    let shown: String = shown.collect::<Vec<_>>().join("]");
    shown.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

/// Reports the parts of a chapter's page that are too long.
pub fn check(project: &Project, page: &Page) -> Vec<Fault> {
    let Some(chapter) = project.of_page(&page.path) else { return Vec::new() };
    let Breath { words, longest: (line, unbroken), .. } = Breath::of(page);
    let mut faults = Vec::new();
    if words > MOST {
        let what = format!("the page has {words} words, more than {MOST}");
        let remedy = format!("cut it, or move tables to {}", chapter.measurements());
        faults.push(Fault::new(&*page.path, 1, what, remedy));
    }
    if unbroken > UNBROKEN {
        let what = format!("a section has {unbroken} words and no drawing, snippet or table");
        faults.push(Fault::new(
            &*page.path,
            line,
            what,
            format!("break it, or cut it to {UNBROKEN}"),
        ));
    }
    faults
}

/// A row for each chapter's page: its words, its tables, its longest section without a break.
pub fn table(project: &Project) -> String {
    let mut text = "page\twords\ttables\tunbroken\tat line\n".to_owned();
    for chapter in &project.chapters {
        let Ok(page) = project.read(&chapter.page()) else { continue };
        let Breath { words, tables, longest: (line, unbroken) } =
            Breath::of(&Page::parse(&chapter.page(), &page));
        text.push_str(&format!("{}\t{words}\t{tables}\t{unbroken}\t{line}\n", chapter.name));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_counted() {
        let text = "# Title\n\none [two](a/b.md) – three.\n![four five](x.png)\n\n*No words: a caption.*\n\n## A\n\nsix seven\n\
                    \n| no | word |\n|---|---|\n\n## B\n\n```glsl\nfloat x; // eight nine\n```\n\n\
                    ```sh\n# none\n```\n\n## C\nten\n<!-- no words -->\n## Sources\nno words\n";
        let found = Breath::of(&Page::parse("p.md", text));
        assert_eq!(found, Breath { words: 10, tables: 1, longest: (25, 1) });
    }
}
