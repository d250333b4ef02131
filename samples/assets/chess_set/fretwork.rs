//! The picture of the fretwork: brass straps, interlaced to eight-pointed stars; the rest is cut
//! out.
//!
//! The construction is Hankin's ("polygons in contact", 1925): tile the plane, here with octagons
//! and squares, and let two straps leave the middle of every side of every polygon under a fixed
//! angle, until each meets the one that comes from the next side. As the polygons on both sides of
//! an edge are treated alike, the straps run straight through the contacts and weave there.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, dvec2, dvec3};
use image::{Rgba, RgbaImage};

/// The picture is this many texels wide and high. It repeats in both directions.
const SIZE: u32 = 512;
/// Samples per texel in each direction.
const SAMPLES: u32 = 2;
/// Half the width of a strap; the picture is 1 wide.
const HALF_WIDTH: f64 = 0.034;
/// The angle between a side and the straps that leave its middle: 3/8 of a half turn.
const CONTACT_ANGLE: f64 = TAU * 3.0 / 16.0;
/// Brass, linear.
const BRASS: DVec3 = dvec3(0.66, 0.40, 0.13);

/// A strap from one contact to the next around a polygon, bent where its halves meet.
struct Strap {
    start: DVec2,
    bend: DVec2,
    end: DVec2,
}

/// The picture: sRGB colours, not multiplied by alpha.
pub fn image() -> RgbaImage {
    let straps = straps();
    RgbaImage::from_fn(SIZE, SIZE, |x, y| {
        let (mut colour, mut covered) = (DVec3::ZERO, 0.0);
        for i in 0..SAMPLES * SAMPLES {
            let sub = dvec2(f64::from(i % SAMPLES), f64::from(i / SAMPLES)) + 0.5;
            let texel = dvec2(f64::from(x), f64::from(y)) + sub / f64::from(SAMPLES);
            let (light, coverage) = shade(&straps, texel / f64::from(SIZE));
            colour += BRASS * light * coverage;
            covered += coverage;
        }
        // The colour counts even where nothing is opaque: a sampler interpolates it with its neighbours'.
        let colour = if covered > 0.0 { colour / covered } else { BRASS };
        let [r, g, b] = colour.to_array().map(srgb);
        let alpha = covered / f64::from(SAMPLES * SAMPLES);
        Rgba([r, g, b, (alpha * 255.0).round() as u8])
    })
}

/// The straps of an octagon as wide as the picture and of the square in the gap between four such
/// octagons, for the picture and, as straps are wide, for those around it.
fn straps() -> Vec<Strap> {
    let mut straps = Vec::new();
    for corner in (0..9).map(|i| dvec2(f64::from(i % 3), f64::from(i / 3)) - 1.0) {
        straps.extend(polygon_straps(corner + 0.5, 8, 0.5, 0.0));
        // Its sides are as long as the octagon's.
        straps.extend(polygon_straps(corner + 1.0, 4, 0.5 * (TAU / 16.0).tan(), TAU / 8.0));
    }
    straps.retain(|strap| {
        [strap.start, strap.bend, strap.end]
            .iter()
            .any(|p| (p - 0.5).abs().max_element() < 0.5 + 2.0 * HALF_WIDTH)
    });
    straps
}

/// The straps of a regular polygon; `inradius` is the distance of its sides from its centre.
fn polygon_straps(centre: DVec2, sides: u32, inradius: f64, turn: f64) -> Vec<Strap> {
    let direction = |i: f64| DVec2::from_angle(turn + TAU * i / f64::from(sides));
    // By symmetry the two straps meet in the direction between the sides. Seen from the centre,
    // the triangle centre, contact, meeting point has the angle π / sides and the angle
    // π / 2 - CONTACT_ANGLE at the contact.
    let at_centre = TAU / f64::from(2 * sides);
    let at_contact = TAU / 4.0 - CONTACT_ANGLE;
    let reach = inradius * at_contact.sin() / (at_centre + at_contact).sin();
    (0..sides)
        .map(|i| {
            let i = f64::from(i);
            Strap {
                start: centre + direction(i) * inradius,
                bend: centre + direction(i + 0.5) * reach,
                end: centre + direction(i + 1.0) * inradius,
            }
        })
        .collect()
}

/// Brightness of the brass at a point, and its coverage of the sample around it.
fn shade(straps: &[Strap], point: DVec2) -> (f64, f64) {
    // A strap goes over at its start and under at its end: turned by half a turn around a
    // contact, the pattern stays the same, so that the two halves of a crossing strap agree.
    let mut over = f64::INFINITY;
    let mut under = f64::INFINITY;
    let mut contact = f64::INFINITY;
    for strap in straps {
        over = over.min(distance(point, strap.start, strap.bend));
        under = under.min(distance(point, strap.bend, strap.end));
        contact = contact.min(point.distance(strap.start));
    }
    let nearest = over.min(under);
    let coverage = ((HALF_WIDTH - nearest) * f64::from(SIZE * SAMPLES) + 0.5).clamp(0.0, 1.0);
    if coverage == 0.0 {
        return (0.0, 0.0);
    }
    // Away from the contacts the two halves are one bent strap.
    let crossing = contact < 2.2 * HALF_WIDTH;
    let across = if crossing && over < HALF_WIDTH { over } else { nearest };
    let across = (across / HALF_WIDTH).min(1.0);
    // Raised in the middle with a fine line along it, dark towards the edges.
    let relief = 1.0 - 0.45 * across.powi(4);
    let line = 1.0 - 0.35 * (1.0 - ((across - 0.5).abs() / 0.12).min(1.0));
    // The strap below is in the shade of the one above.
    let shade = if crossing && over >= HALF_WIDTH {
        ((over - HALF_WIDTH) / HALF_WIDTH).min(1.0) * 0.7 + 0.3
    } else {
        1.0
    };
    (relief * line * shade, coverage)
}

/// The distance of a point from a line segment.
fn distance(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    point.distance(a + along * t)
}

/// Encodes a linear value.
fn srgb(linear: f64) -> u8 {
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded.clamp(0.0, 1.0) * 255.0).round() as u8
}
