//! The world as shaders get it: addresses of shapes, plane, ground and lights, all in one buffer.

use ash::vk;
use bytemuck::Zeroable;
use common::gpu::{Address, ShaderStruct, StructLayout};
use common::scene::plane::Plane;
use common::scene::{DiskLight, Light, LightKind};
use effects::{
    BoardPlane, Column, Composition, Emitter, EmitterAddresses, Face, Finish, Glass, Lens,
    MAX_LIGHTS, Node, Segment, Solid, Sphere, Torus,
};
use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::albedo::Albedo;
use crate::ground::Ground;
use crate::microfacets::{MicrofacetRecord, RoughAddresses};
use crate::normal_map::NormalMapRecord;
use crate::shape::HeightfieldShape;
use crate::sky::{SkyAddresses, SkyRow, Texel};

/// Addresses of the shapes; 0 where there are none.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shapes {
    /// The address of an array of [`effects::Sphere`].
    pub spheres: vk::DeviceAddress,
    /// The address of an array of [`effects::Box`].
    pub boxes: vk::DeviceAddress,
    /// The address of an array of [`effects::Solid`].
    pub solids: vk::DeviceAddress,
    /// The address of an array of [`effects::Node`].
    pub nodes: vk::DeviceAddress,
    /// The address of an array of [`effects::Segment`].
    pub segments: vk::DeviceAddress,
    /// The address of an array of [`effects::Torus`].
    pub tori: vk::DeviceAddress,
    /// The address of an array of [`effects::Face`].
    pub faces: vk::DeviceAddress,
    /// The address of an array of [`effects::Finish`].
    pub finishes: vk::DeviceAddress,
    /// The address of an array of [`effects::Glass`].
    pub glasses: vk::DeviceAddress,
    /// Number of those.
    pub glass_count: u32,
    /// The address of an array of [`NormalMapRecord`].
    pub normal_maps: vk::DeviceAddress,
    /// Number of those.
    pub map_count: u32,
    /// The address of a [`RoughAddresses`].
    pub rough: vk::DeviceAddress,
    /// The address of a [`SkyAddresses`].
    pub sky: vk::DeviceAddress,
    /// Number of materials, if one in use has microfacets.
    pub rough_count: u32,
    /// Addresses of the emitters, if there are any.
    pub emitters: Option<EmitterAddresses>,
}

common::shader_struct! {
    /// The board on the plane.
    pub struct Board {
        /// Colour of the light squares, linear RGB.
        pub light: Vec3,
        /// Colour of the dark ones.
        pub dark: Vec3,
        /// The part of the light that is mirrored at normal incidence.
        pub reflection: f32,
        /// Length of a square's side.
        pub square: f32,
        /// Unit vector along one side.
        pub u: Vec3,
        /// Along the other.
        pub v: Vec3,
        /// The square that contains the plane's anchor.
        pub anchor: Vec2,
    }
}

common::shader_struct! {
    /// The world beside the meshes.
    pub struct World {
        pub spheres: Address,
        pub boxes: Address,
        pub solids: Address,
        pub faces: Address,
        pub nodes: Address,
        pub segments: Address,
        pub finishes: Address,
        pub glasses: Address,
        pub normal_maps: Address,
        pub emitters: EmitterAddresses,
        pub plane: Plane,
        pub board: Board,
        pub ground: Ground,
        pub lens: Lens,
        pub media: [u32; 4],
        pub lights: [DiskLight; MAX_LIGHTS],
        pub sky: f32,
        pub rotation: f32,
        pub sky_on: u32,
        pub light_count: u32,
        pub shadows: u32,
        pub light_samples: u32,
        pub samples: u32,
        pub first_sample: u32,
        pub depth: u32,
        pub bounces: u32,
        pub plane_on: u32,
        pub finish_count: u32,
        pub glass_count: u32,
        pub rough_count: u32,
        pub map_count: u32,
        pub moving: u32,
        pub tori: Address,
        pub filtered: u32,
    }
}

/// Layouts of the structures behind the world's address.
pub const LAYOUTS: [StructLayout; 27] = [
    World::LAYOUT,
    Plane::LAYOUT,
    Board::LAYOUT,
    Ground::LAYOUT,
    HeightfieldShape::LAYOUT,
    DiskLight::LAYOUT,
    Light::LAYOUT,
    Sphere::LAYOUT,
    effects::Box::LAYOUT,
    Solid::LAYOUT,
    Face::LAYOUT,
    Node::LAYOUT,
    Segment::LAYOUT,
    Torus::LAYOUT,
    Finish::LAYOUT,
    Glass::LAYOUT,
    Lens::LAYOUT,
    EmitterAddresses::LAYOUT,
    Emitter::LAYOUT,
    Column::LAYOUT,
    RoughAddresses::LAYOUT,
    MicrofacetRecord::LAYOUT,
    Albedo::LAYOUT,
    NormalMapRecord::LAYOUT,
    SkyAddresses::LAYOUT,
    SkyRow::LAYOUT,
    Texel::LAYOUT,
];

impl World {
    /// The world of a scene, seen from `eye` by rays that are counted from `first_sample` on.
    pub fn new(scene: &Composition, shapes: Shapes, eye: DVec3, first_sample: u32) -> Self {
        let nowhere = BoardPlane {
            normal: Vec3::Y,
            distance: 0.0,
            light: Vec3::ZERO,
            dark: Vec3::ZERO,
            square: 1.0,
            reflection: 0.0,
        };
        let board = scene.plane.unwrap_or(nowhere);
        let normal = board.normal.as_dvec3();
        let plane =
            Plane::new((normal, f64::from(board.distance) * normal.length()), eye.as_vec3());
        let dark =
            Light { place: Vec3::Y, kind: LightKind::Directional.into(), strength: Vec3::ZERO };
        let mut lights = [DiskLight { light: dark, radius: 0.0, samples: 1 }; MAX_LIGHTS];
        let rotation = scene.environment.as_ref().map_or(0.0, |sky| sky.rotation);
        let mut shadows = 0;
        for (number, light) in scene.lights.iter().enumerate() {
            lights[number] = light.disk;
            shadows |= u32::from(light.shadows) << number;
        }
        Self {
            spheres: shapes.spheres.into(),
            boxes: shapes.boxes.into(),
            solids: shapes.solids.into(),
            faces: shapes.faces.into(),
            nodes: shapes.nodes.into(),
            segments: shapes.segments.into(),
            finishes: shapes.finishes.into(),
            glasses: shapes.glasses.into(),
            normal_maps: shapes.normal_maps.into(),
            emitters: shapes.emitters.unwrap_or_else(Zeroable::zeroed),
            plane,
            board: Board::new(&board, &plane),
            ground: scene.heightfield.as_ref().map_or_else(Ground::none, Ground::new),
            lens: scene.lens.shader(),
            media: scene.media_at(eye),
            lights,
            // The picture's light is sampled: nothing stands for it.
            sky: if scene.environment.is_some() { 0.0 } else { scene.sky },
            rotation: (rotation / 360.0).rem_euclid(1.0),
            sky_on: scene.environment.is_some().into(),
            light_count: scene.lights.len() as u32,
            shadows,
            light_samples: scene.light_samples,
            samples: scene.samples,
            first_sample,
            depth: scene.depth,
            bounces: scene.bounces,
            plane_on: scene.plane.is_some().into(),
            finish_count: scene.finishes_to_read().len() as u32,
            glass_count: shapes.glass_count,
            rough_count: shapes.rough_count,
            map_count: shapes.map_count,
            moving: scene.moving() as u32,
            tori: shapes.tori.into(),
            filtered: scene.filtered.into(),
        }
    }
}

impl Board {
    /// As chapter 12 places it: which square the anchor is on, less an even number of squares.
    fn new(board: &BoardPlane, plane: &Plane) -> Self {
        let normal = board.normal.as_dvec3().normalize();
        let aside = if normal.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
        let u = normal.cross(aside).normalize();
        let v = u.cross(normal);
        let from_origin = plane.anchor.as_dvec3() / f64::from(board.square);
        let anchor = DVec2::new(u.dot(from_origin), v.dot(from_origin));
        let anchor = (anchor - 2.0 * (anchor / 2.0).floor()).as_vec2();
        let &BoardPlane { light, dark, square, reflection, .. } = board;
        Self { light, dark, reflection, square, u: u.as_vec3(), v: v.as_vec3(), anchor }
    }
}
