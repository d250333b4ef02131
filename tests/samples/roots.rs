//! 33_roots: every method compared with exact arithmetic, called directly and traced.

mod cases;
mod direct;
mod judged;
mod shapes;
mod traced;

use common::gpu::Gpu;
use instruments::arithmetic::Arithmetic;
use run::{Chapter, expected, has_worst_arithmetic};
use serde_json::{Map, Value, json};

use cases::{FAMILIES, cases};
use direct::{call, device};
use judged::{Exact, Tally};

const NAME: &str = "33_roots";

/// The name of a method, its number, and whether the polynomial is seen from near the torus.
const METHODS: [(&str, u32, bool); 7] = [
    ("ferrari-far", 0, false),
    ("brackets-far", 1, false),
    ("sturm-far", 2, false),
    ("ferrari", 0, true),
    ("brackets", 1, true),
    ("sturm", 2, true),
    ("two-float", 3, true),
];
const TOP: usize = 6;
/// The number of 33's brackets, and of those of 25_scene_effects, in the test's shader.
const BRACKETS: [u32; 2] = [1, 4];

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).repeats();
}

fn row(family: &str, method: &str, tally: &Tally) {
    println!(
        "{family:>9} {method:>12}: {:3} hits, {:3} misses, {:3} false hits, {:3} false misses, {:3} other, \
         {:2} excused; t off by {:.2} ULP (median), {:.2} (p99), {:.2} (most); normals {:.1e} (p99), {:.1e} (most)",
        tally.hits,
        tally.misses,
        tally.false_hits,
        tally.false_misses,
        tally.other,
        tally.excused,
        tally.ulp_at(0.5),
        tally.ulp_at(0.99),
        tally.ulp_at(1.0),
        tally.normal_at(0.99),
        tally.normal_at(1.0),
    );
}

/// The results of a method for all families, with one pipeline.
fn tallies(gpu: &Gpu, method: usize, families: &[Exact]) -> Vec<Tally> {
    let (name, number, conditioned) = METHODS[method];
    let all: Vec<_> = families.iter().flat_map(|exact| &exact.cases).copied().collect();
    let found = call(gpu, number, conditioned, &all);
    let parts = families.iter().zip(found.chunks(cases::COUNT));
    let tallies: Vec<_> = parts.map(|(exact, found)| Tally::new(exact, found)).collect();
    for (family, tally) in FAMILIES.iter().zip(&tallies) {
        row(family, name, tally);
    }
    tallies
}

/// The bounds of the top method: nothing wrong, and t within a unit in the last place.
fn hold_top(tallies: &[Tally]) {
    for (family, tally) in FAMILIES.iter().zip(tallies) {
        assert_eq!(tally.wrong(), 0, "{family}: {:?}", tally.first_wrong);
        // Only rays that begin on the surface or run along it are meant to be undecided.
        let undecided = if ["surface", "plane"].contains(family) { cases::COUNT / 3 } else { 5 };
        assert!(tally.excused <= undecided, "{family}: {} excused", tally.excused);
        assert!(tally.ulp_at(1.0) <= 1.0, "{family}: t is off by {} ULP", tally.ulp_at(1.0));
    }
}

#[test]
fn the_top_method_is_right_where_the_others_fail() {
    direct::run_alone("roots::all_methods_by_the_driver");
}

#[test]
#[ignore = "run by the_top_method_is_right_where_the_others_fail"]
fn all_methods_by_the_driver() {
    let gpu = device(Arithmetic::Driver);
    let families = FAMILIES.map(|family| Exact::new(cases(family)));
    hard_cases_hold(&gpu);
    brackets_of_25_are_those_of_33(&gpu, &families);
    let mut held = Map::new();
    for (method, (name, ..)) in METHODS.iter().enumerate() {
        let tallies = tallies(&gpu, method, &families);
        let part = |count: usize| count as f64 / cases::COUNT as f64;
        for (family, tally) in FAMILIES.iter().zip(&tallies) {
            held.insert(format!("{family}.{name}.wrong"), json!(part(tally.wrong())));
            held.insert(format!("{family}.{name}.p99"), json!(tally.ulp_at(0.99)));
        }
        let wrong: usize = tallies.iter().map(Tally::wrong).sum();
        held.insert(format!("all.{name}.wrong"), json!(part(wrong) / FAMILIES.len() as f64));
        if method == TOP {
            hold_top(&tallies);
        } else {
            assert!(wrong > 20, "{name} is wrong only {wrong} times: the cases are too easy");
        }
    }
    if cases::seed().is_none() {
        expected::hold("33_roots/methods", Value::Object(held));
    }
}

/// Both find the same hits, with the same bits of t and of the normal.
fn brackets_of_25_are_those_of_33(gpu: &Gpu, families: &[Exact]) {
    let all: Vec<_> = families.iter().flat_map(|exact| &exact.cases).copied().collect();
    let [own, other] = BRACKETS.map(|number| call(gpu, number, true, &all));
    for ((case, own), other) in all.iter().zip(&own).zip(&other) {
        assert_eq!(own, other, "{case:?}");
    }
    let hits = own.iter().flatten().count();
    assert!(hits > all.len() / 3, "only {hits} of {} rays hit", all.len());
}

/// The cases of `tests/data/torus_cases.json`: every top answer is right, and the simplest method fails.
fn hard_cases_hold(gpu: &Gpu) {
    let exact = Exact::new(cases::hard_cases());
    let wrong = [0, TOP].map(|method| {
        let (name, number, conditioned) = METHODS[method];
        let tally = Tally::new(&exact, &call(gpu, number, conditioned, &exact.cases));
        row("hard", name, &tally);
        assert!(method != TOP || tally.wrong() == 0, "{:?}", tally.first_wrong);
        assert!(method != TOP || tally.ulp_at(1.0) <= 1.0, "{}", tally.ulp_at(1.0));
        tally.wrong()
    });
    assert!(wrong[0] > 5, "Ferrari's formula fails only {} of them", wrong[0]);
}

#[test]
#[ignore = "nightly: compiles for long; quick: roots::the_top_method_is_right_where_the_others_fail"]
fn in_the_worst_arithmetic_the_top_method_is_right() {
    if has_worst_arithmetic() {
        direct::run_alone("roots::two_floats_in_the_worst_arithmetic");
    }
}

#[test]
#[ignore = "run by in_the_worst_arithmetic_the_top_method_is_right"]
fn two_floats_in_the_worst_arithmetic() {
    let gpu = device(Arithmetic::Worst);
    hard_cases_hold(&gpu);
    let families = FAMILIES.map(|family| Exact::new(cases(family)));
    hold_top(&tallies(&gpu, TOP, &families));
}
