//! 13_callable_shader: one picture for every way to choose its code, and patterns compared with the CPU's.

mod patterns;

use common::scene::Scene;

use run::{Chapter, compiled_for, expected, same_colors};
use serde_json::Map;

const NAME: &str = "13_callable_shader";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

#[test]
fn every_way_to_choose_gives_the_same_bits() {
    for light in ["light=directional", "light=point"] {
        let by_callables = chapter("120x75").sets(&[light]).picture();
        for (choose, stage) in [
            ("callable", "closest hit"),
            ("switch", "raygen"),
            ("switch", "closest hit"),
            ("hit group", "raygen"),
        ] {
            let sets = [format!("choose by={choose}"), format!("called from={stage}")];
            let other = chapter("120x75").sets(&[light, &sets[0], &sets[1]]).picture();
            let what = format!("{light}: {choose} from {stage}");
            same_colors(&what, NAME, &by_callables, &other);
        }
    }
}

#[test]
fn patterns_have_the_same_bits_on_the_host_near_and_far() {
    let materials = Scene::chess().expect("the chess set").model.materials;
    let mut seen = [0; 3];
    let places = chapter("240x150").sets(&["show=object position"]).picture();
    for far in [0, 1, 1000, 1 << 24] {
        let far_control = format!("far={far}");
        let weights = chapter("240x150").sets(&["show=pattern", &far_control]).picture();
        for (&[x, y, z, material], &[weight, ..]) in places.pixels.iter().zip(&weights.pixels) {
            if material < 0.0 {
                continue;
            }
            let name = &*materials[material as usize].name;
            let Some((kind, scale)) = patterns::of(name) else { panic!("no pattern of {name}") };
            let here = patterns::weight(kind, [x, y, z].map(|x| scale * x), far);
            assert_eq!(weight.to_bits(), here.to_bits(), "{name} at {x}, {y}, {z}, far {far}");
            seen[kind as usize] += 1;
        }
    }
    assert!(seen.iter().all(|&count| count > 1000), "{seen:?} pixels of marble, wood, checker");
}

/// A pattern moved by whole cells is the same pattern elsewhere; moved by adding to a float, it is blurred.
#[test]
fn whole_cells_keep_the_digits_that_a_sum_of_floats_loses() {
    let mut table = Map::new();
    for (far, least, most) in
        [(100, 0.0, 1e-4), (10_000, 1e-4, 1e-2), (1_000_000, 1e-3, 0.3), (1 << 24, 0.1, 1.0)]
    {
        let mut error = 0.0;
        for i in 0..1000 {
            let place = [i as f32 * 0.0137, 0.31, 0.77];
            let exact = patterns::weight(patterns::Kind::Marble, place, far);
            let summed = [place[0] + far as f32, place[1], place[2]];
            let blurred = patterns::weight(patterns::Kind::Marble, summed, 0);
            error += f64::from((exact - blurred).abs()) / 1000.0;
        }
        println!("| {far} | {error:.5} |");
        table.insert(far.to_string(), error.into());
        assert!(error >= least && error < most, "{far}: {error}");
    }
    expected::hold_exact("13_callable_shader/cells", table.into());
}

#[test]
#[ignore = "nightly: compiles for a GPU; quick: gpus budgets::no_chapter_costs_a_gpu_more_than_is_recorded"]
fn a_pipeline_with_callables_is_many_programs_and_one_without_is_one() {
    for (choose, several) in [("callable", true), ("switch", false), ("hit group", false)] {
        let choose = format!("choose by={choose}");
        let Some(programs) = compiled_for(NAME, "navi31", &["--set", &choose]) else { return };
        println!("{choose}: {} programs", programs.len());
        assert_eq!(programs.len() > 1, several, "{choose}: {programs:?}");
        for program in programs {
            // Around calls, Mesa 26 spills registers in raygen, and Mesa 25 does not.
            let spills = several && !program["compiler"].as_str().unwrap().contains("Mesa 25.");
            assert!(spills || program["spilled_registers"] == 0, "{choose}: {program}");
        }
    }
}
