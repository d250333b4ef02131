//! The chess set on a floor that reaches to the horizon, and the tiles on it.

use anyhow::Result;
use common::gpu::Sampling;
use common::model::Texture;
use common::scene::{Camera, Instance, Material, Mesh, Scene, Vertex};
use glam::{Affine3A, DVec3, Vec2, Vec3};

/// Distance from the middle of the board to the end of the floor.
const REACH: f32 = 2000.0;
/// Pieces of the floor along a side. Where a shadow ray starts depends on the size of the triangle that it leaves.
const PIECES: u32 = 40;
/// Tiles along a side of the texture, and texels along a side of a tile.
const TILES: u32 = 4;
const TEXELS: u32 = 64;

/// The chess set on the floor. A tile is as large as a square of the board.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let height = scene.bounds().0.y;
    let model = &mut scene.model;
    let material = model.materials.len();
    let mesh = model.meshes.len();
    model.materials.push(Material {
        name: "floor".to_owned(),
        base_color: Vec3::ONE,
        base_texture: Some(model.textures.len()),
        ..Material::default()
    });
    model.textures.push(tiles());
    model.meshes.push(plane(height, material));
    let transform = Affine3A::IDENTITY;
    scene.instances.push(Instance { mesh, transform, material, record_offset: 0 });
    scene.camera = Camera::new(DVec3::new(-7.5, 3.1, 11.5), DVec3::new(1.6, 0.1, -1.5), 36.0);
    Ok(scene)
}

fn plane(height: f32, material: usize) -> Mesh {
    let row = PIECES + 1;
    let vertex = |i: u32| {
        let at = Vec2::new((i % row) as f32, (i / row) as f32) / PIECES as f32;
        let at = REACH * (2.0 * at - 1.0);
        let position = Vec3::new(at.x, height, at.y);
        Vertex { position, normal: Vec3::Y, uv: at / TILES as f32 }
    };
    let piece = |i: u32| {
        let a = i / PIECES * row + i % PIECES;
        [[a, a + row, a + 1], [a + 1, a + row, a + row + 1]]
    };
    Mesh {
        name: "floor".to_owned(),
        vertices: (0..row * row).map(vertex).collect(),
        triangles: (0..PIECES * PIECES).flat_map(piece).collect(),
        material,
    }
}

/// Each tile has two quarter rings, about two corners that lie across from each other: the rings of neighbours meet,
/// whichever way a tile is turned (Smith, "The Tiling Patterns of Sebastien Truchet", Leonardo 20, 1987).
fn tiles() -> Texture {
    const TURNED: [u16; TILES as usize] = [0b0110, 0b1101, 0b0010, 0b1011];
    let (blue, white) = (Vec3::new(0.02, 0.035, 0.09), Vec3::new(0.82, 0.76, 0.64));
    let side = TILES * TEXELS;
    let texel = |i: u32| {
        let (x, y) = (i % side, i / side);
        let turned = TURNED[(y / TEXELS) as usize] >> (x / TEXELS) & 1 == 1;
        let mut at = (Vec2::new((x % TEXELS) as f32, (y % TEXELS) as f32) + 0.5) / TEXELS as f32;
        if turned {
            at.x = 1.0 - at.x;
        }
        let to_ring = |corner: Vec2| (at.distance(corner) - 0.5).abs();
        let distance = to_ring(Vec2::ZERO).min(to_ring(Vec2::ONE));
        // A texel is as white as the ring covers it.
        let covered = ((0.13 - distance) * TEXELS as f32 + 0.5).clamp(0.0, 1.0);
        let encode = |linear: f32| (255.0 * srgb(linear)).round() as u8;
        let [r, g, b] = blue.lerp(white, covered).to_array().map(encode);
        [r, g, b, 255]
    };
    let rgba = (0..side * side).flat_map(texel).collect();
    Texture {
        name: "tiles".to_owned(),
        width: side,
        height: side,
        rgba,
        srgb: true,
        slopes: false,
        sampling: Sampling::default(),
    }
}

fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}
