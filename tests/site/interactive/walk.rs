//! 30's walk, compared with the drawing's own and with brute force.

use std::fs;

use glam::DVec2;
use serde_json::json;

use super::{found, root, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "30_own_tree.html";

/// The value of an attribute of a drawing's element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    element.split_once(&format!("{name}=\"")).unwrap().1.split('"').next().unwrap()
}

/// A row of the walk's table: the visit, its result, and the stack afterwards.
type Visit = (String, String, Vec<String>);

/// The triangles of the walk's drawing, and its table.
fn drawn_walk() -> (Vec<[DVec2; 3]>, Vec<Visit>) {
    let svg = fs::read_to_string(root().join("docs/images/30_walk.svg")).unwrap();
    let corner = |point: &str| {
        let (x, y) = point.split_once(',').unwrap();
        DVec2::new(x.parse().unwrap(), y.parse().unwrap())
    };
    let (mut triangles, mut rows) = (Vec::new(), Vec::new());
    for element in svg.lines() {
        if element.starts_with("<polygon") {
            let corners: Vec<DVec2> = attribute(element, "points").split(' ').map(corner).collect();
            triangles.extend(<[DVec2; 3]>::try_from(corners));
        }
        if element.starts_with("<text") && attribute(element, "y").parse::<f64>().unwrap() > 342.0 {
            let text = element.split(['>', '<']).nth(2).unwrap().to_owned();
            match (attribute(element, "x").parse::<f64>().unwrap(), rows.last_mut()) {
                (56.0, _) => rows.push((text, String::new(), Vec::new())),
                (130.0, Some(row)) => row.1 = text,
                (546.0.., Some(row)) => row.2.push(text),
                _ => {}
            }
        }
    }
    (triangles, rows)
}

/// The point where a ray from `eye` enters a triangle: inside all three edges.
fn entered(eye: DVec2, towards: DVec2, corners: [DVec2; 3]) -> Option<f64> {
    let turn = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).signum();
    let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
    for i in 0..3 {
        let edge = turn * (corners[(i + 1) % 3] - corners[i]);
        let (within, rate) = (edge.perp_dot(eye - corners[i]), edge.perp_dot(towards));
        match rate {
            0.0 if within < 0.0 => return None,
            0.0 => {}
            _ if rate > 0.0 => enter = enter.max(-within / rate),
            _ => leave = leave.min(-within / rate),
        }
    }
    (enter <= leave).then_some(enter)
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_walks_find_the_nearest_triangle() {
    let (triangles, rows) = drawn_walk();
    assert_eq!((triangles.len(), rows.len()), (5, 6));
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "walk");
    let drawn = found(&mut browser, &[], "[Object.values(found.corners), found.visits, found.hit]");
    let corners: Vec<[[f64; 2]; 3]> = serde_json::from_value(drawn[0].clone()).unwrap();
    assert_eq!(corners.iter().map(|all| all.map(DVec2::from)).collect::<Vec<_>>(), triangles);
    assert_eq!([&drawn[1], &drawn[2]], [&json!(rows), &json!("C")]);
    // Each step shows the content of its row.
    for (step, row) in rows.iter().enumerate() {
        found(&mut browser, &[("step", &(step + 1).to_string())], "found");
        let stack = if row.2.is_empty() { vec!["empty".to_owned()] } else { row.2.clone() };
        let shown = "[...figure.stage.querySelectorAll('.record')].map(a => a.textContent)";
        assert_eq!(browser.run(shown), json!(stack));
        let now = "figure.stage.querySelector('.panel + .panel rect.visited-now').dataset.of";
        assert_eq!(browser.run(now), json!(row.0));
        let said = browser.run("figure.said.textContent");
        assert!(said.as_str().unwrap().contains(&row.1), "{said}");
    }

    let mut random = 1u32;
    let mut height = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i64::from(random >> 16) % 201
    };
    let (mut hits, mut counts) = (0, [0, 0]);
    for _ in 0..200 {
        let (eye, aim) = (height(), height());
        let controls = [("eye", eye), ("aim", aim)].map(|(name, at)| (name, at.to_string()));
        let controls = controls.each_ref().map(|(name, at)| (*name, &**at));
        let from = DVec2::new(34.0, (300 - eye) as f64);
        let towards = DVec2::new(400.0, (eye - aim) as f64);
        let met = triangles.iter().zip(["A", "B", "C", "D", "E"]);
        let met = met.filter_map(|(corners, name)| Some((entered(from, towards, *corners)?, name)));
        let nearest = met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name);
        for order in ["near", "far"] {
            let told = found(&mut browser, &controls, "[found.hit, found.counts]");
            assert_eq!(told[0], json!(nearest), "{controls:?}, {order} first: {told}");
            found(&mut browser, &[("first", order)], "found");
            for (all, count) in counts.iter_mut().zip(told[1].as_array().unwrap()) {
                *all += count.as_u64().unwrap();
            }
        }
        hits += usize::from(nearest.is_some());
    }
    assert!(hits > 100 && hits < 200 && counts[0] < counts[1], "{hits} {counts:?}");
}
