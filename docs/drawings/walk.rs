//! A walk through a 2D tree of boxes: the boxes it visits, puts on the stack, and never opens.

use glam::DVec2;

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, GREEN, LINE, Point, RED, SEA, Sheet, WHITE, YOURS};

/// A triangle, and the place of its letter.
type Leaf = ([Point; 3], Point);

const LEAVES: [Leaf; 5] = [
    ([[84.0, 146.0], [84.0, 202.0], [152.0, 146.0]], [101.0, 171.0]),
    ([[94.0, 280.0], [150.0, 248.0], [142.0, 292.0]], [130.0, 279.0]),
    ([[212.0, 234.0], [268.0, 222.0], [236.0, 112.0]], [238.0, 223.0]),
    ([[312.0, 126.0], [364.0, 116.0], [340.0, 196.0]], [340.0, 142.0]),
    ([[376.0, 232.0], [424.0, 156.0], [420.0, 246.0]], [409.0, 216.0]),
];
const EYE: DVec2 = DVec2::new(34.0, 214.0);
const TOWARDS: DVec2 = DVec2::new(400.0, -44.0);

/// A box of the tree: its name, its contents, and its place in the drawing of the tree.
struct Place {
    name: &'static str,
    content: Content,
    drawn: Point,
}

enum Content {
    Node([usize; 2]),
    Leaf(Leaf),
}
use Content::{Leaf as Triangle, Node};

/// One visit: the box, the result in words, and the stack afterwards, its top last.
struct Visit {
    of: usize,
    found: String,
    stack: Vec<usize>,
}

fn tree() -> Vec<Place> {
    let place = |name, content, x: f64, level: f64| Place {
        name,
        content,
        drawn: [x, 84.0 + 62.0 * level],
    };
    let [a, b, c, d, e] = LEAVES.map(Triangle);
    vec![
        place("root", Node([1, 2]), 656.0, 0.0),
        place("P", Node([3, 6]), 578.0, 1.0),
        place("Q", Node([7, 8]), 734.0, 1.0),
        place("R", Node([4, 5]), 540.0, 2.0),
        place("A", a, 506.0, 3.0),
        place("B", b, 574.0, 3.0),
        place("C", c, 616.0, 2.0),
        place("D", d, 696.0, 2.0),
        place("E", e, 772.0, 2.0),
    ]
}

/// The bounding box of a place; each level is a little larger, so that the outlines are distinct.
fn bounds(tree: &[Place], of: usize) -> [DVec2; 2] {
    let [low, high] = match &tree[of].content {
        Node(children) => {
            let [one, other] = children.map(|child| bounds(tree, child));
            [one[0].min(other[0]), one[1].max(other[1])]
        }
        Triangle((corners, _)) => {
            let corners = corners.map(DVec2::from_array);
            corners
                .into_iter()
                .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], corner| {
                    [low.min(corner), high.max(corner)]
                })
        }
    };
    [low - 5.0, high + 5.0]
}

/// The point where the ray enters a box, between 0 and `end`.
fn entered([low, high]: [DVec2; 2], end: f64) -> Option<f64> {
    let (one, other) = ((low - EYE) / TOWARDS, (high - EYE) / TOWARDS);
    let enter = one.min(other).max_element().max(0.0);
    (enter <= one.max(other).min_element().min(end)).then_some(enter)
}

/// The first intersection of the ray with a triangle.
fn met(corners: &[Point; 3]) -> Option<f64> {
    let corners = corners.map(DVec2::from_array);
    let hits = (0..3).filter_map(|i| {
        let (from, edge) = (corners[i], corners[(i + 1) % 3] - corners[i]);
        let area = TOWARDS.perp_dot(edge);
        let along = (from - EYE).perp_dot(TOWARDS) / area;
        (0.0..=1.0).contains(&along).then(|| (from - EYE).perp_dot(edge) / area)
    });
    hits.min_by(f64::total_cmp)
}

/// As in `walk.glsl`.
fn walk(tree: &[Place]) -> (Vec<Visit>, f64) {
    let (mut visits, mut stack, mut nearest) = (Vec::new(), Vec::new(), f64::INFINITY);
    let mut next = Some(0);
    while let Some(of) = next.take().or_else(|| stack.pop()) {
        let found = match &tree[of].content {
            Node(children) => {
                let mut open: Vec<(f64, usize)> = children
                    .iter()
                    .filter_map(|&child| Some((entered(bounds(tree, child), nearest)?, child)))
                    .collect();
                open.sort_by(|a, b| a.0.total_cmp(&b.0));
                let [one, other] = children.map(|child| tree[child].name);
                next = open.first().map(|&(_, near)| near);
                match open[..] {
                    [(_, near), (_, far)] => {
                        stack.push(far);
                        let (near, far) = (tree[near].name, tree[far].name);
                        format!(
                            "the ray enters {near} and {far}; {near} is nearer, {far} is put aside"
                        )
                    }
                    [(_, child)] => {
                        let missed = if tree[child].name == one { other } else { one };
                        format!("the ray enters {}, misses {missed}", tree[child].name)
                    }
                    _ => format!("{one} and {other} begin behind the hit: neither is opened"),
                }
            }
            Triangle((corners, _)) => match met(corners).filter(|&t| t < nearest) {
                Some(t) => {
                    nearest = t;
                    "the triangle is hit: what lies behind is of no interest now".to_owned()
                }
                None => "the triangle is missed, although its box was entered".to_owned(),
            },
        };
        visits.push(Visit { of, found, stack: stack.clone() });
    }
    (visits, nearest)
}

/// A visit's number.
fn number(s: &mut Sheet, at: Point, number: usize) {
    s.dot(at, 9.0, WHITE);
    s.circle(at, 9.0, WHITE, SEA);
    s.say([at[0], at[1] + 4.5], Middle, &number.to_string());
}

fn scene(s: &mut Sheet, tree: &[Place], visits: &[Visit], nearest: f64) {
    let order = |of: usize| visits.iter().position(|visit| visit.of == of).map(|at| at + 1);
    for of in 1..tree.len() {
        let [low, high] = bounds(tree, of);
        let walls = [low.to_array(), [high.x, low.y], high.to_array(), [low.x, high.y]];
        let color = if order(of).is_some() { SEA } else { LINE };
        s.polygon(&walls, "none", color);
    }
    for place in tree {
        if let Triangle((corners, letter)) = &place.content {
            s.polygon(corners, YOURS, BROWN);
            s.say(*letter, Middle, place.name);
        }
    }
    let hit = EYE + nearest * TOWARDS;
    s.arrow(&[EYE.to_array(), hit.to_array()]);
    s.dashes(&[hit.to_array(), (EYE + TOWARDS).to_array()], LINE, 1.4);
    s.dot(EYE.to_array(), 5.0, LINE);
    s.dot(hit.to_array(), 4.5, RED);
    for (of, place) in tree.iter().enumerate().skip(1) {
        let [low, high] = bounds(tree, of);
        let is_leaf = matches!(place.content, Triangle(_));
        if !is_leaf {
            s.strong([low.x + 2.0, low.y - 7.0], Start, place.name);
        }
        if let Some(order) = order(of) {
            let at = if is_leaf { [high.x, low.y] } else { [low.x + 26.0, low.y - 11.0] };
            number(s, at, order);
        }
    }
}

fn diagram(s: &mut Sheet, tree: &[Place], visits: &[Visit]) {
    let (wide, high) = (50.0, 28.0);
    for place in tree {
        if let Node(children) = &place.content {
            for &child in children {
                let [x, y] = place.drawn;
                let below = tree[child].drawn;
                s.line(&[[x, y + high / 2.0], [below[0], below[1] - high / 2.0]], LINE, 1.4);
            }
        }
    }
    for (of, place) in tree.iter().enumerate() {
        let [x, y] = place.drawn;
        let order = visits.iter().position(|visit| visit.of == of);
        let fill = match (&place.content, order) {
            (_, None) => WHITE,
            (Node(_), _) => GREEN,
            (Triangle(_), _) => YOURS,
        };
        s.card([x - wide / 2.0, y - high / 2.0], [wide, high], fill, "", &[place.name]);
        if let Some(order) = order {
            number(s, [x - wide / 2.0, y - high / 2.0], order + 1);
        }
    }
}

/// The scene with the ray, the tree next to it, and each visit with the stack below.
pub fn near_first() -> String {
    let mut s = Sheet::new([840, 508], "A walk: the near box first, the far one on the stack");
    let tree = tree();
    let (visits, nearest) = walk(&tree);
    scene(&mut s, &tree, &visits, nearest);
    diagram(&mut s, &tree, &visits);
    let unopened = ["White, grey: not visited.", "B is missed; D and E", "begin behind the hit."];
    for (row, line) in unopened.into_iter().enumerate() {
        s.note([622.0, 250.0 + 18.0 * row as f64], Start, line);
    }
    let top = 342.0;
    s.strong([56.0, top], Start, "visit");
    s.strong([130.0, top], Start, "what comes of it");
    s.strong([530.0, top], Start, "the stack then: its top is at the right");
    for (row, visit) in visits.iter().enumerate() {
        let y = top + 26.0 + 24.0 * row as f64;
        number(&mut s, [36.0, y - 4.5], row + 1);
        s.say([56.0, y], Start, tree[visit.of].name);
        s.say([130.0, y], Start, &visit.found);
        if visit.stack.is_empty() {
            s.note([530.0, y], Start, "empty");
        }
        for (at, &of) in visit.stack.iter().enumerate() {
            let left = 530.0 + 36.0 * at as f64;
            s.card([left, y - 14.0], [32.0, 19.0], BLUE, "", &[tree[of].name]);
        }
    }
    s.svg()
}
