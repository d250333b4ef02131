//! 34_lights: shadows of a lamp compared with the reference, and the decrease of its light.

use common::app::Picture;
use common::scene::{PointLight, Scene};
use glam::Vec3;
use reference::Ray;

use crate::shadow_rays::{hold_answers, hold_origins, is_on_a_square, picture_by};
use run::{Chapter, render, same_colors, shaders_with};

const NAME: &str = "34_lights";
const SIZE: &str = "240x150";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

#[test]
fn the_sun_makes_the_picture_of_41() {
    let sun = render("41_ray_offset", SIZE, &[]).picture;
    same_colors("34's sun and 41's", NAME, &chapter().sets(&["light=directional"]).picture(), &sun);
}

fn to_lamp(origin: Vec3) -> Ray {
    let direction = PointLight::default().position - origin;
    Ray::from_f32(origin.to_array(), direction.to_array(), 0.0, 1.0)
}

#[test]
fn every_shadow_ray_gets_the_reference_s_answer() {
    hold_answers(NAME, to_lamp);
}

#[test]
fn shadows_are_those_of_the_exact_hit_points() {
    hold_origins(NAME, to_lamp);
}

#[test]
fn a_light_below_the_board_lights_nothing() {
    let below = chapter().sets(&["lamp position=0.3,-1,0.2", "show=shadow origin"]).picture();
    let lit = below.pixels.iter().find(|pixel| pixel[3] > 0.0);
    assert!(lit.is_none(), "{lit:?}");
}

/// An object beyond the lamp casts no shadow: a piece behind a lamp between pieces.
#[test]
fn a_shadow_ray_ends_at_the_lamp() {
    let low = ["lamp position=2.5,1.1,1.5", "show=shadow origin"];
    let endless = shaders_with("common/light.glsl", "? 1.0 : 1e30", "? 1e30 : 1e30");
    let endless = picture_by(endless.path(), NAME, &low);
    let picture = chapter().sets(&low).picture();
    let lit = |picture: &Picture| picture.pixels.iter().filter(|pixel| pixel[3] == 1.0).count();
    let (ends, goes_on) = (lit(&picture), lit(&endless));
    println!("{ends} lit; {goes_on} where the ray goes on behind the lamp");
    assert!(goes_on < ends, "{goes_on} of {ends}");
}

#[test]
fn a_lamp_fades_with_the_square_of_the_distance() {
    let lamp = PointLight::default();
    let eye = Scene::chess().unwrap().camera.eye.as_vec3();
    let lit = chapter().picture();
    let dark = chapter().sets(&["lamp position=0,-1,0"]).picture();
    let origins = chapter().sets(&["show=shadow origin"]).picture();
    let mut compared = 0;
    for ((lit, dark), origin) in lit.pixels.iter().zip(&dark.pixels).zip(&origins.pixels) {
        let [x, y, z, seen] = *origin;
        if seen != 1.0 || !is_on_a_square(origin) {
            continue;
        }
        let (point, up) = (Vec3::new(x, y, z), Vec3::Y);
        let (to_light, view) = (lamp.position - point, (eye - point).normalize());
        let light = to_light.normalize();
        let highlight = up.dot((view + light).normalize()).max(0.0).powf(90.0) * 98.0 / 8.0;
        // In the dark there is only the light of the sky, which has a closed form on a level square.
        let base = Vec3::new(dark[0], dark[1], dark[2]) / Vec3::new(0.42, 0.47, 0.55);
        let reflected = (base + 0.03 * highlight) * light.y / std::f32::consts::PI;
        let expected = lamp.intensity / to_light.length_squared() * reflected;
        let got = Vec3::new(lit[0] - dark[0], lit[1] - dark[1], lit[2] - dark[2]);
        assert!(
            (got - expected).abs().max_element() < 1e-3 * expected.max_element(),
            "{point}: {got} {expected}"
        );
        compared += 1;
    }
    assert!(compared > 1000, "{compared}");
}
