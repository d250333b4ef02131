//! 03's candidates in every order, compared with the drawing and with exact intersections.

use std::collections::BTreeMap;
use std::fs;

use glam::DVec3;
use reference::Ray;
use reference::triangle::intersect_exact;
use serde_json::{Value, json};

use super::{found, root, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "03_any_hit.html";

/// The height of a pane's cell.
const CELL: f64 = 28.0;

/// The panes crossed by a ray at a height, and the places; `true` for wood. Wood is two triangles per cell,
/// and so are holes.
fn crossed(panes: &BTreeMap<String, (f64, String)>, height: f64) -> Vec<(f64, String, bool)> {
    let ray = Ray {
        origin: DVec3::new(20.0, height, 0.25),
        direction: DVec3::X,
        tmin: 0.0,
        tmax: f64::INFINITY,
    };
    let mut met = Vec::new();
    for (name, (x, cells)) in panes {
        for (index, cell) in cells.chars().enumerate() {
            let corner = |up: f64, side: f64| DVec3::new(*x, (index as f64 + up) * CELL, side);
            let corners =
                [corner(0.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            let halves = [[0, 1, 2], [0, 2, 3]].map(|half| half.map(|at| corners[at]));
            let t = halves.iter().find_map(|half| intersect_exact(&ray, half));
            met.extend(t.map(|hit| (hit.surface.to_f64().t, name.clone(), cell == '1')));
        }
    }
    met.sort_by(|a, b| a.0.total_cmp(&b.0));
    met
}

#[test]
#[ignore = "nightly only: in a browser"]
fn every_order_of_candidates_finds_the_nearest_wood_and_only_calls_depend_on_it() {
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "candidates");
    // Initially, the figure shows the same as the drawing.
    let svg = fs::read_to_string(root().join("docs/images/any_hit_order.svg")).unwrap();
    let drawn = |words: &str| svg.lines().filter(|line| line.contains(words)).count();
    let told = found(&mut browser, &[], "found.steps.map(({ name, says }) => [name, says])");
    assert_eq!(
        told,
        json!([["B", "ignored"], ["C", "accepted"], ["A", "accepted"], ["D", "no call"]])
    );
    for (name, call) in
        [("340.0", "1st call"), ("500.0", "2nd call"), ("180.0", "3rd call"), ("680.0", "no call")]
    {
        assert_eq!(
            drawn(&format!(
                "<text x=\"{name}\" y=\"70.0\" text-anchor=\"middle\" font-size=\"14\" font-weight=\"bold\">{call}<"
            )),
            1,
            "{call}"
        );
    }

    let panes = found(&mut browser, &[], "found.panes");
    let panes: BTreeMap<String, (f64, String)> = serde_json::from_value(panes).unwrap();
    let (mut differ, mut misses) = (0, 0);
    for height in [14, 41, 57, 70, 99, 126] {
        let crossed = crossed(&panes, f64::from(height));
        assert_eq!(crossed.len(), panes.len());
        let nearest = crossed.iter().find(|(_, _, wood)| *wood).map(|(_, name, _)| name.clone());
        misses += usize::from(nearest.is_none());
        for answer in ["return", "terminateRayEXT"] {
            let controls = [("ray", height.to_string()), ("on wood", answer.to_owned())];
            found(&mut browser, &controls.each_ref().map(|(name, at)| (*name, &**at)), "0");
            let (mut hits, mut counts) = (BTreeMap::new(), BTreeMap::new());
            let mut orders = Vec::new();
            for order in 1..=24 {
                let told = found(&mut browser, &[("order", &order.to_string())], "found");
                let names: Vec<String> = serde_json::from_value(told["order"].clone()).unwrap();
                // A pane is a candidate if no wood before it in the order is closer.
                let place = |name: &String| crossed.iter().find(|at| at.1 == *name).unwrap();
                let wood: Vec<_> = names.iter().filter(|name| place(name).2).collect();
                let asked = |at: usize| match answer {
                    "return" => {
                        !names[..at].iter().any(|a| place(a).2 && place(a).0 < place(&names[at]).0)
                    }
                    _ => !names[..at].iter().any(|name| place(name).2),
                };
                let calls = (0..names.len()).filter(|&at| asked(at)).count();
                let hit = if answer == "return" {
                    nearest.clone()
                } else {
                    wood.first().copied().cloned()
                };
                let end = &told["steps"][3];
                assert_eq!([&end["hit"], &end["calls"]], [&json!(hit), &json!(calls)], "{told}");
                *hits.entry(hit.unwrap_or("null".to_owned())).or_insert(0) += 1;
                *counts.entry(calls.to_string()).or_insert(0) += 1;
                orders.push(names);
                assert_eq!(told["order"].as_array().unwrap().len(), 4);
            }
            let told = found(&mut browser, &[], "[found.hits, found.counts]");
            assert_eq!(told, json!([hits, counts]), "{height}, {answer}");
            let said = browser.run("figure.said.textContent");
            let same = said.as_str().unwrap().contains("the same in all 24 orders");
            assert_eq!(same, hits.len() == 1, "{said}");
            assert!(answer != "return" || hits.len() == 1, "{hits:?}");
            differ += usize::from(hits.len() > 1);
            orders.sort();
            orders.dedup();
            assert_eq!(orders.len(), 24);
        }
    }
    assert!(differ >= 4 && misses == 1, "{differ} {misses}");
    let left: Value = browser.run("figure.stage.querySelectorAll('.record').length");
    assert_eq!(left, 4);
}
