//! The gallery of the front page: one card per chapter, stacked on a phone.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use manuscript::project::Project;

use crate::color::escaped;
use crate::picture::{Part, Picture};

/// The cards of all parts as HTML, and their pictures.
pub fn cards(project: &Project) -> (String, BTreeSet<Picture>) {
    let (mut html, mut pictures) = (String::new(), BTreeSet::new());
    for (heading, chapters) in project.parted() {
        let _ = writeln!(html, "### {heading}\n\n<ul class=\"cards\">");
        for chapter in chapters {
            let picture = Picture { from: chapter.picture(), part: Part::Small };
            let _ = writeln!(
                html,
                "<li><a href=\"{}.html\">{}<strong>{}</strong></a><span>{}</span></li>",
                chapter.name,
                picture.html(project, "", true),
                escaped(&chapter.heading()),
                escaped(&chapter.teaches)
            );
            pictures.insert(picture);
        }
        html.push_str("</ul>\n\n");
    }
    (html, pictures)
}
