//! Solids with known boundaries, and f64 compared with exact arithmetic.

use super::super::random::{Random, f32s, towards};
use super::*;

fn half(normal: DVec3, offset: f64) -> Solid {
    Solid::HalfSpace { normal, offset }
}

fn block(low: DVec3, high: DVec3) -> Solid {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter();
    let walls = axes.flat_map(|n| [half(n, high.dot(n)), half(-n, -low.dot(n))]);
    Solid::Intersection(walls.collect())
}

fn ball(center: DVec3, radius: f64) -> Solid {
    Solid::Ball(Sphere { center, radius })
}

/// A random convex solid or ball.
fn simple(random: &mut Random, balls: bool) -> Solid {
    if balls && random.below(2) == 0 {
        return ball(random.in_cube(), random.between(0.3, 1.2));
    }
    let walls = (0..4 + random.below(6)).map(|_| {
        let normal = f32s(random.unit() * random.scale(0.1, 10.0));
        half(normal, normal.length() * random.between(0.2, 1.0))
    });
    Solid::Intersection(walls.collect())
}

/// A random tree.
fn tree(random: &mut Random, depth: u32, balls: bool) -> Solid {
    if depth == 0 {
        return simple(random, balls);
    }
    let mut two = || (tree(random, depth - 1, balls), tree(random, depth - 1, balls));
    let (a, b) = two();
    match random.below(4) {
        0 => Solid::Union(vec![a, b]),
        1 => Solid::Intersection(vec![a, b]),
        2 => Solid::difference(a, b),
        _ => Solid::Inverse(Box::new(Solid::Union(vec![a, b]))),
    }
}

fn random_ray(random: &mut Random) -> Ray {
    towards(random.unit() * random.between(0.0, 5.0), random.in_cube() * 0.5)
}

#[test]
fn f64_agrees_with_exact() {
    let mut random = Random(22);
    let mut count = 0;
    for _ in 0..300 {
        let solid = tree(&mut random, 2, false);
        let ray = random_ray(&mut random);
        let exact = solid.boundaries_exact(&ray).unwrap();
        let plain = solid.boundaries(&ray);
        assert_eq!(exact.len(), plain.len(), "{solid:?} {ray:?}");
        for (exact, plain) in exact.iter().zip(&plain) {
            let t = to_f64(&exact.t);
            assert!((plain.t - t).abs() <= 4.0 * f64::EPSILON * t.abs(), "{plain:?} {exact:?}");
            assert_eq!((&exact.through, exact.enters), (&plain.through, plain.enters));
            count += 1;
        }
    }
    assert!(count > 400, "{count}");
}

#[test]
fn between_boundaries_membership_is_that_of_the_point() {
    let mut random = Random(23);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..400 {
        let solid = tree(&mut random, 2, true);
        let ray = random_ray(&mut random);
        let boundaries = solid.boundaries(&ray);
        for pair in boundaries.windows(2) {
            assert!(pair[0].enters != pair[1].enters && pair[0].t < pair[1].t);
            // Within a sliver, f64 cannot decide.
            if pair[1].t - pair[0].t > 1e-9 {
                let middle = ray.at((pair[0].t + pair[1].t) / 2.0);
                assert_eq!(solid.contains(middle), pair[0].enters, "{solid:?} {ray:?}");
                *if pair[0].enters { &mut inside } else { &mut outside } += 1;
            }
        }
    }
    assert!(inside > 200 && outside > 30, "{inside} {outside}");
}

#[test]
fn laws_of_sets_hold() {
    let mut random = Random(24);
    let not = |solid: &Solid| Solid::Inverse(Box::new(solid.clone()));
    let places = |solid: &Solid, ray: &Ray| -> Vec<f64> {
        solid.boundaries(ray).into_iter().map(|boundary| boundary.t).collect()
    };
    for _ in 0..300 {
        let [a, b] = [0, 1].map(|_| simple(&mut random, true));
        let ray = random_ray(&mut random);
        let both = Solid::Union(vec![a.clone(), b.clone()]);
        let by_inverse = not(&Solid::Intersection(vec![not(&a), not(&b)]));
        assert_eq!(both.boundaries(&ray), by_inverse.boundaries(&ray));
        assert_eq!(a.boundaries(&ray), not(&not(&a)).boundaries(&ray));
        assert_eq!(places(&a, &ray), places(&not(&a), &ray));
        assert!(places(&Solid::difference(a.clone(), a.clone()), &ray).is_empty());
        assert!(places(&Solid::Union(vec![a.clone(), not(&a)]), &ray).is_empty());
        assert_eq!(places(&Solid::Union(vec![a.clone(), a.clone()]), &ray), places(&a, &ray));
    }
}

#[test]
fn what_touches_has_no_gap_and_nothing_in_common() {
    let left = block(DVec3::NEG_ONE, DVec3::new(0.0, 1.0, 1.0));
    let right = block(DVec3::new(0.0, -1.0, -1.0), DVec3::ONE);
    let both = Solid::Union(vec![left.clone(), right.clone()]);
    let common = Solid::Intersection(vec![left.clone(), right.clone()]);
    let rest = Solid::difference(left.clone(), right.clone());
    let whole = block(DVec3::NEG_ONE, DVec3::ONE);
    // Across the common wall, slanting through it, within it, along an edge and past everything.
    for (origin, direction) in [
        (DVec3::new(-3.0, 0.25, 0.5), DVec3::X),
        (DVec3::new(-3.0, -0.5, 0.0), DVec3::new(3.0, 0.5, 0.125)),
        (DVec3::new(0.0, 0.5, 5.0), DVec3::NEG_Z),
        (DVec3::new(0.0, 1.0, 5.0), DVec3::NEG_Z),
        (DVec3::new(0.0, 3.0, 5.0), DVec3::NEG_Z),
    ] {
        let ray = Ray { direction, ..towards(origin, origin + DVec3::X) };
        let places = |solid: &Solid| -> Vec<f64> {
            let exact = solid.boundaries_exact(&ray).unwrap();
            let plain = solid.boundaries(&ray);
            assert_eq!(exact.len(), plain.len());
            plain.into_iter().map(|boundary| boundary.t).collect()
        };
        assert_eq!(places(&both), places(&whole), "{ray:?}");
        assert!(places(&common).is_empty(), "{ray:?}");
        assert_eq!(places(&rest), places(&left), "{ray:?}");
    }
    // A ball that is only touched is not hit.
    let touched = ball(DVec3::ZERO, 1.0);
    let ray = Ray { direction: DVec3::X, ..towards(DVec3::new(-3.0, 1.0, 0.0), DVec3::ZERO) };
    assert!(touched.boundaries(&ray).is_empty() && touched.boundaries_exact(&ray).is_none());
}

#[test]
fn the_first_crossing_within_the_interval() {
    let bitten = Solid::difference(block(DVec3::NEG_ONE, DVec3::ONE), ball(DVec3::Y, 0.5));
    let ray = Ray { direction: DVec3::NEG_Y, ..towards(DVec3::Y * 3.0, DVec3::ZERO) };
    let first = bitten.intersect(&ray).unwrap();
    // Into the dent, through the ball's far side, which is number 6.
    assert_eq!((first.t, first.through, first.enters), (2.5, vec![6], true));
    let second = bitten.intersect(&Ray { tmin: 2.5, ..ray }).unwrap();
    assert_eq!((second.t, second.enters), (4.0, false));
    assert!(bitten.intersect(&Ray { tmax: 2.0, ..ray }).is_none());
    assert_eq!(bitten.intervals(&ray), [[2.5, 4.0]]);
    // Clipped, the dent is gone, and with a lid it has one.
    let lid = half(DVec3::Y, 0.25);
    let open = bitten.intersect_within(&lid, &ray).unwrap();
    assert_eq!((open.t, open.enters), (4.0, false));
    let capped = Solid::Intersection(vec![bitten.clone(), lid]);
    let capped = capped.intersect(&ray).unwrap();
    assert_eq!((capped.t, capped.through, capped.enters), (2.75, vec![7], true));
}
