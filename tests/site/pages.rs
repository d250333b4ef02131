//! The site as text: no broken links, and nothing loaded from elsewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use manuscript::project::Project;

use crate::{addresses, built};

#[test]
fn every_link_leads_somewhere() {
    let built = built();
    let places: BTreeMap<&str, BTreeSet<&str>> = built
        .pages
        .iter()
        .map(|(page, (_, attributes))| {
            let ids = attributes.iter().filter(|attribute| attribute.name == "id");
            (&**page, ids.map(|attribute| &*attribute.value).collect())
        })
        .collect();
    let mut followed = 0;
    for (page, (_, attributes)) in &built.pages {
        for attribute in attributes.iter().filter(|a| ["href", "src"].contains(&&*a.name)) {
            let target = &attribute.value;
            let scheme = target.split_once(':').map_or("", |(scheme, _)| scheme);
            if ["https", "http", "data"].contains(&scheme) {
                continue;
            }
            assert!(
                !target.starts_with('/'),
                "{page} leads to '{target}', which needs a site's root"
            );
            let (file, id) = target.split_once('#').unwrap_or((target, ""));
            let file = if file.is_empty() { page } else { file };
            if let Some(there) = places.get(file) {
                let found = id.is_empty() || there.contains(id);
                assert!(found, "{page} leads to '{target}': there is no such place");
            } else {
                let there = built.folder.join(file).is_file();
                assert!(there, "{page} leads to '{target}', which is no file");
            }
            followed += 1;
        }
    }
    assert!(followed > 3000, "{followed} links");
}

#[test]
fn nothing_comes_from_elsewhere() {
    for (page, (text, attributes)) in &built().pages {
        let elsewhere = attributes.iter().find(|attribute| {
            let loads =
                attribute.name == "src" || attribute.tag == "link" && attribute.name == "href";
            loads && attribute.value.contains("//")
        });
        assert_eq!(elsewhere, None, "{page}");
        // The only thing for which mdBook's script would contact a server.
        assert!(!text.contains("class=\"playground"), "{page} has code that runs on a server");
    }
    let mut styles = Vec::new();
    for folder in [built().folder.clone(), built().folder.join("css"), built().folder.join("fonts")]
    {
        let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
        styles.extend(files.filter(|path| path.extension().is_some_and(|e| e == "css")));
    }
    assert!(styles.len() > 5, "{styles:?}");
    for style in styles {
        let text = fs::read_to_string(&style).unwrap();
        assert!(!text.contains("url(http") && !text.contains("url(\"http"), "{}", style.display());
        assert!(!text.contains("@import"), "{}", style.display());
    }
}

#[test]
fn every_page_says_what_it_is() {
    // mdBook has read its settings: otherwise it would make this page.
    assert!(!built().pages.contains_key("print.html"));
    let mut titles = BTreeSet::new();
    for page in addresses() {
        let (text, attributes) = &built().pages[page];
        let title = text.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>"));
        let title = title.map_or("", |(title, _)| title.trim());
        assert!(title.len() > " - Ray Tracing in Vulkan".len(), "{page}: '{title}'");
        // mdBook names the first page after its entry, and index.html is the same page.
        assert!(titles.insert(title), "{page} is called '{title}', as another page is");
        let language = attributes.iter().find(|a| a.tag == "html" && a.name == "lang");
        assert_eq!(language.map(|a| &*a.value), Some("en"), "{page}");
        let views = attributes.iter().any(|a| a.value.contains("width=device-width"));
        assert!(views, "{page} does not fit a phone");
    }
}

#[test]
fn every_formula_is_drawn_by_the_browser_itself() {
    let drawn: usize = built().pages.values().map(|(text, _)| text.matches("<math").count()).sum();
    assert_eq!(drawn, built().counts.formulas);
    assert!(drawn > 400, "{drawn} formulas");
    for (page, (text, _)) in &built().pages {
        // Code may contain anything.
        let mut pieces = text.split("<code").map(|piece| piece.rsplit("</code>").next().unwrap());
        let tex = |piece: &str| {
            ["<merror", "$$", "\\frac", "\\cdot"].iter().any(|tex| piece.contains(tex))
        };
        let code = page.ends_with("-code.html");
        assert_eq!(pieces.find(|piece| !code && tex(piece)), None, "{page}");
    }
}

#[test]
fn every_mark_of_a_figure_has_become_one() {
    let pages = built().pages.values();
    let figures: usize = pages.map(|(text, _)| text.matches(" data-figure=\"").count()).sum();
    assert_eq!(figures, built().counts.figures);
    assert!(figures > 5, "{figures} figures");
}

#[test]
fn every_picture_is_described_and_has_its_size() {
    let mut pictures = 0;
    for (page, (text, _)) in &built().pages {
        for tag in text.split("<img ").skip(1).map(|rest| rest.split_once('>').unwrap().0) {
            let card = page == "index.html" && tag.contains("-small.png");
            assert!(tag.contains("alt=\"") && (card || !tag.contains("alt=\"\"")), "{page}: {tag}");
            assert!(tag.contains(" width=\"") && tag.contains(" height=\""), "{page}: {tag}");
            pictures += 1;
        }
    }
    assert!(pictures >= built().counts.pictures, "{pictures} pictures");
}

#[test]
fn the_search_finds_what_pages_say_and_no_code() {
    let files = fs::read_dir(&built().folder).unwrap().map(|file| file.unwrap());
    let index = files
        .into_iter()
        .find(|file| file.file_name().to_string_lossy().starts_with("searchindex"));
    let index = fs::read_to_string(index.unwrap().path()).unwrap();
    for term in
        ["penumbra", "barycentr", "35_soft_shadows.html#why-is-the-edge-soft", "glossary.html#rung"]
    {
        assert!(index.contains(term), "{term}");
    }
    assert!(!index.contains("-code.html"));
}

#[test]
fn the_pages_follow_each_other_by_part() {
    let page = |name: &str| &built().pages[name].0;
    let last = page("44_geometries.html");
    assert!(last.contains("<p class=\"part\">I · Make it</p>"));
    // From the last chapter of a part to the first of the next, whose name is shown.
    let next = "<a class=\"next\" href=\"08_intersection.html\"><small>Next</small><small>II · Shapes</small>";
    assert!(last.contains(next), "{last}");
    assert!(last.contains("<a class=\"previous\" href=\"41_ray_offset.html\">"));
    assert!(page("toc.html").contains("II · Shapes"));
    let mut at = "index.html".to_owned();
    let mut read = BTreeSet::new();
    while read.insert(at.clone()) {
        let next = page(&at).split_once("<a class=\"next\" href=\"");
        let Some((_, next)) = next else { break };
        at = next.split_once('"').unwrap().0.to_owned();
    }
    // The pages of measurements are outside the reading order: each chapter links to its own.
    let beside = built().pages.keys().filter(|name| name.starts_with("measurements-")).count();
    assert!(beside > 10 && read.iter().all(|name| !name.starts_with("measurements-")));
    assert_eq!(read.len() + beside, built().counts.pages, "{read:?}");
}

#[test]
fn every_chapter_s_code_is_shown_whole_with_what_it_replaces() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let project = Project::open(&root).unwrap();
    for chapter in &project.chapters {
        let (text, _) = &built().pages[&format!("{}-code.html", chapter.name)];
        let main = project.read(&format!("samples/{}/main.rs", chapter.name)).unwrap();
        let (_, section) =
            text.split_once(&format!("samples-{}-main-rs\" class=\"file\"", chapter.name)).unwrap();
        let section = section.split_once("</details>").unwrap().0;
        // Every number occurs exactly once, including marks. The older side has its own.
        let new = section.split("<div class=\"").filter(|block| block.starts_with("new\""));
        let numbers: Vec<usize> = new
            .flat_map(|block| block.split("data-n=\"").skip(1))
            .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
            .collect();
        let expected: Vec<usize> = (1..=main.lines().count()).collect();
        assert_eq!(numbers, expected, "{}", chapter.name);
        let marks = main.lines().filter(|line| line.contains("ANCHOR")).count();
        assert!(section.matches("class=\"l mark\"").count() >= marks, "{}", chapter.name);
        let compared = section.contains("<div class=\"old\">");
        assert_eq!(compared, chapter.from.is_some(), "{}", chapter.name);
    }
}
