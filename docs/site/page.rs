//! A page of the book in the form mdBook needs: with its formulas, links, code, pictures and marks replaced.

mod mark;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::ops::Range;

use manuscript::fault::Fault;
use manuscript::link::local;
use manuscript::page::{Kind, Page};
use manuscript::project::Project;
use pulldown_cmark::{CodeBlockKind, Event, LinkType, Options, Parser, Tag, TagEnd};

use self::mark::Above;
use crate::color::{self, escaped};
use crate::contents::Entry;
use crate::formula;
use crate::link::{self, Target, Wanted};
use crate::picture::{Part, Picture};
use crate::{figure, gallery, slider};

/// A page, ready for mdBook, and what it needs.
#[derive(Debug, Default)]
pub struct Composed {
    /// Its Markdown.
    pub markdown: String,
    /// Files it shows or links to that belong to no chapter; they are listed on the page of its code.
    pub files: BTreeSet<String>,
    /// Its links within the site.
    pub wanted: Vec<Wanted>,
    /// Its pictures.
    pub pictures: BTreeSet<Picture>,
    /// Its faults.
    pub faults: Vec<Fault>,
    /// The number of formulas.
    pub formulas: usize,
    /// The number of sliders.
    pub sliders: usize,
    /// Its figures, by name.
    pub figures: BTreeSet<String>,
}

/// The extensions enabled in mdBook, and formulas.
const OPTIONS: Options = Options::ENABLE_TABLES
    .union(Options::ENABLE_FOOTNOTES)
    .union(Options::ENABLE_STRIKETHROUGH)
    .union(Options::ENABLE_TASKLISTS)
    .union(Options::ENABLE_HEADING_ATTRIBUTES)
    .union(Options::ENABLE_MATH);

/// Composes a page.
pub fn compose(project: &Project, entries: &[Entry], entry: &Entry, text: &str) -> Composed {
    let page = Page::parse(&entry.file, text);
    let mut composer = Composer {
        project,
        entries,
        entry,
        text,
        page: &page,
        edits: Vec::new(),
        folded: false,
        above: None,
        done: Composed::default(),
    };
    composer.done.faults.clone_from(&page.faults);
    composer.read();
    composer.finish()
}

struct Composer<'a> {
    project: &'a Project,
    entries: &'a [Entry],
    entry: &'a Entry,
    text: &'a str,
    page: &'a Page,
    edits: Vec<(Range<usize>, String)>,
    /// True if the next fenced block is a rarely needed command, which is folded.
    folded: bool,
    /// The line and content of the mark of a slider or a figure, until its picture follows.
    above: Option<(usize, Above)>,
    done: Composed,
}

impl Composer<'_> {
    fn read(&mut self) {
        let galleries = self.blocks(Kind::Gallery);
        let mistakes = self.blocks(Kind::Mistakes);
        for lines in &galleries {
            let (cards, pictures) = gallery::cards(self.project);
            self.done.pictures.extend(pictures);
            self.edits.push((self.bytes(lines), cards));
        }
        let mut code: Option<(String, String)> = None;
        let mut picture: Option<(usize, String, String)> = None;
        let mut links = 0;
        for (event, span) in Parser::new_ext(self.text, OPTIONS).into_offset_iter() {
            let index = self.text[..span.start].matches('\n').count();
            if galleries.iter().any(|lines| lines.contains(&index)) {
                continue;
            }
            match event {
                Event::InlineMath(tex) => self.formula(index, span, &tex, false),
                Event::DisplayMath(tex) => self.formula(index, span, &tex, true),
                Event::Start(Tag::Link { link_type, dest_url, .. }) => {
                    links += 1;
                    self.link(index, &span, link_type, &dest_url);
                }
                Event::End(TagEnd::Link) => links -= 1,
                Event::Start(Tag::Image { dest_url, .. }) => {
                    picture = Some((index, dest_url.into_string(), String::new()));
                }
                Event::End(TagEnd::Image) => {
                    let Some((line, target, words)) = picture.take() else { continue };
                    let mistake = mistakes.iter().any(|lines| lines.contains(&index));
                    self.picture(line, span, &target, &words, links > 0, mistake);
                }
                Event::Start(Tag::CodeBlock(kind)) => {
                    let language = match kind {
                        CodeBlockKind::Fenced(language) => language.into_string(),
                        CodeBlockKind::Indented => "text".to_owned(),
                    };
                    code = Some((language, String::new()));
                }
                Event::End(TagEnd::CodeBlock) => {
                    let Some((language, text)) = code.take() else { continue };
                    match &*language {
                        "math" => self.formula(index, span, text.trim(), true),
                        _ => self.code(span, &language, &text),
                    }
                }
                Event::Start(Tag::HtmlBlock) => self.html(index, span),
                Event::InlineHtml(html) if html.starts_with("<!--") => {
                    self.edits.push((span, String::new()));
                }
                Event::Text(text) | Event::Code(text) => {
                    let into = code.as_mut().map(|(_, text)| text);
                    if let Some(into) = into.or(picture.as_mut().map(|(_, _, words)| words)) {
                        into.push_str(&text);
                    } else if text.contains('$') && self.text[span.start..].starts_with('$') {
                        // An unclosed brace, for example: Markdown treats it as text.
                        let what = "a '$' begins a formula that does not end";
                        self.fault(index, what, "close it and its braces, or write it as code");
                    }
                }
                _ => {}
            }
        }
        for (index, line) in self.text.lines().enumerate() {
            if line.contains("{{#") {
                let what = "mdBook's {{#…}} is not filled in here";
                self.fault(index, what, "write a marker, such as <!-- snippet FILE#ANCHOR -->");
            }
        }
        if let Some((index, above)) = self.above.take() {
            let what = format!("no picture follows the mark '{}'", above.word());
            self.fault(index, what, "write it above a picture");
        }
    }

    fn finish(mut self) -> Composed {
        self.edits.sort_by_key(|(span, _)| (span.start, span.end));
        let mut markdown = String::new();
        if let Some(part) = &self.entry.part {
            let _ = writeln!(markdown, "<p class=\"part\">{}</p>\n", escaped(part));
        }
        let mut at = 0;
        for (span, replacement) in &self.edits {
            // A link around a picture is edited after the picture, and not inside it.
            if span.start < at {
                continue;
            }
            markdown.push_str(&self.text[at..span.start]);
            markdown.push_str(replacement);
            at = span.end;
        }
        markdown.push_str(&self.text[at..]);
        self.done.markdown = markdown + &figure::scripts(self.done.figures.iter());
        self.done
    }

    /// The lines of the blocks of a kind, from 0.
    fn blocks(&self, kind: Kind) -> Vec<Range<usize>> {
        let blocks = self.page.blocks.iter().filter(|block| block.kind == kind);
        blocks.map(|block| block.body.clone()).collect()
    }

    fn bytes(&self, lines: &Range<usize>) -> Range<usize> {
        let mut starts = vec![0];
        starts.extend(self.text.match_indices('\n').map(|(at, _)| at + 1));
        let at = |line: usize| starts.get(line).copied().unwrap_or(self.text.len());
        at(lines.start)..at(lines.end)
    }

    fn fault(&mut self, index: usize, what: impl Into<String>, remedy: &str) {
        let fault = Fault::new(&*self.entry.file, index + 1, what, remedy);
        if self.done.faults.last() != Some(&fault) {
            self.done.faults.push(fault);
        }
    }

    fn formula(&mut self, index: usize, span: Range<usize>, tex: &str, display: bool) {
        self.done.formulas += 1;
        match formula::mathml(tex, display) {
            Ok(html) => self.edits.push((span, html)),
            Err(error) => {
                let what = format!("the formula '{}' cannot be drawn: {error}", tex.trim());
                self.fault(index, what, "write it as TeX that math-core knows");
            }
        }
    }

    fn link(&mut self, index: usize, span: &Range<usize>, kind: LinkType, target: &str) {
        let found = link::resolve(self.project, self.entries, self.entry, target);
        let address = match found {
            Ok(Target::Web) => return,
            Ok(Target::Site(address)) => address,
            Ok(Target::File(file)) => {
                let address = link::shown(self.project, self.entries, self.entry, &file, None);
                self.done.files.extend(link::own(self.project, &file).is_none().then_some(file));
                address
            }
            Err(what) => return self.fault(index, what, "correct it"),
        };
        self.want(index, &address);
        // The target as written: in parentheses after the text, which may itself contain a link's address.
        let written = self.text[span.clone()].rfind(&format!("({target}"));
        match written.filter(|_| kind == LinkType::Inline) {
            Some(at) => {
                let start = span.start + at + 1;
                self.edits.push((start..start + target.len(), address));
            }
            None => self.fault(
                index,
                format!("the link to '{target}' has no address beside it"),
                "write [text](address)",
            ),
        }
    }

    fn want(&mut self, index: usize, address: &str) {
        let (page, id) = address.split_once('#').map_or((address, None), |(p, id)| (p, Some(id)));
        let page = if page.is_empty() { self.entry.address() } else { page.to_owned() };
        let file = self.entry.file.clone();
        self.done.wanted.push(Wanted { file, line: index + 1, page, id: id.map(str::to_owned) });
    }

    fn picture(
        &mut self,
        index: usize,
        span: Range<usize>,
        target: &str,
        words: &str,
        linked: bool,
        mistake: bool,
    ) {
        let Some(file) = local(&self.entry.file, target).filter(|file| self.project.has(file))
        else {
            return self.fault(index, format!("there is no picture '{target}'"), "correct it");
        };
        let above = self.above.take().map(|(_, above)| above);
        let above = above.or(mistake.then(|| Above::Slider("right | wrong".to_owned())));
        if let Some(Above::Slider(mark)) = &above {
            match slider::html(self.project, self.page, &file, mark, words) {
                Ok((html, pictures)) => {
                    self.done.sliders += 1;
                    self.done.pictures.extend(pictures);
                    self.edits.push((span, html));
                }
                Err(what) => self.fault(index, what, "correct the mark"),
            }
            return;
        }
        let picture = Picture { from: file, part: Part::Whole };
        let first = self.done.pictures.is_empty();
        let image = picture.html(self.project, words, !first);
        let html = if linked {
            image
        } else {
            format!("<a class=\"picture\" href=\"{}\">{image}</a>", picture.address())
        };
        let html = match above {
            Some(Above::Figure(mark)) => match figure::html(self.project, &mark, &html, words) {
                Ok((name, html)) if self.done.figures.insert(name.clone()) => html,
                Ok(_) => {
                    return self.fault(index, "this figure stands on the page twice", "keep one");
                }
                Err(what) => return self.fault(index, what, "correct the mark"),
            },
            _ => html,
        };
        self.done.pictures.extend(picture.still(&self.project.root));
        self.done.pictures.insert(picture);
        self.edits.push((span, html));
    }

    fn code(&mut self, span: Range<usize>, language: &str, text: &str) {
        let lines = color::lines(language, text).join("&#10;");
        let code = format!("<pre><code class=\"nohighlight {language}\">{lines}&#10;</code></pre>");
        let html = if std::mem::take(&mut self.folded) {
            format!(
                "<details class=\"command\"><summary>How this picture is made</summary>{code}</details>"
            )
        } else {
            code
        };
        // The fence's last line may be the last line of the text, without a line ending.
        let ended = self.text[span.clone()].ends_with('\n');
        self.edits.push((span, if ended { html + "\n" } else { html }));
    }
}
