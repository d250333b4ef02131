//! Shapes that a ray may be tested against: their numbers as shaders read them, and the boxes around them.

use glam::{DMat3, DVec3, Vec3};
use reference::algebraic::exponents;

use crate::ladder::Primitive;

/// A shape in the numbers of a case file: every one an exact f32.
#[derive(Clone, Debug)]
pub enum Shape {
    Sphere {
        center: Vec3,
        radius: f32,
    },
    Box {
        low: Vec3,
        high: Vec3,
    },
    /// `normal · p = distance · |normal|`.
    Plane {
        normal: Vec3,
        distance: f32,
    },
    PointPlane {
        point: Vec3,
        normal: Vec3,
    },
    Triangles(Vec<[Vec3; 3]>),
    Capsule {
        a: Vec3,
        b: Vec3,
        radius: f32,
    },
    /// The unit sphere under a matrix of three rows of four.
    Instance([[f32; 4]; 3]),
    Heightfield(Heightfield),
    /// A ray that leaves a sphere.
    Leaving(Leaving),
    /// The mean of a sequence.
    Sum(Sum),
    Cone(Cone),
    /// Coefficients of x², y², z², yz, xz, xy, x, y, z and 1.
    Quadric([f32; 10]),
    /// Corners of a bilinear patch at (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1).
    Patch([Vec3; 4]),
    Voxel(Voxel),
    Algebraic(Algebraic),
}

/// A box with a distance at each corner, x changing fastest; the surface is where their trilinear mean is 0.
#[derive(Clone, Copy, Debug)]
pub struct Voxel {
    pub low: Vec3,
    pub high: Vec3,
    pub corners: [f32; 8],
}

/// The points of a closed box where a polynomial of degree four in x, y and z is 0.
#[derive(Clone, Copy, Debug)]
pub struct Algebraic {
    pub low: Vec3,
    pub high: Vec3,
    /// In POV-Ray's order: powers of x fall first, then those of y, then those of z.
    pub coefficients: [f32; 35],
}

impl Algebraic {
    /// From the 20 coefficients of a cubic, or the 35 of a quartic; `None` for another number of them.
    pub fn from_list(low: Vec3, high: Vec3, given: &[f32]) -> Option<Self> {
        let is_cubic = given.len() == 20;
        let is_given = |powers: &[u32; 3]| !is_cubic || powers.iter().sum::<u32>() < 4;
        let mut coefficients = [0.0; 35];
        let places = coefficients.iter_mut().zip(exponents()).filter(|(_, p)| is_given(p));
        for ((to, _), from) in places.zip(given) {
            *to = *from;
        }
        [20, 35].contains(&given.len()).then_some(Self { low, high, coefficients })
    }

    /// From terms: the exponents of x, y and z, and the coefficient.
    pub fn from_terms(half: f32, terms: &[([u32; 3], f32)]) -> Self {
        let mut coefficients = [0.0; 35];
        for (to, powers) in coefficients.iter_mut().zip(exponents()) {
            let own = terms.iter().filter(|(of, _)| *of == powers);
            *to = own.map(|(_, coefficient)| coefficient).sum();
        }
        Self { low: Vec3::splat(-half), high: Vec3::splat(half), coefficients }
    }
}

/// A cone between two discs: a cylinder if their radii agree.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub a: Vec3,
    pub b: Vec3,
    pub radii: [f32; 2],
    /// True if its discs are part of the surface.
    pub is_closed: bool,
}

/// `H(x, z)`, as `common/heightfield.glsl` has it.
#[derive(Clone, Copy, Debug)]
pub struct Heightfield {
    pub k: f32,
    pub a: f32,
    pub f: [f32; 2],
    pub b: f32,
    pub g: [f32; 2],
    pub lipschitz: f32,
}

/// A ray's start on a sphere, and the shape it may hit.
#[derive(Clone, Copy, Debug)]
pub struct Leaving {
    pub center: Vec3,
    pub radius: f32,
    pub direction: Vec3,
    /// Without one, the query's ray finds the point, and must not hit the same sphere again.
    pub gap: Option<Gap>,
}

/// A point of a sphere, and a plane above it that must be hit.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    pub point: Vec3,
    pub normal: Vec3,
    pub occluder_y: f32,
}

/// n values, the i-th by a pattern.
#[derive(Clone, Copy, Debug)]
pub struct Sum {
    pub value: f32,
    pub n: u32,
    pub pattern: Pattern,
}

#[derive(Clone, Copy, Debug)]
pub enum Pattern {
    Constant,
    /// `spike` at every i with i mod every = every - 1.
    Firefly {
        spike: f32,
        every: u32,
    },
    /// First `head`.
    Head(f32),
}

/// Extent of the box around a plane or a heightfield, from the origin.
const FAR: f32 = 1e18;

impl Shape {
    pub fn primitive(&self) -> Primitive {
        match self {
            Self::Sphere { .. } => Primitive::Sphere,
            Self::Box { .. } => Primitive::Box,
            Self::Plane { .. } | Self::PointPlane { .. } => Primitive::Plane,
            Self::Triangles(_) => Primitive::Triangle,
            Self::Capsule { .. } => Primitive::Capsule,
            Self::Instance(_) => Primitive::Instance,
            Self::Heightfield(_) => Primitive::Heightfield,
            Self::Leaving(_) => Primitive::SecondaryOrigin,
            Self::Sum(_) => Primitive::Accumulation,
            Self::Cone(_) => Primitive::Cone,
            Self::Quadric(_) => Primitive::Quadric,
            Self::Patch(_) => Primitive::Patch,
            Self::Voxel(_) => Primitive::Voxel,
            Self::Algebraic(_) => Primitive::Algebraic,
        }
    }

    /// The numbers that the shader reads, for a ray from `origin`: some are prepared in 64 bits.
    pub fn numbers(&self, origin: Vec3) -> Vec<f32> {
        let mut numbers = Vec::new();
        let mut add = |values: &[f32]| numbers.extend_from_slice(values);
        match self {
            Self::Sphere { center, radius } => {
                let r = f64::from(*radius);
                let distance = (origin.as_dvec3() - center.as_dvec3()).length();
                add(&center.to_array());
                add(&[*radius, ((distance - r) * (distance + r)) as f32]);
            }
            Self::Box { low, high } => {
                add(&low.to_array());
                add(&high.to_array());
            }
            Self::Plane { normal, distance } => {
                add(&plane(*normal, f64::from(*distance) * normal.as_dvec3().length(), origin));
            }
            Self::PointPlane { point, normal } => {
                add(&plane(*normal, normal.as_dvec3().dot(point.as_dvec3()), origin));
            }
            Self::Triangles(triangles) => {
                triangles.as_flattened().iter().for_each(|corner| add(&corner.to_array()));
            }
            Self::Capsule { a, b, radius } => {
                add(&a.to_array());
                add(&b.to_array());
                add(&[*radius]);
            }
            Self::Instance(rows) => {
                let (linear, translation) = parts(rows);
                let inverse = linear.inverse();
                let back = -(inverse * translation);
                add(rows.as_flattened());
                for row in 0..3 {
                    add(&inverse.row(row).extend(back[row]).as_vec4().to_array());
                }
                let entries: Vec<f64> =
                    (0..3).flat_map(|row| inverse.row(row).to_array()).collect();
                add(&entries.iter().map(|&x| x as f32).collect::<Vec<_>>());
                add(&entries.iter().map(|&x| low_part(x)).collect::<Vec<_>>());
            }
            Self::Heightfield(h) => {
                add(&[h.k, h.a, h.f[0], h.f[1], h.b, h.g[0], h.g[1], h.lipschitz]);
            }
            Self::Leaving(leaving) => {
                let Gap { point, normal, occluder_y } = leaving.gap.unwrap_or(Gap {
                    point: Vec3::ZERO,
                    normal: Vec3::Y,
                    occluder_y: 0.0,
                });
                add(&[if leaving.gap.is_some() { 1.0 } else { 0.0 }]);
                add(&leaving.center.to_array());
                add(&[leaving.radius]);
                add(&point.to_array());
                add(&normal.to_array());
                add(&leaving.direction.to_array());
                add(&[occluder_y]);
            }
            Self::Sum(Sum { value, n, pattern }) => {
                let (kind, special, every) = match *pattern {
                    Pattern::Constant => (0.0, 0.0, 1),
                    Pattern::Firefly { spike, every } => (1.0, spike, every),
                    Pattern::Head(head) => (2.0, head, 1),
                };
                // A float holds 24 bits exactly, so 16 at a time.
                let [every, n] = [every, *n].map(|x| [(x >> 16) as f32, (x & 0xffff) as f32]);
                add(&[kind, *value, special, every[0], every[1], n[0], n[1]]);
            }
            Self::Cone(Cone { a, b, radii, is_closed }) => {
                add(&a.to_array());
                add(&b.to_array());
                add(radii);
                add(&[if *is_closed { 1.0 } else { 0.0 }]);
            }
            Self::Quadric(coefficients) => add(coefficients),
            Self::Patch(corners) => corners.iter().for_each(|corner| add(&corner.to_array())),
            Self::Voxel(Voxel { low, high, corners }) => {
                add(&low.to_array());
                add(&high.to_array());
                add(corners);
            }
            Self::Algebraic(Algebraic { low, high, coefficients }) => {
                add(&low.to_array());
                add(&high.to_array());
                add(coefficients);
            }
        }
        numbers
    }

    /// The corners of a box around the shape, in its own space, without any margin.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let far = DVec3::splat(FAR.into());
        match self {
            Self::Sphere { center, radius } => {
                let (center, radius) = (center.as_dvec3(), DVec3::splat((*radius).into()));
                (center - radius, center + radius)
            }
            Self::Box { low, high }
            | Self::Voxel(Voxel { low, high, .. })
            | Self::Algebraic(Algebraic { low, high, .. }) => (low.as_dvec3(), high.as_dvec3()),
            Self::Plane { .. } | Self::PointPlane { .. } | Self::Sum(_) | Self::Quadric(_) => {
                (-far, far)
            }
            Self::Cone(Cone { a, b, radii, .. }) => {
                let [a, b] = [(a, radii[0]), (b, radii[1])]
                    .map(|(middle, radius)| (middle.as_dvec3(), DVec3::splat(radius.into())));
                ((a.0 - a.1).min(b.0 - b.1), (a.0 + a.1).max(b.0 + b.1))
            }
            Self::Patch(corners) => {
                let [low, high] = [Vec3::min, Vec3::max].map(|f| corners.iter().copied().reduce(f));
                let corner = |c: Option<Vec3>| c.unwrap_or_default().as_dvec3();
                (corner(low), corner(high))
            }
            Self::Triangles(triangles) => {
                let corners = triangles.as_flattened();
                let fold = |f: fn(Vec3, Vec3) -> Vec3| corners.iter().copied().reduce(f);
                let corner = |c: Option<Vec3>| c.unwrap_or_default().as_dvec3();
                (corner(fold(Vec3::min)), corner(fold(Vec3::max)))
            }
            Self::Capsule { a, b, radius } => {
                let radius = DVec3::splat((*radius).into());
                (a.min(*b).as_dvec3() - radius, a.max(*b).as_dvec3() + radius)
            }
            Self::Instance(_) => (DVec3::NEG_ONE, DVec3::ONE),
            Self::Heightfield(h) => {
                let top = f64::from(h.k).abs() * (f64::from(h.a).abs() + f64::from(h.b).abs());
                (far.with_y(top) * DVec3::new(-1.0, -1.0, -1.0), far.with_y(top))
            }
            Self::Leaving(Leaving { center, radius, gap: None, .. }) => {
                let (center, radius) = (center.as_dvec3(), DVec3::splat((*radius).into()));
                (center - radius, center + radius)
            }
            Self::Leaving(Leaving { gap: Some(gap), .. }) => {
                let y = gap.occluder_y.into();
                ((-far).with_y(y), far.with_y(y))
            }
        }
    }
}

/// A plane as `Plane` in `common/plane.glsl`: normal, D·|N| in two floats, an anchor near the origin
/// of the ray, and how far the anchor's rounding moved it.
fn plane(normal: Vec3, distance: f64, origin: Vec3) -> [f32; 9] {
    let n = normal.as_dvec3();
    let height = n.dot(origin.as_dvec3()) - distance;
    let anchor = (origin.as_dvec3() - height / n.length_squared() * n).as_vec3();
    let rest = distance - n.dot(anchor.as_dvec3());
    let [nx, ny, nz] = normal.to_array();
    let [ax, ay, az] = anchor.to_array();
    [nx, ny, nz, distance as f32, low_part(distance), ax, ay, az, rest as f32]
}

/// The rest that rounding to 32 bits leaves, itself rounded.
fn low_part(x: f64) -> f32 {
    (x - f64::from(x as f32)) as f32
}

/// The linear part and the translation of three rows of four.
pub fn parts(rows: &[[f32; 4]; 3]) -> (DMat3, DVec3) {
    let at = |row: usize, column: usize| f64::from(rows[row][column]);
    let column = |k| DVec3::new(at(0, k), at(1, k), at(2, k));
    (DMat3::from_cols(column(0), column(1), column(2)), column(3))
}
