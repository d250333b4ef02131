//! The page's measured tables and a plot of one of them. On request only: `cargo test --test scene_effects
//! plots -- --ignored --nocapture`.

use serde_json::{Map, Value, json};

use super::{NAME, SCENES};
use run::plot::{Axis, Chart, Series, draw};
use run::{command, expected};

/// The report of a run without validation, which would distort the times. The driver's cache is disabled, so
/// that each pipeline is compiled.
fn report(scene: &str, size: &str, more: &[&str]) -> Value {
    let output = command(NAME)
        .args(["--headless", "--report", "-", "--size", size])
        .args(["--set", &format!("scene={scene}")])
        .args(more)
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .output()
        .expect("the sample starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("the report is JSON")
}

/// Milliseconds from the shaders' source to the first frame at full speed: the pipeline, and work the driver
/// defers to the first trace. The picture is tiny, so that tracing it takes no time. The least of three runs.
fn compile_time(scene: &str) -> f64 {
    let times = (0..3).map(|_| {
        let report = report(scene, "16x10", &["--frames", "4"]);
        let frames = &report["gpu_milliseconds"];
        let put_off = frames["max"].as_f64().unwrap() - frames["min"].as_f64().unwrap();
        put_off + report["chapter"]["pipeline"]["build_milliseconds"].as_f64().unwrap()
    });
    times.fold(f64::INFINITY, f64::min)
}

fn spirv_kilobytes(report: &Value) -> f64 {
    let stages = report["chapter"]["pipeline"]["stages"].as_array().unwrap();
    stages.iter().map(|stage| stage["words"].as_f64().unwrap()).sum::<f64>() * 4.0 / 1024.0
}

/// The sizes of a scene's own pipeline, without times.
fn sizes(scene: &str) -> [(&'static str, Value); 5] {
    let own = report(scene, "320x200", &[]);
    let pipeline = &own["chapter"]["pipeline"];
    let stages = pipeline["stages"].as_array().unwrap();
    [
        ("stages", stages.len().into()),
        ("sbt", pipeline["sbt_bytes"].clone()),
        ("payload", stages[0]["module"]["payload"].clone()),
        ("spirv_kilobytes", spirv_kilobytes(&own).into()),
        ("bytes", own["bytes_allocated"].clone()),
    ]
}

/// A scene's name in the form used for figures.
fn key(scene: &str, of: &str) -> String {
    format!("{}.{of}", scene.replace(' ', "-"))
}

#[test]
#[ignore = "by hand: takes figures of the page"]
fn pipelines() {
    let mut table = Map::new();
    for (name, effects, _) in SCENES {
        table.insert(key(name, "effects"), effects.len().into());
        table.extend(sizes(name).map(|(of, size)| (key(name, of), size)));
    }
    println!("{}", json!(table));
    expected::hold("25_scene_effects/pipelines", table.into());
}

#[test]
#[ignore = "by hand: takes times"]
fn costs() {
    let sets = ["--frames", "7", "--set", "measure costs=on"];
    let report = report("mirror balls", "320x200", &sets);
    let effects = report["chapter"]["effects"].as_array().unwrap();
    let mut table = Map::new();
    for effect in effects.iter().filter(|effect| !effect["cost_milliseconds"].is_null()) {
        let name = effect["name"].as_str().unwrap();
        table.insert(key(name, "ms"), effect["cost_milliseconds"].clone());
        table.insert(key(name, "ratio"), effect["time_without"].clone());
    }
    println!("{}", json!(table));
    expected::give_timed("25_scene_effects/costs", table.into());
}

#[test]
#[ignore = "by hand: measures for minutes"]
fn scenes() {
    let mut table = Map::new();
    let mut twice = 0;
    println!("| scene | stages | compile | time | everything / own |");
    println!("|---|---:|---:|---:|---:|");
    for (name, _, stages) in SCENES {
        let compile = compile_time(name);
        let rounds = ["--frames", "25", "--compare", "pipeline=specialised|everything"];
        let times = report(name, "320x200", &rounds)["comparison"].clone();
        let [time, everything] = [0, 1].map(|value| times["values"][value].clone());
        let [low, median, high] =
            ["low", "median", "high"].map(|part| everything["ratio"][part].as_f64().unwrap());
        let milliseconds = time["milliseconds"].as_f64().unwrap();
        // Every pipeline has `camera.rgen` and `sky.rmiss`.
        let stages = 2 + stages.len();
        println!(
            "| {name} | {stages} | {compile:.0} ms | {milliseconds:.1} ms | **{median:.2}** ({low:.2} to {high:.2}) |",
        );
        twice += u32::from(median >= 2.0);
        let row = [("compile", compile), ("ms", milliseconds)];
        let row = row.into_iter().chain([("ratio", median), ("low", low), ("high", high)]);
        table.extend(row.map(|(of, value)| (key(name, of), value.into())));
    }
    table.insert("twice".to_owned(), twice.into());
    expected::give_timed("25_scene_effects/times", table.into());
}

/// The columns of the page's table of scenes: the names, and the numbers of four columns.
fn columns(page: &str) -> (Vec<&str>, [Vec<f64>; 4]) {
    let rows = page.lines().filter_map(|line| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        (cells.len() == 10 && SCENES.iter().any(|scene| scene.0 == cells[0])).then_some(cells)
    });
    let (mut names, mut numbers) = (vec![], [const { vec![] }; 4]);
    for cells in rows {
        names.push(cells[0]);
        // Stages, compile, time, everything / own.
        for (numbers, cell) in numbers.iter_mut().zip([2, 6, 8, 9]) {
            let number = cells[cell].trim_start_matches("**").split(['*', ' ']).next().unwrap();
            numbers.push(number.replace(',', "").parse().expect("a number in the table"));
        }
    }
    (names, numbers)
}

/// The ticks that enclose the values: a dot outside of its chart would not be drawn.
fn fitting(ticks: &[f64], values: &[f64]) -> Vec<f64> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let first = ticks.iter().rposition(|&tick| tick < low).expect("a tick below all values");
    let last = ticks.iter().position(|&tick| tick > high).expect("a tick above all values");
    ticks[first..=last].to_vec()
}

/// Drawn from the page's table, so that the two agree.
#[test]
#[ignore = "by hand: draws docs/images/25_times.svg from the page's table"]
fn times() {
    let page =
        std::fs::read_to_string(run::root().join("docs/measurements/25_scene_effects.md")).unwrap();
    let (names, [stages, compiles, milliseconds, ratios]) = columns(&page);
    assert_eq!(names, SCENES.map(|scene| scene.0));
    let points = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(&x, &y)| [x, y]).collect();
    let points = (points(&milliseconds, &ratios), points(&stages, &compiles));
    let [times, costs] = [
        fitting(
            &[1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3],
            &milliseconds,
        ),
        fitting(&[0.8, 0.9, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0], &ratios),
    ];
    let [counts, compile_times] = [
        fitting(&[0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0], &stages),
        fitting(&[20.0, 50.0, 100.0, 200.0, 500.0, 1e3, 2e3, 5e3, 1e4, 2e4], &compiles),
    ];
    let time = Axis { label: "own pipeline, milliseconds", ticks: &times, logarithmic: true };
    let ratio = Axis { label: "everything / own", ticks: &costs, logarithmic: true };
    let count = Axis { label: "stages", ticks: &counts, logarithmic: false };
    let compile = Axis { label: "compile, milliseconds", ticks: &compile_times, logarithmic: true };
    let series =
        |points| vec![Series { points, names: names.clone(), dots: true, ..Default::default() }];
    let charts = [
        Chart {
            title: "what everything costs a scene",
            x: time,
            y: ratio,
            series: series(points.0),
        },
        Chart {
            title: "what a stage costs to compile",
            x: count,
            y: compile,
            series: series(points.1),
        },
    ];
    draw("25_times.svg", (560, 460), &charts);
}
