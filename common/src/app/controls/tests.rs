//! Controls set, listed and refused.

use glam::DVec3;

use super::*;

#[derive(Default)]
struct Sample {
    height: f32,
    depth: u32,
    on: bool,
    show: u32,
    tint: Vec3,
    normal: Direction,
    camera: Camera,
}

struct Direction(Vec3);

impl Default for Direction {
    fn default() -> Self {
        Self(Vec3::Y)
    }
}

impl Sample {
    fn controls(&mut self, c: &mut Controls) {
        c.slider("height", &mut self.height, 0.0..=10.0);
        c.integer("depth", &mut self.depth, 0..=8);
        c.checkbox("shadows", &mut self.on);
        c.one_of("show", &mut self.show, &["picture", "ray direction"]);
        c.color("tint", &mut self.tint);
        c.direction("normal", &mut self.normal.0, -10.0..=10.0);
        c.camera(&mut self.camera);
    }
}

fn set_on(sample: &mut Sample, name: &str, text: &str) -> Result<(), String> {
    set(name, text, |c| sample.controls(c)).map_err(|usage| usage.0)
}

#[test]
fn every_control_can_be_set_to_what_the_list_says_it_is() {
    let mut sample = Sample::default();
    for control in list(|c| sample.controls(c)) {
        set_on(&mut sample, &control.name, &control.value).unwrap();
    }
    set_on(&mut sample, "show", "ray direction").unwrap();
    set_on(&mut sample, "tint", "0.5, 0.25,1").unwrap();
    set_on(&mut sample, "camera eye", "1e6,2,-3.5").unwrap();
    set_on(&mut sample, "field of view", "30").unwrap();
    assert_eq!((sample.show, sample.tint), (1, Vec3::new(0.5, 0.25, 1.0)));
    assert_eq!((sample.camera.eye, sample.camera.fov_y), (DVec3::new(1e6, 2.0, -3.5), 30.0));
}

/// A lamp, which only one kind of light has.
#[derive(Default)]
struct Lit {
    light: u32,
    lamp: f32,
}

impl Lit {
    fn controls(&mut self, c: &mut Controls) {
        c.slider("lamp", &mut self.lamp, 0.0..=10.0);
        c.needs("lamp", "light=point", self.light == 1);
        c.one_of("light", &mut self.light, &["sun", "point"]);
    }
}

#[test]
fn a_control_without_effect_is_told_if_it_is_set() {
    let told = |sets: &[&str]| {
        let mut lit = Lit::default();
        let pairs: Vec<_> = sets.iter().filter_map(|set| set.split_once('=')).collect();
        let owned: Vec<_> =
            pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        set_all(&owned, |c| lit.controls(c)).unwrap();
        without_effect(pairs.iter().map(|(name, _)| *name), |c| lit.controls(c))
    };
    assert_eq!(told(&["lamp=3"]), ["control 'lamp' has no effect here: it needs light=point"]);
    assert!(told(&["lamp=3", "light=point"]).is_empty());
    assert!(told(&["light=sun"]).is_empty());
}

/// A preset, what it brings, and a control that is there for one preset alone, declared before it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Presets {
    preset: u32,
    height: f32,
    extra: f32,
}

impl Presets {
    fn controls(&mut self, c: &mut Controls) {
        if self.preset == 1 {
            c.slider("extra", &mut self.extra, 0.0..=10.0);
        }
        if c.one_of("preset", &mut self.preset, &["low", "high"]) {
            self.height = [1.0, 9.0][self.preset as usize];
        }
        c.slider("height", &mut self.height, 0.0..=10.0);
    }

    fn with(sets: &[&str]) -> Result<Self, String> {
        let pair = |set: &&str| {
            let (name, text) = set.split_once('=').unwrap();
            (name.to_owned(), text.to_owned())
        };
        let sets: Vec<_> = sets.iter().map(pair).collect();
        let mut presets = Self::default();
        set_all(&sets, |c| presets.controls(c)).map_err(|usage| usage.0)?;
        Ok(presets)
    }
}

#[test]
fn the_order_of_settings_does_not_matter() {
    let expected = Ok(Presets { preset: 1, height: 5.0, extra: 3.0 });
    let [a, b, c] = ["preset=high", "height=5", "extra=3"];
    for sets in [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]] {
        assert_eq!(Presets::with(&sets), expected, "{sets:?}");
    }
    assert_eq!(Presets::with(&["height=5", "preset=high"]).unwrap().height, 5.0);
    assert_eq!(Presets::with(&["preset=high"]).unwrap().height, 9.0);
    assert_eq!(Presets::with(&[]), Ok(Presets::default()));
}

#[test]
fn a_compared_preset_undoes_no_setting() {
    let sets = [("height".to_owned(), "5".to_owned()), ("preset".to_owned(), "low".to_owned())];
    let mut presets = Presets::default();
    for (preset, text) in [(1, "high"), (0, "low"), (1, "high")] {
        set_beside(&sets, "preset", text, |c| presets.controls(c)).unwrap();
        assert_eq!((presets.preset, presets.height), (preset, 5.0));
    }
}

#[test]
fn an_eye_that_is_its_own_target_is_refused() {
    let both = |eye: &str, target: &str| {
        let sets = [("camera eye", eye), ("camera target", target)];
        let sets = sets.map(|(name, text)| (name.to_owned(), text.to_owned()));
        let mut sample = Sample::default();
        set_all(&sets, |c| sample.controls(c)).map_err(|usage| usage.0)
    };
    let error = both("1,2,-0.5", "1,2,-0.5").unwrap_err();
    let line = "control 'camera eye' cannot be where 'camera target' is, at '1,2,-0.5': they take \
                two different points";
    assert_eq!(error, line);
    assert_eq!(both("0,0,0", "0,0,5"), Ok(()), "each where the other was");
    let mut sample = Sample::default();
    assert!(set_on(&mut sample, "camera eye", "0,0,0").unwrap_err().contains("camera target"));
}

#[test]
fn a_name_given_again_begins_another_round() {
    let again = Presets::with(&["height=5", "preset=high", "preset=low"]).unwrap();
    assert_eq!((again.preset, again.height), (0, 1.0));
    let last = Presets::with(&["height=5", "height=6"]).unwrap();
    assert_eq!(last.height, 6.0);
    // Whatever prevents the rest is reported.
    let wrong = Presets::with(&["height=11", "height=6"]).unwrap_err();
    assert!(wrong.contains("'height' cannot be '11'"), "{wrong}");
    let absent = Presets::with(&["height=5", "extra=3"]).unwrap_err();
    assert_eq!(absent, "no control 'extra'; there is preset, height");
}

#[test]
fn wrong_names_and_values_say_what_there_is() {
    let mut sample = Sample::default();
    let error = set_on(&mut sample, "bogus", "1").unwrap_err();
    assert!(error.contains("no control 'bogus'; there is height, depth, shadows"), "{error}");
    let wrong = [
        ("height", "10.5", "0 to 10"),
        ("height", "NaN", "0 to 10"),
        ("depth", "9", "0 to 8"),
        ("depth", "-1", "0 to 8"),
        ("shadows", "maybe", "on, off"),
        ("show", "pictures", "picture, ray direction"),
        ("tint", "1,1", "r,g,b"),
        ("tint", "1,1,2", "0 to 1"),
        ("normal", "0,0,0", "x,y,z, each -10 to 10, not all 0 in 32 bits"),
        ("normal", "-0,0,-0", "not all 0 in 32 bits"),
        ("normal", "1e-60,0,0", "not all 0 in 32 bits"),
        ("normal", "0,11,0", "each -10 to 10"),
        ("normal", "NaN,1,0", "each -10 to 10"),
        ("camera eye", "1,2,inf", "x,y,z"),
        ("camera eye", "1,2,-1.1e18", "x,y,z, each -1e18 to 1e18"),
    ];
    for (name, text, possible) in wrong {
        let error = set_on(&mut sample, name, text).unwrap_err();
        assert!(error.contains(&format!("'{name}'")) && error.contains(possible), "{error}");
    }
    assert_eq!((sample.height, sample.normal.0), (0.0, Vec3::Y));
    set_on(&mut sample, "normal", "0,-1e-40,0").unwrap();
}

/// A control set beside the compared one acts only once: a scene, for example, is not opened again in every frame.
#[test]
fn a_control_beside_the_compared_one_acts_once() {
    let (mut scene, mut rung, mut opened) = (0, 0, 0);
    let mut declare = |c: &mut Controls| {
        opened += u32::from(c.one_of("scene", &mut scene, &["board", "lake"]));
        c.one_of("rung", &mut rung, &["naive", "stable"]);
    };
    let sets = [("scene".to_owned(), "lake".to_owned())];
    set_all(&sets, &mut declare).unwrap();
    for value in ["naive", "stable", "naive"] {
        set_beside(&sets, "rung", value, &mut declare).unwrap();
    }
    assert_eq!((scene, rung, opened), (1, 0, 1));
}

fn mistake(declare: impl FnOnce(&mut Controls)) -> String {
    check(declare).expect_err("it is refused").to_string()
}

#[test]
fn a_control_is_declared_with_a_possible_value_and_a_name_of_its_own() {
    let mut sample = Sample::default();
    check(|c| sample.controls(c)).unwrap();
    let said = mistake(|c| _ = c.slider("moon", &mut 5.0, 0.0..=3.0));
    assert_eq!(said, "control 'moon' is declared with the value 5; it takes 0 to 3");
    let mut unknown = f32::NAN;
    let said = mistake(|c| _ = c.slider("moon", &mut unknown, 0.0..=3.0));
    assert!(said.contains("the value NaN"), "{said}");
    // A range that is written the wrong way round holds nothing.
    let said = mistake(|c| _ = c.integer("depth", &mut 3, RangeInclusive::new(8, 0)));
    assert!(said.ends_with("the value 3; it takes 8 to 0"), "{said}");
    let said = mistake(|c| _ = c.one_of("show", &mut 2, &["picture", "normal"]));
    assert!(said.ends_with("it takes picture, normal"), "{said}");
    let said = mistake(|c| _ = c.color("tint", &mut Vec3::new(0.0, 2.0, 0.0)));
    assert!(said.ends_with("the value 0,2,0; it takes r,g,b, each 0 to 1"), "{said}");
    let mut camera = Camera { fov_y: 0.0, ..Camera::default() };
    let said = mistake(|c| _ = c.camera(&mut camera));
    assert!(said.starts_with("control 'field of view' is declared with the value 0"), "{said}");
    let said = mistake(|c| {
        c.checkbox("on", &mut true);
        c.checkbox("on", &mut false);
    });
    assert!(said.starts_with("two controls have the name 'on'"), "{said}");
    let said = mistake(|c| _ = c.checkbox("a=b", &mut true));
    assert!(said.starts_with("a control has the name 'a=b'"), "{said}");
}
