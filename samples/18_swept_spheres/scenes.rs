//! The scenes of this chapter: a necklace, a rope and hair on the chess board, and chains alone.

use std::f32::consts::{PI, TAU};

use common::scene::{Camera, Material};
use glam::{DVec3, Vec3};

use super::random::unit;
use super::strands::{Node, Strands};

common::shader_enum! {
    /// The scenes.
    pub enum SceneKind { Board, Chain, One }
}

/// A view that shows a scene; `distance` is that of *one*, counted in lengths of the segment.
pub fn camera(scene: SceneKind, distance: f32) -> Camera {
    match scene {
        SceneKind::Board => {
            Camera::new(DVec3::new(1.1, 2.7, 9.0), DVec3::new(1.4, 0.72, 2.6), 31.0)
        }
        SceneKind::Chain => Camera::new(DVec3::new(0.4, 1.5, 5.2), DVec3::ZERO, 36.0),
        SceneKind::One => {
            let distance = f64::from(distance);
            let eye = DVec3::new(1.0, 1.4, 3.0).normalize() * distance;
            Camera::new(eye, DVec3::ZERO, 2.0 * (0.85 / distance).atan().to_degrees())
        }
    }
}

impl Strands {
    /// The strands of a scene; `hairs` is how many there are on *board*. Materials are those of
    /// [`materials`], the first of which is `material`.
    pub fn new(scene: SceneKind, hairs: u32, material: u32) -> Self {
        let mut strands = Self::default();
        match scene {
            SceneKind::Board => {
                strands.necklace(Vec3::new(0.5, 0.0, 3.5), material);
                strands.rope(Vec3::new(2.05, 0.02, 3.5), material + 2);
                strands.hair(hairs, material + 3);
            }
            SceneKind::Chain => {
                let node = |x, y, radius| Node { center: Vec3::new(x, y, 0.0), radius };
                let nodes = [(-1.9, -0.5, 0.12), (-1.0, 0.35, 0.5), (-0.1, -0.35, 0.14)];
                let more = [(0.75, 0.2, 0.42), (1.5, -0.3, 0.3), (2.1, 0.55, 0.0)];
                strands
                    .chain(nodes.into_iter().chain(more).map(|(x, y, r)| node(x, y, r)), material);
            }
            SceneKind::One => {
                let node =
                    |side: f32, radius| Node { center: Vec3::new(0.5 * side, 0.0, 0.0), radius };
                strands.chain([node(-1.0, 0.3), node(1.0, 0.1)], material + 1);
            }
        }
        strands
    }

    /// Beads on a string around a king's neck; the beads are segments without length.
    fn necklace(&mut self, foot: Vec3, material: u32) {
        const BEADS: usize = 34;
        let at = |turn: f32| {
            let front = 0.5 + 0.5 * turn.cos();
            let wide = 0.165 + 0.12 * front;
            let sideways =
                Vec3::new(0.5, 0.0, 0.87) * turn.cos() + Vec3::new(0.87, 0.0, -0.5) * turn.sin();
            foot + wide * sideways + Vec3::Y * (1.3 - 0.5 * front.powf(1.6))
        };
        let turn = |i: usize| i as f32 * TAU / BEADS as f32;
        let string = (0..=4 * BEADS).map(|i| Node { center: at(turn(i) / 4.0), radius: 0.006 });
        self.chain(string, material + 1);
        for i in 0..BEADS {
            let radius = 0.018 + 0.022 * (0.5 + 0.5 * turn(i).cos());
            let center = at(turn(i));
            self.chain([Node { center, radius }; 2], material);
        }
    }

    /// Three strands twisted around each other: coiled on the board, and their end frayed.
    fn rope(&mut self, middle: Vec3, material: u32) {
        const STRAND: f32 = 0.043;
        const TURNS: f32 = 2.75;
        const TAIL: f32 = 2.5;
        // A spiral, then a tail that leaves it along -x. How far along, and the point there.
        let spiral = |turn: f32| {
            let radius = 0.14 + 0.2 * turn;
            let angle = TAU * (turn - TURNS + 0.25);
            middle + radius * Vec3::new(angle.cos(), 0.0, angle.sin())
        };
        let at = |way: f32| {
            if way <= TURNS {
                spiral(way)
            } else {
                let x = way - TURNS;
                spiral(TURNS) + Vec3::new(-x, 0.0, 0.1 * ((2.4 * x).cos() - 1.0) + 0.12 * x)
            }
        };
        let steps = 480;
        for strand in 0..3 {
            let mut twist = TAU * strand as f32 / 3.0;
            let mut way = 0.0;
            let mut nodes = Vec::new();
            for step in 0..=steps {
                let next = (step + 1) as f32 / steps as f32;
                // As long a step in the spiral as in the tail, whose unit is not a turn but a length.
                let inner = 7.3;
                let next = if next * (inner + TAIL) < inner {
                    TURNS * (next * (inner + TAIL) / inner).powf(0.62)
                } else {
                    TURNS + next * (inner + TAIL) - inner
                };
                let (here, there) = (at(way), at(next));
                let along = (there - here).normalize();
                let frayed = ((way - TURNS - TAIL + 0.5) / 0.5).clamp(0.0, 1.0);
                let wide = STRAND * 1.06 + 0.16 * frayed * frayed;
                let sideways = along.cross(Vec3::Y) * twist.cos() + Vec3::Y * twist.sin();
                let mut center = here + Vec3::Y * 2.1 * STRAND + wide * sideways;
                center.y = center.y.max(here.y + STRAND);
                nodes.push(Node { center, radius: STRAND * (1.0 - 0.6 * frayed) });
                twist += (there - here).length() * 13.0 * (1.0 - frayed);
                way = next;
            }
            self.chain(nodes, material);
        }
    }

    /// Hair on the heads of three pawns, each strand four segments that end in a tip.
    fn hair(&mut self, hairs: u32, material: u32) {
        const HEAD: f32 = 0.187;
        // Rise, fall and turn of the hair, and its length.
        let styles = [(0.9, 0.05, 0.0, 0.42), (0.0, 0.75, 0.0, 0.62), (0.2, 0.42, 0.75, 0.5)];
        for hair in 0..hairs {
            let pawn = hair % 3;
            let head = Vec3::new(1.5 + pawn as f32, 0.945, 2.5);
            let (stands, falls, turns, length) = styles[pawn as usize];
            let [x, y, z, w] = unit(hair, 0).map(|number| number as f32);
            // Evenly over the upper part of the sphere.
            let height = 1.0 - 1.05 * x;
            let across = (1.0 - height * height).sqrt();
            let root = Vec3::new(across * (TAU * y).cos(), height, across * (TAU * y).sin());
            let mut center = head + HEAD * root;
            let mut direction = (root + stands * Vec3::Y).normalize();
            let step = 0.25 * length * (0.7 + 0.3 * z);
            let mut nodes = vec![Node { center, radius: 0.0042 }];
            for knot in 1..=4 {
                center += step * direction;
                // Not through the head.
                let from_head = center - head;
                let clear = HEAD + 0.012 + 0.01 * knot as f32 * w;
                if from_head.length() < clear {
                    center = head + clear * from_head.normalize();
                }
                nodes.push(Node { center, radius: 0.0042 * (1.0 - 0.25 * knot as f32) });
                let sway = 0.15 * (Vec3::new(y, w, z) - 0.5);
                let around = Vec3::Y.cross(direction) * (turns * (0.5 + (PI * w).sin()));
                direction = (direction - falls * Vec3::Y + around + sway).normalize();
            }
            self.chain(nodes, material + pawn);
        }
    }
}

/// Garnet, gold, hemp; ginger, black and blond hair.
const MATERIALS: [[f32; 3]; 6] = [
    [0.36, 0.012, 0.02],
    [0.62, 0.36, 0.08],
    [0.46, 0.32, 0.15],
    [0.50, 0.13, 0.025],
    [0.025, 0.02, 0.022],
    [0.66, 0.46, 0.16],
];

/// The strands' materials, to be added to a model's.
pub fn materials() -> impl Iterator<Item = Material> {
    MATERIALS.into_iter().map(|color| Material {
        name: "strand".to_owned(),
        base_color: Vec3::from_array(color),
        specular: Vec3::splat(0.05),
        shininess: 90.0,
        ..Material::default()
    })
}
