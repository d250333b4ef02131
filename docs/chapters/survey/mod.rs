//! The survey: runs every chapter on a reader's device and writes the report card.

pub mod accuracy;
pub mod atlas;
pub mod card;
pub mod card_page;
mod chapter;
pub mod command;
mod faults;
mod price;
mod steps;
