//! Measured values on pages: each is bound to a stored value next to it, or is part of a generated table.
//!
//! ````markdown
//! <!-- measure acne -->
//! ```sh
//! cargo test --test samples shadow_miss::acne
//! ```
//!
//! Of 59,050<!-- acne.lit --> lit pixels 26,950<!-- acne.dark --> go dark.
//!
//! <!-- table modes -->
//! … filled in by `chapters sync` from `docs/values/PAGE.md`
//! <!-- /table -->
//! ````
//!
//! A [`measurement`] is a command on a page. Its result ([`given`]) is stored as a [`record`]. A [`binding`]
//! names the value of a [`number`], and a [`table`] is generated from many. All other numbers are prose. See
//! `docs/chapters/values/README.md`.

pub mod binding;
pub mod budget;
pub mod given;
pub mod measurement;
pub mod number;
pub mod passage;
pub mod record;
pub mod stamp;
pub mod table;

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;

use record::Record;

/// Bound numbers that differ from the stored values, and measurements that are missing or have a new command.
pub fn check(project: &Project, pages: &[Page]) -> Vec<Fault> {
    let (stored, mut faults) = Record::all(project);
    let (measurements, wrong) = measurement::all(pages, &stored);
    faults.extend(wrong);
    // A damaged file has already been reported, and nothing on its page can be compared.
    let damaged: Vec<String> = faults.iter().map(|fault| fault.file.clone()).collect();
    let is_readable = |stem: &str| !damaged.contains(&record::file(stem));
    let readable = measurements.iter().filter(|m| is_readable(m.page_name()));
    faults.extend(readable.filter_map(|m| m.fault(stored.get(&m.name))));
    faults.extend(measurement::strays(project));
    let readable = pages.iter().filter(|page| is_readable(page.stem()));
    faults.extend(readable.flat_map(|page| binding::check(page, &stored)));
    faults.extend(table::strays(project, pages));
    faults.extend(budget::check(project));
    faults
}
