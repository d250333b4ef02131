//! Emitters of a scene: its spheres, and each triangle of a mesh whose material has a `Ke`.

use anyhow::{Context, Result};
use common::gpu::Address;
use common::scene::{Instance, Material, Scene};
use glam::{DMat3, DVec3, Vec3};

use super::alias::{AliasTable, Column};

/// A sphere.
#[derive(Clone, Copy)]
pub struct Sphere {
    /// Its centre, in the world.
    pub center: Vec3,
    /// Its radius.
    pub radius: f32,
    /// Its material, by position in the model.
    pub material: usize,
}

common::shader_struct! {
    /// A sphere or a triangle that shines, in the world.
    pub struct Emitter {
        /// A triangle's first corner; a sphere's centre.
        pub corner: Vec3,
        /// A sphere's; 0 for a triangle.
        pub radius: f32,
        /// From a triangle's first corner to its second.
        pub across: Vec3,
        /// The probability with which it is chosen, by its power.
        pub probability: f32,
        /// From a triangle's first corner to its third.
        pub along: Vec3,
        /// Index of its material.
        pub material: u32,
        /// A ray that ends so far above it, and [`Emitter::slack`] times its length, does not meet it.
        pub offset: f32,
        /// See [`Emitter::offset`].
        pub slack: f32,
    }
}

common::shader_struct! {
    /// Addresses of the emitters.
    pub struct EmitterAddresses {
        /// All spheres, then the triangles of each mesh that shines.
        pub emitters: Address<Emitter>,
        /// The table that chooses by power.
        pub columns: Address<Column>,
        /// Of each instance: which emitter its triangle 0 is; and of the spheres' instance, the last.
        pub first: Address,
        /// The sphere of each primitive of the build.
        pub sphere_ids: Address,
        /// Number of emitters.
        pub count: u32,
        /// Number of columns.
        pub column_count: u32,
    }
}

/// The emitters of a scene, and how one is found.
pub struct Emitters {
    /// Spheres first.
    pub list: Vec<Emitter>,
    /// Of each instance and then of the spheres: which emitter its primitive 0 is.
    pub first: Vec<u32>,
    /// The table that chooses by power.
    pub table: AliasTable,
}

/// The relative error of one rounding to f32.
const ROUNDING: f64 = 1.0 / 16_777_216.0;

impl Emitters {
    /// The emitters of a scene and its spheres.
    ///
    /// # Errors
    /// If the power of one is not a number, or there are too many.
    pub fn new(scene: &Scene, spheres: &[Sphere]) -> Result<Self> {
        let materials = &scene.model.materials;
        let mut list: Vec<Emitter> = spheres.iter().map(sphere).collect();
        let mut first = Vec::new();
        for instance in &scene.instances {
            first.push(list.len() as u32);
            if shines(&materials[instance.material]) {
                list.extend(triangles(scene, instance));
            }
        }
        first.push(0);
        let powers =
            list.iter().map(|emitter| emitter.power(&materials[emitter.material as usize]));
        let table = AliasTable::new(&powers.collect::<Vec<_>>()).context("choosing by power")?;
        for (i, emitter) in list.iter_mut().enumerate() {
            emitter.probability = table.probability(i) as f32;
        }
        Ok(Self { list, first, table })
    }
}

fn shines(material: &Material) -> bool {
    material.emission.max_element() > 0.0
}

impl Emitter {
    /// The light that it sends out: pi times radiance times surface. A triangle shines on both sides.
    fn power(&self, material: &Material) -> f64 {
        let [across, along] = [self.across, self.along].map(|edge| edge.as_dvec3());
        let surface = match f64::from(self.radius) {
            0.0 => across.cross(along).length(),
            radius => 4.0 * std::f64::consts::PI * radius * radius,
        };
        let [red, green, blue] = material.emission.to_array().map(f64::from);
        std::f64::consts::PI * surface * (red + green + blue) / 3.0
    }
}

/// The least distance from a ray's end to a sphere: as in 08 for one that starts there, and `slack` for the way.
/// Along that, the device may be off by 25u where it takes origin and direction into the spheres' space (its matrix
/// is the identity), and the shader by 30u: 1u for f, 10u for the foot of the perpendicular and what is left of the
/// radius there, 19u for root, c and quotient.
fn sphere(sphere: &Sphere) -> Emitter {
    let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
    let height = 56.0 * (center.length() + radius) + 46.0 * radius;
    Emitter {
        corner: sphere.center,
        radius: sphere.radius,
        across: Vec3::ZERO,
        probability: 0.0,
        along: Vec3::ZERO,
        material: sphere.material as u32,
        offset: (ROUNDING * height) as f32,
        slack: (ROUNDING * 80.0) as f32,
    }
}

fn triangles(scene: &Scene, instance: &Instance) -> impl Iterator<Item = Emitter> {
    let mesh = &scene.model.meshes[instance.mesh];
    mesh.triangles.iter().map(move |corners| {
        let positions = corners.map(|i| mesh.vertices[i as usize].position.as_dvec3());
        triangle(positions, instance)
    })
}

/// The least distance from a ray's end to a triangle: as in common/ray_offset.glsl for one that starts there, for the
/// farthest corner. The part that grows with the way is `slack`: 25u for origin and direction in the mesh's space,
/// and those parts of the triangle's test that there are multiples of its longest edge; and 10u of the target's
/// place.
fn triangle(corners: [DVec3; 3], instance: &Instance) -> Emitter {
    let linear: DMat3 = instance.transform.matrix3.as_dmat3();
    let shift = instance.transform.translation.as_dvec3();
    let [a, b, c] = corners;
    let (across, along) = (linear * (b - a), linear * (c - a));
    let absolute = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let (out, back) = (absolute(linear), absolute(linear.inverse()));
    let height = corners.map(|corner| {
        let (reach, world) = (out * corner.abs(), (linear * corner + shift).abs());
        let error_bound = out * (corner.abs() + 3.0 * ((b - a).abs() + (c - a).abs()))
            + 4.0 * (reach + shift.abs())
            + 2.0 * world
            + out * (back * (18.0 * reach + 14.0 * (world + shift.abs())));
        error_bound.length()
    });
    let longest = across.length().max(along.length()).max((along - across).length());
    let area = across.cross(along).length().max(2.0 * ROUNDING * longest * longest).max(1e-300);
    let test = 37.0 + 2.0 * longest * longest / area;
    let both = out * back;
    let norm = both.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    let height = height.into_iter().fold(0.0, f64::max) + longest * test;
    Emitter {
        corner: (linear * a + shift).as_vec3(),
        radius: 0.0,
        across: across.as_vec3(),
        probability: 0.0,
        along: along.as_vec3(),
        material: instance.material as u32,
        offset: (ROUNDING * height) as f32,
        slack: (ROUNDING * (25.0 * norm + test + 10.0)) as f32,
    }
}
