//! The worst arithmetic, operation by operation: its errors reach what Vulkan allows, and do not exceed it.
//!
//! The bounds are those of the specification's appendix "Vulkan Environment for SPIR-V", section
//! "Precision of Individual Operations".

mod bounds;
mod traversal;

use bounds::{BOUNDED, Bounded, Random, pair, ulp};
use common::gpu::{
    Address, Buffer, Gpu, GpuOptions, RayTracingPipeline, Requirements, ShaderBindingTable, barrier,
};
use common::scene::input_usage;
use glam::{Vec3, Vec3Swizzles};
use instruments::arithmetic::Arithmetic;

common::shader_struct! {
    struct Push {
        operands: Address,
        results: Address,
    }
}

const COUNT: usize = 4096;

/// An operation on two numbers, in 64 bits.
type Exact = fn(f64, f64) -> f64;

fn results(gpu: &Gpu, shader: &str, operation: u32, operands: &[Vec3]) -> Vec<f32> {
    computed(gpu, shader, operation, operands)
}

/// The device's results for these operands.
fn computed<T: bytemuck::Pod>(
    gpu: &Gpu,
    shader: &str,
    operation: u32,
    operands: &[Vec3],
) -> Vec<T> {
    let pipeline = RayTracingPipeline::builder("operations")
        .raygen(shader)
        .constant(0, operation)
        .push_constants::<Push>()
        .build(gpu)
        .unwrap();
    let sbt = ShaderBindingTable::new(gpu, &pipeline).unwrap();
    let input = Buffer::with_data(gpu, "operands", operands, input_usage()).unwrap();
    let usage = input_usage() | ash::vk::BufferUsageFlags::TRANSFER_SRC;
    let output = Buffer::new(gpu, "results", size_of_val(operands) as u64, usage).unwrap();
    let push = Push { operands: input.address.into(), results: output.address.into() };
    let extent = ash::vk::Extent2D { width: operands.len() as u32, height: 1 };
    gpu.submit(|cmd| {
        pipeline.bind(cmd, &[], &push)?;
        sbt.trace(cmd, extent.into());
        barrier::trace_to_trace(gpu, cmd);
        Ok(())
    })
    .unwrap();
    let mut found: Vec<T> = output.read().unwrap();
    found.truncate(operands.len());
    found
}

#[test]
fn every_error_that_is_allowed_is_made_and_none_beyond() {
    if !run::has_worst_arithmetic() {
        return;
    }
    let shaders = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/arithmetic/shaders");
    // SAFETY: this is the only test of the program, and no other thread reads the environment yet.
    unsafe { std::env::set_var("SHADERS", shaders) };
    let open = |arithmetic: Arithmetic| {
        let requirements = Requirements::ray_tracing();
        let driver_shim = std::sync::Arc::new(arithmetic);
        Gpu::new(&GpuOptions { requirements, driver_shim, ..GpuOptions::default() }).unwrap()
    };
    let gpu = open(Arithmetic::Worst);
    bounds_are_approached_and_kept(&gpu);
    sums_and_products_are_one_of_two_floats(&gpu);
    what_is_declared_is_kept(&gpu);
    the_rest_of_the_promises(&gpu);
    a_remainder_may_be_one_divisor_off(&gpu);
    nan_may_be_taken_for_the_lesser_and_the_greater(&gpu);
    doubles_have_the_bits_of_floats(&gpu);
    let driver = open(Arithmetic::Driver);
    traversal::offers_more_boxes_in_another_order(&driver, &gpu);
    drop((gpu, driver));
    let by_place = open(Arithmetic::WorstByPlace);
    bounds_are_approached_and_kept(&by_place);
    places_disagree_only_by_place(&by_place);
    pipelines_disagree_by_the_seed(&by_place);
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
        // The errors are added to the device's own sine, which a GPU computes to about 2^-21.
        let most_allowed = if run::device::is_software() { 1.0 } else { 1.0 + f64::powi(2.0, -9) };
        for (v, result) in operands.iter().zip(results(gpu, "probe.rgen", number, &operands)) {
            let [x, y, z] = v.to_array().map(f64::from);
            let part = (f64::from(result) - exact(x, y, z)) / bound(x, y, z);
            assert!(part.abs() <= most_allowed, "{name} of {v}: {result} is {part} bounds off");
            (most, least) = (most.max(part), least.min(part));
        }
        println!("{name}: from {least:.3} to {most:.3} of the bound");
        // If the bound is inherited from a formula, it is only reached when all steps err in the same
        // direction.
        let inherited =
            ["sqrt", "pow", "length", "tan", "mix", "smoothstep", "refract"].contains(&name);
        let near = if inherited { 0.5 } else { 0.95 };
        assert!(most > near && least < -near, "{name}: only from {least} to {most} of the bound");
    }
}

fn sums_and_products_are_one_of_two_floats(gpu: &Gpu) {
    let operands = operands(pair);
    let exact: [Exact; 3] = [|x, y| x + y, |x, y| x - y, |x, y| x * y];
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
    // Exact results: 24 bits are enough for them.
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
    // Denormalized results are also found in a shader without booleans.
    let found = results(gpu, "sum_exact.rgen", 0, &operands);
    assert!(found.iter().zip(&operands).all(|(sum, v)| *sum == v.x + v.y));
    // NaN is only recognised where the shader declares that it is preserved.
    let zeros = [Vec3::ZERO; 4];
    assert_eq!(results(gpu, "probe_exact.rgen", 18, &zeros), [1.0; 4]);
    assert_eq!(results(gpu, "probe.rgen", 18, &zeros), [0.0; 4]);
}

fn the_rest_of_the_promises(gpu: &Gpu) {
    // Denormalized results are flushed to zero, and nothing else is.
    let tiny: Vec<Vec3> = (1..64).map(|i| Vec3::new(i as f32 * 1e-25, 1e-15, 0.0)).collect();
    assert!(results(gpu, "probe.rgen", 2, &tiny).iter().all(|x| *x == 0.0));
    let operands = operands(pair);
    // x·y + z with one rounding here, with two there.
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
    // x + y - x may be y, or y after two roundings.
    let wide: Vec<Vec3> = operands.iter().map(|v| Vec3::new(v.x * 1e6, v.y, 0.0)).collect();
    let found = results(gpu, "probe.rgen", 16, &wide);
    let kept = wide.iter().zip(&found).filter(|(v, result)| v.y == **result).count();
    assert!(kept > COUNT / 5 && kept < COUNT * 4 / 5, "{kept} of {COUNT}");
    // Beyond π, the sine may be any number from -1 to 1.
    let far: Vec<Vec3> = (0..COUNT).map(|i| Vec3::splat(4.0 + i as f32)).collect();
    let found = results(gpu, "probe.rgen", 10, &far);
    assert!(found.iter().all(|x| x.abs() <= 1.0));
    let wrong = far.iter().zip(&found).filter(|(v, x)| (v.x.sin() - *x).abs() > 0.1);
    assert!(wrong.count() > COUNT / 2);
    // The same operation on the same operands gives the same result.
    assert!(results(gpu, "probe.rgen", 19, &operands).iter().all(|x| *x == 0.0));
}

/// x - y·⌊x/y⌋: the quotient may be 2.5 ULP off, and so ⌊x/y⌋ may be off by one.
fn a_remainder_may_be_one_divisor_off(gpu: &Gpu) {
    let mut random = Random(1);
    let operand =
        |random: &mut Random| Vec3::new(random.within(1.0, 99.0), random.within(1.0, 9.0), 0.0);
    let operands: Vec<Vec3> = (0..COUNT).map(|_| operand(&mut random)).collect();
    let mut largest = 0.0f64;
    for (v, result) in operands.iter().zip(results(gpu, "probe.rgen", 26, &operands)) {
        let (x, y) = (f64::from(v.x), f64::from(v.y));
        let off = 2.5 * ulp(x / y);
        let parts = [x / y - off, x / y + off].map(|quotient| {
            let multiple = y * quotient.floor();
            let bound = ulp(multiple) + ulp((x - multiple).abs() + ulp(multiple));
            (f64::from(result) - (x - multiple)).abs() / bound
        });
        let part = parts[0].min(parts[1]);
        assert!(part <= 1.0, "{x} mod {y}: {result} is {part} bounds off");
        largest = largest.max(part);
    }
    assert!(largest > 0.5, "{largest}");
    // x mod x is 0, or x.
    let same: Vec<Vec3> = operands.iter().map(|v| v.xxx()).collect();
    let found = results(gpu, "probe.rgen", 26, &same);
    assert!(found.iter().zip(&same).all(|(result, v)| *result == 0.0 || *result == v.x));
    let whole = found.iter().filter(|result| **result != 0.0).count();
    assert!(whole > COUNT / 5 && whole < COUNT * 4 / 5, "{whole} of {COUNT}");
}

/// min, max and clamp promise nothing for a NaN, whatever a shader declares: they may return any operand. For
/// numbers they return the right one.
fn nan_may_be_taken_for_the_lesser_and_the_greater(gpu: &Gpu) {
    let operands = operands(pair);
    let order = |v: &Vec3| Vec3::new(v.x, v.y.min(v.z), v.y.max(v.z));
    let numbers: Vec<Vec3> = operands.iter().map(order).collect();
    let nans: Vec<Vec3> = numbers.iter().map(|v| Vec3::new(f32::NAN, v.y, v.z)).collect();
    let correct: [fn(&Vec3) -> f32; 3] =
        [|v| v.x.min(v.y), |v| v.x.max(v.y), |v| v.x.clamp(v.y, v.z)];
    for shader in ["probe.rgen", "probe_exact.rgen"] {
        for (number, correct) in (27..).zip(correct) {
            let found = results(gpu, shader, number, &numbers);
            assert!(found.iter().zip(&numbers).all(|(x, v)| *x == correct(v)), "{number}");
            let found = results(gpu, shader, number, &nans);
            let is_known = |(x, v): (&f32, &Vec3)| x.is_nan() || *x == v.y || *x == v.z;
            assert!(found.iter().zip(&nans).all(is_known), "{number}");
            let lost = found.iter().filter(|x| x.is_nan()).count();
            assert!(lost > COUNT / 8 && lost < COUNT * 7 / 8, "{number}: {lost} of {COUNT}");
        }
    }
}

/// Vulkan only promises the precision of 32-bit operations for 64-bit ones; here they have no more.
fn doubles_have_the_bits_of_floats(gpu: &Gpu) {
    let operands = operands(pair);
    let operations: [(&str, Exact, f64); 5] = [
        ("+", |x, y| x + y, 0.5),
        ("-", |x, y| x - y, 0.5),
        ("*", |x, y| x * y, 0.5),
        ("/", |x, y| x / y, 2.5),
        ("sqrt", |x, _| x.abs().sqrt(), 4.5),
    ];
    for (number, (name, exact, bound)) in (0..).zip(operations) {
        let (mut most, mut least) = (0.0f64, 0.0f64);
        let found = computed::<f64>(gpu, "probe_double.rgen", number, &operands);
        for (v, result) in operands.iter().zip(found) {
            let exact = exact(v.x.into(), v.y.into());
            let part = (result - exact) / (bound * ulp(exact));
            // The driver's own 53 bits.
            assert!(part.abs() <= 1.0 + 1e-8, "{name} of {v}: {result} is {part} bounds off");
            (most, least) = (most.max(part), least.min(part));
        }
        assert!(most > 0.95 && least < -0.95, "{name}: from {least} to {most} of the bound");
    }
}

fn places_disagree_only_by_place(gpu: &Gpu) {
    let operands = operands(pair);
    let differences = results(gpu, "probe.rgen", 19, &operands);
    let differ = differences.iter().filter(|x| **x != 0.0).count();
    assert!(differ > COUNT / 2, "{differ} of {COUNT}");
}

fn pipelines_disagree_by_the_seed(gpu: &Gpu) {
    let Bounded { number, operands: of, exact, bound, .. } = BOUNDED[0];
    let operands = operands(of);
    let of_seed = |seed: &str| {
        // SAFETY: this is the only test of the program, and no other thread reads the environment.
        unsafe { std::env::set_var("ARITHMETIC_SEED", seed) };
        let results = results(gpu, "probe.rgen", number, &operands);
        for (v, result) in operands.iter().zip(&results) {
            let [x, y, z] = v.to_array().map(f64::from);
            assert!((f64::from(*result) - exact(x, y, z)).abs() <= bound(x, y, z), "{v}: {result}");
        }
        results
    };
    let (one, two) = (of_seed("1"), of_seed("2"));
    assert_eq!(one, of_seed("1"));
    let differ = one.iter().zip(&two).filter(|(a, b)| a != b).count();
    assert!(differ > COUNT / 2, "{differ} of {COUNT}");
}
