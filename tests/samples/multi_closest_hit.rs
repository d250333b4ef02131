//! 07_multi_closest_hit: the group and the record of every ray, the data of records, the printed table.

use std::fs;

use common::gpu::{Limits, sbt};
use common::scene::{Instance, Scene};
use serde_json::{Value, json};

use run::primary_hits::{answer, judge, rays, reference};
use run::{Run, bits, command, expected, refusal, render, root};

const NAME: &str = "07_multi_closest_hit";
const SIZE: &str = "240x150";
/// Records per instance: for its look and for inspection.
const RAY_TYPES: u32 = 2;

fn show(view: &str) -> Run {
    render(NAME, SIZE, &["--set", &format!("show={view}")])
}

/// The group an instance of the chess set should use, by the number in `push.glsl`.
fn group(scene: &Scene, instance: &Instance) -> u32 {
    let mesh = scene.model.meshes[instance.mesh].name.as_str();
    match scene.model.materials[instance.material].name.as_str() {
        "white" => 1,
        "black" => 3,
        "board_light" | "board_dark" => 2,
        "frame" if mesh == "board_frame" => 2,
        "frame" => 3,
        _ => 0,
    }
}

#[test]
fn every_ray_takes_the_record_that_the_formula_gives() {
    let scene = Scene::chess().unwrap();
    let [hits, directions, groups, records] =
        ["hit", "ray direction", "group", "record"].map(|view| show(view).picture);
    // The reference gives the instance a ray hits.
    let answers = hits.pixels.iter().map(answer);
    let tally = judge(&reference(&scene), rays(&scene.camera, &directions).zip(answers));
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    let mut rays_of = [0; 4];
    for ((hit, by_group), by_record) in hits.pixels.iter().zip(&groups.pixels).zip(&records.pixels)
    {
        let (found_group, found_record) = (by_group[3], by_record[3]);
        let Some(answer) = answer(hit) else {
            assert_eq!((found_group, found_record), (-1.0, -1.0));
            continue;
        };
        let expected = group(&scene, &scene.instances[answer.instance as usize]);
        let record = sbt::hit_record(RAY_TYPES * answer.instance, 0, RAY_TYPES, 0);
        assert_eq!((found_group, found_record), (expected as f32, record as f32), "{answer:?}");
        rays_of[expected as usize] += 1;
    }
    assert!(rays_of.iter().all(|&rays| rays > 1000), "{rays_of:?}");
}

#[test]
fn the_data_of_a_record_reaches_its_own_piece_and_no_other() {
    let [before, hits] = ["picture", "hit"].map(|view| show(view).picture);
    // The board, the screen, a black and a white piece: one instance for each group.
    for (instance, setting) in [
        (1, "tint=0.1,0.3,0.2"),
        (3, "tint=0.2,0.5,0.9"),
        (6, "tint=0.4,0.02,0.01"),
        (22, "scale=3"),
        (22, "roughness=0.9"),
    ] {
        let changed = format!("instance={instance}");
        let after = render(NAME, SIZE, &["--set", &changed, "--set", setting]).picture;
        let (mut own, mut differ) = (0, 0);
        for ((hit, before), after) in hits.pixels.iter().zip(&before.pixels).zip(&after.pixels) {
            let is_own = hit[0] == instance as f32;
            assert!(is_own || before == after, "{setting} of {instance} changed {hit:?}");
            own += usize::from(is_own);
            differ += usize::from(before != after);
        }
        // Dust, or a pixel in shadow, may be the same with another tint or roughness.
        assert!(own > 150 && differ > own * 3 / 4, "{setting}: {differ} of {own} pixels differ");
    }
}

#[test]
fn data_changes_between_frames_and_the_pipeline_stays() {
    let plain = render(NAME, SIZE, &[]);
    let (red, white) = ("0.6,0.05,0.04", "0.83,0.78,0.7");
    // `--compare` renders the values alternately and ends with the first.
    for (first, second) in [(red, white), (white, red)] {
        let compare = format!("tint={first}|{second}");
        let turns = ["--set", "instance=22", "--compare", &compare, "--frames", "2"];
        let turns = render(NAME, SIZE, &turns);
        let tint = format!("tint={first}");
        let alone = render(NAME, SIZE, &["--set", "instance=22", "--set", &tint]);
        assert!(bits(&turns.picture) == bits(&alone.picture), "{first} after {second}");
        assert_eq!(first == white, bits(&turns.picture) == bits(&plain.picture));
        // A recreated pipeline would have added its stages and groups again.
        assert_eq!(turns.report["stages"], plain.report["stages"]);
        assert_eq!(turns.report["groups"], json!(7));
    }
    let stages: Vec<_> = plain.report["stages"].as_array().unwrap().iter().collect();
    assert_eq!(stages.len(), 7, "one raygen, one miss, five closest hit shaders: {stages:?}");
}

fn table(report: &Value) -> Vec<&str> {
    let lines = report["chapter"]["table"].as_array().expect("the report has the table");
    lines.iter().map(|line| line.as_str().expect("a line of text")).collect()
}

/// All whole numbers of a line, in order.
fn numbers(line: &str) -> Vec<u64> {
    line.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn the_printed_table_is_the_layout_for_the_device_s_limits() {
    let Run { report, .. } = render(NAME, SIZE, &[]);
    let table = table(&report);
    let [handle, alignment, base] = numbers(table[0])[..] else { panic!("{}", table[0]) };
    let mut limits = Limits::default();
    limits.ray_tracing_pipeline.shader_group_handle_size = handle as u32;
    limits.ray_tracing_pipeline.shader_group_handle_alignment = alignment as u32;
    limits.ray_tracing_pipeline.shader_group_base_alignment = base as u32;
    limits.ray_tracing_pipeline.max_shader_group_stride = 4096;
    let scene = Scene::chess().unwrap();
    let records = scene.instances.len() * RAY_TYPES as usize;
    expected::hold_exact("07_multi_closest_hit/table", json!({ "records": records }));
    // The ray generation shader's record contains the first pixel of a band.
    let layout = sbt::layout(&limits, [1, 1, records, 0], [8, 0, 24, 0]).unwrap();
    let address = report["chapter"]["address"].as_u64().unwrap();
    for ((region, line), count) in layout.regions.iter().zip(&table[2..]).zip([1, 1, records, 0]) {
        assert_eq!(numbers(line), [region.offset, region.stride, count as u64], "{line}");
        assert_eq!((address + region.offset) % base, 0, "{line}");
    }
    let hit = layout.regions[2];
    let fields = [0, handle, handle + 12, handle + 16, handle + 20, handle + 24, hit.stride];
    assert_eq!(numbers(table[6]), fields, "{}", table[6]);
    let mut next = 0;
    for (index, line) in table[8..].iter().enumerate() {
        let numbers = numbers(line);
        assert_eq!(numbers[0], index as u64, "{line}");
        for sum in numbers[1..].chunks(6) {
            let &[offset, geometry, stride, ray_type, record, byte] = sum else { panic!("{line}") };
            assert_eq!(offset + geometry * stride + ray_type, record, "{line}");
            assert_eq!(byte, hit.offset + record * hit.stride, "{line}");
            // Each record is reached in one way, and they come in order.
            assert_eq!(record, next, "{line}");
            next += 1;
        }
    }
    assert_eq!(next, records as u64);

    // The page shows the software driver's table.
    if report["device"].as_str().unwrap().starts_with("llvmpipe") {
        let page = fs::read_to_string(root().join(format!("docs/{NAME}.md"))).unwrap();
        let (_, shown) = page.split_once(&format!("```text\n{}\n", table[0])).expect("the table");
        let (shown, _) = shown.split_once("```").expect("its end");
        let shown: Vec<_> = shown.lines().filter(|line| line.trim() != "…").collect();
        assert!(shown.len() > 10 && shown[..10] == table[1..11], "{shown:?}");
        assert!(shown.iter().all(|line| table.contains(line)), "{shown:?}");
    }
}

#[test]
fn record_data_that_differ_between_rust_and_glsl_are_refused() {
    let folder = run::copy_of_shaders();
    let file = folder.path().join(NAME).join("look.glsl");
    let text = fs::read_to_string(&file).unwrap();
    let swapped =
        text.replace("float scale;", "float x;").replace("float roughness;", "float scale;");
    let swapped = swapped.replace("float x;", "float roughness;");
    assert_ne!(text, swapped);
    fs::write(&file, swapped).unwrap();
    let (code, line) =
        refusal(command(NAME).args(["--headless"]).env("SHADERS", folder.path()).output().unwrap());
    assert_eq!(code, 1);
    assert!(line.contains("Look.roughness is 12 bytes from the start in the shader"), "{line}");
}
