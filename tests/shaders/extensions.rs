//! Shaders for extensions that no driver here supports: compiled, but never run.

use common::gpu::shader::to_spirv;

/// `OpDecorate` with a `BuiltIn`, as SPIR-V numbers them.
const OP_DECORATE: u32 = 71;
const BUILT_IN: u32 = 11;
/// `OpTraceRayMotionNV`.
const OP_TRACE_RAY_MOTION: u32 = 5339;

/// The instructions of a module: each with its opcode and its operands.
fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    let mut rest = &words[5..];
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let (instruction, after) = rest.split_at((first >> 16) as usize);
        rest = after;
        Some((first & 0xffff, &instruction[1..]))
    })
}

/// The built-in variables read by a module, as numbered in SPIR-V, in order.
fn built_in(words: &[u32]) -> Vec<u32> {
    let decorations = instructions(words)
        .filter(|(code, operands)| *code == OP_DECORATE && operands.get(1) == Some(&BUILT_IN));
    let mut found: Vec<u32> = decorations.map(|(_, operands)| operands[2]).collect();
    found.sort_unstable();
    found
}

/// 23: a ray with a time (`GL_NV_ray_tracing_motion_blur`), and a hit shader that reads it.
#[test]
fn a_ray_has_a_time_and_the_hit_shader_reads_it() {
    let ray = include_str!("../samples/motion_blur/nv.rgen");
    let ray = to_spirv("nv.rgen", ray, &[]).expect("the ray generation shader compiles");
    assert!(instructions(&ray).any(|(code, _)| code == OP_TRACE_RAY_MOTION));
    let hit = include_str!("../samples/motion_blur/nv.rchit");
    let hit = to_spirv("nv.rchit", hit, &[]).expect("the hit shader compiles");
    // CurrentRayTimeNV.
    assert_eq!(built_in(&hit), [5334]);
}

/// 18: a hit shader that reads the ends and radii of the device's own swept spheres
/// (`GL_NV_linear_swept_spheres`).
#[test]
fn the_hit_shader_of_a_device_s_swept_sphere_compiles() {
    let text = include_str!("../samples/swept_spheres/nv.rchit");
    let words = to_spirv("nv.rchit", text, &[]).expect("the hit shader compiles");
    // ObjectRayOriginKHR, ObjectRayDirectionKHR, RayTmaxKHR, WorldToObjectKHR, HitLSSPositionsNV, HitLSSRadiiNV.
    assert_eq!(built_in(&words), [5323, 5324, 5326, 5331, 5396, 5421]);
}
