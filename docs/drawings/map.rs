//! The map of the book: the first way as one line, and below it every chapter under its parent.
//!
//! All of it comes from `Cargo.toml`. It is narrow, so that its words can be read on a phone.

use std::path::Path;

use manuscript::project::{Chapter, Project, Way};

use crate::sheet::Anchor::{End, Middle, Start};
use crate::sheet::{BLUE, BROWN, DEVICE, GREEN, LEAF, LINE, SEA, Sheet, WHITE, YOURS};

/// The height of a row and of a card, and the indent of a chapter from its parent.
const ROW: f64 = 27.0;
const CARD: f64 = 21.0;
const STEP: f64 = 18.0;
/// The left edge, and the top of the first row.
const LEFT: f64 = 14.0;
const TOP: f64 = 168.0;
/// The line of the first way: its height, and the radius of a stop.
const FIRST: f64 = 62.0;
const FIRST_RADIUS: f64 = 15.0;
/// The distance between ways.
const LANE: f64 = 28.0;
/// The width of a letter, at most on average, regular and bold; and the margin of a card.
const LETTER: [f64; 2] = [7.2, 8.2];
const MARGIN: f64 = 7.0;
/// The width reserved for the number of a part.
const NUMERAL: f64 = 24.0;

/// The fills of the parts of the book, and the colours of the ways next to the tree.
const GROUNDS: [&str; 6] = [BLUE, GREEN, YOURS, "#f3d9a8", DEVICE, WHITE];
const INKS: [&str; 2] = [SEA, LEAF];

/// The chapters of this book.
///
/// # Panics
/// If the manifest cannot be read.
pub fn chapters() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    draw(&Project::open(&root).expect("Cargo.toml names the chapters"))
}

/// The first way as one line from left to right, which ends in the reader's own program.
fn first_line(s: &mut Sheet, project: &Project, way: &Way, width: f64) {
    let stops: Vec<(&str, &str)> = (way.chapters.iter())
        .filter_map(|number| project.chapters.iter().find(|chapter| chapter.number() == *number))
        .map(|chapter| (chapter.number(), chapter.title.as_str()))
        .chain([("", "your own program")])
        .collect();
    let room = (width - 2.0 * LEFT) / stops.len() as f64;
    let place = |stop: usize| LEFT + room * (stop as f64 + 0.5);
    for (stop, &(number, title)) in stops.iter().enumerate() {
        let x = place(stop);
        if stop > 0 {
            s.arrow(&[[place(stop - 1) + FIRST_RADIUS, FIRST], [x - FIRST_RADIUS - 2.0, FIRST]]);
        }
        s.circle([x, FIRST], FIRST_RADIUS, GROUNDS[0], BROWN);
        s.strong([x, FIRST + 4.5], Middle, number);
        for (row, word) in title.split(' ').enumerate() {
            s.note([x, FIRST + FIRST_RADIUS + 16.0 + 13.0 * row as f64], Middle, word);
        }
    }
}

/// The map of a project with at least one way through it.
///
/// # Panics
/// If it has none.
pub fn draw(project: &Project) -> String {
    let tree = project.tree();
    let parts = project.parted();
    let (first_way, ways) = project.ways.split_first().expect("a first way");
    let place = |row: usize| {
        let left = LEFT + STEP * tree[row].0 as f64;
        [left, TOP + ROW * (ways.len() + row) as f64]
    };
    let first = |chapter: &Chapter| first_way.chapters.iter().any(|n| n == chapter.number());
    let width = |row: usize| {
        let chapter = tree[row].1;
        let letter = LETTER[usize::from(first(chapter))];
        letter * chapter.heading().chars().count() as f64 + 2.0 * MARGIN + NUMERAL
    };
    let right = (0..tree.len()).map(|row| place(row)[0] + width(row)).fold(0.0, f64::max);
    // The upper way is outermost, so that its line crosses no other way's words.
    let lane = |way: usize| right + 24.0 + LANE * (ways.len() - 1 - way) as f64;
    let legend = TOP + ROW * (ways.len() + tree.len()) as f64 + 22.0;
    let size =
        [right + LANE * ways.len() as f64 + 14.0, legend + ROW * parts.len().div_ceil(2) as f64];
    let mut s = Sheet::new(size.map(|side| side as u32), "Read this first");
    first_line(&mut s, project, first_way, size[0]);
    s.title([LEFT, TOP - 10.0], Start, "Every chapter under the one it comes from");

    for (row, &(depth, chapter)) in tree.iter().enumerate() {
        let [x, y] = place(row);
        let parent = tree[..row].iter().rposition(|&(above, _)| above + 1 == depth);
        if let Some([px, py]) = parent.map(place) {
            let (down, across) = (px + 8.0, y + CARD / 2.0);
            s.line(&[[down, py + CARD], [down, across], [x, across]], LINE, 1.4);
        }
        let of = |part: &(String, Vec<&Chapter>)| part.1.contains(&chapter);
        let part = parts.iter().position(of).unwrap_or(0);
        s.card([x, y], [width(row), CARD], GROUNDS[part % GROUNDS.len()], "", &[]);
        let numeral = parts[part].0.split(' ').next().unwrap_or_default();
        s.note([x + width(row) - MARGIN, y + 15.0], End, numeral);
        let at = [x + MARGIN, y + 15.0];
        if first(chapter) {
            s.strong(at, Start, &chapter.heading())
        } else {
            s.say(at, Start, &chapter.heading())
        }
    }

    for (index, Way { title, chapters, .. }) in ways.iter().enumerate() {
        let (x, ink) = (lane(index), INKS[index % INKS.len()]);
        let row = |number: &String| tree.iter().position(|(_, c)| c.number() == *number);
        let middle = |row: usize| place(row)[1] + CARD / 2.0;
        let stops: Vec<f64> = chapters.iter().filter_map(row).map(middle).collect();
        let mut along = stops.clone();
        along.sort_by(f64::total_cmp);
        let head = TOP + ROW * index as f64 + CARD / 2.0;
        s.say([x - 22.0, head + 4.5], End, title);
        s.line(
            &[[x - 16.0, head], [x, head], [x, along.first().map_or(head, |y| y - 9.0)]],
            ink,
            2.5,
        );
        for pair in along.windows(2) {
            s.line(&[[x, pair[0] + 9.0], [x, pair[1] - 9.0]], ink, 2.5);
        }
        for (stop, &y) in stops.iter().enumerate() {
            s.circle([x, y], 9.0, WHITE, ink);
            s.say([x, y + 4.5], Middle, &(stop + 1).to_string());
        }
    }

    for (index, (heading, _)) in parts.iter().enumerate() {
        let rows = parts.len().div_ceil(2);
        let x = LEFT + (size[0] / 2.0 - LEFT) * (index / rows) as f64;
        let y = legend + ROW * (index % rows) as f64 - 12.0;
        s.card([x, y], [16.0, 16.0], GROUNDS[index % GROUNDS.len()], "", &[]);
        s.note([x + 24.0, y + 12.5], Start, heading);
    }
    s.svg()
}
