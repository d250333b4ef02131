//! The scenes of this chapter: the mesh, rotation and flags of each instance.

use anyhow::{Context, Result};
use common::model::Model;
use common::scene::{Camera, Instance, Mesh, Scene, Vertex};
use glam::{Affine3A, DVec3, Mat3, Vec2, Vec3};

common::shader_enum! {
    /// The scenes.
    pub enum SceneKind { Ripples, Specimens }
    /// The way to repeat a mesh: by instances, or by copies of it.
    pub enum Geometry { Instances, Copies }
}

/// The bits of the visibility mask.
pub const BOARD: u8 = 1;
pub const WHITE: u8 = 2;
pub const BLACK: u8 = 4;

/// Parameters of meshes and pieces; a change rebuilds them.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub scene: SceneKind,
    pub squares: u32,
    pub geometry: Geometry,
}

impl Build {
    pub fn is_copied(&self) -> bool {
        self.geometry == Geometry::Copies
    }
}

/// One instance, with its place in f64.
#[derive(Clone, Copy)]
pub struct Piece {
    /// The mesh, by position in the model.
    pub mesh: usize,
    /// The material, likewise.
    pub material: usize,
    /// Turns, stretches, shears and mirrors the mesh.
    pub linear: Mat3,
    /// Position.
    pub at: DVec3,
    /// Wood is lighter and darker: multiplies the base colour.
    pub tone: f32,
    /// Mask of the instance: one of [`BOARD`], [`WHITE`], [`BLACK`].
    pub mask: u8,
}

impl Piece {
    /// As an instance; here the place is rounded to f32.
    pub fn instance(&self) -> Instance {
        let transform = Affine3A::from_mat3_translation(self.linear, self.at.as_vec3());
        instance(self.mesh, self.material, transform)
    }
}

/// Everything that is placed; the custom index of an instance is its position here.
pub struct Formation {
    pub pieces: Vec<Piece>,
}

/// A view that shows a scene.
pub fn camera(scene: SceneKind) -> Camera {
    if scene == SceneKind::Specimens {
        return Camera::new(DVec3::new(0.0, 2.3, 9.0), DVec3::new(0.1, 0.75, 0.0), 34.0);
    }
    Camera::new(DVec3::new(0.0, 12.0, 27.0), DVec3::new(0.0, -0.5, 1.0), 36.0)
}

/// The meshes to place: the chess set's pieces, and a square of the board. Each is one instance, so
/// that a record on the device tells where it is.
pub fn meshes() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let is_piece =
        |mesh: &Mesh| !mesh.name.starts_with("board") && !mesh.name.starts_with("screen");
    scene.model.meshes.retain(is_piece);
    scene.model.meshes.push(square(material(&scene.model, "board_light")?));
    scene.instances = one_each(&scene.model);
    Ok(scene)
}

/// One instance a mesh.
fn one_each(model: &Model) -> Vec<Instance> {
    let place = |(index, mesh): (usize, &Mesh)| instance(index, mesh.material, Affine3A::IDENTITY);
    model.meshes.iter().enumerate().map(place).collect()
}

/// A mesh at a place.
fn instance(mesh: usize, material: usize, transform: Affine3A) -> Instance {
    Instance { mesh, transform, material, record_offset: 0 }
}

/// A block one wide and one high, its top in the plane y = 0.
fn square(material: usize) -> Mesh {
    let mut mesh =
        Mesh { name: "square".into(), vertices: Vec::new(), triangles: Vec::new(), material };
    for (axis, sign) in [(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0)] {
        let normal = Vec3::AXES[axis] * sign;
        let (across, along) = (Vec3::AXES[(axis + 1) % 3] * sign, Vec3::AXES[(axis + 2) % 3]);
        let first = mesh.vertices.len() as u32;
        for uv in [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y] {
            let side = across * (uv.x - 0.5) + along * (uv.y - 0.5);
            let position = normal * 0.5 + side - Vec3::Y * 0.5;
            mesh.vertices.push(Vertex { position, normal, uv });
        }
        mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|i| first + i)));
    }
    mesh
}

impl Formation {
    /// The meshes and the pieces that are made from them.
    ///
    /// # Errors
    /// If the model cannot be read, or lacks a mesh or a material.
    pub fn build(build: Build) -> Result<(Scene, Self)> {
        let meshes = meshes()?;
        let formation = Self::new(build.scene, build.squares, &meshes.model)?;
        Ok(if build.is_copied() { formation.copies(&meshes) } else { (meshes, formation) })
    }

    /// A scene of so many squares where that is free.
    ///
    /// # Errors
    /// If the model lacks a mesh or a material.
    pub fn new(scene: SceneKind, squares: u32, model: &Model) -> Result<Self> {
        let set = Set::of(model)?;
        if scene == SceneKind::Specimens { Ok(set.specimens()) } else { Ok(set.ripples(squares)) }
    }

    /// Number of visible triangles, all pieces together.
    pub fn triangles(&self, model: &Model) -> usize {
        self.pieces.iter().map(|piece| model.meshes[piece.mesh].triangles.len()).sum()
    }

    /// The same as copies: a mesh for each piece, moved to its place once and for all.
    pub fn copies(&self, scene: &Scene) -> (Scene, Self) {
        let mut model = Model { meshes: Vec::new(), ..scene.model.clone() };
        let mut pieces = self.pieces.clone();
        for (index, piece) in pieces.iter_mut().enumerate() {
            let mut mesh = scene.model.meshes[piece.mesh].clone();
            let normals = piece.linear.inverse().transpose();
            for vertex in &mut mesh.vertices {
                vertex.position = piece.linear * vertex.position + piece.at.as_vec3();
                vertex.normal = (normals * vertex.normal).normalize();
            }
            model.meshes.push(mesh);
            *piece = Piece { mesh: index, linear: Mat3::IDENTITY, at: DVec3::ZERO, ..*piece };
        }
        let instances = one_each(&model);
        (Scene { model, instances, camera: scene.camera }, Self { pieces })
    }
}

/// Meshes and materials to place, by name.
struct Set {
    /// King, queen, bishop, knight, rook, pawn.
    meshes: [usize; 6],
    square: usize,
    /// Light and dark.
    squares: [usize; 2],
    white: usize,
    black: usize,
}

const KNIGHT: usize = 3;
const PAWN: usize = 5;

impl Set {
    fn of(model: &Model) -> Result<Self> {
        let mesh = |name: &str| {
            let found = model.meshes.iter().position(|mesh| mesh.name == name);
            found.with_context(|| format!("the model has no mesh '{name}'"))
        };
        let [king, queen, bishop] = [mesh("king")?, mesh("queen")?, mesh("bishop")?];
        Ok(Self {
            meshes: [king, queen, bishop, mesh("knight")?, mesh("rook")?, mesh("pawn")?],
            square: mesh("square")?,
            squares: [material(model, "board_light")?, material(model, "board_dark")?],
            white: material(model, "white")?,
            black: material(model, "black")?,
        })
    }

    fn board(&self, x: i32, z: i32, top: f64, depth: f64) -> Piece {
        Piece {
            mesh: self.square,
            material: self.squares[(x + z).rem_euclid(2) as usize],
            linear: Mat3::from_diagonal(Vec3::new(1.0, depth as f32, 1.0)),
            at: DVec3::new(x.into(), top, z.into()),
            tone: 1.0,
            mask: BOARD,
        }
    }

    fn piece(&self, kind: usize, is_white: bool, linear: Mat3, at: DVec3) -> Piece {
        Piece {
            mesh: self.meshes[kind],
            material: if is_white { self.white } else { self.black },
            linear,
            at,
            tone: 1.0,
            mask: if is_white { WHITE } else { BLACK },
        }
    }

    /// A king has dropped into a sea of squares. All pieces look at him: the white ones on the crests, the
    /// black ones in the troughs. On the slopes there are none.
    fn ripples(&self, squares: u32) -> Formation {
        let mut pieces = Vec::with_capacity(2 * squares as usize);
        for (index, (x, z)) in disk(squares).into_iter().enumerate() {
            let r = f64::from(x * x + z * z).sqrt();
            let wave = (r * std::f64::consts::TAU / WAVE_LENGTH).cos();
            let top = WAVE_HEIGHT * wave / (1.0 + r / FADING);
            let kind = match (r / WAVE_LENGTH * 2.0).round() as u32 {
                0 if r == 0.0 => 0,
                0 => 1,
                1 => KNIGHT,
                _ => PAWN,
            };
            let is_white = wave > 0.0;
            // A hand sets them down: not quite in the middle, not quite straight.
            let [a, b, c, tone] = random(index as u32);
            let at =
                DVec3::new(f64::from(x) + 0.16 * (a - 0.5), top, f64::from(z) + 0.16 * (b - 0.5));
            // Pieces are modelled facing +x.
            let yaw = f64::from(z).atan2(-f64::from(x)) + 0.3 * (c - 0.5);
            pieces.push(self.board(x, z, top, top + 8.0));
            if wave.abs() < 0.5 {
                continue;
            }
            let turn = Mat3::from_rotation_y(yaw as f32);
            let piece = self.piece(kind, is_white, turn, at);
            pieces.push(Piece { tone: (0.7 + 0.6 * tone) as f32, ..piece });
        }
        Formation { pieces }
    }

    /// Six knights in a row, and what a matrix may do to them.
    fn specimens(&self) -> Formation {
        let mut pieces = Vec::new();
        for (x, z) in (-4..=4).flat_map(|x| (-2..=1).map(move |z| (x, z))) {
            pieces.push(self.board(x, z, 0.0, 0.25));
        }
        // Towards the camera, and a little past it.
        let turn = Mat3::from_rotation_y(-0.6);
        let stretch = |x, y, z| Mat3::from_diagonal(Vec3::new(x, y, z));
        let shear = Mat3::from_cols(Vec3::X, Vec3::new(0.7, 1.0, 0.0), Vec3::Z);
        let tilt = Mat3::from_rotation_x(-0.4) * Mat3::from_rotation_y(-0.5);
        let linears = [
            turn,
            turn * stretch(-1.0, 1.0, 1.0),
            turn * shear,
            turn * stretch(1.0, 1.8, 0.5),
            turn * stretch(1.0, 1.0, 0.001),
            tilt * stretch(1.2, 1.2, 0.0012) * tilt.transpose() * turn,
        ];
        for (index, linear) in linears.into_iter().enumerate() {
            let at = DVec3::new(1.4 * (index as f64 - 2.5), 0.0, 0.0);
            pieces.push(self.piece(KNIGHT, index % 2 == 0, linear, at));
        }
        Formation { pieces }
    }
}

const WAVE_LENGTH: f64 = 8.0;
const WAVE_HEIGHT: f64 = 1.6;
/// Distance at which a wave is half as high as in the middle.
const FADING: f64 = 25.0;

/// The `count` squares nearest to the middle.
fn disk(count: u32) -> Vec<(i32, i32)> {
    let reach = (f64::from(count) / std::f64::consts::PI).sqrt() as i32 + 2;
    let mut squares: Vec<_> =
        (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |z| (x, z))).collect();
    squares.sort_by_key(|&(x, z)| (x * x + z * z, z, x));
    squares.truncate(count as usize);
    squares
}

fn material(model: &Model, name: &str) -> Result<usize> {
    let found = model.materials.iter().position(|material| material.name == name);
    found.with_context(|| format!("the model has no material '{name}'"))
}

/// Four numbers from 0 to 1 that belong to `index` (the finaliser of splitmix64).
fn random(index: u32) -> [f64; 4] {
    std::array::from_fn(|k| {
        let mut bits = (u64::from(index) * 4 + k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits ^ (bits >> 31)) as f64 / u64::MAX as f64
    })
}
