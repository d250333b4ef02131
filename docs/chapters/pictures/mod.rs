//! The pages' pictures: rendered by the commands printed on the pages, and stamped with their maker.

pub mod difference;
pub mod downscale;
pub mod picture;
pub mod rendering;
pub mod stamp;
pub mod tour;
