//! Statistics from the device's own compiler, in its maker's words: folded until opened.

use egui::{CollapsingHeader, RichText, Ui};

use super::{rows, style};
use crate::gpu::Executable;

/// A line that unfolds to a table for each program; nothing if the driver reports nothing.
pub fn show(ui: &mut Ui, programs: &[Executable]) {
    if programs.is_empty() {
        return;
    }
    let title = format!("compiler: {} programs", programs.len());
    let title = if programs.len() == 1 { "compiler: 1 program".to_owned() } else { title };
    CollapsingHeader::new(RichText::new(title).small()).id_salt("compiler").show(ui, |ui| {
        for (number, program) in programs.iter().enumerate() {
            ui.label(RichText::new(&program.name).small());
            rows::grid(&format!("program {number}")).spacing([10.0, 1.0]).show(ui, |ui| {
                for (name, value) in &program.statistics {
                    ui.label(RichText::new(name).small().color(style::DIM));
                    ui.label(RichText::new(value.to_string()).small());
                    ui.end_row();
                }
            });
        }
    });
}
