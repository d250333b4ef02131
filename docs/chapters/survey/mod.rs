//! The survey: every chapter on a reader's device, and the report card that comes of it.

pub mod accuracy;
pub mod atlas;
pub mod card;
pub mod card_page;
pub mod command;
