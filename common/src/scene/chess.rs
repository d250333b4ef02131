//! The world of the book: a chess set, placed from a position in Forsyth-Edwards notation.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use anyhow::{Context, Result, bail};
use glam::{Affine3A, DVec3, Mat3A, Vec3, Vec3A};

use super::{Camera, Instance, Material, Scene};
use crate::model::Model;
use crate::model::obj;
use crate::paths;

/// Morphy's game at the Paris opera, 1858, before White's tenth move.
const POSITION: &str = "rn2kb1r/p3qppp/2p2n2/1p2p1B1/2B1P3/1QN5/PPP2PPP/R3K2R";

/// The folder of the project's own models.
pub fn assets() -> &'static Path {
    static ASSETS: LazyLock<PathBuf> = LazyLock::new(|| paths::book().join("samples/assets"));
    &ASSETS
}

impl Scene {
    /// The chess set in mid-game: pieces, board and frame, and the fretwork screen behind them.
    ///
    /// The board is in the plane y = 0, one unit per square, its middle at the origin; White is at +z.
    ///
    /// # Errors
    /// If the project's own model is missing or wrong.
    pub fn chess() -> Result<Self> {
        let model = obj::load_own(&assets().join("chess.obj"))?;
        let mut instances = Vec::new();
        // The screen is on the rim behind Black.
        let rim = Vec3::new(0.0, 0.02, -4.28);
        for (name, at) in [
            ("board_light", Vec3::ZERO),
            ("board_dark", Vec3::ZERO),
            ("board_frame", Vec3::ZERO),
            ("screen", rim),
            ("screen_frame", rim),
        ] {
            let mesh = mesh(&model, name)?;
            let transform = Affine3A::from_translation(at);
            let material = model.meshes[mesh].material;
            instances.push(Instance { mesh, transform, material, record_offset: 0 });
        }
        place_pieces(&model, POSITION, &mut instances)?;
        let camera = Camera::new(DVec3::new(-5.6, 4.8, 9.2), DVec3::new(0.35, 0.3, -0.2), 37.0);
        Ok(Self { model, instances, camera })
    }

    /// The chess set with kings and queens of metal, White's of gold and Black's of silver, from low down.
    ///
    /// Linear RGB reflectances of metals: Akenine-Möller et al., Real-Time Rendering, 4th ed., table 9.2.
    ///
    /// # Errors
    /// If the project's own model is missing or wrong.
    pub fn chess_of_metal() -> Result<Self> {
        let mut scene = Self::chess()?;
        let Model { meshes, materials, .. } = &mut scene.model;
        let (gold, silver) = (Vec3::new(1.0, 0.782, 0.344), Vec3::new(0.972, 0.96, 0.915));
        for (wood, metal, specular) in [("white", "gold", gold), ("black", "silver", silver)] {
            let like = materials.iter().position(|material| material.name == wood);
            let like = like.with_context(|| format!("the chess set has no material '{wood}'"))?;
            for instance in &mut scene.instances {
                let is_royal = matches!(meshes[instance.mesh].name.as_str(), "king" | "queen");
                if is_royal && instance.material == like {
                    instance.material = materials.len();
                }
            }
            // Light that enters a metal is lost: it has no colour but that of its reflections.
            let (name, base_color) = (metal.to_owned(), Vec3::ZERO);
            materials.push(Material { name, base_color, specular, ..materials[like].clone() });
        }
        scene.camera = Camera::new(DVec3::new(-8.2, 2.9, 5.2), DVec3::new(-0.2, 0.35, 0.8), 32.0);
        Ok(scene)
    }

    /// Removes the board and the screen on its frame. A chapter replaces them by a plane.
    pub fn remove_board(&mut self) {
        let meshes = &self.model.meshes;
        self.instances.retain(|instance| {
            let name = &meshes[instance.mesh].name;
            !name.starts_with("board") && !name.starts_with("screen")
        });
    }
}

/// As `place_pieces`, for an untrusted position.
///
/// # Errors
/// If it is not a position of eight ranks of eight squares.
pub fn place_position(model: &Model, position: &str, instances: &mut Vec<Instance>) -> Result<()> {
    let files = |rank: &str| -> u32 { rank.chars().map(|c| c.to_digit(10).unwrap_or(1)).sum() };
    let ranks: Vec<&str> = position.split('/').take(9).collect();
    if ranks.len() != 8 || ranks.iter().any(|rank| rank.len() > 8 || files(rank) != 8) {
        bail!(
            "a position has eight ranks of eight squares, as rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR"
        );
    }
    place_pieces(model, position, instances)
}

/// Adds the pieces of a position: upper case is white, ranks from the eighth down.
fn place_pieces(model: &Model, position: &str, instances: &mut Vec<Instance>) -> Result<()> {
    let [white, black] = ["white", "black"].map(|name| {
        let found = model.materials.iter().position(|material| material.name == name);
        found.with_context(|| format!("the chess set has no material '{name}'"))
    });
    let (white, black) = (white?, black?);
    for (row, rank) in position.split('/').enumerate() {
        let mut file = 0;
        for letter in rank.chars() {
            if let Some(empty) = letter.to_digit(10) {
                file += empty;
                continue;
            }
            let mesh = mesh(model, piece(letter)?)?;
            let is_white = letter.is_ascii_uppercase();
            // Pieces are modelled facing +x. They look at the other side, and a little past it.
            let yaw: f32 = if is_white { 140.0 } else { -40.0 };
            let turn = Mat3A::from_rotation_y(yaw.to_radians());
            let at = Vec3A::new(file as f32 - 3.5, 0.0, row as f32 - 3.5);
            instances.push(Instance {
                mesh,
                transform: Affine3A { matrix3: turn, translation: at },
                material: if is_white { white } else { black },
                record_offset: 0,
            });
            file += 1;
        }
    }
    Ok(())
}

fn piece(letter: char) -> Result<&'static str> {
    Ok(match letter.to_ascii_lowercase() {
        'p' => "pawn",
        'r' => "rook",
        'n' => "knight",
        'b' => "bishop",
        'q' => "queen",
        'k' => "king",
        _ => bail!("'{letter}' is no chess piece"),
    })
}

fn mesh(model: &Model, name: &str) -> Result<usize> {
    let found = model.meshes.iter().position(|mesh| mesh.name == name);
    found.with_context(|| format!("the chess set has no mesh '{name}'"))
}
