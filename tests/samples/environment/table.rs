//! The table of texels: its shares, its densities, and the sum of its weights.

use super::alias::UNITS;
use super::sky::{SkyTable, Sum, add, divided, solid_angle};
use super::{evaluate, evaluate_in, own_sky, set};
use common::model::panorama::Panorama;
use run::{copy_of_shaders, replace_line};

/// The weights of a sky: luminance times solid angle.
fn weights(sky: &Panorama) -> Vec<f64> {
    let angles: Vec<f64> = (0..sky.height).map(|row| solid_angle(sky, row)).collect();
    let weight = |(i, [r, g, b]): (usize, &[f32; 3])| {
        let light = 0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b);
        light * angles[i / sky.width as usize]
    };
    sky.texels.iter().enumerate().map(weight).collect()
}

#[test]
fn all_directions_are_a_sphere() {
    let sky = own_sky("day.exr");
    let all: f64 = (0..sky.height).map(|row| solid_angle(&sky, row) * f64::from(sky.width)).sum();
    assert!((all / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-13, "{all}");
}

#[test]
fn a_texel_is_chosen_as_often_as_its_light_says() {
    for name in ["day.exr", "evening.exr"] {
        let sky = own_sky(name);
        let weights = weights(&sky);
        let sum: f64 = weights.iter().sum();
        let table = SkyTable::new(&sky, Sum::Exact);
        let mut shares = vec![0u64; table.columns.len()];
        for (i, column) in table.columns.iter().enumerate() {
            let own = (column.own * UNITS as f32) as u64;
            shares[i] += own;
            shares[column.other as usize] += UNITS - own;
        }
        let all = (table.columns.len() as u64 * UNITS) as f64;
        let mut densities = 0.0;
        for (i, weight) in weights.iter().enumerate() {
            let (share, angle) = (shares[i] as f64 / all, solid_angle(&sky, i as u32 / sky.width));
            // A share is rounded to a part, 2^-41 of all, and the strongest takes what is left.
            assert!((share - weight / sum).abs() < 2.0 / UNITS as f64, "{name}, {i}: {share}");
            let density = f64::from(table.texels[i].density);
            // The density is that of the share, rounded once.
            assert!((density * angle / share - 1.0).abs() < 6e-8, "{name}, {i}: {density}");
            densities += density * angle;
        }
        // Roundings of 2^-24 each.
        assert!((densities - 1.0).abs() < 6e-8, "{name}: {densities}");
    }
}

#[test]
fn a_direction_in_a_texel_finds_that_texel() {
    let sky = own_sky("day.exr");
    let body = "uint texel = at.y * push.sky.size.x + at.x;
        vec2 u = 0.02 + 0.96 * random(at, 0, 0, 9).xy;
        vec3 direction = direction_in(push.sky, push.rotation, texel, u);
        Texel found = texel_at(push.sky, push.rotation, direction);
        Texel own = push.sky.texels.at[texel];
        answer = vec4(found.radiance == own.radiance && found.density == own.density, own.density,
            push.sky.rows.at[at.y].height, length(direction));";
    let sets = set(&["rotation=77"]);
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let shown = evaluate("", body, "512x256", &sets);
    let found = shown.pixels.iter().filter(|pixel| pixel[0] == 1.0).count();
    assert_eq!(found, shown.pixels.len());
    // The densities that shaders use integrate to 1 over the sphere.
    let around = 2.0 * std::f64::consts::PI / f64::from(sky.width);
    let all: f64 = shown.pixels.iter().map(|p| f64::from(p[1]) * f64::from(p[2]) * around).sum();
    assert!((all - 1.0).abs() < 1.2e-7, "{all}");
}

#[test]
fn no_direction_by_chance_has_an_angle_beyond_pi() {
    // Beyond it, Vulkan promises nothing about sin() and cos(): these macros record the largest of their angles.
    let noting = "float widest = 0.0;
        float noted(float angle) { widest = max(widest, abs(angle)); return angle; }
        #define cos(angle) cos(noted(angle))
        #define sin(angle) sin(noted(angle))
        #include \"common/sky_map.glsl\"";
    // The numbers that complete a turn, and some between, in the outermost texels.
    let body =
        "float u = at.x < 32 ? float(16777215 - at.x) / 16777216.0 : float(at.x - 32) / 96.0;
        uint last = push.sky.size.x - 1;
        vec3 direction = SAMPLER == SAMPLER_UNIFORM
            ? sky_sample(push.sky, 0.0, vec2(0.5), vec2(u, 0.5)).direction
            : direction_in(push.sky, 0.0, at.y == 0 ? 0 : last, vec2(u, 0.5));
        answer = vec4(widest, direction);";
    for sampling in ["sampling=map", "sampling=uniform"] {
        let folder = copy_of_shaders();
        let include = "#include \"common/sky_map.glsl\"";
        replace_line(folder.path(), "46_environment/camera.rgen", include, noting);
        let sets = set(&[sampling]);
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let shown = evaluate_in(&folder, "", body, "128x2", &sets);
        let widest = shown.pixels.iter().map(|pixel| f64::from(pixel[0])).fold(0.0, f64::max);
        println!("{sampling}: widest angle {widest}");
        assert!(widest > 3.0 && widest <= std::f64::consts::PI, "{sampling}: {widest}");
    }
}

/// The error of a sum in floats, for the day divided into more and more texels.
pub fn offs(cut: u32) -> [f64; 2] {
    let sky = divided(&own_sky("day.exr"), cut).expect("it fits");
    let weights = weights(&sky);
    let sum: f64 = weights.iter().sum();
    [Sum::Floats, Sum::Pairwise].map(|way| f64::from(add(&weights, way)) / sum - 1.0)
}

/// One rounding of each weight, and one for each level of pairs.
pub fn bound_of_pairs(cut: u32) -> f64 {
    let count = f64::from(512 * 256 * cut * cut);
    (1.0 + count.log2().ceil()) / 16_777_216.0
}

#[test]
fn a_sum_in_floats_forgets_texels_and_in_pairs_it_does_not() {
    for cut in [1, 2, 4] {
        let [floats, pairs] = offs(cut);
        println!("cut={cut}: floats {floats:.2e}, pairs {pairs:.2e}");
        assert!(pairs.abs() < bound_of_pairs(cut), "cut={cut}: {pairs}");
        // Only an addition after the other loses so much: 131,072 texels would have a bound of 0.008.
        assert!(floats.abs() > 1e-4, "cut={cut}: a naive sum is right: {floats}");
    }
}

#[test]
fn too_many_texels_are_refused() {
    let error = divided(&own_sky("day.exr"), 16).expect_err("too many").to_string();
    assert!(error.starts_with("cut=16 makes 33554432 texels of the sky"), "{error}");
}

#[test]
fn a_black_sky_has_no_table_and_no_density() {
    let black = Panorama { width: 4, height: 2, texels: vec![[0.0; 3]; 8] };
    for sum in [Sum::Exact, Sum::Floats, Sum::Pairwise] {
        let table = SkyTable::new(&black, sum);
        assert!(table.columns.is_empty() && table.texels.iter().all(|texel| texel.density == 0.0));
    }
}
