//! The place of a surface in the last frame's picture, seen from above.

use crate::sheet::Anchor::Start;
use crate::sheet::{BLUE, FAINT, LEAF, LINE, Point, RED, SEA, Sheet, WHITE, YOURS};

/// The distance of the picture below the wall, and of the eye.
const WALL: f64 = 92.0;
const PICTURE: f64 = 262.0;
const EYE: f64 = 322.0;
/// The width of a pixel, and the number of pixels.
const PIXEL: f64 = 24.0;
const COUNT: u32 = 9;
/// The radius of the piece.
const RADIUS: f64 = 44.0;

/// A frame: the eye's place to the right of the sheet's left edge, and the piece's middle.
struct Frame {
    eye: f64,
    piece: Point,
}

impl Frame {
    /// The picture's place straight ahead of a pixel coordinate.
    fn on_picture(&self, pixel: f64) -> Point {
        [self.eye + (pixel - 0.5 * f64::from(COUNT)) * PIXEL, PICTURE]
    }

    /// The pixel coordinate that sees a point.
    fn pixel_of(&self, [x, y]: Point) -> f64 {
        let across = (x - self.eye) * (EYE - PICTURE) / (EYE - y);
        across / PIXEL + 0.5 * f64::from(COUNT)
    }

    /// The point that the ray of a pixel coordinate hits, and whether it is on the piece.
    fn hit(&self, pixel: f64) -> (Point, bool) {
        let [x, y] = self.on_picture(pixel);
        let way = [x - self.eye, y - EYE];
        let from = [self.eye - self.piece[0], EYE - self.piece[1]];
        let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1];
        let (half, product) = (dot(way, from), dot(way, way));
        let root = half * half - product * (dot(from, from) - RADIUS * RADIUS);
        let t = if root > 0.0 { (-half - root.sqrt()) / product } else { (WALL - EYE) / way[1] };
        ([self.eye + t * way[0], EYE + t * way[1]], root > 0.0)
    }

    fn draw(&self, s: &mut Sheet, left: f64) {
        s.line(&[[left, WALL], [left + 372.0, WALL]], LINE, 3.0);
        s.circle(self.piece, RADIUS, BLUE, LINE);
        for pixel in 0..COUNT {
            let [a, b] = [0.0, 1.0].map(|side| self.on_picture(f64::from(pixel) + side));
            let corners =
                [[a[0], a[1] - 6.0], [b[0], b[1] - 6.0], [b[0], b[1] + 6.0], [a[0], a[1] + 6.0]];
            s.polygon(&corners, WHITE, LINE);
        }
        s.dot([self.eye, EYE], 5.0, LINE);
        s.note([self.eye + 14.0, EYE + 5.0], Start, "eye");
    }

    /// Fills a pixel of the picture.
    fn fill(&self, s: &mut Sheet, pixel: f64, color: &str) {
        let [a, b] = [0.0, 1.0].map(|side| self.on_picture(pixel.floor() + side));
        let corners =
            [[a[0], a[1] - 6.0], [b[0], b[1] - 6.0], [b[0], b[1] + 6.0], [a[0], a[1] + 6.0]];
        s.polygon(&corners, color, LINE);
    }
}

/// A hit of this frame, the same point of the piece in the last frame, and the pixels around it there.
pub fn reprojection() -> String {
    let mut s = Sheet::new([840, 392], "Where was this point in the last frame?");
    let now = Frame { eye: 640.0, piece: [680.0, 170.0] };
    let last = Frame { eye: 215.0, piece: [168.0, 170.0] };
    s.title([24.0, 66.0], Start, "last frame");
    s.title([440.0, 66.0], Start, "this frame");
    last.draw(&mut s, 24.0);
    now.draw(&mut s, 440.0);

    let pixel = 5.5;
    let (point, _) = now.hit(pixel);
    now.fill(&mut s, pixel, YOURS);
    s.line(&[[now.eye, EYE], point], SEA, 2.0);
    s.dot(point, 5.0, SEA);

    let then = [0, 1].map(|axis| point[axis] - now.piece[axis] + last.piece[axis]);
    let at = last.pixel_of(then);
    let first = (at - 0.5).floor() + 0.5;
    for tap in [first, first + 1.0] {
        let (hit, on_piece) = last.hit(tap);
        let color = if on_piece { LEAF } else { RED };
        last.fill(&mut s, tap, color);
        s.dashes(&[[last.eye, EYE], hit], color, 1.4);
        s.dot(hit, 4.0, color);
    }
    s.line(&[[last.eye, EYE], then], SEA, 2.0);
    s.dot(then, 5.0, SEA);
    s.dashed_arrow(&[
        [point[0] - 8.0, point[1] - 2.0],
        [0.5 * (point[0] + then[0]), WALL + 22.0],
        [then[0] + 10.0, then[1] - 2.0],
    ]);
    s.line(&[[412.0, 56.0], [412.0, 340.0]], FAINT, 1.2);
    s.note([510.0, WALL + 40.0], Start, "back with the piece");
    s.note(
        [24.0, 368.0],
        Start,
        "Green: a pixel that saw the piece, and counts. Red: one that saw the wall behind.",
    );
    s.svg()
}
