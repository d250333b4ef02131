//! `--why`: a line for each effect, with the reason in the scene and the savings without it.

use std::process::Output;

use common::gpu::ShaderEnum;
use effects::Effect;

use crate::NAME;

fn why(arguments: &[&str]) -> Output {
    let command = &mut run::command(NAME);
    command.arg("--why").args(arguments).output().expect("it starts")
}

#[test]
fn every_effect_has_a_line_with_its_reason() {
    let scene = "samples/assets/scenes/one_sphere.toml";
    let output = why(&["--scene", scene, "--size", "48x30", "--frames", "3"]);
    let (out, err) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{out}{err}");
    assert!(out.contains("\n1 of 28 effects, this scene's own pipeline: "), "{out}");
    for &effect in Effect::ALL {
        let sign = if effect == Effect::Spheres { "✓" } else { "✗" };
        let start = format!("{sign}  {} ", effect.name());
        let line = out.lines().find(|line| line.starts_with(&start));
        let line = line.unwrap_or_else(|| panic!("no '{start}' in:\n{out}"));
        // The sphere's shaders are most of this pipeline, so their instructions cannot be free.
        if effect == Effect::Spheres && !out.contains("No instructions: ") {
            let cells: Vec<&str> =
                line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
            let instructions = cells[cells.len() - 2].replace(',', "");
            assert!(instructions.parse::<i64>().expect("a number") > 100, "{line}");
        }
    }
    assert!(out.contains("✓  spheres "), "{out}");
    assert!(out.contains("1 sphere"), "{out}");
    assert!(out.contains("\nThreads keep their places: no surface sends a ray on."), "{out}");
}

#[test]
fn what_goes_with_a_picture_is_refused_in_one_line() {
    for (arguments, part) in [
        (&["--out", "x.png"][..], "--why makes no picture for --out, --animate or --then"),
        (&["--set", "without=spheres"], "--why sets the control 'without' itself; leave it out"),
        (&["--compare", "without=nothing|spheres"], "takes none of the instruments' options"),
        (&["--scene", "no_such.toml"], "no_such.toml"),
    ] {
        let output = why(arguments);
        let err = String::from_utf8_lossy(&output.stderr);
        let code = output.status.code().expect("an exit code");
        assert!([1, 2].contains(&code), "{arguments:?}: {err}");
        assert!(err.contains(part), "{arguments:?}: {err}");
        assert_eq!(err.lines().count(), 1, "{arguments:?}: {err}");
    }
}
