//! The corners that an acceleration structure hands out: are they those that it was built from?

use anyhow::Result;
use common::gpu::{Gpu, GpuOptions, Requirements};
use glam::{DVec3, Vec3};
use reference::random::Random;

use super::row::{Case, Row};
use super::seed;
use super::tracer::{Tracer, What};
use super::world::{Build, Corners, Traversal, World};
use crate::batch::IDENTITY;
use crate::query::Ray;

/// Triangles beside each other, none behind another.
const TRIANGLES: usize = 512;

/// Requirements of the device: the extension, and with it the feature.
const NEEDED: [&str; 2] = ["VK_KHR_ray_tracing_position_fetch", "rayTracingPositionFetch"];

/// Asks the same device once more, opened with what this takes; the row, and the messages of validation.
///
/// # Errors
/// If the device fails.
pub fn row(gpu: &Gpu, options: &GpuOptions, rays: usize) -> Result<(Row, Vec<String>)> {
    let row = Row {
        row: "corners",
        title: "The corners that hit shaders are given",
        section: "HitTriangleVertexPositionsKHR",
        claim: "… will specify the object space vertices of the triangle at the current intersection in \
                application-provided order. The positions returned are transformed by the geometry transform, \
                which is performed at standard floating-point precision, …",
        relied: "the very bits that the build was given, where a geometry has no transform (10)",
        ..Row::default()
    };
    let requirements = Requirements::ray_tracing().float64_where_offered().position_fetch();
    let number = gpu.index.to_string();
    let (validate, driver_shim) = (options.validate, options.driver_shim.clone());
    let device = Some(number.as_str());
    let opened = Gpu::new(&GpuOptions {
        requirements,
        device,
        validate,
        driver_shim,
        ..GpuOptions::default()
    });
    let gpu = match opened {
        Ok(gpu) => gpu,
        Err(error) if NEEDED.iter().any(|needed| format!("{error:#}").contains(needed)) => {
            let why = format!("the device does not offer {}", NEEDED[0]);
            return Ok((Row { unavailable: Some(why), ..row }, Vec::new()));
        }
        Err(error) => return Err(error),
    };
    let case = case(&gpu, rays)?;
    let kept = case.number("other bits") == 0.0 && case.number("missed") == 0.0;
    let messages = gpu.validation().all();
    Ok((Row { met: Some(kept), kept: Some(kept), cases: vec![case], ..row }, messages))
}

fn case(gpu: &Gpu, count: usize) -> Result<Case> {
    let mut random = Random(seed("corners", ""));
    // In a row along x, a cell of 1 each, of all sizes: the bits of a coordinate are any.
    let triangles: Vec<Corners> = (0..TRIANGLES)
        .map(|number| {
            let size = random.scale(1e-3, 0.4);
            let middle = DVec3::new(number as f64, 0.0, 0.0);
            [(1.0, 0.0), (-0.5, 0.8), (-0.5, -0.8)].map(|(x, y): (f64, f64)| {
                let off = random.in_cube() * 0.1;
                (middle + size * (DVec3::new(x, y, 0.0) + off)).as_vec3()
            })
        })
        .collect();
    let build = Build { data_access: true, ..Build::default() };
    let world = World::of_triangles(gpu, Traversal::Device, &triangles, &IDENTITY, build)?;
    let rays: Vec<Ray> = (0..count)
        .map(|number| {
            let [a, b, c] = triangles[number % TRIANGLES];
            let target = (a + b + c) / 3.0;
            let origin = target + Vec3::Z;
            Ray { origin, direction: target - origin, tmin: 0.0, tmax: 1e30 }
        })
        .collect();
    let corners = Tracer::new(gpu, What::Corners)?.corners(&world, &rays)?;
    let bits = |corners: &Corners| corners.map(|corner| corner.to_array().map(f32::to_bits));
    let (mut missed, mut other, mut turned) = (0u64, 0u64, 0u64);
    for (number, found) in corners.iter().enumerate() {
        let uploaded = &triangles[number % TRIANGLES];
        let (found, wanted) = (bits(found), bits(uploaded));
        if found == wanted {
            continue;
        }
        if found == [[0; 3]; 3] {
            missed += 1;
        } else {
            other += 1;
            turned += u64::from(wanted.iter().all(|corner| found.contains(corner)));
        }
    }
    let mut case = Case::new("centres", count);
    case.tell("missed", missed);
    case.tell("other bits", other);
    case.tell("the same in another order", turned);
    Ok(case)
}
