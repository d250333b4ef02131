//! Every chapter, rendered headless and small, under validation: one module a chapter.

mod animation;
mod any_hit;
mod bands;
mod basic;
mod callable_shader;
mod foundation;
mod glass;
mod heightfield;
mod infinite_plane;
mod instancing;
mod intersection;
mod jitter_camera;
mod leaving_a_surface;
mod long_renders;
mod multi_closest_hit;
mod path_tracing;
mod position_fetch;
mod ray_query;
mod ray_query_raster;
mod reflection;
mod settings;
mod shadow_miss;
mod slivers;
mod solids;
mod wireframe;
mod worst;
