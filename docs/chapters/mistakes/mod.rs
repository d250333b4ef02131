//! Classic mistakes: patches that make a chapter wrong, reproduced and compared with the claims in their
//! files.

pub mod command;
pub mod mistake;
pub mod reproduction;
pub mod stages;
