//! One declaration, four uses: a control is a row of the panel, a `--set` of a script or test, a row of
//! the table on the chapter's page, and a line of `--list-controls`.

mod elsewhere;
mod settings;
mod value;

use std::ops::RangeInclusive;

use anyhow::{Result, anyhow};
use glam::Vec3;

use super::Playback;
use super::chart::Chart;
use crate::gpu::ShaderEnum;
use crate::scene::{Camera, Sun};

pub use settings::{set, set_all, set_beside, try_to_set};
pub use value::Value;

/// A visitor that is shown every control in turn: the panel, a list, a setting.
pub trait Visit {
    /// Visits one control, may change its value, and returns whether it did.
    fn visit(&mut self, name: &str, value: Value) -> bool;

    /// Visits a line of information, such as what is in use; ignored by default.
    fn note(&mut self, _name: &str, _text: &str) {}

    /// Visits a control that has no effect now, and the setting it needs; ignored by default.
    fn idle(&mut self, _name: &str, _needs: &str) {}

    /// Visits the camera; by default as the controls a script can set.
    fn camera(&mut self, camera: &mut Camera) -> bool {
        visit_camera(self, camera)
    }

    /// Visits an animation's frame; by default as the controls a script can set.
    fn playback(&mut self, playback: &mut Playback) -> bool {
        let last = playback.last;
        self.visit("frame", Value::Integer(&mut playback.frame, 0..=last))
            | self.visit("play", Value::Checkbox(&mut playback.playing))
    }

    /// Visits a chart of the sample's measurements; only the panel has room for it.
    fn chart(&mut self, _: &Chart) {}
}

/// Visits a camera as the controls a script can set.
fn visit_camera<V: Visit + ?Sized>(visitor: &mut V, camera: &mut Camera) -> bool {
    let mut degrees = camera.fov_y as f32;
    let moved = visitor.visit("camera eye", Value::Point(&mut camera.eye))
        | visitor.visit("camera target", Value::Point(&mut camera.target));
    let zoomed = visitor.visit("field of view", Value::Slider(&mut degrees, Camera::FIELD_OF_VIEW));
    if zoomed {
        camera.fov_y = f64::from(degrees);
    }
    moved | zoomed
}

/// The set on which [`Sample::controls`](super::Sample::controls) declares its controls.
///
/// ```
/// use raybook::prelude::*;
///
/// /// In the panel, and for `--set "radius=0.5"`.
/// fn controls(c: &mut Controls, radius: &mut f32, camera: &mut Camera) {
///     c.slider("radius", radius, 0.1..=1.0);
///     c.camera(camera);
/// }
/// ```
///
/// Each method returns true if the value has just been changed.
pub struct Controls<'a> {
    visitor: &'a mut dyn Visit,
}

impl<'a> Controls<'a> {
    /// Controls as seen by `visitor`.
    pub fn new(visitor: &'a mut dyn Visit) -> Self {
        Self { visitor }
    }

    /// A number in a range.
    pub fn slider(&mut self, name: &str, value: &mut f32, range: RangeInclusive<f32>) -> bool {
        self.visitor.visit(name, Value::Slider(value, range))
    }

    /// A whole number in a range.
    pub fn integer(&mut self, name: &str, value: &mut u32, range: RangeInclusive<u32>) -> bool {
        self.visitor.visit(name, Value::Integer(value, range))
    }

    /// On or off.
    pub fn checkbox(&mut self, name: &str, value: &mut bool) -> bool {
        self.visitor.visit(name, Value::Checkbox(value))
    }

    /// A linear colour.
    pub fn color(&mut self, name: &str, value: &mut Vec3) -> bool {
        self.visitor.visit(name, Value::Color(value))
    }

    /// One of the words of an enumeration.
    pub fn choice<T: ShaderEnum>(&mut self, name: &str, value: &mut T) -> bool {
        let mut number = (*value).into();
        let changed = self.visitor.visit(name, Value::Choice(&mut number, T::LAYOUT.words));
        *value = T::ALL[number as usize];
        changed
    }

    /// One of a list of words known only at run time, stored as its position in the list.
    pub fn one_of(&mut self, name: &str, value: &mut u32, options: &[&str]) -> bool {
        self.visitor.visit(name, Value::Choice(value, options))
    }

    /// Three numbers, each in a range.
    pub fn vector(&mut self, name: &str, value: &mut Vec3, range: RangeInclusive<f32>) -> bool {
        self.visitor.visit(name, Value::Vector(value, range))
    }

    /// A direction: three numbers, each in a range, of any length except 0.
    pub fn direction(&mut self, name: &str, value: &mut Vec3, range: RangeInclusive<f32>) -> bool {
        self.visitor.visit(name, Value::Direction(value, range))
    }

    /// A line of information, shown in the panel; not a control.
    pub fn note(&mut self, name: &str, text: &str) {
        self.visitor.note(name, text);
    }

    /// Says that a control has an effect only with a setting such as `light=point`, and whether that holds: setting
    /// a control that has none is a warning.
    pub fn needs(&mut self, name: &str, setting: &str, holds: bool) {
        if !holds {
            self.visitor.idle(name, setting);
        }
    }

    /// A camera: moved with the mouse in a window, by three controls elsewhere.
    pub fn camera(&mut self, camera: &mut Camera) -> bool {
        self.visitor.camera(camera)
    }

    /// An animation: played, paused and stepped in a window, by two controls elsewhere.
    pub fn playback(&mut self, playback: &mut Playback) -> bool {
        self.visitor.playback(playback)
    }

    /// A sun: two angles place it.
    pub fn sun(&mut self, sun: &mut Sun) -> bool {
        self.slider("sun azimuth", &mut sun.azimuth, 0.0..=360.0)
            | self.slider("sun elevation", &mut sun.elevation, 0.0..=90.0)
    }

    /// A plot below the controls before it; nothing to set.
    pub fn chart(&mut self, chart: &Chart) {
        self.visitor.chart(chart);
    }
}

/// A control as `--list-controls` prints it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: &'static str,
    /// Its possible values.
    pub possible: String,
    /// Its current value.
    pub value: String,
}

impl Visit for Vec<Listed> {
    fn visit(&mut self, name: &str, value: Value) -> bool {
        let (kind, possible) = (value.kind(), value.possible());
        self.push(Listed { name: name.to_owned(), kind, possible, value: value.text() });
        false
    }
}

/// The controls that have no effect now, each with the setting it needs.
#[derive(Default)]
struct Idle(Vec<(String, String)>);

impl Visit for Idle {
    fn visit(&mut self, _: &str, _: Value) -> bool {
        false
    }

    fn idle(&mut self, name: &str, needs: &str) {
        self.0.push((name.to_owned(), needs.to_owned()));
    }
}

/// A warning for each of these controls that has no effect now.
pub fn without_effect<'a>(
    names: impl Iterator<Item = &'a str>,
    declare: impl FnOnce(&mut Controls),
) -> Vec<String> {
    let mut idle = Idle::default();
    declare(&mut Controls::new(&mut idle));
    let warning = |name: &str| {
        let (_, needs) = idle.0.iter().find(|(idle, _)| idle == name)?;
        Some(format!("control '{name}' has no effect here: it needs {needs}"))
    };
    names.filter_map(warning).collect()
}

/// Every control that `declare` declares.
pub fn list(declare: impl FnOnce(&mut Controls)) -> Vec<Listed> {
    let mut listed = Vec::new();
    declare(&mut Controls::new(&mut listed));
    listed
}

/// Controls as they are declared: names, and the first mistake.
#[derive(Default)]
struct Declared {
    names: Vec<String>,
    wrong: Option<String>,
}

impl Visit for Declared {
    fn visit(&mut self, name: &str, value: Value) -> bool {
        let wrong = if self.names.iter().any(|known| known == name) {
            Some(format!("two controls have the name '{name}': --set would find the first alone"))
        } else if name.trim().is_empty() || name.contains('=') {
            Some(format!("a control has the name '{name}'; --set \"NAME=VALUE\" could not name it"))
        } else if !value.is_possible() {
            let (now, possible) = (value.text(), value.possible());
            Some(format!("control '{name}' is declared with the value {now}; it takes {possible}"))
        } else {
            None
        };
        self.wrong = self.wrong.take().or(wrong);
        self.names.push(name.to_owned());
        false
    }
}

/// Checks that each control of those that `declare` declares has a name of its own and a possible value.
///
/// # Errors
/// Names the first that does not.
pub fn check(declare: impl FnOnce(&mut Controls)) -> Result<()> {
    let mut declared = Declared::default();
    declare(&mut Controls::new(&mut declared));
    declared.wrong.map_or(Ok(()), |wrong| Err(anyhow!(wrong)))
}

#[cfg(test)]
mod tests;
