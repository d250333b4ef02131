//! 16_ray_query: the picture of 41_ray_offset from a compute shader, equal bit for bit.

use common::app::Picture;
use common::gpu::{ComputePipeline, Gpu, GpuOptions, Requirements};

use run::{expected, has_worst_arithmetic, render, same_answers, same_colors};
use serde_json::json;

const NAME: &str = "16_ray_query";
/// The chapter that every test below compares with.
const PIPELINE: &str = "41_ray_offset";
/// Not a multiple of any workgroup's sides.
const SIZE: &str = "121x77";
const WORKGROUPS: [&str; 5] = ["8x4", "8x8", "16x4", "32x1", "16x16"];

/// A picture traced in several bands, because the cost of a first frame is unknown.
#[track_caller]
fn picture(name: &str, arguments: &[&str]) -> Picture {
    let run = render(name, SIZE, arguments);
    assert!(run.report["bands"].as_u64() > Some(1), "{name}: {}", run.report["bands"]);
    run.picture
}

#[track_caller]
fn same(arguments: &[&str]) {
    let [by_pipeline, by_query] = [PIPELINE, NAME].map(|name| picture(name, arguments));
    let what = format!("16 and 05, {arguments:?}");
    let shows = arguments.iter().any(|set| set.starts_with("show=") && *set != "show=picture");
    let same = if shows { same_answers } else { same_colors };
    same(&what, NAME, &by_pipeline, &by_query);
}

#[test]
fn queries_give_the_bits_of_the_pipeline_in_every_view() {
    run::needs!(NAME);
    for show in ["normal", "triangle", "hit", "ray direction", "shadow", "shadow origin"] {
        same(&["--set", &format!("show={show}")]);
    }
}

#[test]
fn queries_give_the_bits_of_the_pipeline_in_every_light() {
    run::needs!(NAME);
    same(&[]);
    same(&["--set", "sun azimuth=300"]);
    same(&["--set", "sun elevation=0"]);
}

/// The errors depend only on an operation's operands, so the two may only differ where their code does.
#[test]
#[ignore = "nightly: compiles for long; quick: ray_query::queries_give_the_bits_of_the_pipeline_in_every_light"]
fn queries_give_the_bits_of_the_pipeline_in_the_worst_arithmetic() {
    if !has_worst_arithmetic() {
        return;
    }
    for show in ["picture", "hit", "shadow origin"] {
        same(&["--arithmetic", "worst", "--set", &format!("show={show}")]);
    }
}

#[test]
fn no_workgroup_s_shape_leaves_out_a_pixel_or_traces_another() {
    // The widest and the largest workgroup.
    workgroups_trace_each_pixel(&["32x1", "16x16"], &["3x50", "50x3"]);
}

#[test]
#[ignore = "nightly: the other shapes; quick: ray_query::no_workgroup_s_shape_leaves_out_a_pixel_or_traces_another"]
fn nor_does_any_other_shape() {
    workgroups_trace_each_pixel(&WORKGROUPS, &["1x1", "3x50", "50x3"]);
}

fn workgroups_trace_each_pixel(shapes: &[&str], sizes: &[&str]) {
    run::needs!(NAME);
    let by_pipeline = picture(PIPELINE, &["--set", "show=hit"]);
    for shape in shapes {
        let set = format!("workgroup={shape}");
        let by_query = picture(NAME, &["--set", "show=hit", "--set", &set]);
        same_answers(shape, NAME, &by_pipeline, &by_query);
    }
    // Narrower than any workgroup, and lower.
    for size in sizes {
        let by_pipeline = render(PIPELINE, size, &["--set", "show=ray direction"]).picture;
        for shape in shapes {
            let set = format!("workgroup={shape}");
            let sets = ["--set", "show=ray direction", "--set", &set];
            let by_query = render(NAME, size, &sets).picture;
            same_answers(&format!("{size} by {shape}"), NAME, &by_pipeline, &by_query);
        }
    }
}

#[test]
fn a_workgroup_larger_than_the_device_takes_is_refused_in_one_line() {
    run::needs!(NAME);
    let requirements = Requirements::ray_tracing().ray_query();
    let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).expect("a device");
    let limit = gpu.limits.core.max_compute_work_group_invocations;
    let builder = ComputePipeline::builder(NAME).compute("trace.comp").workgroup(3, [limit + 1, 1]);
    let error = builder.build_compute(&gpu).err().expect("it is refused").to_string();
    let words = format!("has workgroups of {}x1 invocations; ", limit + 1);
    assert!(error.contains(&words) && error.ends_with(&format!("takes {limit}")), "{error}");
}

#[test]
fn a_query_needs_no_groups_and_no_table() {
    run::needs!(NAME);
    let report = render(NAME, "8x8", &[]).report;
    assert_eq!(report["groups"], 0);
    assert_eq!(report["stages"], serde_json::json!(["16_ray_query/trace.comp"]));
}

/// The time of a frame with queries, relative to the pipeline's.
#[test]
#[ignore = "by hand: takes times"]
fn the_time_of_a_frame() {
    let time = |name: &str| {
        let run = render(name, "480x300", &["--frames", "5"]);
        run.report["gpu_milliseconds"]["min"].as_f64().unwrap()
    };
    let mut ratios: Vec<f64> = (0..20).map(|_| time(NAME) / time(PIPELINE)).collect();
    ratios.sort_by(f64::total_cmp);
    let [low, ratio, high] = [5, 10, 15].map(|at| ratios[at]);
    println!("{ratio:.2}, middle half {low:.2} to {high:.2}");
    expected::give_timed("16_ray_query/time", json!({ "ratio": ratio, "low": low, "high": high }));
}
