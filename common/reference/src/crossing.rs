//! Intersection of a ray's line with the plane of a triangle, and its distance to the edges, in f64.

use glam::{DVec2, DVec3};

use super::ray::Ray;

/// Three vertices in world space.
pub type Triangle = [DVec3; 3];

/// Intersection of a ray's line with the plane of a triangle, inside it or not, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Ray parameter, in lengths of the ray's direction; NaN where the triangle is seen edge-on.
    pub t: f64,
    /// Weights of the three vertices; they sum to 1 and are negative outside.
    pub weights: [f64; 3],
    /// Distance of the ray inside each edge; element k belongs to the edge opposite vertex k.
    ///
    /// The distance, in world units, between the line of the ray and the line of the edge, that is
    /// the distance seen when looking along the ray; negative outside. Seen edge-on, a triangle has
    /// no inside, and no margin is positive. An edge that is seen end-on has margin 0.
    pub margins: [f64; 3],
    /// True if the vertices turn counterclockwise as seen from the ray's origin, in the world's right-handed axes;
    /// false if the triangle is seen edge-on.
    pub counterclockwise: bool,
    /// True if the line passes through the closed triangle.
    pub inside: bool,
}

impl Crossing {
    /// The weights of the second and third vertex, as GLSL's hit attributes give them.
    pub fn barycentrics(&self) -> DVec2 {
        DVec2::new(self.weights[1], self.weights[2])
    }
}

/// Data shared by all tests of one ray: the shear that turns its direction into an axis.
///
/// Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection* (JCGT 2:1, 2013). The edge function
/// of an edge that two triangles share is the same product difference with the opposite sign, so no
/// ray passes between them; and as rounding is monotonic, its sign is never wrong for the sheared
/// vertices, it can only be zero, which counts as inside.
#[derive(Clone, Copy, Debug)]
pub struct Shear {
    ray: Ray,
    axes: [usize; 3],
    slope: DVec2,
}

impl Shear {
    /// Prepares a ray.
    pub fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let z = d.abs().max_position();
        // Swapping two axes for a direction that points down keeps the turn of the vertices.
        let (x, y) = if d[z] >= 0.0 { (1, 2) } else { (2, 1) };
        let (x, y) = ((z + x) % 3, (z + y) % 3);
        Self { ray: *ray, axes: [x, y, z], slope: DVec2::new(d[x], d[y]) / d[z] }
    }

    /// The edge functions of the three edges; the triangle is hit where none differs in sign.
    #[inline]
    fn edges(&self, triangle: &Triangle) -> ([f64; 3], [f64; 3]) {
        let [x, y, z] = self.axes;
        let relative = triangle.map(|v| v - self.ray.origin);
        let [a, b, c] = relative.map(|v| DVec2::new(v[x], v[y]) - self.slope * v[z]);
        let edges = [c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x];
        (edges, relative.map(|v| v[z]))
    }

    /// True if the line passes through the closed triangle: [`Crossing::inside`] at less cost.
    #[inline]
    pub fn is_inside(&self, triangle: &Triangle) -> bool {
        let [u, v, w] = self.edges(triangle).0;
        (u >= 0.0 && v >= 0.0 && w >= 0.0 || u <= 0.0 && v <= 0.0 && w <= 0.0) && u + v + w != 0.0
    }

    /// The crossing of the line and the plane of the triangle.
    pub fn cross(&self, triangle: &Triangle) -> Crossing {
        let (edges, heights) = self.edges(triangle);
        let sum = edges[0] + edges[1] + edges[2];
        let d = self.ray.direction;
        let along = d[self.axes[2]];
        let weights = edges.map(|edge| edge / sum);
        let height = edges[0] * heights[0] + edges[1] * heights[1] + edges[2] * heights[2];
        let margins = std::array::from_fn(|k| {
            let edge = triangle[(k + 2) % 3] - triangle[(k + 1) % 3];
            // |d × edge| is the edge's length as seen along the ray, times |d|; and the edge
            // function times d[z] is the triple product of d and the two ends.
            let seen = d.cross(edge).length();
            let distance = edges[k] * along.abs() / seen;
            match seen {
                0.0 => 0.0,
                _ if sum == 0.0 => -distance.abs(),
                _ => distance * sum.signum(),
            }
        });
        Crossing {
            t: height / (sum * along),
            weights,
            margins,
            counterclockwise: sum > 0.0,
            inside: self.is_inside(triangle),
        }
    }
}
