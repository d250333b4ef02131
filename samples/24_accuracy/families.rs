//! Seeded random rays by the thousand, each family hard in its own way, with the true answers.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3, Vec3};
use reference::random::{Random, f32s};
use reference::{ExactSurface, scene::Scene};
use reference::{
    aabb::Aabb, capsule::Capsule, heightfield, instance::Ellipsoid, plane, scene, sphere, transform,
};

use crate::judge::{Expected, ExpectedHit};
use crate::ladder::Primitive;
use crate::probe::Ray;
use crate::shape::{Gap, Heightfield, Leaving, Pattern, Shape, Sum, parts};

/// Rays at shapes of one primitive.
pub struct Family {
    pub name: &'static str,
    pub shapes: Vec<Shape>,
    /// Which shape, which ray.
    pub rays: Vec<(usize, Ray)>,
    pub expected: Vec<Expected>,
    /// Whether each shape can stand in an acceleration structure: not if there is one for every ray.
    pub is_traced: bool,
}

/// What a family asks of each ray: given a source of random numbers, a shape and a ray.
pub type Make<'a> = dyn FnMut(&mut Random, usize) -> (usize, DVec3, DVec3) + 'a;

impl Family {
    /// Every family of a primitive, `rays` rays each. The first is the rung's home ground, the one
    /// that is timed.
    pub fn of(primitive: Primitive, rays: usize) -> Vec<Self> {
        match primitive {
            Primitive::Sphere => spheres(rays),
            Primitive::Box => boxes(rays),
            Primitive::Plane => planes(rays),
            Primitive::Triangle => triangles(rays),
            Primitive::Capsule => capsules(rays),
            Primitive::Instance => instances(rays),
            Primitive::Heightfield => heightfields(rays),
            Primitive::SecondaryOrigin => departures(rays),
            Primitive::Accumulation => sums(),
        }
    }

    /// `make` says which shape, where a ray begins and where it goes, all in f64.
    pub fn new(name: &'static str, shapes: Vec<Shape>, count: usize, make: &mut Make) -> Self {
        // Each family has its own numbers, whatever other families there are.
        let seed = name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut random = Random(seed);
        let truth = Truth::new(&shapes);
        let (mut rays, mut expected) = (Vec::new(), Vec::new());
        for number in 0..count {
            let (shape, origin, direction) = make(&mut random, number);
            let (origin, direction) = (origin.as_vec3(), direction.as_vec3());
            let ray = Ray { origin, direction, tmin: 0.0, tmax: 1e30 };
            expected.push(truth.of(shape, &ray));
            rays.push((shape, ray));
        }
        Self { name, shapes, rays, expected, is_traced: true }
    }
}

/// The shapes as the reference knows them.
struct Truth<'a> {
    shapes: &'a [Shape],
    meshes: Vec<Option<Scene>>,
}

impl<'a> Truth<'a> {
    fn new(shapes: &'a [Shape]) -> Self {
        let mesh = |shape: &Shape| {
            let Shape::Triangles(mesh) = shape else { return None };
            let transform = transform::Transform::identity();
            let triangles = mesh.iter().map(|triangle| triangle.map(|v| v.to_array())).collect();
            Some(Scene::new([scene::Instance { transform, triangles }]))
        };
        Self { shapes, meshes: shapes.iter().map(mesh).collect() }
    }

    fn of(&self, number: usize, ray: &Ray) -> Expected {
        let exact = ray.exact();
        let surface = |hit: Option<ExactSurface>| hit.map(|hit| hit.to_f64().t);
        let t = match &self.shapes[number] {
            Shape::Sphere { center, radius } => {
                let (center, radius) = (center.as_dvec3(), (*radius).into());
                surface(sphere::Sphere { center, radius }.intersect_exact(&exact))
            }
            Shape::Box { low, high } => {
                let (low, high) = (low.as_dvec3(), high.as_dvec3());
                let hit = Aabb { low, high }.intersect_exact(&exact);
                hit.map(|hit| reference::rational::to_f64(&hit.t))
            }
            Shape::Plane { normal, distance } => {
                let (normal, distance) = (normal.as_dvec3(), (*distance).into());
                surface(plane::Plane { normal, distance }.intersect_exact(&exact))
            }
            Shape::PointPlane { point, normal } => {
                let (point, normal) = (point.as_dvec3(), normal.as_dvec3());
                surface(plane::PointPlane { point, normal }.intersect_exact(&exact))
            }
            Shape::Capsule { a, b, radius } => {
                let (a, b, radius) = (a.as_dvec3(), b.as_dvec3(), (*radius).into());
                Capsule { a, b, radius }.intersect(&exact).map(|hit| hit.t)
            }
            Shape::Instance(rows) => {
                let (linear, translation) = parts(rows);
                Ellipsoid { linear, translation }.intersect(&exact).map(|hit| hit.t)
            }
            Shape::Heightfield(h) => reference(h).intersect(&exact).map(|hit| hit.t),
            Shape::Triangles(_) => {
                let mesh = self.meshes[number].as_ref().expect("made for every mesh");
                mesh.closest_hit(&exact, |_| true).map(|hit| hit.t)
            }
            // Nothing convex is met again by a ray that leaves it; what lies above is met.
            Shape::Leaving(Leaving { gap: None, .. }) => None,
            Shape::Leaving(leaving) => {
                let gap = leaving.gap.expect("matched above");
                let rise = f64::from(gap.occluder_y) - f64::from(gap.point.y);
                Some(rise / f64::from(leaving.direction.y))
            }
            Shape::Sum(sum) => Some(mean(sum)),
        };
        let hit = if t.is_some() { ExpectedHit::Yes } else { ExpectedHit::No };
        Expected { hit, t, normal: None, faces: Vec::new(), surface: None }
    }
}

fn reference(h: &Heightfield) -> heightfield::Heightfield {
    heightfield::Heightfield {
        k: h.k.into(),
        a: h.a.into(),
        fx: h.f[0].into(),
        fz: h.f[1].into(),
        b: h.b.into(),
        gx: h.g[0].into(),
        gz: h.g[1].into(),
        lipschitz: h.lipschitz.into(),
    }
}

/// In f64: products of two f32 and their few sums are exact, or as good as.
fn mean(sum: &Sum) -> f64 {
    let (value, n) = (f64::from(sum.value), f64::from(sum.n));
    match sum.pattern {
        Pattern::Constant => value,
        Pattern::Firefly { spike, every } => {
            let spikes = f64::from(sum.n / every);
            (spikes * f64::from(spike) + (n - spikes) * value) / n
        }
        Pattern::Head(head) => (f64::from(head) + (n - 1.0) * value) / n,
    }
}

/// A point of the disc of this radius around `center`, across `axis`.
fn on_disc(random: &mut Random, center: DVec3, axis: DVec3, radius: f64) -> DVec3 {
    let u = axis.any_orthonormal_vector();
    let v = axis.cross(u);
    let (r, angle) = (random.between(0.0, 1.0).sqrt() * radius, random.between(0.0, TAU));
    center + r * (angle.cos() * u + angle.sin() * v)
}

/// From `distance` away, at a disc a little larger than the unit sphere.
fn from_afar(random: &mut Random, distance: f64) -> (DVec3, DVec3) {
    let axis = random.unit();
    let origin = f32s(axis * distance);
    (origin, (on_disc(random, DVec3::ZERO, axis, 1.1) - origin).normalize())
}

fn spheres(count: usize) -> Vec<Family> {
    let unit = || vec![Shape::Sphere { center: Vec3::ZERO, radius: 1.0 }];
    let afar = |name, distance| {
        Family::new(name, unit(), count, &mut move |random, _| {
            let (origin, direction) = from_afar(random, distance);
            (0, origin, direction)
        })
    };
    let tangent = &mut |random: &mut Random, number: usize| {
        let axis = random.unit();
        let impact = if number.is_multiple_of(2) { 1.0 - 1e-6 } else { 1.0 + 1e-6 };
        let side = axis.any_orthonormal_vector() * impact;
        let origin = f32s(axis * 10.0 + side);
        (0, origin, -axis)
    };
    let tiny = &mut |random: &mut Random, _| {
        let axis = random.unit();
        let origin = f32s(axis * 1e4);
        (0, origin, (on_disc(random, DVec3::ZERO, axis, 1.1e-4) - origin).normalize())
    };
    let planet = &mut |random: &mut Random, _| {
        let down = random.between(1f64.to_radians(), 90f64.to_radians());
        let around = random.between(0.0, TAU);
        let (out, y) = (down.cos(), -down.sin());
        (0, DVec3::Y, DVec3::new(out * around.cos(), y, out * around.sin()))
    };
    let inside = &mut |random: &mut Random, _| {
        (0, f32s(random.unit() * random.between(0.0, 0.99)), random.unit())
    };
    let small = vec![Shape::Sphere { center: Vec3::ZERO, radius: 1e-4 }];
    let world = vec![Shape::Sphere { center: Vec3::new(0.0, -1e6, 0.0), radius: 1e6 }];
    vec![
        afar("sphere from 10 radii", 10.0),
        afar("sphere from 1e3 radii", 1e3),
        afar("sphere from 1e6 radii", 1e6),
        Family::new("sphere nearly grazed", unit(), count, tangent),
        Family::new("sphere of 1e-4 from 1e4", small, count, tiny),
        Family::new("planet of 1e6 from 1 above", world, count, planet),
        Family::new("sphere from inside", unit(), count, inside),
    ]
}

fn boxes(count: usize) -> Vec<Family> {
    let unit = || vec![Shape::Box { low: Vec3::NEG_ONE, high: Vec3::ONE }];
    let afar = |name, distance| {
        Family::new(name, unit(), count, &mut move |random, _| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (0, origin, (on_disc(random, DVec3::ZERO, axis, 1.6) - origin).normalize())
        })
    };
    // Along a wall, exactly in its plane: the box is closed, so all of these are hits.
    let wall = &mut |random: &mut Random, number: usize| {
        let (a, b, c) = (number % 3, (number + 1) % 3, (number + 2) % 3);
        let mut origin = DVec3::ZERO;
        origin[a] = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        origin[b] = 10.0;
        origin[c] = random.between(-0.9, 0.9);
        let mut target = origin;
        target[b] = 0.0;
        target[c] = random.between(-0.9, 0.9);
        (0, f32s(origin), f32s(target) - f32s(origin))
    };
    let inside = &mut |random: &mut Random, _| (0, f32s(random.in_cube() * 0.99), random.unit());
    vec![
        afar("box from 10", 10.0),
        Family::new("box along a wall", unit(), count, wall),
        afar("box from 1e4", 1e4),
        Family::new("box from inside", unit(), count, inside),
    ]
}

fn planes(count: usize) -> Vec<Family> {
    const PLANES: usize = 16;
    // Sixteen planes of any normal, the camera at some height above a point near the foot of each.
    let family = |name, distance: f64, sine: fn(&mut Random) -> f64| {
        let mut random = Random(7);
        let normals: Vec<DVec3> =
            (0..PLANES).map(|_| f32s(random.unit() * random.scale(0.1, 10.0))).collect();
        let plane = |n: &DVec3| Shape::Plane { normal: n.as_vec3(), distance: distance as f32 };
        Family::new(name, normals.iter().map(plane).collect(), count, &mut |random, number| {
            let shape = number % PLANES;
            let n = normals[shape].normalize();
            let height = random.between(0.5, 2.0);
            let origin = f32s(n * (distance + height) + 3.0 * n.any_orthonormal_vector());
            let sine = sine(random);
            let along = on_disc(random, DVec3::ZERO, n, 1.0).normalize();
            (shape, origin, along * (1.0 - sine * sine).sqrt() - n * sine)
        })
    };
    vec![
        family("plane from 1 above", 1.0, |random| random.between(0.05, 1.0)),
        family("plane at 1e6", 1e6, |random| random.between(0.05, 1.0)),
        family("plane grazed at 1e-3", 1.0, |random| random.between(0.5e-3, 2e-3)),
        family("plane grazed at 1e-6", 1.0, |random| random.between(0.5e-6, 2e-6)),
    ]
}

/// A bumpy ball of `2·n²` triangles, closed: every ray through its middle hits it.
fn ball(n: usize) -> Vec<[Vec3; 3]> {
    let at = |i: usize, j: usize| {
        let (u, v) = (i as f64 / n as f64, (j % n) as f64 / n as f64);
        let (polar, around) = (u * std::f64::consts::PI, v * std::f64::consts::TAU);
        // The poles are one point each.
        let around = if i == 0 || i == n { 0.0 } else { around };
        let radius = 1.0 + 0.1 * (5.0 * polar).sin() * (3.0 * around).cos();
        let y = if i == n { -1.0 } else { polar.cos() };
        let side = if i == n { 0.0 } else { polar.sin() };
        (DVec3::new(side * around.cos(), y, side * around.sin()) * radius).as_vec3()
    };
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let quad = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        let both = [[a, b, c], [a, c, d]];
        both.into_iter().filter(|[a, b, c]| a != b && b != c && c != a)
    };
    cells.flat_map(quad).collect()
}

fn triangles(count: usize) -> Vec<Family> {
    let mesh = ball(16);
    let shapes = || vec![Shape::Triangles(mesh.clone())];
    // Aimed at a point of a triangle: inside it, on an edge, or at a corner.
    let aimed = |name, weights: fn(&mut Random) -> [f64; 3]| {
        Family::new(name, shapes(), count, &mut |random, _| {
            let triangle = mesh[random.below(mesh.len())];
            let w = weights(random);
            let target: DVec3 = (0..3).map(|k| triangle[k].as_dvec3() * w[k]).sum();
            let axis = (target.normalize() + 0.5 * random.unit()).normalize();
            let origin = f32s(target + axis * 5.0);
            (0, origin, f32s(target) - origin)
        })
    };
    vec![
        aimed("triangles inside", |random| {
            let (a, b) = (random.between(0.05, 0.5), random.between(0.05, 0.4));
            [1.0 - a - b, a, b]
        }),
        aimed("triangles at edges", |random| {
            let a = random.between(0.0, 1.0);
            [1.0 - a, a, 0.0]
        }),
        aimed("triangles at corners", |_| [1.0, 0.0, 0.0]),
        far_ball(count),
        far_plane(count),
    ]
}

/// A ball of radius 2 far from the origin, seen from close by: none of the rays at it may pass through.
/// The place is that of Embree's WatertightTest (`verify.cpp`).
fn far_ball(count: usize) -> Family {
    let center = DVec3::new(148_376.0, 1234.0, -223_423.0);
    let moved = |v: Vec3| (v.as_dvec3() * 2.0 + center).as_vec3();
    let mesh: Vec<_> = ball(16).into_iter().map(|triangle| triangle.map(moved)).collect();
    Family::new("triangles far away", vec![Shape::Triangles(mesh)], count, &mut |random, _| {
        let origin = f32s(center + random.unit() * 6.0);
        (0, origin, f32s(center + random.in_cube()) - origin)
    })
}

/// A plane of triangles as far away, seen from 3 in front of its middle at a slant: after the other half of
/// Embree's WatertightTest.
fn far_plane(count: usize) -> Family {
    const CELLS: usize = 16;
    const AT: f64 = 148_376.0;
    let corner = |i: usize, j: usize| {
        let along = |i: usize| 12.0 * i as f64 / CELLS as f64 - 6.0;
        // Not quite flat, or no plane could tell the edges apart.
        let bump = ((5 * i + 3 * j) % 7) as f64 / 64.0;
        DVec3::new(AT + bump, along(i), along(j)).as_vec3()
    };
    let quad = |cell: usize| {
        let (i, j) = (cell / CELLS, cell % CELLS);
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let mesh: Vec<_> = (0..CELLS * CELLS).flat_map(quad).collect();
    // Its border is the end of the plane: beyond, a miss is right.
    let is_inside = |triangle: &&[Vec3; 3]| {
        triangle.iter().all(|corner| corner.y.abs().max(corner.z.abs()) < 6.0)
    };
    let inner: Vec<[Vec3; 3]> = mesh.iter().filter(is_inside).copied().collect();
    Family::new(
        "triangles of a far plane",
        vec![Shape::Triangles(mesh)],
        count,
        &mut |random, number| {
            // At an edge or a corner, as well as rounding allows.
            let triangle = inner[random.below(inner.len())];
            let share = if number % 2 == 0 { random.between(0.0, 1.0) } else { 0.0 };
            let target = triangle[0].as_dvec3().lerp(triangle[1].as_dvec3(), share);
            let origin = DVec3::new(AT - 3.0, 0.0, 0.0);
            (0, origin, f32s(target) - origin)
        },
    )
}

fn capsules(count: usize) -> Vec<Family> {
    let (a, b) = (Vec3::NEG_X, Vec3::X);
    let afar = |name, distance| {
        let shapes = vec![Shape::Capsule { a, b, radius: 0.5 }];
        Family::new(name, shapes, count, &mut move |random, _| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (0, origin, (on_disc(random, DVec3::ZERO, axis, 1.6) - origin).normalize())
        })
    };
    vec![afar("capsule from 10", 10.0), afar("capsule from 1e4", 1e4)]
}

fn instances(count: usize) -> Vec<Family> {
    const MATRICES: usize = 16;
    // Turned, sheared, mirrored half of the time, stretched by `stretch`, moved by `shift`.
    let family = |name, stretch: f64, shift: f64| {
        let mut random = Random(11);
        let matrix = |_| {
            let size =
                DVec3::new(1.0, random.scale(1.0 / stretch, 1.0), random.scale(1.0 / stretch, 1.0));
            let mirror = if random.below(2) == 0 { 1.0 } else { -1.0 };
            let mut linear = DMat3::from_axis_angle(random.unit(), random.between(0.0, 6.0))
                * DMat3::from_diagonal(size * DVec3::new(mirror, 1.0, 1.0));
            linear.y_axis += linear.x_axis * 0.3 / stretch;
            let shift = random.unit() * shift;
            let row = |i: usize| {
                [0, 1, 2, 3].map(|k| (if k < 3 { linear.col(k)[i] } else { shift[i] }) as f32)
            };
            [row(0), row(1), row(2)]
        };
        let matrices: Vec<_> = (0..MATRICES).map(matrix).collect();
        let shapes = matrices.iter().map(|rows| Shape::Instance(*rows)).collect();
        Family::new(name, shapes, count, &mut |random, number| {
            let shape = number % MATRICES;
            let (linear, translation) = parts(&matrices[shape]);
            let target = translation + linear * random.in_cube() * 0.6;
            let origin = f32s(translation + random.unit() * 8.0);
            (shape, origin, (target - origin).normalize())
        })
    };
    vec![
        family("instance sheared", 4.0, 3.0),
        family("instance 1:1000", 1e3, 3.0),
        family("instance at 1e6", 4.0, 1e6),
    ]
}

fn heightfields(count: usize) -> Vec<Family> {
    let field = |k: f32, lipschitz: f32| {
        let (f, g) = ([0.11, 0.08], [0.3, 0.2]);
        vec![Shape::Heightfield(Heightfield { k, a: 0.6, f, b: 0.25, g, lipschitz })]
    };
    let family = |name, shapes, degrees: f64, height: f64| {
        Family::new(name, shapes, count, &mut move |random, _| {
            let around = random.between(0.0, TAU);
            let down = degrees.to_radians();
            let origin = DVec3::new(random.between(-9.0, 9.0), height, random.between(-9.0, 9.0));
            let (out, y) = (down.cos(), -down.sin());
            (0, f32s(origin), DVec3::new(out * around.cos(), y, out * around.sin()))
        })
    };
    vec![
        family("hills at 60°", field(1.0, 1.373_695_8), 60.0, 2.5),
        family("hills at 5°", field(1.0, 1.373_695_8), 5.0, 1.4),
        family("hills at 1°", field(1.0, 1.373_695_8), 1.0, 1.2),
        family("steep ground at 20°", field(8.0, 10.989_566), 20.0, 8.0),
        family("flat ground at 0.2°", field(0.0, 0.0), 0.2, 1.0),
    ]
}

/// A ray that leaves a sphere where another one arrives, anywhere above the surface, often grazing;
/// `None` where that one misses.
fn leaving(
    random: &mut Random,
    sphere: &sphere::Sphere,
    origin: DVec3,
    direction: DVec3,
) -> Option<Shape> {
    let (origin, direction) = (origin.as_vec3(), direction.as_vec3());
    let arriving = Ray { origin, direction, tmin: 0.0, tmax: 1e30 }.exact();
    let hit = sphere.intersect(&arriving)?;
    // The device's point may lie a few ULP of t farther along the ray. There the surface has turned, and a
    // direction must be above that one, as a renderer's is: it has no other normal.
    let cosine = -hit.normal.dot(arriving.direction.normalize());
    let distance = (arriving.origin - sphere.center).length() / sphere.radius;
    let turned = 16.0 * 2f64.powi(-24) * distance / cosine;
    let sine = random.scale(turned.clamp(1e-4, 1.0), 1.0);
    let along = on_disc(random, DVec3::ZERO, hit.normal, 1.0).normalize();
    let direction = (along + sine * hit.normal).normalize().as_vec3();
    let (center, radius) = (sphere.center.as_vec3(), sphere.radius as f32);
    Some(Shape::Leaving(Leaving { center, radius, direction, gap: None }))
}

fn departures(count: usize) -> Vec<Family> {
    // Each ray has a sphere of its own, and a camera somewhere that sees it.
    let family = |name, make: &dyn Fn(&mut Random) -> (sphere::Sphere, f64, f64)| {
        let mut random = Random(13);
        let (mut shapes, mut rays) = (Vec::new(), Vec::new());
        while rays.len() < count {
            let (sphere, distance, speed) = make(&mut random);
            let axis = random.unit();
            let origin = f32s(sphere.center + axis * (distance * sphere.radius));
            let target = on_disc(&mut random, sphere.center, axis, sphere.radius);
            let direction = (target - origin).normalize() * speed;
            if let Some(shape) = leaving(&mut random, &sphere, origin, direction) {
                shapes.push(shape);
                rays.push((origin, direction));
            }
        }
        let mut family = Family::new(name, shapes, count, &mut |_, number| {
            (number, rays[number].0, rays[number].1)
        });
        family.is_traced = false;
        family
    };
    let still = |name, center: DVec3, radius: f64, distance: f64| {
        let radius = f64::from(radius as f32);
        family(name, &move |_| (sphere::Sphere { center, radius }, distance, 1.0))
    };
    // Any size, any place (after pbrt-v4's FullSphere.Reintersect).
    let anywhere = |random: &mut Random| {
        let radius = f64::from(random.scale(1e-4, 1e4) as f32);
        let center = f32s(random.unit() * radius * random.scale(1e-4, 1e4));
        (sphere::Sphere { center, radius }, random.scale(1.1, 1e4), random.scale(1e-4, 1e4))
    };
    // A plane so many units in the last place above the top of a sphere.
    let gap = |name, radius: f32, units: f32| {
        let mut random = Random(17);
        let make = |_| {
            let center = Vec3::new(0.0, random.between(-4.0, 4.0) as f32 * radius, 0.0);
            let top = center.y + radius;
            let largest = top.abs().max(center.y.abs()).max(radius);
            let unit = largest.next_up() - largest;
            let gap = Gap {
                point: Vec3::new(0.0, top, 0.0),
                normal: Vec3::Y,
                occluder_y: top + units * unit,
            };
            let direction = Vec3::new(random.between(-0.5, 0.5) as f32, 1.0, 0.0);
            Shape::Leaving(Leaving { center, radius, direction, gap: Some(gap) })
        };
        let shapes: Vec<Shape> = (0..count).map(make).collect();
        let mut family =
            Family::new(name, shapes, count, &mut |_, number| (number, DVec3::ZERO, DVec3::Y));
        family.is_traced = false;
        family
    };
    vec![
        still("leaving r=1 seen from 5", DVec3::ZERO, 1.0, 5.0),
        still("leaving r=1 seen from 1e3", DVec3::ZERO, 1.0, 1e3),
        still("leaving r=1 at 1e4", DVec3::new(6e3, 4.8e3, 6.4e3), 1.0, 5.0),
        still("leaving r=1e6", DVec3::ZERO, 1e6, 2.0),
        still("leaving r=1e-3", DVec3::ZERO, 1e-3, 5.0),
        family("leaving any sphere anywhere", &anywhere),
        gap("gap of 64 ULP, r=1", 1.0, 64.0),
        gap("gap of 64 ULP, r=1e-3", 1e-3, 64.0),
        gap("gap of 64 ULP, r=1e6", 1e6, 64.0),
    ]
}

fn sums() -> Vec<Family> {
    let family = |name, value: f32, pattern| {
        let shape = Shape::Sum(Sum { value, n: 1 << 20, pattern });
        let mut family = Family::new(name, vec![shape], 1, &mut |_, _| (0, DVec3::ZERO, DVec3::Y));
        family.is_traced = false;
        family
    };
    vec![
        family("a million times 0.1", 0.1, Pattern::Constant),
        family("a firefly in ten thousand", 0.1, Pattern::Firefly { spike: 1e4, every: 10_000 }),
        family("after one of 2^24", 1.0, Pattern::Head(16_777_216.0)),
    ]
}
