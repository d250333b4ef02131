//! The scenes' tori: their boxes hold them, and the links of the chain do not touch.

use glam::DVec3;
use reference::random::Random;
use reference::torus::Torus;

use super::traced::{scenes, tori};
use scenes::SceneKind;

/// A torus in the reference's form.
pub fn exact(torus: &tori::Torus) -> Torus {
    Torus {
        center: torus.center.as_dvec3(),
        axis: torus.axis.as_dvec3(),
        major: torus.major.into(),
        minor: torus.minor.into(),
    }
}

/// The point of a torus' circle at an angle.
fn on_circle(torus: &Torus, angle: f64) -> DVec3 {
    let n = torus.axis.normalize();
    let side = n.any_orthonormal_vector();
    torus.center + torus.major * (angle.cos() * side + angle.sin() * n.cross(side))
}

/// Random tori and the scenes' own; points in all directions, and the extreme one along each axis.
#[test]
fn boxes_hold_their_tori() {
    let mut random = Random(33);
    let mut all = super::traced::scene(SceneKind::Chain, 0.0);
    for _ in 0..200 {
        let size = random.scale(1e-3, 1e3);
        all.push(tori::Torus {
            center: (random.in_cube() * 10.0).as_vec3(),
            axis: (random.unit() * random.scale(0.01, 100.0)).as_vec3(),
            major: size as f32,
            minor: (size * random.scale(1e-6, 1.0)) as f32,
            material: 0,
        });
    }
    let mut least = f64::INFINITY;
    for torus in &all {
        let (low, high) = torus.bounds();
        let [low, high] = [low, high].map(|corner| corner.as_dvec3());
        let torus = exact(torus);
        let n = torus.axis.normalize();
        for e in [DVec3::X, DVec3::Y, DVec3::Z] {
            for e in [e, -e] {
                // The circle reaches farthest where it leans along e.
                let across = e - e.dot(n) * n;
                let ring = across.normalize_or(n.any_orthonormal_vector());
                let point = torus.center + torus.major * ring + torus.minor * e;
                let room = if e.min_element() < 0.0 {
                    (point - low).dot(-e)
                } else {
                    (high - point).dot(e)
                };
                assert!(room >= 0.0, "{torus:?}: {room} along {e}");
                least = least.min(room / torus.major);
            }
        }
    }
    assert!(least < 1e-6, "the boxes are larger than they need be, by {least}");
}

#[test]
fn links_pass_through_their_neighbours_and_touch_none() {
    let all: Vec<_> = super::traced::scene(SceneKind::Chain, 0.0).iter().map(exact).collect();
    let links: Vec<_> = all.iter().filter(|torus| torus.major == f64::from(0.15f32)).collect();
    assert!(links.len() > 15 && links.len().is_multiple_of(2), "{}", links.len());
    let turn = std::f64::consts::TAU / 720.0;
    for (i, link) in links.iter().enumerate() {
        let next = links[(i + 1) % links.len()];
        let points = (0..720).map(|k| on_circle(next, f64::from(k) * turn));
        let nearest = points.map(|point| link.distance(point)).fold(f64::INFINITY, f64::min);
        assert!(nearest > next.minor, "link {i} and the next overlap by {}", next.minor - nearest);
        // The next link's circle crosses this one's disk: once, if they are linked.
        let n = link.axis.normalize();
        let height = |k: u32| (on_circle(next, f64::from(k) * turn) - link.center).dot(n);
        let crossings = (0..720).filter(|&k| {
            let inside = (on_circle(next, f64::from(k) * turn) - link.center).length() < link.major;
            inside && (height(k) < 0.0) != (height(k + 1) < 0.0)
        });
        assert_eq!(crossings.count(), 1, "link {i} and the next are not linked");
    }
}
