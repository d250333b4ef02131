//! Measurements as the page shows them.

use std::fmt::Write as _;

use crate::compiled;
use crate::geometry::Form;
use crate::hard::short;
use crate::ladder::Primitive;
use crate::measurement::{Errors, MeasuredRung, Measurement, Time};

impl Measurement {
    /// Markdown tables of each primitive: time beside the home family's error, a compiler's estimates, and
    /// every family.
    pub fn markdown(&self) -> String {
        let Self { device, driver, arithmetic, date, rays, .. } = self;
        let mut text = format!("{device} · {driver} · {date} · {rays} rays a family");
        if arithmetic != "driver" {
            let _ = write!(text, " · arithmetic {arithmetic}");
        }
        if self.rounds > 0 {
            let _ = write!(text, " · {} rounds", self.rounds);
        }
        text += "\n";
        match (&self.compiler, &self.no_compiler) {
            (Some(compiler), _) => {
                let _ = writeln!(
                    text,
                    "\nEstimates, which are no times: {compiler} for navi21, navi31, gfx1201."
                );
            }
            (None, Some(why)) => {
                let _ = writeln!(text, "\nNo estimates: {why}.");
            }
            (None, None) => {}
        }
        let mut rungs = self.rungs.as_slice();
        while let Some(first) = rungs.first() {
            let count = rungs.iter().take_while(|row| row.primitive == first.primitive).count();
            let (ladder, rest) = rungs.split_at(count);
            rungs = rest;
            let mut name = first.primitive.to_owned();
            name[..1].make_ascii_uppercase();
            let _ = write!(text, "\n### {name}\n\n");
            text += &times(ladder);
            text += "\n";
            text += &compiled::table(ladder);
            text += &marches(ladder);
            let is_about_t = first.primitive != Primitive::SecondaryOrigin.name();
            text += &if is_about_t { errors(ladder) } else { departures(ladder) };
        }
        if !self.forms.is_empty() {
            text += "\n### The price of geometry\n\n";
            text += &forms(&self.forms);
        }
        text += &self.disagreements();
        text
    }
}

fn times(ladder: &[MeasuredRung]) -> String {
    let home = ladder.iter().find_map(|row| row.errors.first()).map_or("", |e| e.family);
    let mut text = String::from(
        "| rung | time / cheapest | middle half | million a second | p50, ULP | p99, ULP | wrong |\n\
         |---|---|---|---|---|---|---|\n",
    );
    let (mut noise, mut asked) = (None, 1);
    for row in ladder {
        let MeasuredRung { rung, name, unavailable, errors, time, .. } = row;
        if let Some(why) = unavailable {
            let _ = writeln!(text, "| {rung} {name} | unavailable: {why} | | | | | |");
            continue;
        }
        let Some(error) = errors.iter().find(|error| error.family == home) else { continue };
        let (p50, p99, wrong) = (short(error.p50), short(error.p99), error.wrong());
        let timed = match time {
            Some(Time { millions_a_second, ratio, noise: floor, copies }) => {
                (noise, asked) = (Some(*floor), *copies);
                let (low, high) = (ratio.low, ratio.high);
                let rate = short(*millions_a_second);
                format!("{:.2} | {low:.2} to {high:.2} | {rate}", ratio.median)
            }
            None => " | | ".to_owned(),
        };
        let _ = writeln!(text, "| {rung} {name} | {timed} | {p50} | {p99} | {wrong} |");
    }
    if let Some(noise) = noise {
        let (low, high, shape) = (noise.low, noise.high, ladder[0].primitive);
        let _ = writeln!(
            text,
            "| the cheapest {shape} again (noise) | {:.2} | {low:.2} to {high:.2} | | | | |",
            noise.median
        );
    }
    let _ = writeln!(text, "\nThe errors above are those of the family *{home}*.");
    if asked > 1 {
        let _ = writeln!(
            text,
            "{asked} invocations at once asked each ray, so that the device was full."
        );
    }
    text
}

/// Time of every family, where it depends on the rays.
fn marches(ladder: &[MeasuredRung]) -> String {
    let families: Vec<_> = ladder[0].marches.iter().map(|march| march.family).collect();
    if families.is_empty() {
        return String::new();
    }
    let mut text = String::from("| time / cheapest |");
    for row in ladder {
        let _ = write!(text, " {} {} |", row.rung, row.name);
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(ladder.len()));
    for (i, family) in families.iter().enumerate() {
        let _ = write!(text, "| {family} |");
        for row in ladder {
            let ratio = row.marches.get(i).map_or(f64::NAN, |march| march.ratio.median);
            let _ = write!(text, " {ratio:.2} |");
        }
        text += "\n";
    }
    text + "\n"
}

fn errors(ladder: &[MeasuredRung]) -> String {
    let mut text = String::from(
        "| family | rung | way | p50 | p99 | largest, ULP | false misses | false hits | never offered |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let families: Vec<_> = ladder.iter().flat_map(|row| &row.errors).map(|e| e.family).collect();
    let mut seen = Vec::new();
    for family in families {
        if seen.contains(&family) {
            continue;
        }
        seen.push(family);
        for row in ladder {
            let errors: Vec<_> = row.errors.iter().filter(|e| e.family == family).collect();
            for error in &errors {
                if error.way == "traced"
                    && errors.iter().any(|e| e.way == "direct" && e.same(error))
                {
                    continue;
                }
                let Errors { way, p50, p99, max, false_misses, false_hits, never_offered, .. } =
                    error;
                let (p50, p99, max) = (short(*p50), short(*p99), short(*max));
                let _ = writeln!(
                    text,
                    "| {family} | {} | {way} | {p50} | {p99} | {max} | {false_misses} | {false_hits} \
                     | {never_offered} |",
                    row.rung
                );
            }
        }
    }
    text + "\nTraced rays are listed only where their figures differ from those of direct rays.\n"
}

/// For rays that leave a surface, the only errors are to hit it again, or to miss a close surface.
fn departures(ladder: &[MeasuredRung]) -> String {
    let families = ladder.iter().find(|row| !row.errors.is_empty());
    let families: Vec<_> =
        families.into_iter().flat_map(|row| &row.errors).map(|error| error.family).collect();
    let mut text = String::from("| family | rays |");
    for row in ladder {
        let _ = write!(text, " {} {} |", row.rung, row.name);
    }
    text += "\n|---|---|";
    text += &"---|".repeat(ladder.len());
    text += "\n";
    for (i, family) in families.iter().enumerate() {
        let _ = write!(text, "| {family} | {} |", ladder[0].errors[i].rays);
        for row in ladder {
            let _ = write!(text, " {} |", row.errors.get(i).map_or(0, Errors::wrong));
        }
        text += "\n";
    }
    text + "\nRays that met the sphere again, or passed the plane in the gap.\n"
}

/// The sphere and what is nearly one.
fn forms(forms: &[Form]) -> String {
    let mut text = String::from(
        "| a sphere as | pixels lost of a million | deepest, pixels | p99 of the distance, radii | bytes \
         | build, ms | time |\n|---|---|---|---|---|---|---|\n",
    );
    for Form { name, lost, depth, p99, bytes, build_milliseconds, ratio, .. } in forms {
        let time = ratio.map_or(String::new(), |ratio| format!("{:.2}", ratio.median));
        let _ = writeln!(
            text,
            "| {name} | {lost:.0} | {depth:.2} | {p99:.1e} | {bytes} | {build_milliseconds:.2} | {time} |"
        );
    }
    text
}

impl Errors {
    /// Tests for the same result, whatever the way to it.
    fn same(&self, other: &Self) -> bool {
        let Self { p50, p99, max, false_hits, false_misses, never_offered, .. } = *self;
        let errors = [p50, p99, max] == [other.p50, other.p99, other.max];
        errors
            && [false_hits, false_misses, never_offered]
                == [other.false_hits, other.false_misses, other.never_offered]
    }

    /// Hits that are misses and misses that are hits, the device's own left out.
    pub fn wrong(&self) -> usize {
        self.false_hits + self.false_misses
    }
}
