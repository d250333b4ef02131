//! 21's marches over a section of a land, compared with the exact hit and with the page's statements.

use reference::Ray;
use reference::heightfield::Heightfield;
use reference::random::Random;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "21_heightfield.html";

/// A march: the number of heights it evaluates, the t and height of each, the hit's t, and whether it passed
/// through the ground.
type March = (usize, Vec<[f64; 2]>, f64, bool);

/// The steepest slope, the ray, the exact hit's t if there is one, and all marches.
type Found = (f64, Ray, Option<f64>, [March; 4]);

fn told(browser: &mut Browser, [slope, eye, aim]: [i64; 3]) -> Found {
    let controls = [("steepest slope", slope), ("eye", eye), ("aim", aim)];
    let controls = controls.map(|(name, value)| (name, value.to_string()));
    let controls = controls.each_ref().map(|(name, value)| (*name, &**value));
    let what = "[found.k, found.ray.o, found.ray.d, found.ray.tmax, found.truth, \
                found.marches.map(march => [march.asked, march.places, march.t, march.through])]";
    type Told = (f64, [f64; 3], [f64; 3], f64, Option<f64>, [March; 4]);
    let (k, origin, direction, tmax, truth, marches): Told =
        serde_json::from_value(found(browser, &controls, what)).unwrap();
    let ray = Ray { origin: origin.into(), direction: direction.into(), tmin: 0.0, tmax };
    (k, ray, truth, marches)
}

/// The figure's land, whose steepest slope is `k`.
fn land(k: f64) -> Heightfield {
    let [a, fx, b, gx] = [8.0, 1.0 / 256.0, 3.0, 1.0 / 32.0];
    Heightfield { k, a, fx, fz: 0.0, b, gx, gz: 0.0, lipschitz: k }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_last_two_marches_find_the_exact_hit_and_the_first_goes_through_ridges_that_are_steep() {
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(PAGE), "march");
    let mut random = Random(21);
    let mut within = |low: i64, high: i64| low + random.below((high + 1 - low) as usize) as i64;
    // The page: "try each march at slopes of 1, 3 and 6". Initially, the relaxed one is right to a pixel on
    // gentle slopes, and passes through the ground of the steepest.
    let begin = found(
        &mut browser,
        &[],
        "['steepest slope', 'eye', 'aim'].map(name => figure.number(name))",
    );
    assert_eq!(begin, serde_json::json!([6, 70, -56]));
    for slope in [1, 3, 6] {
        let (.., truth, [(_, _, t, through), ..]) = told(&mut browser, [slope, 70, -56]);
        let off = t - truth.unwrap();
        assert_eq!(through, slope == 6, "{slope}: {off}");
        assert!(
            if through { off > 20.0 } else { (0.001..1.0).contains(&off.abs()) },
            "{slope}: {off}"
        );
        let word = browser.run("figure.found.marches[0].word");
        assert_eq!(word.as_str().unwrap().starts_with("nearly right, 0."), !through, "{word}");
    }
    let (mut hits, mut gone, mut wrong) = (0, [0; 9], [0; 2]);
    for number in 0..135 {
        let controls = [number % 9, within(5, 130), within(-90, 130)];
        let (k, line, truth, marches) = &told(&mut browser, controls);
        let land = land(*k);
        let exact = land.intersect(line).map(|hit| hit.t);
        assert_eq!(truth.is_some(), exact.is_some(), "{controls:?}");
        let exact = exact.unwrap_or(f64::INFINITY);
        hits += usize::from(exact.is_finite());
        assert!(truth.is_none_or(|truth| (truth - exact).abs() < 1e-6), "{controls:?}: {truth:?}");
        for (rung, (asked, places, t, through)) in marches.iter().enumerate() {
            let what = format!("{controls:?}, {rung}: {t}, not {exact}");
            assert_eq!(places.len(), *asked, "{what}");
            // The figure's land equals the reference's.
            for [t, above] in places {
                let at = line.at(*t);
                assert!((at.y - land.height(at.x, 0.0).0 - above).abs() < 1e-3, "{what}");
            }
            if rung < 2 {
                // The steps on the page: 0.4 of the height, or the longest that is safe for every slope.
                let part = [0.4, 1.0 / (k * line.direction.x - line.direction.y)][rung];
                for two in places.windows(2) {
                    let step = part * two[0][1];
                    assert!((two[1][0] - two[0][0] - step).abs() <= 1e-6 * (step.abs() + 480.0));
                }
                if let Some([at, above]) = places.last().filter(|[at, _]| *at <= line.tmax) {
                    assert!(*asked == 300 || above.abs() < 0.0015 * at, "{what}");
                }
                let off = if *t > 0.0 { t - exact } else { exact };
                wrong[rung] += usize::from(off.abs() > 1e-3 && exact.is_finite());
            } else if exact.is_finite() {
                assert!((t - exact).abs() < 1e-3, "{what}");
            } else {
                assert_eq!(*t, 0.0, "{what}");
            }
            // Only the relaxed march passes through.
            assert!(!through || rung == 0, "{what}");
            // "If m > 2.5, a step of 0.4 of the height ends below the ground."
            let below = places.iter().any(|[t, above]| *t > 0.0 && *above < -1e-3);
            let fastest = k * line.direction.x - line.direction.y;
            assert!(rung > 0 || !below || fastest > 2.5, "{what}");
            gone[controls[0] as usize] += usize::from(*through);
        }
    }
    assert!(hits > 75 && wrong.iter().all(|wrong| *wrong > hits / 2), "{hits} {wrong:?}");
    assert!(gone[..5] == [0; 5] && gone.iter().sum::<usize>() > 1, "{gone:?}");

    // The page's picture of a march that gives up: over flat ground, each step leaves the same fraction of
    // the path.
    let (.., truth, [relaxed, ..]) = told(&mut browser, [0, 6, -1]);
    let left = truth.unwrap() * (1.0 - 0.4 * 7.0 / 480f64.hypot(7.0)).powi(300);
    assert!((relaxed.2 - (truth.unwrap() - left)).abs() < 0.01 && relaxed.0 == 300);
    let said = browser.run("figure.said.textContent");
    assert!(said.as_str().unwrap().contains("It gives up"), "{said}");
}
