//! The price line of a chapter: what is exact there, what that costs, and how much is wrong without it.
//!
//! It stands below the heading picture, above the first section:
//!
//! ````markdown
//! > **Exact:** where a shadow ray starts. **Price:** no time: a frame takes 1.00 times as long. **Without it:**
//! > 26,950<!-- acne.dark --> of 59,050<!-- acne.lit --> lit pixels go dark.
//! ````

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;

use crate::values::binding::stripped;

/// The words before each part, in order.
const LABELS: [&str; 3] = ["**Exact:**", "**Price:**", "**Without it:**"];

/// The parts of a page's price line, if it has one: it begins above the first section.
fn parts(page: &Page) -> Option<[String; 3]> {
    let head = page.prose().into_iter().map(|(_, line)| line);
    let head = head.take_while(|line| !line.starts_with("## "));
    let quoted: Vec<&str> = head.filter_map(|line| line.strip_prefix("> ")).collect();
    // What binds a number names values of this page, and the table of prices stands on another.
    let text = stripped(&quoted.join(" "));
    let [exact, price, without] = LABELS.map(|label| text.find(label));
    let part = |from: usize, label: &str, to: usize| {
        text.get(from + label.len()..to).map(|part| part.trim().to_owned())
    };
    let (exact, price, without) = (exact?, price?, without?);
    let parts = [
        part(exact, LABELS[0], price)?,
        part(price, LABELS[1], without)?,
        part(without, LABELS[2], text.len())?,
    ];
    parts.iter().all(|part| !part.is_empty()).then_some(parts)
}

/// The faults of the price line of a chapter's page.
pub fn check(project: &Project, page: &Page) -> Option<Fault> {
    let name = page.stem();
    project.of_page(&page.path).filter(|_| parts(page).is_none())?;
    let remedy =
        format!("write `> {} … {} … {} …` below the picture", LABELS[0], LABELS[1], LABELS[2]);
    Some(Fault::new(&*page.path, 1, format!("{name} has no price line"), remedy))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_line_has_three_parts_above_the_first_section() {
        let line =
            "> **Exact:** the start. **Price:** 1.00 times\n> a frame. **Without it:** acne.\n";
        let of = |text: String| parts(&Page::parse("p.md", &text));
        let expected = ["the start.", "1.00 times a frame.", "acne."].map(str::to_owned);
        assert_eq!(of(format!("# T\n\n{line}\n## S\n")), Some(expected));
        assert_eq!(of(format!("# T\n\n## S\n{line}")), None);
        for label in LABELS {
            assert_eq!(of(format!("# T\n\n{}", line.replace(label, ""))), None, "{label}");
        }
        assert_eq!(of("# T\n\n> **Exact:** **Price:** a **Without it:** b\n".to_owned()), None);
    }
}
