//! Report cards as Markdown: one alone, and all of them as a table.

use std::fmt::Write as _;

use super::card::{Card, ChapterResult, Device, HardCase, HardCases};
use super::faults::FaultRow;
use super::price::Price;

/// The limits of a device in a line.
fn limits(Device { limits, .. }: &Device) -> String {
    let yes = |offered: bool| if offered { "yes" } else { "no" };
    format!(
        "recursion {}; rays a trace {}; push constants {} bytes; shader binding table in {} bytes; scratch \
         in {} bytes; textures {}; buffer {} bytes; primitives {}; instances {}; image side {}; \
         64-bit floats {}; rounding to nearest even {}; signed zeros, infinities and NaN {}; \
         primitive culling {}; nanoseconds a tick {}",
        limits.max_ray_recursion_depth,
        limits.max_ray_dispatch_invocation_count,
        limits.max_push_constants_size,
        limits.shader_group_base_alignment,
        limits.min_scratch_offset_alignment,
        limits.max_textures,
        limits.max_buffer_size,
        limits.max_primitive_count,
        limits.max_instance_count,
        limits.max_image_dimension,
        yes(limits.float64),
        yes(limits.rounding_to_nearest_even),
        yes(limits.signed_zero_inf_nan),
        yes(limits.primitive_culling),
        limits.timestamp_period,
    )
}

fn vulkan(device: &Device) -> String {
    device.vulkan.map(|part| part.to_string()).join(".")
}

/// The result of a chapter, in a word or a line.
fn result(chapter: &ChapterResult) -> String {
    match (&chapter.failed, &chapter.lacks) {
        (Some(why), _) => why.replace('|', "\\|"),
        (None, Some(lacks)) => format!("not run: the device lacks {lacks}"),
        (None, None) => "passes".to_owned(),
    }
}

/// One card.
pub fn card(card: &Card) -> String {
    let mut text = format!("# {}\n\n", card.device.as_ref().map_or("No device", |d| &d.name));
    text.push_str("| | |\n|---|---|\n");
    let mut line = |name: &str, what: &str| {
        let _ = writeln!(text, "| {name} | {} |", what.replace('|', "\\|"));
    };
    if let Some(device) = &card.device {
        let [vendor, id] = device.limits.vendor_and_device;
        line("driver", &device.driver);
        line("vendor and device", &format!("{vendor:#06x}, {id:#06x}"));
        line("Vulkan", &vulkan(device));
        line("limits", &limits(device));
    }
    line("system", &card.system);
    line("date", &card.date);
    line("commit", card.commit.as_deref().unwrap_or("unknown"));
    let validation = match (&card.device, card.validated) {
        (None, _) => "nothing ran",
        (_, true) => "on",
        (_, false) => "not installed",
    };
    line("validation", validation);
    if card.chapters.is_empty() {
        return text;
    }
    line("chapters that pass", &format!("{} of {}", card.passed(), card.offered()));
    line("hard cases", &top(&card.hard_cases));
    line("known faults", &seen(&card.faults));
    if !card.left_out.is_empty() {
        line("left out, because three minutes were over", &card.left_out.join(", "));
    }
    let _ = write!(
        text,
        "\nA picture passes if its mean FLIP error against the golden one is at most what Vulkan lets the device \
         round; on the software driver of Mesa 25.0.7, which made it, at most {}.",
        card.tolerance
    );
    if card.full {
        let _ = write!(text, " Times are of {} pixels.", card.timed);
    }
    text.push_str("\n\n| chapter | result | mean FLIP | at most | messages |");
    text.push_str(if card.full {
        " GPU ms | device's compiler | RADV, RDNA 3: instructions, registers, spilled |\n\
         |---|---|--:|--:|--:|--:|---|---|\n"
    } else {
        "\n|---|---|--:|--:|--:|\n"
    });
    for chapter in &card.chapters {
        let number = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"))
        };
        let _ = write!(
            text,
            "| {} | {} | {} | {} | {} |",
            chapter.name,
            result(chapter),
            number(chapter.mean_flip.map(f64::from), 5),
            number(chapter.tolerance.map(f64::from), 5),
            chapter.validation_messages,
        );
        if card.full {
            let milliseconds = number(chapter.milliseconds, 2);
            let _ = write!(text, " {milliseconds} | {} | {} |", compiler(chapter), radv(chapter));
        }
        text.push('\n');
    }
    text.push_str(&hard_cases(&card.hard_cases));
    text.push_str(&faults(&card.faults));
    text.push_str(&prices(&card.prices));
    if card.full {
        text.push_str(&measured(card));
    }
    text
}

/// The atlas as Markdown, below a card's other sections.
pub fn atlas(text: &str) -> String {
    // Its title becomes a section, and its sections become subsections.
    format!("\n#{}", text.replace("\n## ", "\n### "))
}

/// The figures of the device's compiler, summed over a chapter's programs.
fn compiler(chapter: &ChapterResult) -> String {
    let mut sums: Vec<(&str, f64)> = Vec::new();
    for (name, value) in chapter.compiler.iter().flat_map(|program| &program.statistics) {
        match sums.iter_mut().find(|(known, _)| known == name) {
            Some((_, sum)) => *sum += value,
            None => sums.push((name, *value)),
        }
    }
    let counted = sums.iter().map(|(name, sum)| format!("{name} {sum}"));
    let words = counted.collect::<Vec<_>>().join("; ").replace('|', "\\|");
    if words.is_empty() { "–".to_owned() } else { words }
}

/// The figures of RADV: sums, and the most registers of a program.
fn radv(chapter: &ChapterResult) -> String {
    if chapter.radv.is_empty() {
        return "–".to_owned();
    }
    let instructions: u64 = chapter.radv.iter().map(|program| program.instructions).sum();
    let registers = chapter.radv.iter().map(|program| program.registers).max().unwrap_or(0);
    let spilled: u64 = chapter.radv.iter().map(|program| program.spilled_registers).sum();
    format!("{instructions}, {registers}, {spilled}")
}

/// The number of right answers of the top rungs.
fn top(table: &HardCases) -> String {
    let HardCases { failed, right, cases, missing, .. } = table;
    match (failed, missing) {
        (Some(why), _) => why.clone(),
        (None, 0) => format!("top rungs right {right} of {cases}"),
        (None, _) => format!("top rungs right {right} of {cases}, {missing} rungs not offered"),
    }
}

/// The number of known faults that the device has.
fn seen(faults: &[FaultRow]) -> String {
    match faults.iter().filter(|row| row.is_seen()).count() {
        _ if faults.is_empty() => "not looked for".to_owned(),
        0 => "none seen".to_owned(),
        count => format!("{count} seen"),
    }
}

fn faults(rows: &[FaultRow]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut text =
        "\n## Known faults of drivers\n\n| circumstances | result |\n|---|---|\n".to_owned();
    for row in rows {
        let _ = writeln!(text, "| {} | {} |", row.what, row.result().replace('|', "\\|"));
    }
    text
}

fn prices(rows: &[Price]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut text = "\n## What accuracy costs\n\n\
                    | time of the accurate way, divided by that of the simple one | ratio | middle half |\n\
                    |---|--:|--:|\n"
        .to_owned();
    for Price { what, ratio, quartiles, failed } in rows {
        let ratio = ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
        let middle = match (failed, quartiles) {
            (Some(why), _) => why.replace('|', "\\|"),
            (None, Some([low, high])) => format!("{low:.2} to {high:.2}"),
            (None, None) => "–".to_owned(),
        };
        let _ = writeln!(text, "| {what} | {ratio} | {middle} |");
    }
    text
}

fn hard_cases(table: &HardCases) -> String {
    let mut text = "\n## Hard cases\n\n".to_owned();
    if let Some(why) = &table.failed {
        let _ = writeln!(text, "{why}\n");
    }
    if table.rungs.is_empty() {
        return text;
    }
    text.push_str("| primitive | rung | way | right |\n|---|---|---|---|\n");
    for HardCase { primitive, rung, name, way, top, cases, right, unavailable } in &table.rungs {
        let mark = if *top { ", top" } else { "" };
        let right = match unavailable {
            Some(why) => why.replace('|', "\\|"),
            None => format!("{right} of {cases}"),
        };
        let _ = writeln!(text, "| {primitive} | {rung} {name}{mark} | {way} | {right} |");
    }
    text
}

fn measured(card: &Card) -> String {
    let mut text = "\n## Random rays\n\n".to_owned();
    if let Some(why) = &card.measured.failed {
        return text + why + "\n";
    }
    text.push_str(
        "| primitive | rung | worst, ULP | wrong hits and misses | time, plain rung 1 (and its quartiles) |\n",
    );
    text.push_str("|---|---|--:|--:|--:|\n");
    for row in &card.measured.rungs {
        let ratio = match (row.time_ratio, row.time_quartiles) {
            (Some(ratio), Some([low, high])) => format!("{ratio:.2} ({low:.2} to {high:.2})"),
            (Some(ratio), None) => format!("{ratio:.2}"),
            (None, _) => "–".to_owned(),
        };
        let _ = writeln!(
            text,
            "| {} | {} {} | {:.1} | {} | {ratio} |",
            row.primitive, row.rung, row.name, row.worst_ulp, row.wrong
        );
    }
    text
}

/// All cards, one row per device.
pub fn devices(cards: &[Card]) -> String {
    let mut text = "| device | driver | Vulkan | system | chapters that pass | hard cases | validation | date |\n\
                    |---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for card in cards.iter().filter(|card| !card.chapters.is_empty()) {
        let Some(device) = &card.device else { continue };
        let failing = card.chapters.iter().filter(|chapter| chapter.failed.is_some());
        let failing: Vec<String> =
            failing.map(|chapter| format!("{}: {}", chapter.name, result(chapter))).collect();
        let mut passed = format!("{} of {}", card.passed(), card.offered());
        let lacking = card.chapters.iter().filter_map(|c| Some((&c.name[..2], c.lacks.as_ref()?)));
        for (number, lacks) in lacking {
            passed += &format!("; {number} needs {lacks}");
        }
        if !failing.is_empty() {
            passed += &format!("; {}", failing.join("; "));
        }
        let cells = [
            device.name.clone(),
            device.driver.clone(),
            vulkan(device),
            card.system.clone(),
            passed,
            top(&card.hard_cases),
            if card.validated { "on" } else { "not installed" }.to_owned(),
            card.date.clone(),
        ];
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::card::{Measured, MeasuredRung};

    /// Without quartiles, only the median is shown.
    #[test]
    fn a_time_has_its_quartiles() {
        let rung = |time_ratio, time_quartiles| MeasuredRung {
            primitive: "plane".to_owned(),
            rung: "P0".to_owned(),
            time_ratio,
            time_quartiles,
            ..MeasuredRung::default()
        };
        for (ratio, quartiles, cell) in [
            (Some(2.0), Some([1.951, 2.1]), "| 2.00 (1.95 to 2.10) |"),
            (Some(2.0), None, "| 2.00 |"),
            (None, None, "| – |"),
        ] {
            let rungs = vec![rung(ratio, quartiles)];
            let card = Card { measured: Measured { failed: None, rungs }, ..Card::default() };
            assert!(measured(&card).ends_with(&format!("{cell}\n")), "{}", measured(&card));
        }
    }
}
