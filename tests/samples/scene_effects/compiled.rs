//! What a GPU's own compiler makes of each scene's pipeline, against that which has everything.

use run::compiled_for;
use serde_json::Value;

use super::{NAME, SCENES};

/// A pipeline on one family: its programs, and of their figures the sum or the worst.
#[derive(Debug, PartialEq)]
struct Figures {
    programs: usize,
    instructions: u64,
    registers: u64,
    waves: u64,
    scratch: u64,
}

impl Figures {
    fn of(rows: &[Value], family: &str) -> Self {
        let rows: Vec<_> = rows.iter().filter(|row| row["family"] == family).collect();
        let all = |key: &str| -> Vec<u64> {
            rows.iter().map(|row| row[key].as_u64().expect("a whole number")).collect()
        };
        Self {
            programs: rows.len(),
            instructions: all("instructions").iter().sum(),
            registers: all("registers").into_iter().max().expect("a program"),
            waves: all("waves").into_iter().min().expect("a program"),
            scratch: all("scratch_bytes").into_iter().max().expect("a program"),
        }
    }

    /// Its cells of a table.
    fn cells(&self) -> String {
        let Self { programs, instructions, registers, waves, scratch } = self;
        format!(
            "{programs} | {} | {registers} | {waves} | {} B",
            thousands(*instructions),
            thousands(*scratch)
        )
    }
}

/// A whole number with commas.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let parts = digits.as_bytes().rchunks(3).rev().map(|part| String::from_utf8_lossy(part));
    parts.collect::<Vec<_>>().join(",")
}

/// The programs of a scene's own pipeline, or of the one with everything; `None` without the compiler.
fn compiled(scene: &str, pipeline: &str, family: &str) -> Option<Vec<Value>> {
    let sets = [format!("scene={scene}"), format!("pipeline={pipeline}")];
    let sets = sets.iter().flat_map(|set| ["--set", set.as_str()]);
    let arguments: Vec<&str> = ["--size", "16x10"].into_iter().chain(sets).collect();
    compiled_for(NAME, family, &arguments)
}

#[test]
fn everything_has_no_fewer_instructions_registers_and_scratch_than_a_scene_calls_for() {
    let Some(everything) = compiled("one sphere", "everything", "navi31") else { return };
    let everything = Figures::of(&everything, "navi31");
    for (scene, ..) in SCENES {
        let own = compiled(scene, "specialised", "navi31").expect("the compiler is there");
        let own = Figures::of(&own, "navi31");
        println!("{scene}: {own:?}");
        assert!(own.programs >= 1 && own.programs <= everything.programs, "{scene}: {own:?}");
        assert!(own.instructions <= everything.instructions, "{scene}: {own:?}");
        assert!(own.registers <= everything.registers, "{scene}: {own:?}");
        assert!(own.scratch <= everything.scratch, "{scene}: {own:?}");
        assert!(own.waves >= everything.waves, "{scene}: {own:?}");
    }
}

#[test]
#[ignore = "prints a table of the page"]
fn table() {
    let families = ["navi21", "navi31", "gfx1201"];
    let everything = compiled("one sphere", "everything", "all").expect("the compiler is there");
    println!("{}\n", everything[0]["compiler"].as_str().unwrap());
    let own = SCENES.map(|(scene, ..)| compiled(scene, "specialised", "all").unwrap());
    for family in families {
        println!("| {family} | programs | instructions | registers | waves | scratch |");
        println!("|---|---:|---:|---:|---:|---:|");
        for ((scene, ..), own) in SCENES.iter().zip(&own) {
            println!("| {scene} | {} |", Figures::of(own, family).cells());
        }
        println!(
            "| *any scene, by* `pipeline=everything` | {} |\n",
            Figures::of(&everything, family).cells()
        );
    }
    // The pipeline does not depend on the scene, so one row is enough.
    for (scene, ..) in SCENES {
        let other = compiled(scene, "everything", "navi31").unwrap();
        assert_eq!(Figures::of(&other, "navi31"), Figures::of(&everything, "navi31"), "{scene}");
    }
}
