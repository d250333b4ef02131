//! Before and after: two pictures of one view, with a slider between them.
//!
//! `<!-- slider -->` above a sheet of two panels shows both, with the labels of their commands. `<!-- slider
//! OTHER: THEN | NOW -->` above a picture shows `images/OTHER.png` as the first.

use manuscript::page::Page;
use manuscript::project::Project;

use crate::color::escaped;
use crate::picture::{Part, Picture, size};

/// A slider as HTML in one line, and its pictures. Without a script the two are side by side.
///
/// # Errors
/// The fault of the mark.
pub fn html(
    project: &Project,
    page: &Page,
    file: &str,
    mark: &str,
    words: &str,
) -> Result<(String, [Picture; 2]), String> {
    let whole = |file: &str| Picture { from: file.to_owned(), part: Part::Whole };
    let half = |part| Picture { from: file.to_owned(), part };
    let (pictures, labels) = match mark.split_once(':') {
        Some((other, labels)) => {
            let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
            let other = format!("{folder}/{}.png", other.trim());
            if !project.has(&other) {
                return Err(format!("the slider takes '{other}', which does not exist"));
            }
            let [first, second] = [&*other, file].map(|file| size(&project.root.join(file)));
            if first.is_none() || first != second {
                return Err(format!("the slider's pictures '{other}' and '{file}' differ in size"));
            }
            ([whole(&other), whole(file)], labels.to_owned())
        }
        None => {
            let made = || labels_of(page, file);
            let labels = if mark.is_empty() { made().join(" | ") } else { mark.to_owned() };
            ([half(Part::First), half(Part::Second)], labels)
        }
    };
    let labels: Vec<String> = labels.split('|').map(|label| escaped(label.trim())).collect();
    let [first, second] = &labels[..] else {
        return Err(format!("the slider has {} labels for two pictures", labels.len()));
    };
    let wide = size(&project.root.join(file)).map_or(0, |(width, height)| match pictures[0].part {
        Part::Whole => width,
        _ => crate::picture::panel((width, height), false)[2],
    });
    // Small pictures show single pixels, so they stay sharp at twice their size.
    let (wide, sharp) = if wide <= 400 { (2 * wide, " sharp") } else { (wide, "") };
    let figure = |picture: &Picture, label: &str, alt: &str| {
        let image = picture.html(project, alt, true);
        format!("<span class=\"side\">{image}<span class=\"label\">{label}</span></span>")
    };
    let html = format!(
        "<span class=\"slider{sharp}\" style=\"--wide:{wide}px\">{}{}<input type=\"range\" min=\"0\" \
         max=\"100\" value=\"50\" aria-label=\"How much to show of: {first}, before: {second}\" hidden></span>",
        figure(&pictures[0], first, &format!("{words}: {first}")),
        figure(&pictures[1], second, &format!("{words}: {second}")),
    );
    Ok((html, pictures))
}

/// The labels of a sheet's panels, from the lines above the commands in its block.
fn labels_of(page: &Page, file: &str) -> Vec<String> {
    let stem = file.rsplit('/').next().and_then(|name| name.split('.').next());
    let made = page.pictures.iter().find(|mark| mark.name.as_deref() == stem);
    let lines = made.map_or("", |mark| &mark.command).lines();
    lines.filter_map(|line| Some(line.strip_prefix("# ")?.trim().to_owned())).collect()
}
