//! What a run of a chapter's program gave, and how far two pictures are apart.

use std::fs;
use std::process::{Command, ExitStatus};

use anyhow::Result;
use common::app::Picture;
use common::files::Folder;
use patience::Limit;
use serde_json::Value;

use super::child;

/// What a run gave.
#[derive(Default)]
pub struct Seen {
    /// The floats that the shader wrote; `None` if there is no picture.
    pub picture: Option<Picture>,
    /// `None` if it did not end.
    pub status: Option<ExitStatus>,
    /// What it said on standard error, in one line.
    pub said: String,
    /// What it said on standard output.
    pub told: String,
    /// Its report; null if there is none.
    pub report: Value,
}

impl Seen {
    /// Runs a program headless and under validation, and no longer than it may take.
    ///
    /// # Errors
    /// If it does not start.
    pub fn of(mut command: Command, arguments: &[String], limit: Limit) -> Result<Self> {
        let folder = Folder::temporary()?;
        let (out, report) = (folder.path().join("out.exr"), folder.path().join("report.json"));
        command.args(["--headless", "--validate"]).args(arguments);
        command.arg("--out").arg(&out).arg("--report").arg(&report);
        let ended = child::run(&mut command, limit)?;
        let said = ended.said.trim().replace('\n', " ");
        Ok(Self {
            picture: Picture::open_exr(&out).ok(),
            status: ended.status,
            said: said.trim_start_matches("error: ").to_owned(),
            told: ended.told,
            report: fs::read(&report)
                .ok()
                .and_then(|text| serde_json::from_slice(&text).ok())
                .unwrap_or_default(),
        })
    }

    /// What validation said.
    pub fn messages(&self) -> Vec<&str> {
        let messages = self.report["validation_messages"].as_array().into_iter().flatten();
        messages.map(|message| message.as_str().unwrap_or_default()).collect()
    }

    /// The device's time for a frame, in milliseconds.
    pub fn milliseconds(&self) -> f64 {
        self.report["gpu_milliseconds"]["median"].as_f64().unwrap_or_default()
    }

    /// The device's name.
    pub fn device(&self) -> &str {
        self.report["device"].as_str().unwrap_or("unknown")
    }
}

/// Whether the device of this name is a software driver, by the list that a chapter's program prints.
///
/// # Errors
/// If the program does not start.
pub fn is_software(mut program: Command, device: &str, limit: Limit) -> Result<bool> {
    let listed = child::run(program.arg("--list-devices"), limit)?.told;
    let line = format!(": {device} (software;");
    Ok(listed.lines().any(|listed| listed.contains(&line)))
}

/// The mean difference of all channels as a PNG would have them, of 1.
pub fn mean_difference(a: &Picture, b: &Picture) -> f64 {
    let (a, b) = (a.srgb(), b.srgb());
    let sum: u64 = a.iter().zip(&b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / 255.0 / a.len().max(1) as f64
}

/// How many pixels differ as a PNG would have them.
pub fn pixels_apart(a: &Picture, b: &Picture) -> usize {
    let (a, b) = (a.srgb(), b.srgb());
    a.chunks(3).zip(b.chunks(3)).filter(|(a, b)| a != b).count()
}

/// Whether two pictures are the same to the bit.
pub fn same_bits(a: &Picture, b: &Picture) -> bool {
    let bits = |picture: &Picture| -> Vec<[u32; 4]> {
        picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    (a.width, a.height) == (b.width, b.height) && bits(a) == bits(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_and_white_are_one_apart() {
        let plain = |value| Picture { width: 3, height: 2, pixels: vec![[value; 4]; 6] };
        assert_eq!(mean_difference(&plain(0.0), &plain(1.0)), 1.0);
        assert_eq!(mean_difference(&plain(0.3), &plain(0.3)), 0.0);
        let mut spot = plain(0.3);
        spot.pixels[4][1] = 0.7;
        assert_eq!(pixels_apart(&plain(0.3), &spot), 1);
        // Less than a step of 255: another float, the same pixel of a PNG.
        spot.pixels[4][1] = 0.300_000_1;
        assert_eq!(pixels_apart(&plain(0.3), &spot), 0);
        assert!(!same_bits(&plain(0.3), &spot) && same_bits(&spot, &spot));
    }
}
