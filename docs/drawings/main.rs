//! Draws the ideas of the book: `cargo run -p drawings` writes all drawings to `docs/images`, and adds the
//! dark inks to the other SVGs.
//!
//! A drawing that shows data computes it: the hill, the solids and the triangles are real.

mod calls;
mod cones;
mod floats;
mod frame;
mod history;
mod lens;
mod lights;
mod march;
mod micro;
mod orders;
mod rays;
mod reservoir;
mod shadows;
mod shapes;
mod shutter;
mod squares;
mod structures;
mod surfaces;
mod table;
mod walk;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use drawings::{map, sheet};

/// A drawing's name, and the function that draws it.
type Drawing = (&'static str, fn() -> String);

const DRAWINGS: &[Drawing] = &[
    ("30_walk", walk::near_first),
    ("acceleration_structures", structures::two_levels),
    ("acne_and_leak", rays::acne_and_leak),
    ("address_chain", structures::address_chain),
    ("any_hit_order", calls::any_hit_order),
    ("barycentrics", rays::barycentrics),
    ("bent_cones", cones::bent),
    ("callable_calls", calls::callable_calls),
    ("camera_ray", rays::camera_ray),
    ("edge_plane", rays::edge_plane),
    ("disk_points", surfaces::disk_points),
    ("ellipse", cones::ellipse),
    ("footprint", rays::footprint),
    ("frame_barriers", frame::barriers),
    ("from_raster", rays::from_raster),
    ("heightfield_steps", march::steps),
    ("micro_bound", micro::bound),
    ("micro_order", micro::order),
    ("owen_scrambling", squares::scrambling),
    ("map", map::chapters),
    ("penumbra", shadows::penumbra),
    ("primitive_order", orders::quarters),
    ("refit", structures::refit),
    ("reprojection", history::reprojection),
    ("reservoir", reservoir::life),
    ("shadow_lift", shadows::lift),
    ("shader_binding_table", table::chapter_13),
    ("shader_calls", calls::shader_calls),
    ("shutter_methods", shutter::methods),
    ("shutter_times", shutter::times),
    ("slabs", shapes::slabs),
    ("slope_and_wall", surfaces::slope_and_wall),
    ("sphere_foot", shapes::foot),
    ("squashed_normals", surfaces::squashed_normals),
    ("swept", shapes::swept),
    ("solid_angles", lights::solid_angles),
    ("sobol_boxes", squares::boxes),
    ("solid_intervals", shapes::intervals),
    ("subtract_first", floats::subtract_first),
    ("table_of_foundation", table::chapter_01),
    ("table_of_shadow_miss", table::chapter_05),
    ("thin_lens", lens::thin_lens),
    ("trace_calls", calls::trace_calls),
    ("two_lights", shadows::two_lights),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../images")
}

/// Every SVG of the book: its file and its text.
fn all() -> std::io::Result<Vec<(PathBuf, String)>> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder())?.map(|file| Ok(file?.path())).collect::<std::io::Result<_>>()?;
    files.retain(|file| file.extension().is_some_and(|extension| extension == "svg"));
    files.sort();
    files.into_iter().map(|file| Ok((file.clone(), fs::read_to_string(file)?))).collect()
}

fn write_all() -> Result<(), String> {
    for (name, draw) in DRAWINGS {
        let file = folder().join(format!("{name}.svg"));
        fs::write(&file, draw()).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    for (file, text) in all().map_err(|error| format!("{}: {error}", folder().display()))? {
        let themed =
            drawings::themed(&text).map_err(|what| format!("{}: {what}", file.display()))?;
        if themed != text {
            fs::write(&file, themed).map_err(|error| format!("{}: {error}", file.display()))?;
        }
    }
    Ok(())
}

const USAGE: &str = "usage: cargo run -p drawings    write all drawings to docs/images";

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        None => (),
        Some("--help" | "-h") => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        Some(other) => {
            eprintln!("error: unexpected argument '{other}'; {USAGE}");
            return ExitCode::from(2);
        }
    }
    match write_all() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

#[test]
fn the_drawings_of_the_book_are_these() {
    for (name, draw) in DRAWINGS {
        let file = folder().join(format!("{name}.svg"));
        let found = fs::read_to_string(&file).unwrap_or_default();
        assert!(found == draw(), "{name}.svg is not what is drawn; run: cargo run -p drawings");
    }
}

#[test]
fn every_drawing_has_its_inks_by_dark() {
    let all = all().unwrap();
    assert!(all.len() >= DRAWINGS.len());
    for (file, text) in all {
        let themed = drawings::themed(&text);
        let themed = themed.unwrap_or_else(|what| panic!("{}: {what}", file.display()));
        let file = file.display();
        assert!(themed == text, "{file} lacks its inks by dark; run: cargo run -p drawings");
    }
}
