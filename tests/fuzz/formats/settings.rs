//! Settings of controls, and the other syntaxes of the command line.

use std::path::Path;
use std::sync::LazyLock;

use anyhow::{Result, anyhow};
use common::app::controls::{list, set_all};
use common::scene::{Camera, Sun};
use common::{Controls, Playback};
use glam::{DVec3, Vec3};
use instruments::compare;
use instruments::sums::range;

use super::{corpus, nothing};
use crate::format::{Format, Function};
use crate::grammar::Grammar;

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/settings.txt")));

/// Lines, each the argument of a `--set`.
pub const FORMAT: Format = Format {
    name: "settings",
    file: "settings.txt",
    most: 1 << 12,
    make: |random| GRAMMAR.text(random, 300).into_bytes(),
    grammar: Some(|| &GRAMMAR),
    seeds: || corpus("settings"),
    seal: None,
};

/// The reader of settings.
pub const FUNCTION: Function = Function { beside: nothing, read, memory: 1 << 20 };

/// A control of each kind.
struct All {
    height: f32,
    count: u32,
    on: bool,
    tint: Vec3,
    show: u32,
    size: Vec3,
    camera: Camera,
    playback: Playback,
    sun: Sun,
}

const WORDS: [&str; 3] = ["picture", "normal", "depth"];

impl All {
    fn controls(&mut self, c: &mut Controls) {
        if c.checkbox("on", &mut self.on) {
            // A preset also sets another control, which comes after it.
            self.height = 0.5;
        }
        c.slider("height", &mut self.height, -1.0..=1.0);
        c.integer("count", &mut self.count, 1..=9);
        c.color("tint", &mut self.tint);
        c.one_of("show", &mut self.show, &WORDS);
        if self.on {
            c.vector("size", &mut self.size, 0.0..=10.0);
        }
        c.camera(&mut self.camera);
        c.playback(&mut self.playback);
        c.sun(&mut self.sun);
    }

    /// Checks that every value is accepted by its control.
    fn check(&self) {
        assert!((-1.0..=1.0).contains(&self.height) && (1..=9).contains(&self.count));
        assert!(self.tint.min_element() >= 0.0 && self.tint.max_element() <= 1.0);
        assert!((self.show as usize) < WORDS.len() && self.size.is_finite());
        assert!(self.playback.frame <= self.playback.last);
        assert!(self.camera.looks_somewhere(), "{:?}", self.camera);
        let basis = self.camera.basis(1.6);
        assert!(basis.forward.is_finite() && basis.right.is_finite(), "{:?}", self.camera);
        assert!((0.0..=360.0).contains(&self.sun.azimuth));
    }
}

fn read(path: &Path) -> Result<String> {
    let bytes = std::fs::read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut told = String::new();
    for line in text.lines() {
        told += match range(line) {
            Ok(range) => {
                assert!(range.start < range.end);
                "range "
            }
            Err(_) => "",
        };
        if let Ok((name, values)) = compare::parse(line) {
            assert!(!name.is_empty() && values.len() > 1);
            told += "compared ";
        }
    }
    let pairs = text.lines().filter_map(|line| line.split_once('='));
    let sets: Vec<_> =
        pairs.map(|(name, value)| (name.trim().into(), value.trim().into())).collect();
    let camera = Camera::new(DVec3::new(0.0, 1.0, 5.0), DVec3::ZERO, 40.0);
    let sun = Sun { azimuth: 30.0, elevation: 40.0, radiance: Vec3::ONE };
    let mut all = All {
        height: 0.0,
        count: 1,
        on: false,
        tint: Vec3::ONE,
        show: 0,
        size: Vec3::ONE,
        camera,
        playback: Playback::new(100),
        sun,
    };
    let set = set_all(&sets, |c| all.controls(c));
    set.map_err(|refused| anyhow!("{}: {refused}", path.display()))?;
    all.check();
    // The listed values can be set again, and the list is then the same.
    let listed = list(|c| all.controls(c));
    let again: Vec<_> = listed.iter().map(|one| (one.name.clone(), one.value.clone())).collect();
    set_all(&again, |c| all.controls(c)).expect("what is listed can be set");
    assert_eq!(list(|c| all.controls(c)), listed);
    Ok(told)
}
