//! The levels of a texture, as made by the device.

use common::model::Texture;

use super::{NAME, floor};
use run::{command, copy_of_shaders, render_by, replace_line};

fn linear(code: u8) -> f64 {
    let code = f64::from(code) / 255.0;
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

/// The mean over squares of `step` texels, of the light or of the encoded values.
fn means(texture: &Texture, step: u32, value: fn(u8) -> f64) -> Vec<[f64; 3]> {
    let side = texture.width / step;
    let of = |i: u32| {
        let mut sum = [0.0; 3];
        for k in 0..step * step {
            let (x, y) = (i % side * step + k % step, i / side * step + k / step);
            let texel = 4 * (y * texture.width + x) as usize;
            let rgb = texture.rgba[texel..].iter();
            sum.iter_mut().zip(rgb).for_each(|(sum, &code)| *sum += value(code));
        }
        sum.map(|sum| sum / f64::from(step * step))
    };
    (0..side * side).map(of).collect()
}

/// The texels of a level, read by a shader at their middles.
fn level(number: u32, side: u32) -> Vec<[f64; 3]> {
    let shaders = copy_of_shaders();
    let file = "19_ray_cones/camera.rgen";
    let seen = "#include \"seen.glsl\"";
    let table = format!("{seen}\nlayout(set = 1, binding = 0) uniform sampler2D textures[];");
    replace_line(shaders.path(), file, seen, &table);
    let texel =
        format!("vec4(textureLod(textures[1], (vec2(id) + 0.5) / {side}.0, {number}.0).rgb, 1.0)");
    replace_line(shaders.path(), file, "sum / float(side * side)", &texel);
    let mut command = command(NAME);
    let size = format!("{side}x{side}");
    let run = render_by(command.env("SHADERS", shaders.path()), &size, &[]);
    run.picture.pixels.iter().map(|p| [p[0], p[1], p[2]].map(f64::from)).collect()
}

#[test]
fn each_level_is_the_mean_of_the_light() {
    let scene = floor::chess().unwrap();
    let tiles = &scene.model.textures[1];
    assert_eq!((tiles.name.as_str(), tiles.width, tiles.height), ("tiles", 256, 256));
    for number in [1, 2, 4, 6, 8] {
        let side = 256 >> number;
        let found = level(number, side);
        let light = means(tiles, 1 << number, linear);
        let codes = means(tiles, 1 << number, |code| f64::from(code) / 255.0);
        // Each level is rounded to 8 bits, up or down. Two steps of the encoding, each at most 1/110 of the
        // light: set by llvmpipe (Mesa 25.0.7), which is off by less than one.
        let rounding = 2.0 / 110.0;
        let (mut most_off, mut most_wrong) = (0.0_f64, 0.0_f64);
        for ((found, light), code) in found.iter().zip(&light).zip(&codes) {
            for c in 0..3 {
                let off = (found[c] - light[c]).abs();
                most_off = most_off.max(off);
                assert!(off <= rounding, "level {number}: {found:?}, not {light:?}");
                let wrong = linear((255.0 * code[c]).round() as u8);
                most_wrong = most_wrong.max((wrong - light[c]).abs());
            }
        }
        println!("level {number}: off by {most_off:.4}, the mean of codes by {most_wrong:.4}");
        // The mean of encoded values would have been detected.
        assert!(most_wrong > 2.0 * rounding, "level {number}: {most_wrong}");
    }
}
