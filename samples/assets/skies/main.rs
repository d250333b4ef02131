//! Makes the skies of chapter 46: writes `day.exr` and `evening.exr` next to this directory, the same bytes on every
//! run.
//!
//! `skies --check` writes nothing and fails if a file differs from what it would write.

use std::f32::consts::PI;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use common::UsageError;
use common::app::Picture;
use common::exit::finish;
use common::output;
use glam::Vec3;

/// Directory of the files.
const DIRECTORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/assets");

/// Width and height: a texel is 0.7 degrees wide, and the sun 0.5.
const SIZE: [u32; 2] = [512, 256];

/// The sun's place, in degrees: 0 is towards z, 90 towards x.
const SUN: [f32; 2] = [300.0, 35.0];

/// The radiance of the sun's texel, which lights as the sun of 45 does.
const SUNLIGHT: Vec3 = Vec3::new(34_000.0, 27_000.0, 18_500.0);

const USAGE: &str = "usage: skies           write the files\n       \
                     skies --check   only say whether they are as they would be written\n";

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    finish(|| match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => make(false),
        ["--check"] => make(true),
        ["--help" | "-h"] => output::print(USAGE),
        _ => {
            let all = arguments.join(" ");
            Err(UsageError(format!("skies takes --check, or nothing, and not '{all}'")).into())
        }
    })
}

/// Writes the files, or only compares them.
fn make(check: bool) -> Result<()> {
    for (name, light) in [("day.exr", day as fn(Vec3) -> Vec3), ("evening.exr", evening)] {
        let mut picture = picture(light);
        if name == "day.exr" {
            let [x, y] = texel_of(direction(SUN));
            let [r, g, b] = SUNLIGHT.to_array();
            picture.pixels[(y * SIZE[0] + x) as usize] = [r, g, b, 1.0];
        }
        let path = Path::new(DIRECTORY).join(name);
        if check {
            ensure!(Picture::open_exr(&path)? == picture, "{name} is not as it would be written");
        } else {
            picture.save(&path)?;
        }
    }
    Ok(())
}

/// The direction of an azimuth and an elevation, in degrees.
fn direction([azimuth, elevation]: [f32; 2]) -> Vec3 {
    let ((x, z), (y, flat)) = (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
    Vec3::new(x * flat, y, z * flat)
}

/// The column and the row that show a direction.
fn texel_of(direction: Vec3) -> [u32; 2] {
    let u = 0.5 + direction.x.atan2(-direction.z) / (2.0 * PI);
    let v = direction.y.acos() / PI;
    [(u * SIZE[0] as f32) as u32, (v * SIZE[1] as f32) as u32]
}

fn picture(light: fn(Vec3) -> Vec3) -> Picture {
    let [width, height] = SIZE;
    let pixel = |i: u32| {
        let u = ((i % width) as f32 + 0.5) / width as f32;
        let v = ((i / width) as f32 + 0.5) / height as f32;
        let ((x, z), (flat, y)) = ((2.0 * PI * (u - 0.5)).sin_cos(), (PI * v).sin_cos());
        let [r, g, b] = light(Vec3::new(x * flat, y, -z * flat)).to_array().map(rounded);
        [r, g, b, 1.0]
    };
    Picture { width, height, pixels: (0..width * height).map(pixel).collect() }
}

/// A number with eight digits of its 24: the file is smaller, and no eye sees it.
fn rounded(value: f32) -> f32 {
    f32::from_bits((value.to_bits() + 0x8000) & 0xffff_0000)
}

/// Blue with a few clouds, and dry ground.
fn day(direction: Vec3) -> Vec3 {
    let sun = self::direction(SUN);
    let near = direction.dot(sun).max(0.0);
    let glow = Vec3::new(1.0, 0.85, 0.6) * (0.35 * near.powi(8) + 1.5 * near.powi(400));
    if direction.y < 0.0 {
        return ground(direction, Vec3::new(0.30, 0.25, 0.19), Vec3::new(0.72, 0.76, 0.80));
    }
    let height = direction.y.sqrt();
    let blue = Vec3::new(0.80, 0.86, 0.92).lerp(Vec3::new(0.13, 0.30, 0.66), height);
    let cover = smooth(0.52, 0.78, clouds(direction)) * smooth(0.0, 0.2, direction.y);
    let thick = smooth(0.6, 0.95, clouds(direction));
    let cloud = Vec3::splat(1.15).lerp(Vec3::new(0.55, 0.58, 0.64), thick);
    blue.lerp(cloud, 0.9 * cover) + glow
}

/// The sun has set in the east of the picture, and clouds show its last light.
fn evening(direction: Vec3) -> Vec3 {
    let west = 0.5 + 0.5 * direction.dot(self::direction([300.0, 0.0]));
    if direction.y < 0.0 {
        let far = Vec3::new(0.35, 0.30, 0.42).lerp(Vec3::new(1.1, 0.55, 0.30), west * west);
        return ground(direction, Vec3::new(0.05, 0.05, 0.07), far);
    }
    let height = direction.y.sqrt();
    let low = Vec3::new(0.42, 0.36, 0.52).lerp(Vec3::new(2.6, 1.05, 0.38), west.powi(3));
    let high = Vec3::new(0.10, 0.13, 0.30).lerp(Vec3::new(0.30, 0.26, 0.42), west);
    let sky = low.lerp(high, smooth(0.0, 0.75, height));
    let cover = smooth(0.40, 0.66, clouds(direction)) * smooth(0.0, 0.15, direction.y);
    let lit = Vec3::new(0.16, 0.14, 0.22)
        .lerp(Vec3::new(2.2, 0.75, 0.42), west.powi(3) * (1.0 - 0.6 * height));
    sky.lerp(lit, 0.85 * cover)
}

/// Ground that fades into the haze of the horizon.
fn ground(direction: Vec3, near: Vec3, haze: Vec3) -> Vec3 {
    haze.lerp(near, smooth(0.0, 0.22, -direction.y))
}

/// Smoothstep.
fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The density of clouds in a flat layer above, from 0 to 1.
fn clouds(direction: Vec3) -> f32 {
    let up = direction.y.max(0.02) + 0.12;
    let (x, z) = (1.6 * direction.x / up, 1.6 * direction.z / up);
    let octave = |i: i32| {
        let scale = f32::powi(2.03, i);
        0.5f32.powi(i) * noise(x * scale + 7.3 * i as f32, z * scale - 3.1 * i as f32)
    };
    (0..5).map(octave).sum::<f32>() / 1.9375
}

/// Smooth noise, from 0 to 1.
fn noise(x: f32, y: f32) -> f32 {
    let (column, row) = (x.floor(), y.floor());
    let (u, v) = (smooth(0.0, 1.0, x - column), smooth(0.0, 1.0, y - row));
    let at = |i: i32, j: i32| lattice(column as i32 + i, row as i32 + j);
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(at(0, 0), at(1, 0), u), mix(at(0, 1), at(1, 1), u), v)
}

/// A random number of a lattice point.
fn lattice(x: i32, y: i32) -> f32 {
    let mut hash = (x as u32).wrapping_mul(0x9e37_79b9) ^ (y as u32).wrapping_mul(0x85eb_ca6b);
    for shift in [15, 13, 16] {
        hash = (hash ^ (hash >> shift)).wrapping_mul(0xc2b2_ae35);
    }
    (hash >> 8) as f32 / 16_777_216.0
}
