//! The glossary: its terms, and a check that each page links a term where it first uses it.
//!
//! A term is a heading of the third level in `docs/glossary.md`, followed by its definition and links to the
//! pages that explain it. Those pages need no link back. An everyday word, which a page may use in another
//! sense, has the comment `<!-- everyday word -->` and is skipped. The comment `<!-- not: A, B -->` lists
//! other words for the same thing, which no page may use.

use std::ops::Range;

use manuscript::fault::Fault;
use manuscript::link::local;
use manuscript::page::Page;
use manuscript::project::Project;

use super::markdown::Markdown;
use super::reference::slug;
use crate::values::passage::{self, line};

/// The page.
pub const GLOSSARY: &str = "docs/glossary.md";

/// The mark of a term that is skipped.
const EVERYDAY: &str = "<!-- everyday word -->";
/// The start of the list of words that the term replaces.
const NOT: &str = "<!-- not:";

/// A project's terms.
#[derive(Default)]
pub struct Glossary {
    terms: Vec<Term>,
    /// Words that no page may use, each with the term to write instead.
    others: Vec<(String, String)>,
}

struct Term {
    name: String,
    explained_on: Vec<String>,
}

/// A term's first use on a page, not yet a link.
struct Use<'a> {
    term: &'a Term,
    span: Range<usize>,
}

impl Glossary {
    /// The terms of a project; none if it has no glossary.
    pub fn of(project: &Project) -> Self {
        Self::parse(&project.read(GLOSSARY).unwrap_or_default())
    }

    fn parse(text: &str) -> Self {
        let all = || text.split("\n### ").skip(1);
        let others = |entry: &str| {
            let name = entry.lines().next().unwrap_or_default().trim().to_owned();
            let list = entry.split_once(NOT).and_then(|(_, rest)| rest.split_once("-->"));
            let words = list.map_or("", |(words, _)| words).split(',').map(str::trim);
            let words = words.filter(|word| !word.is_empty());
            words.map(|word| (word.to_owned(), name.clone())).collect::<Vec<_>>()
        };
        let entries = all().filter(|entry| !entry.contains(EVERYDAY));
        let term = |entry: &str| {
            let (name, meaning) = entry.split_once('\n')?;
            let links = Markdown::parse(meaning).links;
            let explained_on = links.iter().filter_map(|link| local(GLOSSARY, &link.target));
            Some(Term { name: name.trim().to_owned(), explained_on: explained_on.collect() })
        };
        Self { terms: entries.filter_map(term).collect(), others: all().flat_map(others).collect() }
    }

    /// The terms that a page of the book uses without a link at or before their first use, and the words it
    /// should not use.
    pub fn check(&self, page: &Page) -> Vec<Fault> {
        let text = page.written();
        let mut faults = Vec::new();
        if page.path != GLOSSARY {
            for (word, term) in &self.others {
                for span in sentences(&text).into_iter().flat_map(|part| uses(&text, part, word)) {
                    let what = format!("'{word}' is called '{term}' in this book");
                    let line = line(&text, span.start);
                    faults.push(Fault::new(&*page.path, line, what, format!("write '{term}'")));
                }
            }
        }
        let fault = |Use { term, span }: Use| {
            let what = format!("the first '{}' of this page leads to no meaning", term.name);
            Fault::stale(&page.path, line(&text, span.start), &what)
        };
        faults.extend(self.unlinked(page, &text).into_iter().map(fault));
        faults
    }

    /// The page, with every term linked at its first use.
    pub fn linked(&self, page: &Page) -> Page {
        let text = page.written();
        let linked = |Use { term, span }: Use| {
            let link = format!("[{}]{}", &text[span.clone()], link_to(page, term));
            (span, link)
        };
        page.edited(self.unlinked(page, &text).into_iter().map(linked).collect())
    }

    /// In the order of the page.
    fn unlinked<'a>(&'a self, page: &Page, text: &str) -> Vec<Use<'a>> {
        if !page.path.starts_with("docs/") || page.path == GLOSSARY {
            return Vec::new();
        }
        let sentences = sentences(text);
        let found = |term: &'a Term| {
            let used = |part: &Range<usize>| uses(text, part.clone(), &term.name);
            sentences.iter().flat_map(used).map(|span| Use { term, span }).collect::<Vec<_>>()
        };
        let all: Vec<Use> = self.terms.iter().flat_map(found).collect();
        // The term "hit group" must not match inside "shader hit group".
        let within = |one: &Use, other: &Use| {
            other.span.len() > one.span.len()
                && other.span.start <= one.span.start
                && one.span.end <= other.span.end
        };
        let mut first: Vec<Use> = Vec::new();
        for term in &self.terms {
            if term.explained_on.contains(&page.path) {
                continue;
            }
            let mut own = all.iter().filter(|one| std::ptr::eq(one.term, term));
            let Some(used) = own.find(|one| !all.iter().any(|other| within(one, other))) else {
                continue;
            };
            let link = text.find(&format!("]{}", link_to(page, term)));
            if link.is_none_or(|link| link > used.span.start) {
                first.push(Use { term, span: used.span.clone() });
            }
        }
        first.sort_by_key(|used| used.span.start);
        first
    }
}

/// The link target of a term, relative to a page.
fn link_to(page: &Page, term: &Term) -> String {
    let up = "../".repeat(page.path.matches('/').count().saturating_sub(1));
    format!("({up}glossary.md#{})", slug(&term.name))
}

/// The byte ranges of a text that are prose.
fn sentences(text: &str) -> Vec<Range<usize>> {
    let passages = passage::all(text);
    let passages = passages.iter().filter(|passage| !passage.is_set_apart);
    passages.flat_map(|passage| passage.text.iter().cloned()).collect()
}

/// The places in a part of a text where a term occurs as a whole word, singular or plural.
fn uses(text: &str, part: Range<usize>, term: &str) -> Vec<Range<usize>> {
    let (lower, term) = (text[part.clone()].to_ascii_lowercase(), term.to_ascii_lowercase());
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || "-_".contains(c));
    let mut found = Vec::new();
    for (at, _) in lower.match_indices(&term) {
        let plural = lower[at + term.len()..].starts_with('s');
        let end = at + term.len() + usize::from(plural);
        if !is_word(lower[..at].chars().next_back()) && !is_word(lower[end..].chars().next()) {
            found.push(part.start + at..part.start + end);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const TERMS: &str = "# Glossary\n\n### group\nA group. ([01](01_one.md))\n\n### hit group\nOne \
                         that is hit.\n\n### tie\nAs far.\n<!-- everyday word -->\n\n### two-float \
                         number\nTwo.\n";

    fn linked(path: &str, text: &str) -> String {
        let page = Page::parse(path, text);
        let glossary = Glossary::parse(TERMS);
        let linked = glossary.linked(&page);
        assert!(glossary.check(&linked).is_empty());
        linked.written()
    }

    #[test]
    fn the_first_use_is_linked_and_no_other() {
        let text = "# Hit groups\n\nTwo **hit groups**, a tie, `hit group` and a hit group.\n";
        let link =
            "Two **[hit groups](glossary.md#hit-group)**, a tie, `hit group` and a hit group.";
        assert_eq!(linked("docs/02_two.md", text), format!("# Hit groups\n\n{link}\n"));
        assert_eq!(
            linked("docs/02_two.md", &linked("docs/02_two.md", text)),
            linked("docs/02_two.md", text)
        );
    }

    #[test]
    fn what_a_page_explains_it_does_not_link() {
        let text = "A group, regrouped; Two-float numbers.\n";
        let link = "A group, regrouped; [Two-float numbers](glossary.md#two-float-number).\n";
        assert_eq!(linked("docs/01_one.md", text), link);
        assert_eq!(linked("README.md", text), text);
        assert!(linked("docs/02_two.md", text).starts_with("A [group](glossary.md#group)"));
        let below = linked("docs/measurements/02_two.md", text);
        assert!(below.starts_with("A [group](../glossary.md#group)"), "{below}");
    }

    #[test]
    fn another_word_for_a_term_is_a_fault() {
        let terms = "# Glossary\n\n### shadow ray\nA ray. ([05](05_e.md))\n<!-- not: occlusion ray, feeler -->\n";
        let glossary = Glossary::parse(terms);
        let told = |path: &str, text: &str| {
            let faults = glossary.check(&Page::parse(path, text));
            faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n")
        };
        let text = "# Five\n\nA shadow ray, `occlusion ray`.\n\nTwo occlusion rays.\n";
        let expected = "'occlusion ray' is called 'shadow ray' in this book; write 'shadow ray'";
        // The check includes the page that explains the term and the README.
        assert_eq!(told("docs/05_e.md", text), format!("docs/05_e.md:5: {expected}"));
        assert_eq!(told("README.md", text), format!("README.md:5: {expected}"));
        assert_eq!(told(GLOSSARY, text), "");
    }

    #[test]
    fn a_use_before_the_link_is_a_fault() {
        let text = "# Two\n\nA hit group.\n\nSee [hit group](glossary.md#hit-group).\n";
        let [fault] = &Glossary::parse(TERMS).check(&Page::parse("docs/02_two.md", text))[..]
        else {
            panic!("not one fault");
        };
        let told = fault.to_string();
        assert!(told.starts_with("docs/02_two.md:3: the first 'hit group'"), "{told}");
    }
}
