//! Instances whose matrices are hard to invert.

use common::glam::{Affine3A, DVec3, Mat3A, Vec3, Vec3A};
use own_tree::Builder;
use reference::random::Random;

use crate::hunts::{ball, scene};
use crate::rig::{BEST, By, Given, NOTHING, Rig};

/// The number of rays, of a thousand from the middle of a ball, that hit its instance with these columns.
fn met(columns: [Vec3; 3]) -> usize {
    let mut scene = scene(ball(2), 1.0, DVec3::ZERO);
    let [x, y, z] = columns.map(Vec3A::from);
    scene.instances[0].transform = Affine3A::from_mat3(Mat3A::from_cols(x, y, z).into());
    let rig = Rig::new(&scene, Builder::Binned);
    let mut random = Random(11);
    let ray = |_| {
        let direction: DVec3 = random.unit();
        Given { origin: Vec3::ZERO, tmax: 1e30, direction: direction.as_vec3(), any: 0 }
    };
    let rays: Vec<_> = (0..1000).map(ray).collect();
    let (answers, _) = rig.answers(&rig.way(By::Walk, BEST), &rays);
    assert_eq!(rig.gpu.validation().all(), [""; 0]);
    answers.iter().filter(|answer| answer.instance != NOTHING).count()
}

#[test]
fn what_is_sheared_far_or_stretched_is_met_from_within() {
    for shear in [0.0, 1.0, 1e3, 1e6] {
        assert_eq!(met([Vec3::new(1.0, shear, 0.0), Vec3::Y, Vec3::Z]), 1000, "{shear}");
    }
    assert_eq!(met([Vec3::X * 1e-6, Vec3::Y, Vec3::Z * 1e6]), 1000);
}

#[test]
fn rays_are_answered_on_the_narrowest_device() {
    let test = "instances::what_is_singular_or_is_so_but_for_rounding_is_left_out";
    run::layer::in_child(test, "");
}

#[test]
fn what_is_singular_or_is_so_but_for_rounding_is_left_out() {
    let (a, b) = (Vec3::new(0.1, 0.7, -0.3), Vec3::new(-0.9, 0.2, 0.6));
    // A column of zeros is excluded: the scene is refused.
    for third in [a * 0.3 + b * 0.7, a * 3.1 - b, Vec3::X * 1e-39] {
        assert_eq!(met([a, b, third]), 0, "{third}");
    }
}
