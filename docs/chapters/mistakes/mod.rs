//! Classic mistakes: patches that make a chapter wrong, reproduced and held to what their files claim.

pub mod command;
pub mod mistake;
pub mod reproduction;
pub mod stages;
