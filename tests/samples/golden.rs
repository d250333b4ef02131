//! The picture of every chapter, compared with its golden one, `tests/golden/NAME.png`.
//!
//! The arguments and the size come from the chapter's table in `Cargo.toml`.

use manuscript::project::Project;
use run::{Chapter, chapters, needs, root};

/// Chapters whose own tests compare their picture with the golden one: those of other packages, and 27, whose
/// tolerance on another driver is measured.
const ELSEWHERE: [&str; 3] = ["24_accuracy", "25_scene_effects", "27_glass"];

/// Generates a test for each chapter, named like the module of its other tests.
macro_rules! golden {
    ($($module:ident,)*) => {
        const MODULES: &[&str] = &[$(stringify!($module)),*];

        $(
            #[test]
            fn $module() {
                compare(stringify!($module));
            }
        )*
    };
}

golden! {
    animation,
    any_hit,
    basic,
    callable_shader,
    curved_cones,
    depth_of_field,
    distant_spheres,
    emitters,
    environment,
    far_from_origin,
    filtered_checker,
    foundation,
    geometries,
    heightfield,
    history_and_filter,
    infinite_plane,
    instancing,
    intersection,
    jitter_camera,
    leaving_a_surface,
    lights,
    motion_blur,
    multi_closest_hit,
    normal_maps,
    opacity_micromaps,
    own_tree,
    path_tracing,
    position_fetch,
    primitive_order,
    ray_cones,
    ray_offset,
    ray_query,
    ray_query_raster,
    reflection,
    reservoirs,
    roots,
    rough_metal,
    sequences,
    shadow_miss,
    soft_shadows,
    solids,
    swept_spheres,
    two_normals,
    wireframe,
}

fn compare(module: &str) {
    let project = Project::open(&root()).expect("the project can be read");
    let chapter = project.chapter(module).expect("a chapter's module");
    if !chapter.needs.is_empty() {
        needs!(&chapter.name);
    }
    let golden: Vec<&str> = chapter.golden.iter().map(String::as_str).collect();
    Chapter::new(&chapter.name).size(chapter.golden_size()).with(&golden).is_golden();
}

#[test]
fn every_chapter_is_compared() {
    let project = Project::open(&root()).expect("the project can be read");
    let name = |module: &&str| project.chapter(module).expect("a chapter's module").name.clone();
    let mut compared: Vec<String> = MODULES.iter().map(name).collect();
    compared.extend(ELSEWHERE.map(str::to_owned));
    compared.sort();
    assert_eq!(compared, chapters());
}
