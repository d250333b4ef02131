//! Figures: the numbers on pages, and the measurements that gave them.
//!
//! A page's [`passage`]s have [`number`]s. Its comments bind each to a value ([`binding`]) of a [`record`], which
//! a [`measurement`] renews. `docs/chapters/figures/README.md` tells authors how.

pub mod binding;
pub mod device_note;
pub mod figure;
pub mod measurement;
pub mod number;
pub mod passage;
pub mod record;
pub mod stamp;
pub mod values;

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;

use crate::sources::hash::Sources;
use record::Record;

/// Figures that are not what was measured, and measurements that are out of date.
pub fn check(project: &Project, pages: &[Page], sources: &mut Sources) -> Vec<Fault> {
    let (stored, mut faults) = Record::all(project);
    // If a page's stored file is damaged, its figures cannot be checked.
    let is_known = |page: &&Page| {
        let folder = format!("{}/{}/", record::FOLDER, page.stem());
        !faults.iter().any(|fault| fault.file.starts_with(&folder))
    };
    let known: Vec<&Page> = pages.iter().filter(is_known).collect();
    let (measurements, wrong) = measurement::all(pages);
    faults.extend(wrong);
    for measurement in &measurements {
        let known = stored.get(&measurement.name);
        // A file that is damaged has been told as that.
        if known.is_some() || !project.has(&measurement.file()) {
            faults.extend(measurement.stale(project, known, sources));
        }
    }
    faults.extend(measurement::strays(&measurements, &stored));
    faults.extend(known.into_iter().flat_map(|page| figure::check(page, &stored)));
    faults
}
