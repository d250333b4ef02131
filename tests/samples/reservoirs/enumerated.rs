//! Every outcome on two pixels: the unbiased weights give the integral, and the bias of the others is a fraction.

use dashu::rational::RBig;

use super::model::{Rules, Weights, World, both, first, second, whole};

fn fraction(above: u32, below: u32) -> RBig {
    whole(above) / whole(below)
}

fn rules(weights: Weights, visibility: bool) -> Rules {
    Rules { weights, visibility, candidates: 1, most: 20 }
}

/// The page's world: a pixel that sees a lamp of 1 and one of 3, and one that sees the first alone.
fn small() -> World {
    World {
        chosen: vec![fraction(1, 2), fraction(1, 2)],
        light: vec![vec![whole(1), whole(3)]; 2],
        seen: vec![vec![true, true], vec![true, false]],
    }
}

/// Three lamps with other probabilities. The second pixel has the third lamp below its horizon.
fn horizon() -> World {
    World {
        chosen: vec![fraction(1, 2), fraction(1, 3), fraction(1, 6)],
        light: vec![
            vec![whole(2), whole(5), fraction(1, 3)],
            vec![whole(4), fraction(1, 2), whole(0)],
        ],
        seen: vec![vec![true, false, true], vec![true, true, true]],
    }
}

/// The light of both pixels after so many frames with reuse in time and in space.
fn means(world: &World, rules: Rules, frames: u32) -> [RBig; 2] {
    let fresh = both(&world.candidates(rules, 0), &world.candidates(rules, 1));
    let mut kept = world.space(rules, &fresh);
    for _ in 1..frames {
        kept = world.next(rules, &kept);
    }
    [world.moments(0, &first(&kept)).0, world.moments(1, &second(&kept)).0]
}

#[test]
fn one_over_z_and_balance_give_the_integral_exactly() {
    for (name, world, frames) in [("small", small(), 2), ("horizon", horizon(), 1)] {
        let truth = [world.truth(0), world.truth(1)];
        for weights in [Weights::OneOverZ, Weights::Balance] {
            for visibility in [false, true] {
                for frames in 1..=frames {
                    let means = means(&world, rules(weights, visibility), frames);
                    assert_eq!(means, truth, "{name}, {weights:?}, {visibility}, {frames} frames");
                }
            }
        }
    }
}

/// Two candidates, three sources, one of them twice.
#[test]
fn so_they_do_with_more_candidates_and_sources() {
    let world = horizon();
    for weights in [Weights::OneOverZ, Weights::Balance] {
        let rules = Rules { candidates: 2, ..rules(weights, true) };
        let fresh = both(&world.candidates(rules, 0), &world.candidates(rules, 1));
        let mut mean = RBig::ZERO;
        for ((a, b), probability) in &fresh {
            let sources = [(0, a.clone()), (1, b.clone()), (1, b.clone())];
            mean += probability * world.moments(0, &world.merged(rules, &sources)).0;
        }
        assert_eq!(mean, world.truth(0), "{weights:?}");
    }
}

/// The page's table: the first pixel's light, which should be 4, after one to four frames. Whatever the second
/// pixel takes over from the first, it sees lamp A alone, and all agree about that.
#[test]
fn the_bias_of_one_over_m_is_a_fraction_that_grows() {
    let world = small();
    assert_eq!([world.truth(0), world.truth(1)], [whole(4), whole(1)]);
    let fractions = [(5, 2), (2, 1), (23, 14), (7, 5)];
    for (frames, (above, below)) in (1..).zip(fractions) {
        let [first, second] = means(&world, rules(Weights::OneOverM, true), frames);
        assert_eq!(first, fraction(above, below), "{frames} frames");
        assert_eq!(second, whole(1), "{frames} frames");
    }
    // Nothing is below a horizon here: without visibility, each pixel could have made each sample.
    assert_eq!(means(&world, rules(Weights::OneOverM, false), 2)[0], whole(4));
    // A lamp below the horizon has the effect of a hidden one.
    let mut below = small();
    below.light[1][1] = whole(0);
    assert_eq!(means(&below, rules(Weights::OneOverM, false), 1)[0], fraction(5, 2));
}
