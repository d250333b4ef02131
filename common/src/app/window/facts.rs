//! Facts about the run, shown in the panel and the title.

use crate::gpu::Executable;

/// Facts about the run, shown in the panel.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// The sample's name.
    pub name: String,
    /// The device's name.
    pub device: String,
    /// True for a driver that runs on the CPU.
    pub software: bool,
    /// The name of its arithmetic.
    pub arithmetic: &'static str,
    /// Device time of the last picture, in milliseconds.
    pub milliseconds: f64,
    /// The parts of that time, by name, if the sample has passes.
    pub parts: Vec<(&'static str, f64)>,
    /// The last picture's width and height.
    pub rendered: [u32; 2],
    /// The window's.
    pub full: [u32; 2],
    /// Number of accumulated pictures, if the sample accumulates.
    pub accumulated: Option<u32>,
    /// Warnings about likely mistakes in the current picture.
    pub warnings: Vec<String>,
    /// The driver's statistics for the programs of the newest pipeline, if it offers them.
    pub programs: Vec<Executable>,
}

impl Facts {
    /// Primary rays per second.
    pub fn rays(&self) -> f64 {
        let [width, height] = self.rendered.map(f64::from);
        if self.milliseconds > 0.0 { width * height / self.milliseconds * 1e3 } else { 0.0 }
    }

    /// The window's title.
    pub fn title(&self) -> String {
        let kind = if self.software { ", software" } else { "" };
        let kind = match self.arithmetic {
            "driver" => kind.to_owned(),
            other => format!("{kind} · arithmetic {other}"),
        };
        let (name, device) = (&self.name, &self.device);
        format!("{name} · {device}{kind} · {:.1} ms · {}", self.milliseconds, rays(self.rays()))
    }
}

/// A rate in words.
pub fn rays(rate: f64) -> String {
    match rate {
        rate if rate >= 1e9 => format!("{:.2} Grays/s", rate * 1e-9),
        rate => format!("{:.2} Mrays/s", rate * 1e-6),
    }
}
