//! Parses the author's text of a page into links, code and headings.

use manuscript::fault::Fault;
use manuscript::link::local;
use manuscript::project::Project;
use pulldown_cmark::{CodeBlockKind, Event, HeadingLevel, Options, Parser, Tag, TagEnd};

/// A link or a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// Its line, from 1.
    pub line: usize,
    /// Its target.
    pub target: String,
}

/// A fenced block, or inline code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Code {
    /// The line on which its text begins, from 1.
    pub line: usize,
    /// The language given; empty for inline code.
    pub language: String,
    /// The text.
    pub text: String,
}

impl Code {
    /// True if it may contain commands. Inline code may as well.
    pub fn is_shell(&self) -> bool {
        ["sh", "bash", "console", "shell", ""].contains(&&*self.language)
    }
}

/// A formula in TeX.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula {
    /// The line on which its text begins, from 1.
    pub line: usize,
    /// The text.
    pub text: String,
    /// True for a block of ```` ```math ````, which Markdown leaves unchanged; false between dollars.
    pub fenced: bool,
}

/// The parts of a page.
#[derive(Debug, Default)]
pub struct Markdown {
    /// Every link and picture.
    pub links: Vec<Link>,
    /// Every piece of code.
    pub code: Vec<Code>,
    /// Every formula.
    pub formulas: Vec<Formula>,
    /// The first heading of the first level, with its line.
    pub title: Option<(usize, String)>,
    /// Every heading.
    pub headings: Vec<String>,
}

impl Markdown {
    /// Parses a page.
    pub fn parse(text: &str) -> Self {
        let mut found = Self::default();
        let options = Options::ENABLE_TABLES | Options::ENABLE_MATH;
        let mut open_code: Option<Code> = None;
        let mut open_heading: Option<(usize, String)> = None;
        for (event, span) in Parser::new_ext(text, options).into_offset_iter() {
            let line = 1 + text[..span.start].matches('\n').count();
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    found.links.push(Link { line, target: dest_url.into_string() });
                }
                Event::Html(html) | Event::InlineHtml(html) => {
                    let target = |target| Link { line, target };
                    found.links.extend(html_targets(&html).into_iter().map(target));
                }
                Event::Start(Tag::CodeBlock(kind)) => {
                    let (language, line) = match kind {
                        CodeBlockKind::Fenced(language) => (language.into_string(), line + 1),
                        CodeBlockKind::Indented => ("text".to_owned(), line),
                    };
                    open_code = Some(Code { line, language, text: String::new() });
                }
                Event::End(TagEnd::CodeBlock) => match open_code.take() {
                    Some(Code { line, language, text }) if language == "math" => {
                        found.formulas.push(Formula { line, text, fenced: true });
                    }
                    code => found.code.extend(code),
                },
                Event::Start(Tag::Heading { .. }) => open_heading = Some((line, String::new())),
                Event::End(TagEnd::Heading(level)) => {
                    let Some(heading) = open_heading.take() else { continue };
                    found.headings.push(heading.1.clone());
                    if level == HeadingLevel::H1 {
                        found.title.get_or_insert(heading);
                    }
                }
                Event::InlineMath(formula) | Event::DisplayMath(formula) => {
                    let text = formula.into_string();
                    found.formulas.push(Formula { line, text, fenced: false });
                }
                Event::Code(code) => {
                    if let Some((_, heading)) = &mut open_heading {
                        heading.push_str(&code);
                    }
                    found.code.push(Code {
                        line,
                        language: String::new(),
                        text: code.into_string(),
                    });
                }
                Event::Text(text) => match (&mut open_code, &mut open_heading) {
                    (Some(code), _) => code.text.push_str(&text),
                    (_, Some((_, heading))) => heading.push_str(&text),
                    _ => {}
                },
                _ => {}
            }
        }
        found
    }
}

/// The values of `src` and `href`.
fn html_targets(html: &str) -> Vec<String> {
    let pieces = ["src=\"", "href=\""].into_iter().flat_map(|key| html.split(key).skip(1));
    pieces.filter_map(|rest| rest.split_once('"')).map(|(target, _)| target.to_owned()).collect()
}

/// The faults of a page's links.
pub fn check_links(project: &Project, page: &str, links: &[Link]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for Link { line, target } in links {
        let Some(path) = local(page, target) else { continue };
        if !project.root.join(&path).exists() {
            let what = format!("the link leads to '{path}', which does not exist");
            faults.push(Fault::new(page, *line, what, "correct it"));
        } else if page.starts_with("docs/") && path.ends_with(".md") && !path.starts_with("docs/") {
            let what = format!("the link leads to '{path}', which is no page of the book");
            faults.push(Fault::new(page, *line, what, "link a page in docs/ or the web"));
        }
    }
    faults
}

/// The faults of formulas. Between dollars, a code host's Markdown removes the `\` before punctuation. A
/// block of ```` ```math ```` is unchanged, but may contain no dollars, and its braces must match.
pub fn check_formulas(page: &str, formulas: &[Formula]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for Formula { line, text, fenced } in formulas {
        let mut fault = |what: String, remedy| faults.push(Fault::new(page, *line, what, remedy));
        let mut pairs = text.chars().zip(text.chars().skip(1));
        let escaped = pairs.find(|(a, b)| *a == '\\' && b.is_ascii_punctuation());
        match escaped.filter(|_| !fenced) {
            Some((_, lost)) => fault(
                format!("in a formula, Markdown takes '\\{lost}' for '{lost}'"),
                "write a word, such as \\thinspace for \\,",
            ),
            None if *fenced && text.contains('$') => {
                fault("a block of formulas has a '$'".to_owned(), "take it out");
            }
            None => {}
        }
        let plain = text.replace("\\{", "").replace("\\}", "");
        let [open, closed] = ['{', '}'].map(|brace| plain.matches(brace).count());
        if open != closed {
            fault(format!("a formula has {open} '{{' and {closed} '}}'"), "pair them");
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_code_and_title_have_their_lines() {
        let text = "# 02 · `Basic`\n\n[a](x.md#y) ![b](images/ä.png)\n<img src=\"c.png\">\n\n\
                    [r][ref] and `cargo run`\n\n```sh\none\ntwo\n```\n\n[ref]: z.rs\n";
        let found = Markdown::parse(text);
        let links: Vec<(usize, &str)> =
            found.links.iter().map(|link| (link.line, &*link.target)).collect();
        assert_eq!(links, [(3, "x.md#y"), (3, "images/ä.png"), (4, "c.png"), (6, "z.rs")]);
        assert_eq!(found.title, Some((1, "02 · Basic".to_owned())));
        let block = found.code.iter().find(|code| code.language == "sh").unwrap();
        assert_eq!((block.line, &*block.text), (9, "one\ntwo\n"));
        assert!(found.code.iter().any(|code| code.line == 6 && code.text == "cargo run"));
    }

    #[test]
    fn formulas_must_survive_markdown() {
        let faults = |text: &str| {
            let faults = check_formulas("p.md", &Markdown::parse(text).formulas);
            faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n")
        };
        let told = faults("Fine: $a \\thinspace b$.\n\nNot: $t\\,d$, it costs $5.\n");
        assert!(told.starts_with("p.md:3: in a formula, Markdown takes '\\,' for ','; "), "{told}");
        // A block reaches the reader unchanged.
        assert_eq!(faults("```math\n\\frac{a}{b} \\, c\n```\n"), "");
        let told = faults("A\n\n```math\n$a$\n```\n");
        assert!(told.starts_with("p.md:4: a block of formulas has a '$'; "), "{told}");
        let told = faults("```math\n\\frac{1}{2\n```\n");
        assert!(told.starts_with("p.md:2: a formula has 2 '{' and 1 '}'; pair them"), "{told}");
    }
}
