//! 08's ray past a sphere and a box, compared with the exact hits.

use std::collections::BTreeMap;

use glam::DVec3;
use reference::Ray;
use reference::aabb::Aabb;
use reference::sphere::Sphere;
use serde_json::json;

use super::{found, shown, wait};
use crate::browser::{Browser, Pointer};
use crate::reading::{DESK, address, sized};

pub const PAGE: &str = "08_intersection.html";

#[test]
#[ignore = "nightly only: in a browser"]
fn each_shape_reports_what_the_exact_ray_hits_first() {
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "box");
    let mut random = 1u32;
    let mut within = |low: u32, high: u32| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (random >> 16) % (high + 1 - low)
    };
    // The figure's initial ray, level rays on a wall and next to one, and random rays.
    let mut rays = vec![
        [100, 40, 200, 20, 380],
        [100, 160, 160, 0, 500],
        [100, 161, 161, 0, 500],
        [350, 160, 160, 0, 500],
    ];
    rays.extend((0..120).map(|_| {
        let [tmin, tmax] = [within(0, 150), within(0, 300)];
        [within(90, 440), within(40, 160), within(40, 160), tmin, tmax]
    }));
    let mut cases = BTreeMap::<_, usize>::new();
    for values in rays {
        let names = ["start x", "start y", "aim", "tmin", "tmax"];
        let values = values.map(|value| value.to_string());
        let controls: Vec<_> = names.into_iter().zip(values.iter().map(String::as_str)).collect();
        let told = found(&mut browser, &controls, "found");
        let plane = |value: &serde_json::Value| {
            let [x, y]: [f64; 2] = serde_json::from_value(value.clone()).unwrap();
            DVec3::new(x, y, 0.0)
        };
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        let center = plane(&told["sphere"]["center"]);
        let sphere = Sphere { center, radius: number(&told["sphere"]["radius"]) };
        let high = plane(&told["box"]["high"]) + DVec3::Z;
        let cuboid = Aabb { low: plane(&told["box"]["low"]) - DVec3::Z, high };
        let ray = Ray {
            origin: plane(&told["ray"]["origin"]),
            direction: plane(&told["ray"]["direction"]),
            tmin: number(&told["tmin"]),
            tmax: number(&told["tmax"]),
        };
        // The origin and the end match the controls.
        let control = |index: usize| values[index].parse::<f64>().unwrap();
        assert_eq!(ray.origin, DVec3::new(control(0), 220.0 - control(1), 0.0));
        let end = ray.at((466.0 - control(0)) / ray.direction.x);
        assert!((end.y - (220.0 - control(2))).abs() < 1e-9, "{told}");
        assert_eq!([ray.tmin, ray.tmax], [control(3), control(4).max(control(3))]);

        // The first hit along the line is the near root; the next hit is the far one.
        let exact = |shape: &str, ray: &Ray| match shape {
            "sphere" => sphere.intersect_exact(ray).map(|hit| hit.to_f64().t),
            _ => cuboid.intersect_exact(ray).map(|hit| hit.t.to_f64().value()),
        };
        let same = |t: &serde_json::Value, exact: Option<f64>| {
            let t = t.as_f64();
            let close = t.zip(exact).is_some_and(|(t, exact)| (t - exact).abs() < 1e-9);
            assert!(close || t.is_none() && exact.is_none(), "{exact:?}: {told}");
        };
        let said = browser.run("figure.said.textContent");
        let said = said.as_str().unwrap();
        for (index, shape) in ["sphere", "box"].into_iter().enumerate() {
            let line = Ray { tmin: f64::NEG_INFINITY, tmax: f64::INFINITY, ..ray };
            let near = exact(shape, &line);
            let after = |near| exact(shape, &Ray { tmin: near + 1e-6, ..line });
            let far = near.map(|near| after(near).unwrap_or(near));
            same(&told["shapes"][shape][0], near);
            same(&told["shapes"][shape][1], far);
            let hit = exact(shape, &ray);
            same(&told["hits"][index], hit);
            let mine =
                said.split(&format!("The {shape}: ")).nth(1).unwrap().split(['.']).next().unwrap();
            let case = match (near.zip(far), hit) {
                (None, _) => "no root",
                (Some((near, _)), Some(hit)) if hit == near => "is the first after tmin",
                (Some((near, _)), Some(_)) if near < 0.0 => "the ray starts inside",
                (Some(_), Some(_)) => "is too near",
                (Some((_, far)), None) if far <= ray.tmin => "both lie before tmin",
                (Some((near, _)), None) if near > ray.tmax => "both lie beyond tmax",
                _ => "one lies before tmin, the other beyond tmax",
            };
            assert!(mine.contains(case), "{case}: {said}");
            *cases.entry((shape, case)).or_default() += 1;
        }
        let hits = ["sphere", "box"].map(|shape| (exact(shape, &ray), shape));
        let nearest = hits.into_iter().filter_map(|(t, shape)| Some((t?, shape)));
        let nearest = nearest.min_by(|a, b| a.0.total_cmp(&b.0)).map_or("nothing", |hit| hit.1);
        assert!(said.replace("the ", "").ends_with(&format!("hits {nearest}.")), "{said}");
    }
    assert!(cases.len() == 14, "{cases:?}");
    // As in the page's drawing, the ray leaves the slab of y first, and with it the box.
    let told =
        found(&mut browser, &[("start x", "100"), ("start y", "40"), ("aim", "200")], "found");
    assert_eq!(told["shapes"]["box"], json!([told["slabs"][0][0], told["slabs"][1][1]]));
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_ends_of_the_ray_are_dragged_along_it() {
    let mut browser = Browser::start();
    sized(&mut browser, DESK);
    shown(&mut browser, &address(PAGE), "box");
    browser.run("figure.stage.scrollIntoView({ block: 'center', behavior: 'instant' })");
    for (index, name, by) in [(2, "tmin", 30.0), (3, "tmax", -30.0)] {
        let place = format!(
            "(box => [box.x + box.width / 2, box.y + box.height / 2])(\
             figure.stage.querySelectorAll('.grip')[{index}].getBoundingClientRect())"
        );
        let [x, y]: [f64; 2] = serde_json::from_value(browser.run(&place)).unwrap();
        let value = format!("figure.number({name:?})");
        let before = browser.run(&value).as_f64().unwrap();
        browser.drag(&[[x, y], [x + by, y]], Pointer::Mouse);
        wait(&mut browser, "!figure.changed");
        let [now, _]: [f64; 2] = serde_json::from_value(browser.run(&place)).unwrap();
        assert!((now - x - by).abs() < 1.5, "{name}: from {x} to {now}");
        assert_eq!(browser.run(&value).as_f64().unwrap() > before, by > 0.0, "{name}");
    }
}
