//! The origin of a file's sums, and the differences between two origins.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Everything a picture depends on, which samples must have in common to be added.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// The chapter.
    pub chapter: String,
    /// The version of this program.
    pub version: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Every control's value, by name.
    pub settings: BTreeMap<String, String>,
    /// The files of the scene, by name, each with a CRC-32 of its bytes.
    pub scene: BTreeMap<String, u32>,
    /// True if acceleration structures are built in the model's order.
    pub unordered: bool,
    /// A CRC-32 of the SPIR-V of all shaders, once they are compiled.
    pub shaders: Option<u32>,
    /// The device's name.
    pub device: String,
    /// Its driver and that driver's version.
    pub driver: String,
    /// The arithmetic of shaders: the value of `--arithmetic`.
    pub arithmetic: String,
}

/// A difference between two origins.
pub struct Difference {
    what: String,
    values: [String; 2],
}

impl Difference {
    /// One line with both sources, such as "in a.sums" and "here".
    pub fn line(&self, [a, b]: [&str; 2]) -> String {
        format!("{} is {} {a} and {} {b}", self.what, self.values[0], self.values[1])
    }
}

impl Origin {
    /// Everything, as names and values.
    fn facts(&self) -> Vec<(String, String)> {
        let Self { chapter, version, size: [width, height], device, driver, .. } = self;
        let named = |(name, value): (&str, &str)| (name.to_owned(), format!("'{value}'"));
        let mut facts: Vec<_> = [("the chapter", chapter), ("the version", version)]
            .map(|(name, value)| named((name, value)))
            .into();
        facts.push(("the size".to_owned(), format!("{width}x{height}")));
        // A scene changes other settings, so it is compared before them.
        let (scene, others): (Vec<_>, Vec<_>) =
            self.settings.iter().partition(|(name, _)| *name == "scene");
        let set = |(name, value): (&String, &String)| (format!("'{name}'"), format!("'{value}'"));
        facts.extend(scene.into_iter().map(set));
        let crc = |crc: &u32| format!("{crc:08x}");
        let files = self.scene.iter();
        facts.extend(files.map(|(name, sum)| (format!("the CRC-32 of '{name}'"), crc(sum))));
        facts.extend(others.into_iter().map(set));
        facts.push(("--unordered".to_owned(), self.unordered.to_string()));
        facts.extend(self.shaders.map(|sum| ("the CRC-32 of the shaders".to_owned(), crc(&sum))));
        let device = [("the device", device), ("the driver", driver)];
        let arithmetic = ("--arithmetic", &self.arithmetic);
        facts.extend(device.into_iter().chain([arithmetic]).map(|(n, v)| named((n, v))));
        facts
    }

    /// The first difference from `other`. Shaders that are not compiled yet match any.
    pub fn difference(&self, other: &Self) -> Option<Difference> {
        let mut values = BTreeMap::<_, [Option<String>; 2]>::new();
        let (mine, others) = (self.facts(), other.facts());
        let order: Vec<_> = mine.iter().chain(&others).map(|(name, _)| name.clone()).collect();
        for (side, facts) in [mine, others].into_iter().enumerate() {
            for (name, value) in facts {
                values.entry(name).or_default()[side] = Some(value);
            }
        }
        let compiled = self.shaders.is_some() && other.shaders.is_some();
        let differ = |name: &String| {
            let [a, b] = &values[name];
            a != b && (compiled || !name.ends_with("the shaders"))
        };
        let what = order.iter().find(|name| differ(name))?.clone();
        let nothing = || "nothing".to_owned();
        let values = values[&what].clone().map(|value| value.unwrap_or_else(nothing));
        Some(Difference { what, values })
    }
}
