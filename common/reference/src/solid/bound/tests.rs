//! The bounds compared with solids traced in f32.

use glam::Vec3;

use super::super::super::random::{Random, f32s, towards};
use super::*;

/// Dot2 in f32, as the shaders have it.
fn dot2_f32(start: f32, a: Vec3, b: Vec3) -> f32 {
    let (mut sum, mut error) = (start, 0.0f32);
    for i in 0..3 {
        let product = a[i] * b[i];
        let next = sum + product;
        let back = next - sum;
        error += a[i].mul_add(b[i], -product) + ((sum - (next - back)) + (product - back));
        sum = next;
    }
    sum + error
}

/// sphere_stable of shaders/common/sphere.glsl.
fn ball_f32(f: Vec3, d: Vec3, r: f32) -> Option<[f32; 2]> {
    let (a, b) = (d.dot(d), -f.dot(d));
    let foot = f + (b / a) * d;
    let discriminant = a * (r * r - foot.dot(foot));
    if discriminant < 0.0 {
        return None;
    }
    let c = f.dot(f) - r * r;
    let root = discriminant.sqrt();
    let q = if b < 0.0 { b - root } else { b + root };
    let both = [c / q, q / a];
    Some([both[0].min(both[1]), both[0].max(both[1])])
}

/// The part of its bound that a change's error uses.
fn used(change: &Change, t: f32) -> f64 {
    let middle = (change.low + change.high) / 2.0;
    (f64::from(t) - middle).abs() / (change.high - middle)
}

#[test]
fn f32_stays_within_the_bounds_and_makes_use_of_them() {
    let mut random = Random(25);
    let (mut plane, mut ball, mut touches) = (0.0f64, 0.0f64, 0);
    for _ in 0..400_000 {
        let ray = towards(random.unit() * random.scale(0.1, 100.0), random.in_cube());
        let (o, d) = (ray.origin.as_vec3(), ray.direction.as_vec3());
        let normal = f32s(random.unit() * random.scale(0.1, 10.0));
        let offset = random.between(-2.0, 2.0) as f32;
        let n = normal.as_vec3();
        let [t, slope] = [dot2_f32(offset, -o, n), dot2_f32(0.0, d, n)];
        let flat = Solid::HalfSpace { normal, offset: offset.into() };
        let changes = flat.changes(&ray, Stray::default());
        plane = plane.max(used(&changes[0], t / slope));

        let radius = random.between(0.1, 1.5) as f32;
        // Every other ball is touched, or all but touched, by the ray.
        let aside = d.as_dvec3().any_orthonormal_vector() * f64::from(radius);
        let touched = f32s(ray.at(random.between(0.1, 2.0)) + aside);
        let center = if random.below(2) == 0 { touched } else { f32s(random.in_cube()) };
        let round = Solid::Ball(Sphere { center, radius: radius.into() });
        let changes = round.changes(&ray, Stray::default());
        match ball_f32(o - center.as_vec3(), d, radius) {
            Some(both) => {
                assert_eq!(changes.len(), 2, "{ray:?} {round:?}");
                for (change, t) in changes.iter().zip(both) {
                    assert!(change.holds(t.into()), "{ray:?} {round:?}: {t} {change:?}");
                    // A ball that is all but touched may use all of the bound: the ray's foot is its end.
                    if change.sure {
                        ball = ball.max(used(change, t));
                    }
                }
            }
            None => assert!(changes.iter().all(|change| !change.sure), "{ray:?} {round:?}"),
        }
        touches += usize::from(changes.iter().any(|change| !change.sure));
    }
    println!("of the bounds: plane {plane:.2}, ball {ball:.2}; {touches} balls touched");
    assert!(plane <= 1.0 && ball <= 1.0, "{plane} {ball}");
    assert!(plane > 0.1 && ball > 0.1 && touches > 200, "{plane} {ball} {touches}");
}

#[test]
fn an_answer_is_judged_by_its_margin() {
    let flat = |normal, offset| Solid::HalfSpace { normal, offset };
    let all = Solid::Intersection(vec![]);
    let ray = Ray { direction: DVec3::NEG_Y, ..towards(DVec3::Y * 3.0, DVec3::ZERO) };
    // Two planes cross almost exactly where the ray hits them.
    let edge = |apart: f64| {
        Solid::Intersection(vec![flat(DVec3::Y, 1.0), flat(DVec3::new(1.0, 1.0, 0.0), 1.0 + apart)])
    };
    let says = |solid: &Solid, t, member, enters| {
        solid.judge(&all, &ray, Stray::default(), Some(SolidAnswer { t, member, enters }))
    };
    assert_eq!(says(&edge(1e-3), 2.0, 0, true), SolidVerdict::Agrees(Some(2.0)));
    assert_eq!(says(&edge(1e-3), 2.0 - 1e-3, 1, true), SolidVerdict::Wrong);
    assert_eq!(says(&edge(1e-9), 2.0, 1, true), SolidVerdict::Near);
    assert_eq!(says(&edge(1e-9), 2.0 + 1e-5, 0, true), SolidVerdict::Wrong);
    let silent = |solid: &Solid| solid.judge(&all, &ray, Stray::default(), None);
    assert_eq!(silent(&edge(1e-3)), SolidVerdict::Wrong);
    assert_eq!(silent(&Solid::Inverse(Box::new(all.clone()))), SolidVerdict::Agrees(None));
}
