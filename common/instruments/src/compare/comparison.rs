//! The result of `--compare`, and its table.

use serde::Serialize;

use super::LEAST;
use super::error::PictureError;

/// A control's values, measured relative to the first.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Comparison {
    /// The control.
    pub control: String,
    /// Number of rounds that were timed, after some frames of warm-up.
    pub rounds: u32,
    /// Number of frames rendered, including the warm-up.
    pub frames: u32,
    /// The size of the picture, if the device is too fast for the requested one.
    pub widened: Option<[u32; 2]>,
    /// The first value relative to itself.
    pub noise: Ratio,
    /// The picture that `--against` names.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// Each value, in the order given.
    pub values: Vec<Measured>,
}

/// The time of one value.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Measured {
    /// The control's value.
    pub value: String,
    /// The median of the device times of a frame, in milliseconds.
    pub milliseconds: f64,
    /// Its time divided by the first value's in the same round.
    pub ratio: Ratio,
    /// The error of its picture after some numbers of frames, in ascending order; empty without `--against`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<PictureError>,
    /// The number of its frames in the time that the fastest value takes for all of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frames_in_equal_time: Option<u32>,
}

/// Quartiles of the rounds' ratios.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Ratio {
    /// A quarter of the rounds are below.
    pub low: f64,
    /// The median.
    pub median: f64,
    /// A quarter of the rounds are above.
    pub high: f64,
}

impl Ratio {
    pub(super) fn of(mut ratios: Vec<f64>) -> Self {
        ratios.sort_by(f64::total_cmp);
        let at = |part: usize| ratios.get(ratios.len() * part / 4).copied().unwrap_or_default();
        Self { low: at(1), median: at(2), high: at(3) }
    }
}

impl Comparison {
    /// The comparison as a Markdown table, for the pages.
    pub fn table(&self) -> String {
        let first = self.values.first().map_or("", |measured| &measured.value);
        let mut table = format!(
            "| {} | GPU ms | time / {first} | middle half of {} rounds |\n|---|---|---|---|\n",
            self.control, self.rounds
        );
        let mut row = |name: &str, milliseconds: String, ratio: Ratio| {
            let Ratio { low, median, high } = ratio;
            table +=
                &format!("| {name} | {milliseconds} | {median:.2} | {low:.2} to {high:.2} |\n");
        };
        for Measured { value, milliseconds, ratio, .. } in &self.values {
            row(value, format!("{milliseconds:.1}"), *ratio);
        }
        row(&format!("{first} again (noise)"), String::new(), self.noise);
        if let Some([width, height]) = self.widened {
            table += &format!(
                "\n> Launches were widened to {width}x{height}, for one of the size asked for takes less than {LEAST} \
                 ms: too little to be timed.\n"
            );
        }
        self.add_errors(&mut table);
        table
    }

    /// Appends the errors, if there is a reference.
    fn add_errors(&self, table: &mut String) {
        let Some(reference) = &self.reference else { return };
        let of = |error: Option<&PictureError>| {
            let [rmse, relative] = error.map_or([f64::NAN; 2], |it| [it.rmse, it.relative]);
            format!("{rmse:.4} | {relative:.4}")
        };
        *table += &format!(
            "\n| {} | RMSE | relative error | frames in equal time | RMSE | relative error |\n\
             |---|---|---|---|---|---|\n",
            self.control
        );
        for measured in &self.values {
            let frames = measured.frames_in_equal_time.unwrap_or_default();
            let equal = measured.errors.iter().find(|error| error.frames == frames);
            let (all, equal) = (of(measured.errors.last()), of(equal));
            *table += &format!("| {} | {all} | {frames} | {equal} |\n", measured.value);
        }
        *table += &format!(
            "\n> Errors of {} frames against {reference}, and of as many as fit into the time of the fastest value.\n",
            self.rounds
        );
    }
}
