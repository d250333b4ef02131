//! Pages: fills their generated blocks, and checks their statements.
//!
//! The top layer: it collects the other layers' parts of the [`book`]; none of them depends on it.

pub mod block;
pub mod book;
pub mod breath;
pub mod chapter_files;
pub mod exercise_list;
pub mod gallery;
pub mod glossary;
pub mod map;
pub mod markdown;
pub mod mention;
pub mod placeholder;
pub mod price;
pub mod reference;
pub mod run_command;
pub mod shared_shader;
pub mod stray_file;
pub mod test_command;
pub mod text;
