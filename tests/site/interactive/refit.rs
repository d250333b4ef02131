//! 14's two trees of moving triangles, compared with rays through their boxes.

use std::array::from_fn;

use glam::DVec3;
use reference::Ray;
use reference::aabb::Aabb;
use reference::random::Random;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "14_animation.html";

/// The figure's contents: its triangles, the boxes of both trees, a ray's average cost, the number of boxes
/// hit by the ray, and its depth.
type Found = (Vec<[[f64; 2]; 3]>, [Vec<[[f64; 2]; 2]>; 2], [f64; 2], [usize; 2], f64);

/// Each level of the figure's boxes is larger by this.
const GAP: f64 = 5.0;
/// The positions of the leaves in a list with each box before those inside it.
const LEAVES: [usize; 4] = [2, 3, 5, 6];
const PARENTS: [[usize; 3]; 3] = [[1, 2, 3], [4, 5, 6], [0, 1, 4]];

fn told(browser: &mut Browser, motion: &str, frame: usize, ray: usize) -> Found {
    let [frame, ray] = [frame, ray].map(|number| number.to_string());
    let controls = [("motion", motion), ("frame", &*frame), ("ray", &*ray)];
    let what = "[found.triangles, found.boxes, found.costs, found.met, found.y]";
    serde_json::from_value(found(browser, &controls, what)).unwrap()
}

/// The box around some points, with the gap.
fn around<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [[f64; 2]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in points {
        low = from_fn(|axis| low[axis].min(point[axis] - GAP));
        high = from_fn(|axis| high[axis].max(point[axis] + GAP));
    }
    [low, high]
}

/// The two triangles of each leaf, and nothing else: the four leaves together contain all triangles.
fn pairs(triangles: &[[[f64; 2]; 3]], boxes: &[[[f64; 2]; 2]]) -> [[usize; 2]; 4] {
    let pairs = LEAVES.map(|leaf| {
        let all = (0..8).flat_map(|i| (i + 1..8).map(move |j| [i, j]));
        let mut fit =
            all.filter(|pair| around(pair.iter().flat_map(|&i| &triangles[i])) == boxes[leaf]);
        let pair = fit.next().expect("a leaf is around a pair");
        assert_eq!(fit.next(), None);
        pair
    });
    let mut held: Vec<usize> = pairs.into_iter().flatten().collect();
    held.sort_unstable();
    assert_eq!(held, Vec::from_iter(0..8));
    for [parent, one, other] in PARENTS {
        assert_eq!(around(boxes[one].iter().chain(&boxes[other])), boxes[parent]);
    }
    pairs
}

fn flat([low, high]: &[[f64; 2]; 2]) -> Aabb {
    let corner = |[x, y]: [f64; 2], z| DVec3::new(x, y, z);
    Aabb { low: corner(*low, -1.0), high: corner(*high, 1.0) }
}

fn line(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction, tmin: f64::NEG_INFINITY, tmax: f64::INFINITY }
}

/// The number of boxes hit by random lines that hit the first.
fn counted(boxes: &[[[f64; 2]; 2]]) -> f64 {
    let boxes: Vec<Aabb> = boxes.iter().map(flat).collect();
    let mut random = Random(14);
    let (mut met, mut lines) = (0, 0);
    for _ in 0..100_000 {
        let (sin, cos) = random.between(0.0, std::f64::consts::PI).sin_cos();
        let aside = random.between(-200.0, 200.0);
        let ray = line(
            DVec3::new(150.0 - aside * sin, 120.0 + aside * cos, 0.0),
            DVec3::new(cos, sin, 0.0),
        );
        if boxes[0].intersect(&ray).is_some() {
            lines += 1;
            met += boxes.iter().filter(|one| one.intersect(&ray).is_some()).count();
        }
    }
    met as f64 / f64::from(lines)
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_trees_hold_all_triangles_and_cost_what_random_rays_meet() {
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "refit");
    let mut worst = [0.0f64; 2];
    for (way, motion) in ["apart", "a wave"].into_iter().enumerate() {
        let mut first = None;
        for frame in (0..=120).step_by(15) {
            let (triangles, boxes, costs, met, y) =
                told(&mut browser, motion, frame, 10 + 3 * frame / 2);
            let what = format!("{motion}, frame {frame}: {costs:?}");
            let [updated, anew] = boxes.each_ref().map(|boxes| pairs(&triangles, boxes));
            // An update preserves the pairs of the first frame.
            assert_eq!(*first.get_or_insert(anew), updated, "{what}");
            // The ray of the figure is level.
            let ray = line(DVec3::new(12.0, y, 0.0), DVec3::X);
            for tree in 0..2 {
                let hits =
                    boxes[tree].iter().filter(|one| flat(one).intersect_exact(&ray).is_some());
                assert_eq!(hits.count(), met[tree], "{what}");
                let counted = counted(&boxes[tree]);
                assert!((costs[tree] / counted - 1.0).abs() < 0.01, "{what}, not {counted}");
            }
            worst[way] = worst[way].max(costs[0] / costs[1]);
            let said = browser.run("figure.said.textContent");
            let ratio = format!("{:.2} times as many", costs[0] / costs[1]);
            assert!(said.as_str().unwrap().contains(&ratio), "{said}, not {ratio}");
        }
    }
    // "Worst is a piece that leaves its neighbours": about as bad as the unfolding flag.
    assert!(worst[0] > 1.4, "{worst:?}");
    assert!(worst[1] < 1.1, "{worst:?}");
    // "A wave passes, and the next is like the last."
    for frame in [0, 7, 22, 41, 60] {
        let [one, next] =
            [frame, frame + 60].map(|frame| told(&mut browser, "a wave", frame, 120).2);
        assert!(one.iter().zip(next).all(|(one, next)| (one - next).abs() < 1e-9), "{frame}");
    }
}
