//! The pages' pictures: rendered by the commands that the pages print, and stamped with what made them.

pub mod difference;
pub mod downscale;
pub mod picture;
pub mod rendering;
pub mod stamp;
pub mod tour;
