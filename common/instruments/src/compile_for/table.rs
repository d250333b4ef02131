//! The statistics as tables, readable as text and as Markdown.

use std::fmt::Write as _;

use super::card;
use super::family::Family;
use super::figures::{CompiledFor, Figures, Intel, Radeon};

/// A table for each maker's compiler, and a line for what could not be compiled.
pub fn table(family: Family, rows: &[CompiledFor]) -> String {
    let (mut radeon, mut intel) = (String::new(), String::new());
    for row in rows {
        let begin =
            format!("| {} | {} | {} | {} |", row.family, row.pipeline, row.executable, row.stage);
        match &row.figures {
            Figures::Radeon(figures) => radeon += &(begin + &of_radeon(row.instructions, figures)),
            Figures::Intel(figures) => intel += &(begin + &of_intel(row.instructions, figures)),
        }
    }
    let mut text = String::new();
    let mut add = |head: &str, table: &str, maker: &str| {
        let of_maker = |row: &&CompiledFor| row.radeon().is_some() == (maker == "AMD");
        let Some(row) = rows.iter().find(of_maker) else { return };
        let blank = if text.is_empty() { "" } else { "\n" };
        let _ = writeln!(
            text,
            "{blank}| family | pipeline | program | stage | {head}\n{table}\n\
             Estimates of a compiler for {maker} GPUs, {}: comparable between programs of one shape, no times.",
            row.compiler
        );
    };
    add(
        "registers | spilled | scratch, bytes | code, bytes | instructions | waves | latency | inverse throughput |\n\
         |---|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|",
        &radeon,
        "AMD",
    );
    add(
        "SIMD | instructions | sends | live registers | spills | fills |\n\
         |---|---|---|---|--:|--:|--:|--:|--:|--:|",
        &intel,
        "Intel",
    );
    if !intel.is_empty() {
        text +=
            "Of a shader that traces, this compiler counts only what precedes its first trace.\n";
    }
    if family == Family::All && intel.is_empty() {
        let why = card::why_no_intel().unwrap_or_default();
        let _ = writeln!(text, "\ndg2 and bmg are left out: {why}");
    }
    text
}

fn of_radeon(instructions: u64, figures: &Radeon) -> String {
    format!(
        " {} | {} | {} | {} | {instructions} | {} of {} | {} | {} |\n",
        figures.registers,
        figures.spilled_registers,
        figures.scratch_bytes,
        figures.code_bytes,
        figures.waves,
        figures.wave_size,
        figures.latency,
        figures.inverse_throughput
    )
}

fn of_intel(instructions: u64, figures: &Intel) -> String {
    format!(
        " {} | {instructions} | {} | {} of {} | {} | {} |\n",
        figures.simd,
        figures.sends.map_or_else(|| "–".to_owned(), |sends| sends.to_string()),
        figures.live_registers,
        figures.of_registers,
        figures.spills,
        figures.fills
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(family: &'static str, figures: Figures) -> CompiledFor {
        let [pipeline, executable, stage] = ["02_basic", "raygen", "raygen"].map(str::to_owned);
        let compiler = "Mesa 25.0.7".to_owned();
        CompiledFor { family, compiler, pipeline, executable, stage, instructions: 562, figures }
    }

    #[test]
    fn each_maker_has_a_table_and_what_is_left_out_a_line() {
        let radeon = row("navi31", Figures::Radeon(Radeon::default()));
        let figures =
            Intel { simd: 16, live_registers: 206, of_registers: 256, ..Intel::default() };
        let intel = row("bmg", Figures::Intel(figures));
        let both = table(Family::All, &[radeon.clone(), intel]);
        let line = "| bmg | 02_basic | raygen | raygen | 16 | 562 | – | 206 of 256 | 0 | 0 |";
        assert!(both.contains(line) && both.contains("for Intel GPUs, Mesa 25.0.7"), "{both}");
        assert!(!both.contains("left out"), "{both}");
        let one = table(Family::All, std::slice::from_ref(&radeon));
        // The reason is this machine's.
        assert!(one.contains("\ndg2 and bmg are left out: "), "{one}");
        assert!(!table(Family::Navi31, &[radeon]).contains("left out"));
    }
}
