//! The price line of a chapter: what is exact, what it costs, and how wrong the result is without it.
//!
//! The line is optional. It opens the section about accuracy, near the end:
//!
//! ````markdown
//! ## What accuracy costs here
//!
//! > **Exact:** where a shadow ray starts. **Price:** no time: a frame takes 1.00 times as long. **Without it:**
//! > 26,950<!-- acne.dark --> of 59,050<!-- acne.lit --> lit pixels go dark.
//! ````

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;

/// The label of each part, in order.
const LABELS: [&str; 3] = ["**Exact:**", "**Price:**", "**Without it:**"];

/// The heading of the section that it opens.
const SECTION: &str = "## What accuracy costs here";

/// The fault of the price line of a chapter's page, if it has one.
pub fn check(project: &Project, page: &Page) -> Option<Fault> {
    project.of_page(&page.path)?;
    let (line, what, remedy) = wrong(page)?;
    Some(Fault::new(&*page.path, line, what, remedy))
}

/// The faulty line of a price line, the fault, and the remedy.
fn wrong(page: &Page) -> Option<(usize, &'static str, String)> {
    let prose = page.prose();
    let is_part = |line: &str| line.starts_with("> ") && LABELS.iter().any(|l| line.contains(l));
    let first = prose.iter().position(|(_, line)| is_part(line))?;
    let line = prose[first].0;
    let above = prose[..first].iter().rev().map(|(_, line)| line.trim());
    if above.into_iter().find(|line| !line.is_empty()) != Some(SECTION) {
        return Some((
            line,
            "the price line stands elsewhere",
            format!("move it below '{SECTION}'"),
        ));
    }
    let quoted = prose[first..].iter().map_while(|(_, line)| line.strip_prefix("> "));
    let text = quoted.collect::<Vec<_>>().join(" ");
    let form = format!("write `> {} … {} … {} …`", LABELS[0], LABELS[1], LABELS[2]);
    (!is_whole(&text)).then_some((line, "the price line lacks a part", form))
}

/// Returns whether all parts are present, in order, and not empty.
fn is_whole(text: &str) -> bool {
    let mut rest = text;
    let mut parts = Vec::new();
    for label in LABELS {
        let Some((before, behind)) = rest.split_once(label) else { return false };
        parts.push(before.trim());
        rest = behind;
    }
    parts.push(rest.trim());
    parts[0].is_empty() && parts[1..].iter().all(|part| !part.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_line_has_three_parts_and_opens_its_section() {
        let of = |text: &str| wrong(&Page::parse("p.md", text)).map(|(line, what, _)| (line, what));
        let whole =
            "> **Exact:** the start. **Price:** 1.00 times\n> a frame. **Without it:** acne.\n";
        assert_eq!(of(&format!("# T\n\n{SECTION}\n\n{whole}\nMore.\n")), None);
        assert_eq!(of("# T\n\n## S\n"), None);
        let elsewhere = Some((3, "the price line stands elsewhere"));
        assert_eq!(of(&format!("# T\n\n{whole}\n{SECTION}\n")), elsewhere);
        let lacks = Some((5, "the price line lacks a part"));
        for label in &LABELS[1..] {
            let part = whole.replace(label, "");
            assert_eq!(of(&format!("# T\n\n{SECTION}\n\n{part}")), lacks, "{label}");
        }
        let empty = "> **Exact:** **Price:** a **Without it:** b\n";
        assert_eq!(of(&format!("# T\n\n{SECTION}\n\n{empty}")), lacks);
    }
}
