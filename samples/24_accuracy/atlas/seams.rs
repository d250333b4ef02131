//! Rays at shared edges and corners of a closed mesh: the numbers of lost rays and of double hits.

use anyhow::Result;
use common::gpu::Gpu;
use glam::DVec3;
use reference::random::Random;
use reference::transform::Transform;
use reference::triangle::Triangle;

use super::ball::{Mesh, Seam, facing, on_grid};
use super::row::{Case, Row};
use super::seed;
use super::tracer::{Answer, Tracer};
use super::truth::Truth;
use super::world::{Build, Rows, Traversal, World};
use crate::batch::IDENTITY;
use crate::query::Ray;

/// The least cosine of ray and normal of the triangles aimed at, so that they are not edge-on.
const FACING: f64 = 0.3;

/// A target, and the triangles that share it.
struct Aimed {
    ray: Ray,
    fan: Vec<usize>,
}

/// The aim of the rays.
#[derive(Clone, Copy, PartialEq)]
enum Aim {
    /// Through the seam to the last bit: origin plus direction is the point.
    Exact,
    /// As a renderer's rays are: the direction is rounded.
    Rounded,
}

/// A ray from outside at a seam whose triangles all face it.
fn aimed(
    random: &mut Random,
    mesh: &Mesh,
    placed: &[Triangle],
    rows: &Rows,
    seam: Seam,
    aim: Aim,
) -> Aimed {
    let [x, y, z] = rows.map(|row| f64::from(row[3]));
    let middle = DVec3::new(x, y, z);
    let transform = Transform::from_rows(*rows).expect("the atlas's matrices can be inverted");
    loop {
        let (at, fan) = mesh.seam(random, seam);
        let target = transform.point(at);
        let out = target - middle;
        let origin = target
            + out.length() * (out.normalize() + 0.6 * random.in_cube()) * random.between(1.5, 3.0);
        let origin = if aim == Aim::Exact { on_grid(origin) } else { origin };
        let origin = origin.as_vec3();
        let direction = (target - origin.as_dvec3()).as_vec3();
        let faces = |&number: &usize| facing(&placed[number], direction.as_dvec3(), out) > FACING;
        if fan.iter().all(faces) {
            if aim == Aim::Exact {
                assert_eq!(origin.as_dvec3() + direction.as_dvec3(), target, "an exact aim");
            }
            return Aimed { ray: Ray { origin, direction, tmin: 0.0, tmax: 1e30 }, fan };
        }
    }
}

/// Counts of a case's rays by result.
#[derive(Default)]
struct Tally {
    through: u64,
    nothing: u64,
    doubled: u64,
    elsewhere: u64,
    not_aimed: u64,
}

impl Tally {
    fn add(&mut self, mesh_middle: DVec3, placed: &[Triangle], aimed: &Aimed, answer: &Answer) {
        let direction = aimed.ray.direction.as_dvec3();
        let is_near = |shape: u32| {
            let triangle = &placed[shape as usize];
            facing(triangle, direction, triangle[0] - mesh_middle) > 0.0
        };
        match answer.nearest.map(|met| met.primitive) {
            None => self.nothing += 1,
            Some(shape) if !is_near(shape) => self.through += 1,
            Some(shape) => self.elsewhere += u64::from(!aimed.fan.contains(&(shape as usize))),
        }
        let mut near: Vec<u32> = answer.calls.iter().map(|met| met.primitive).collect();
        near.retain(|&shape| (shape as usize) < placed.len() && is_near(shape));
        near.sort_unstable();
        near.dedup();
        self.doubled += u64::from(near.len() > 1);
    }

    fn lost(&self) -> u64 {
        self.through + self.nothing
    }
}

/// Placements of the mesh.
fn places() -> [(&'static str, Rows); 6] {
    let fine = |x: f64| ((x * 65_536.0).round() / 65_536.0) as f32;
    let rows = |linear: glam::DMat3, shift: f32| -> Rows {
        let row = |i: usize| linear.row(i).to_array().map(fine);
        [0, 1, 2].map(|i| {
            let [x, y, z] = row(i);
            [x, y, z, shift]
        })
    };
    let turn = glam::DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    let mirror = glam::DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let shear =
        glam::DMat3::from_cols(DVec3::X, DVec3::new(0.75, 1.0, 0.0), DVec3::new(-0.5, 0.25, 1.0));
    let one = glam::DMat3::IDENTITY;
    [
        ("rotated", rows(turn, 0.0)),
        ("mirrored", rows(mirror, 0.0)),
        ("sheared", rows(shear, 0.0)),
        ("1e3 away", rows(one, 1e3)),
        ("1e6 away", rows(one, 1e6)),
        ("all of it, 1e3 away", rows(turn * shear * mirror, 1e3)),
    ]
}

/// Returns whether no ray was lost, and none hit two triangles.
fn is_watertight(cases: &[Case]) -> bool {
    cases.iter().all(|case| case.number("lost") == 0.0 && case.number("doubled") == 0.0)
}

/// The tracer, and its settings.
pub struct Asked<'a> {
    pub gpu: &'a Gpu,
    pub tracer: &'a Tracer,
    pub traversal: Traversal,
    pub rays: usize,
    pub exact: usize,
}

impl Asked<'_> {
    /// The mesh as it is.
    ///
    /// # Errors
    /// If the device fails.
    pub fn seams(&self) -> Result<Row> {
        let mut truth = Truth::new(self.exact);
        let mut cases = Vec::new();
        for (aim, how) in [(Aim::Exact, "exactly"), (Aim::Rounded, "rounded")] {
            for (seam, what) in [(Seam::Edges, "edges"), (Seam::Corners, "corners")] {
                cases.push(self.case(format!("{what} {how}"), &IDENTITY, seam, aim, &mut truth)?);
            }
        }
        let row = Row {
            met: Some(is_watertight(&cases)),
            row: "seams",
            title: "Edges and corners that triangles share",
            section: "Watertightness",
            claim: "Implementations should not double-hit or miss when a ray intersects a shared edge, or a shared \
                    vertex of a closed fan.",
            relied: "nothing: a lost ray is one wrong pixel, and 03 says that an edge may be met twice. Where no \
                     leak may be, 24 has an intersection shader",
            cases,
            ..Row::default()
        };
        Ok(row.decided(&truth))
    }

    /// The same under an instance's matrix.
    ///
    /// # Errors
    /// If the device fails.
    pub fn instances(&self) -> Result<Row> {
        let mut truth = Truth::new(self.exact);
        let mut cases = Vec::new();
        for (place, rows) in places() {
            for (seam, what) in [(Seam::Edges, "edges"), (Seam::Corners, "corners")] {
                let name = format!("{what} {place}");
                cases.push(self.case(name, &rows, seam, Aim::Rounded, &mut truth)?);
            }
        }
        let row = Row {
            met: Some(is_watertight(&cases)),
            row: "instances",
            title: "The same under an instance's matrix",
            section: "Watertightness",
            claim: "For a set of triangles with identical transforms, within a single instance: … Implementations \
                    should not double-hit or miss when a ray intersects a shared edge, or a shared vertex of a \
                    closed fan.",
            relied: "nothing: as above. 39 places what is far away relative to the camera",
            cases,
            ..Row::default()
        };
        Ok(row.decided(&truth))
    }

    fn case(
        &self,
        name: String,
        rows: &Rows,
        seam: Seam,
        aim: Aim,
        truth: &mut Truth,
    ) -> Result<Case> {
        let mesh = Mesh::new();
        let placed = mesh.placed(rows)?;
        let world =
            World::of_triangles(self.gpu, self.traversal, &mesh.built(), rows, Build::default())?;
        let mut random = Random(seed("seams", &name));
        let aims: Vec<Aimed> =
            (0..self.rays).map(|_| aimed(&mut random, &mesh, &placed, rows, seam, aim)).collect();
        let rays: Vec<Ray> = aims.iter().map(|aimed| aimed.ray).collect();
        let mut tally = Tally::default();
        for aimed in &aims {
            let outline = mesh.outline(seam, &aimed.fan);
            let fan: Vec<(Triangle, &[usize])> =
                aimed.fan.iter().map(|&number| placed[number]).zip(outline).collect();
            tally.not_aimed += u64::from(!truth.hits_one(&aimed.ray.exact(), &fan));
        }
        let middle = Transform::from_rows(*rows)?.translation;
        self.tracer.trace(&world, &rays, |number, answer| {
            tally.add(middle, &placed, &aims[number], answer);
        })?;
        let mut case = Case::new(name, self.rays);
        case.tell("lost", tally.lost());
        case.tell("hit the far side", tally.through);
        case.tell("hit nothing", tally.nothing);
        case.tell("doubled", tally.doubled);
        case.tell("hit elsewhere", tally.elsewhere);
        case.tell("not aimed", tally.not_aimed);
        Ok(case)
    }
}
