//! Triangles of a polygon.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// The part of a polygon's area below which a triangle that is turned over is a rounding error.
const TURNED: f64 = 1e-6;

/// The part of a polygon's area by which that of its triangles differs if it crosses itself.
const CROSSES: f64 = 1e-3;

/// Beyond this, polygons that may cross themselves are no longer cut as if they did not: a file of them would take
/// minutes.
const MOST_CROSSED: usize = 1 << 28;

/// Cuts polygons into triangles; keeps its memory from one to the next.
#[derive(Default)]
pub(crate) struct Triangulator {
    ears: Option<Earcut<f64>>,
    indices: Vec<u32>,
    triangles: Vec<[usize; 3]>,
    /// The squares of the counts of corners of polygons that crossed themselves: the time they took.
    crossed: usize,
}

impl Triangulator {
    /// The triangles of a polygon with three or more corners, as positions in `corners`, in its order of rotation.
    ///
    /// A fan from the first corner, which is right for every convex polygon. Where the fan would turn a triangle
    /// over, it would fill a notch: there, ears are clipped, in the plane in which the polygon is largest. A hole
    /// that a bridge of two edges joins to the outline stays a hole. Also returns true if the polygon crosses itself,
    /// and so has no right triangles.
    pub fn triangulate(&mut self, corners: &[DVec3]) -> (&[[usize; 3]], bool) {
        self.triangles.clear();
        let last = corners.len().saturating_sub(1);
        let normal = |i: usize| (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
        // Twice the vector area of the whole.
        let area: DVec3 = (1..last).map(normal).sum();
        let least = -TURNED * area.length_squared();
        let turns = (1..last).any(|i| normal(i).dot(area) < least);
        let mut crosses = turns;
        if turns && self.crossed < MOST_CROSSED {
            crosses = self.clip(corners, area);
            self.crossed += if crosses { corners.len().pow(2) } else { 0 };
        }
        if self.triangles.is_empty() {
            self.triangles.extend((1..last).map(|i| [0, i, i + 1]));
        }
        (&self.triangles, crosses)
    }

    /// Clips ears. Returns true if they have not the area of the polygon.
    fn clip(&mut self, corners: &[DVec3], area: DVec3) -> bool {
        let flat = |corner: &DVec3| {
            let corner = corner - corners[0];
            match area.abs().max_position() {
                0 => DVec2::new(corner.y, corner.z),
                1 => DVec2::new(corner.z, corner.x),
                _ => DVec2::new(corner.x, corner.y),
            }
        };
        let ears = self.ears.get_or_insert_with(Earcut::new);
        ears.earcut(corners.iter().map(|corner| flat(corner).to_array()), &[], &mut self.indices);
        let side = area[area.abs().max_position()];
        let mut sum = 0.0;
        self.triangles.extend(self.indices.chunks_exact(3).map(|ear| {
            let [a, b, c] = [ear[0] as usize, ear[1] as usize, ear[2] as usize];
            let [p, q, r] = [a, b, c].map(|i| flat(&corners[i]));
            let area = (q - p).perp_dot(r - p);
            sum += area.abs();
            if area * side < 0.0 { [a, c, b] } else { [a, b, c] }
        }));
        (sum - side.abs()).abs() > CROSSES * side.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(outline: &[[f64; 2]]) -> Vec<[usize; 3]> {
        let corners: Vec<_> = outline.iter().map(|&[x, y]| DVec3::new(x, 0.0, -y)).collect();
        Triangulator::default().triangulate(&corners).0.to_vec()
    }

    /// The areas of the triangles, all of which turn as the outline does.
    fn area(outline: &[[f64; 2]]) -> f64 {
        let corner = |i: usize| DVec2::from(outline[i]);
        let areas = cut(outline).into_iter().map(|[a, b, c]| {
            let area = 0.5 * (corner(b) - corner(a)).perp_dot(corner(c) - corner(a));
            assert!(area >= 0.0, "{a} {b} {c}");
            area
        });
        areas.sum()
    }

    const L: [[f64; 2]; 6] = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]];

    #[test]
    fn a_polygon_that_is_not_convex_keeps_its_notch_from_every_first_corner() {
        for first in 0..6 {
            let mut outline = L;
            outline.rotate_left(first);
            assert!((area(&outline) - 3.0).abs() < 1e-12, "{first}");
        }
        let star: Vec<_> = (0..20)
            .map(|i| {
                let (angle, radius) =
                    (f64::from(i) * 0.1 * std::f64::consts::PI, [2.0, 0.5][i as usize % 2]);
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let right = 10.0 * 2.0 * 0.5 * (0.1 * std::f64::consts::PI).sin();
        for first in 0..2 {
            let mut outline = star.clone();
            outline.rotate_left(first);
            assert!((area(&outline) - right).abs() < 1e-9, "{first}: {}", area(&outline));
        }
    }

    #[test]
    fn a_hole_behind_a_bridge_stays_a_hole() {
        let [a, b] = [[0., 0.], [1., 1.]];
        let frame = [a, [4., 0.], [4., 4.], [0., 4.], a, b, [1., 3.], [3., 3.], [3., 1.], b];
        assert!((area(&frame) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn a_convex_polygon_is_a_fan_and_so_is_one_without_area() {
        let square = [[0., 0.], [1., 0.], [1., 1.], [0.5, 1.0], [0., 1.]];
        assert_eq!(cut(&square), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        let bent = [[0., 0.], [1., 0.], [2., -1e-8], [2., 1.], [0., 1.]];
        assert_eq!(cut(&bent), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert_eq!(cut(&[[1., 1.]; 4]), [[0, 1, 2], [0, 2, 3]]);
        let bow_tie = [[0., 0.], [1., 1.], [1., 0.], [0., 1.]];
        assert_eq!(cut(&bow_tie).len(), 2);
        let crosses = |outline: &[[f64; 2]]| {
            let corners: Vec<_> = outline.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
            Triangulator::default().triangulate(&corners).1
        };
        assert!(crosses(&[[0., 0.], [2., 2.], [2., 0.], [0., 1.]]) && !crosses(&L));
        // Huge and tiny, where products of three lengths leave the range of 64 bits.
        for size in [1e38, 1e-44] {
            let l = [L[1], L[2], L[3], L[4], L[5], L[0]].map(|corner| corner.map(|x| x * size));
            assert_eq!(cut(&l).len(), 4);
        }
    }
}
