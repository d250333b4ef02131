//! The worst arithmetic, operation by operation: each error that Vulkan allows is made, and none beyond.
//!
//! The bounds are those of the specification's appendix "Vulkan Environment for SPIR-V", section
//! "Precision of Individual Operations".

use std::f64::consts::LN_2;

use common::gpu::{
    Address, Arithmetic, Buffer, Gpu, GpuOptions, RayTracingPipeline, Requirements,
    ShaderBindingTable, barrier,
};
use common::scene::input_usage;
use glam::Vec3;

common::shader_struct! {
    struct Push {
        operands: Address,
        results: Address,
    }
}

const COUNT: usize = 4096;

/// The distance of the floats around x.
fn ulp(x: f64) -> f64 {
    let exponent = (x.abs().max(1e-300).to_bits() >> 52) as i32 - 1023;
    2f64.powi(exponent.max(-126) - 23)
}

/// From 0 to 1, the same at every run.
struct Random(u32);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((self.0 >> ((self.0 >> 28) + 4)) ^ self.0).wrapping_mul(277_803_737);
        (((word >> 22) ^ word) >> 8) as f32 / 16_777_216.0
    }

    fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next()
    }

    /// Of any size within 2^±10 and either sign.
    fn any(&mut self) -> f32 {
        let size = self.within(-10.0, 10.0).exp2();
        if self.next() < 0.5 { size } else { -size }
    }
}

/// What the device makes of the operands.
fn results(gpu: &Gpu, shader: &str, operation: u32, operands: &[Vec3]) -> Vec<f32> {
    let pipeline = RayTracingPipeline::builder("operations")
        .raygen(shader)
        .constant(0, operation)
        .push_constants::<Push>()
        .build(gpu)
        .unwrap();
    let sbt = ShaderBindingTable::new(gpu, &pipeline).unwrap();
    let input = Buffer::with_data(gpu, "operands", operands, input_usage()).unwrap();
    let usage = input_usage() | ash::vk::BufferUsageFlags::TRANSFER_SRC;
    let output = Buffer::new(gpu, "results", 4 * operands.len() as u64, usage).unwrap();
    let push = Push { operands: input.address.into(), results: output.address.into() };
    let extent = ash::vk::Extent2D { width: operands.len() as u32, height: 1 };
    gpu.submit(|cmd| {
        pipeline.bind(cmd, &[], &push)?;
        sbt.trace(cmd, extent.into());
        barrier::trace_to_trace(gpu, cmd);
        Ok(())
    })
    .unwrap();
    output.read().unwrap()
}

/// An operation with an error bound: its number in the shader, its operands, and for operands the exact
/// result and how far it may be off.
struct Bounded {
    name: &'static str,
    number: u32,
    operands: fn(&mut Random) -> Vec3,
    exact: fn(f64, f64, f64) -> f64,
    bound: fn(f64, f64, f64) -> f64,
}

fn pair(random: &mut Random) -> Vec3 {
    Vec3::new(random.any(), random.any(), random.any())
}

fn positive(random: &mut Random) -> Vec3 {
    pair(random).abs()
}

fn angle(random: &mut Random) -> Vec3 {
    let most = std::f32::consts::PI.next_down();
    Vec3::splat(random.within(-most, most))
}

fn exponent(random: &mut Random) -> Vec3 {
    Vec3::splat(random.within(-20.0, 20.0))
}

fn near_one(random: &mut Random) -> Vec3 {
    Vec3::splat(random.within(0.5, 2.0))
}

/// The largest distance from `exact` of what `of` makes of numbers within `off` of `x`.
fn spread(of: impl Fn(f64) -> f64, x: f64, off: f64) -> f64 {
    (of(x + off) - of(x)).abs().max((of(x - off) - of(x)).abs())
}

fn logarithm_bound(x: f64, exact: f64) -> f64 {
    if (0.5..=2.0).contains(&x) { 2f64.powi(-21) } else { 3.0 * ulp(exact) }
}

fn power_bound(x: f64, y: f64) -> f64 {
    let product = y * x.log2();
    let off = logarithm_bound(x, x.log2()) * y.abs();
    let off = off + 1.01 * ulp(product.abs() + off);
    let largest = (product + off).exp2();
    spread(f64::exp2, product, off) + (3.0 + 2.0 * (product.abs() + off)) * ulp(largest)
}

fn root_bound(x: f64) -> f64 {
    let inverse = 1.0 / x.sqrt();
    let off = spread(|inverse| 1.0 / inverse, inverse, 2.0 * ulp(inverse));
    off + 2.5 * ulp(x.sqrt() + off)
}

const BOUNDED: [Bounded; 14] = [
    Bounded {
        name: "division",
        number: 3,
        operands: pair,
        exact: |x, y, _| x / y,
        bound: |x, y, _| 2.5 * ulp(x / y),
    },
    Bounded {
        name: "sqrt",
        number: 4,
        operands: positive,
        exact: |x, _, _| x.sqrt(),
        bound: |x, _, _| root_bound(x),
    },
    Bounded {
        name: "inversesqrt",
        number: 5,
        operands: positive,
        exact: |x, _, _| 1.0 / x.sqrt(),
        bound: |x, _, _| 2.0 * ulp(1.0 / x.sqrt()),
    },
    Bounded {
        name: "exp2",
        number: 6,
        operands: exponent,
        exact: |x, _, _| x.exp2(),
        bound: |x, _, _| (3.0 + 2.0 * x.abs()) * ulp(x.exp2()),
    },
    Bounded {
        name: "exp",
        number: 7,
        operands: exponent,
        exact: |x, _, _| x.exp(),
        bound: |x, _, _| (3.0 + 2.0 * x.abs()) * ulp(x.exp()),
    },
    Bounded {
        name: "log2 near 1",
        number: 8,
        operands: near_one,
        exact: |x, _, _| x.log2(),
        bound: |_, _, _| 2f64.powi(-21),
    },
    Bounded {
        name: "log2",
        number: 8,
        operands: positive,
        exact: |x, _, _| x.log2(),
        bound: |x, _, _| logarithm_bound(x, x.log2()),
    },
    Bounded {
        name: "log",
        number: 9,
        operands: positive,
        exact: |x, _, _| x.log2() * LN_2,
        bound: |x, _, _| logarithm_bound(x, x.ln()),
    },
    Bounded {
        name: "sin",
        number: 10,
        operands: angle,
        exact: |x, _, _| x.sin(),
        bound: |_, _, _| 2f64.powi(-11),
    },
    Bounded {
        name: "cos",
        number: 11,
        operands: angle,
        exact: |x, _, _| x.cos(),
        bound: |_, _, _| 2f64.powi(-11),
    },
    Bounded {
        name: "atan",
        number: 12,
        operands: pair,
        exact: |x, _, _| x.atan(),
        bound: |x, _, _| 4096.0 * ulp(x.atan()),
    },
    Bounded {
        name: "atan2",
        number: 13,
        operands: pair,
        exact: |x, y, _| x.atan2(y),
        bound: |x, y, _| 4096.0 * ulp(x.atan2(y)),
    },
    Bounded {
        name: "pow",
        number: 14,
        operands: positive,
        exact: |x, y, _| x.powf(y.min(9.0)),
        bound: |x, y, _| power_bound(x, y.min(9.0)),
    },
    Bounded {
        name: "length",
        number: 17,
        operands: pair,
        exact: |x, y, z| (x * x + y * y + z * z).sqrt(),
        bound: |x, y, z| {
            let square = x * x + y * y + z * z;
            // Three products and two sums, each off by one ULP at most of the whole.
            let off = 5.0 * ulp(square);
            spread(f64::sqrt, square, off) + root_bound(square + off)
        },
    },
];

#[test]
fn every_error_that_is_allowed_is_made_and_none_beyond() {
    let shaders = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/arithmetic/shaders");
    // SAFETY: this is the only test of the program, and no other thread reads the environment yet.
    unsafe { std::env::set_var("SHADERS", shaders) };
    let open = |arithmetic| {
        let requirements = Requirements::ray_tracing();
        Gpu::new(&GpuOptions { requirements, arithmetic, ..GpuOptions::default() }).unwrap()
    };
    let gpu = open(Arithmetic::Worst);
    bounds_are_approached_and_kept(&gpu);
    sums_and_products_are_one_of_two_floats(&gpu);
    what_is_declared_is_kept(&gpu);
    the_rest_of_the_promises(&gpu);
    drop(gpu);
    let by_place = open(Arithmetic::WorstByPlace);
    bounds_are_approached_and_kept(&by_place);
    places_disagree_only_by_place(&by_place);
}

fn operands(of: fn(&mut Random) -> Vec3) -> Vec<Vec3> {
    let mut random = Random(1);
    (0..COUNT).map(|_| of(&mut random)).collect()
}

fn bounds_are_approached_and_kept(gpu: &Gpu) {
    for Bounded { name, number, operands: of, exact, bound } in BOUNDED {
        let mut operands = operands(of);
        if name == "pow" {
            operands.iter_mut().for_each(|v| v.y = v.y.min(9.0));
        }
        let (mut most, mut least) = (0.0f64, 0.0f64);
        for (v, result) in operands.iter().zip(results(gpu, "probe.rgen", number, &operands)) {
            let [x, y, z] = v.to_array().map(f64::from);
            let part = (f64::from(result) - exact(x, y, z)) / bound(x, y, z);
            assert!(part.abs() <= 1.0, "{name} of {v}: {result} is {part} bounds off");
            (most, least) = (most.max(part), least.min(part));
        }
        println!("{name}: from {least:.3} to {most:.3} of the bound");
        // Where the bound is inherited from a formula, all steps would have to err the same way.
        let inherited = ["sqrt", "pow", "length"].contains(&name);
        let near = if inherited { 0.5 } else { 0.95 };
        assert!(most > near && least < -near, "{name}: only from {least} to {most} of the bound");
    }
}

fn sums_and_products_are_one_of_two_floats(gpu: &Gpu) {
    let operands = operands(pair);
    let exact: [fn(f64, f64) -> f64; 3] = [|x, y| x + y, |x, y| x - y, |x, y| x * y];
    for (number, exact) in (0..).zip(exact) {
        let (mut inexact, mut other) = (0, 0);
        for (v, result) in operands.iter().zip(results(gpu, "probe.rgen", number, &operands)) {
            let exact = exact(v.x.into(), v.y.into());
            let nearest = exact as f32;
            if f64::from(nearest) == exact {
                assert_eq!(result, nearest, "operation {number} on {v} is exact");
                continue;
            }
            inexact += 1;
            let beyond = f64::from(nearest) > exact;
            let beside = if beyond { nearest.next_down() } else { nearest.next_up() };
            assert!(result == nearest || result == beside, "operation {number} on {v}: {result}");
            other += u32::from(result == beside);
        }
        println!("operation {number}: {other} of {inexact} inexact results are the farther float");
        assert!(inexact > 1000 && other * 3 > inexact && other * 3 < 2 * inexact);
    }
    // Exact results: 24 bits are enough for these.
    let small =
        operands.iter().map(|v| (v * 8.0).round().clamp(-Vec3::splat(2048.0), Vec3::splat(2048.0)));
    let small: Vec<Vec3> = small.collect();
    for (number, exact) in (0..).zip(exact) {
        for (v, result) in small.iter().zip(results(gpu, "probe.rgen", number, &small)) {
            assert_eq!(f64::from(result), exact(v.x.into(), v.y.into()), "{number} on {v}");
        }
    }
}

fn what_is_declared_is_kept(gpu: &Gpu) {
    let operands = operands(pair);
    let exact: [fn(f32, f32) -> f32; 3] = [|x, y| x + y, |x, y| x - y, |x, y| x * y];
    for (number, exact) in (0..).zip(exact) {
        let found = results(gpu, "probe_exact.rgen", number, &operands);
        for (v, result) in operands.iter().zip(found) {
            assert_eq!(result.to_bits(), exact(v.x, v.y).to_bits(), "nearest: {number} on {v}");
        }
    }
    // NaN is known where it is declared to be kept, and only there.
    let zeros = [Vec3::ZERO; 4];
    assert_eq!(results(gpu, "probe_exact.rgen", 18, &zeros), [1.0; 4]);
    assert_eq!(results(gpu, "probe.rgen", 18, &zeros), [0.0; 4]);
}

fn the_rest_of_the_promises(gpu: &Gpu) {
    // Denormalized results are flushed, and nothing else is.
    let tiny: Vec<Vec3> = (1..64).map(|i| Vec3::new(i as f32 * 1e-25, 1e-15, 0.0)).collect();
    assert!(results(gpu, "probe.rgen", 2, &tiny).iter().all(|x| *x == 0.0));
    let operands = operands(pair);
    // x·y + z: with one rounding here, with two there.
    let fused = |v: &Vec3| f64::from(v.x) * f64::from(v.y) + f64::from(v.z);
    let found = results(gpu, "probe.rgen", 15, &operands);
    let mut beyond_one_rounding = 0;
    for (v, result) in operands.iter().zip(&found) {
        let off = (f64::from(*result) - fused(v)).abs();
        let product = f64::from(v.x) * f64::from(v.y);
        let bound = ulp(product) + ulp(fused(v).abs() + ulp(product));
        assert!(off <= bound, "{v}: {off} above {bound}");
        beyond_one_rounding += usize::from(off > ulp(fused(v)));
    }
    let share = beyond_one_rounding as f64 / COUNT as f64;
    assert!(share > 0.05 && share < 0.6, "{share}");
    // x + y - x may be y, and may be what two roundings leave of it.
    let wide: Vec<Vec3> = operands.iter().map(|v| Vec3::new(v.x * 1e6, v.y, 0.0)).collect();
    let found = results(gpu, "probe.rgen", 16, &wide);
    let kept = wide.iter().zip(&found).filter(|(v, result)| v.y == **result).count();
    assert!(kept > COUNT / 5 && kept < COUNT * 4 / 5, "{kept} of {COUNT}");
    // Beyond π the sine is any number from -1 to 1, and not the sine.
    let far: Vec<Vec3> = (0..COUNT).map(|i| Vec3::splat(4.0 + i as f32)).collect();
    let found = results(gpu, "probe.rgen", 10, &far);
    assert!(found.iter().all(|x| x.abs() <= 1.0));
    let wrong = far.iter().zip(&found).filter(|(v, x)| (v.x.sin() - *x).abs() > 0.1);
    assert!(wrong.count() > COUNT / 2);
    // The same operation on the same operands gives the same result.
    assert!(results(gpu, "probe.rgen", 19, &operands).iter().all(|x| *x == 0.0));
}

fn places_disagree_only_by_place(gpu: &Gpu) {
    let operands = operands(pair);
    let differences = results(gpu, "probe.rgen", 19, &operands);
    let differ = differences.iter().filter(|x| **x != 0.0).count();
    assert!(differ > COUNT / 2, "{differ} of {COUNT}");
}
