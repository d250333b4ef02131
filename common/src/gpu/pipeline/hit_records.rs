//! Compares the hit records used by instances with those in a table. Using a missing record is undefined
//! behaviour, and one of the wrong kind of hit group fails silently: nothing is hit.

use std::collections::BTreeSet;

use anyhow::{Result, ensure};
use ash::vk;

/// Records used by instances: for each one, the record of its first geometry for a ray with `sbtRecordOffset` 0,
/// and the kind of geometry, if it is known and every ray sees it.
pub type Asked = BTreeSet<(u32, Option<vk::GeometryTypeKHR>)>;

/// Checks that a table has each record that is used, of the geometry's kind. `table` has the kind of hit group of
/// each of its records.
///
/// # Errors
/// If it does not.
pub(super) fn check(
    asked: &Asked,
    table: &[vk::RayTracingShaderGroupTypeKHR],
    pipeline: &str,
) -> Result<()> {
    for &(record, kind) in asked {
        let count = table.len();
        ensure!(
            (record as usize) < count,
            "an instance of the top level has the hit record {record}, and the shader binding table of \
             '{pipeline}' has {count}, counted from 0 in the order of the .hit lines"
        );
        let (made_of, group) = match kind {
            Some(vk::GeometryTypeKHR::AABBS) => {
                ("boxes", vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP)
            }
            Some(_) => ("triangles", vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP),
            None => continue,
        };
        let other = if made_of == "boxes" { "triangles" } else { "boxes" };
        ensure!(
            table[record as usize] == group,
            "an instance of {made_of} has the hit record {record}, which is a hit group for {other} in \
             '{pipeline}'; records are counted from 0 in the order of the .hit lines"
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_there_and_of_the_kind_of_what_asks_for_it() {
        let triangles = vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP;
        let boxes = vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP;
        let said = |record, kind| {
            let asked = Asked::from([(0, Some(vk::GeometryTypeKHR::TRIANGLES)), (record, kind)]);
            check(&asked, &[triangles, boxes], "mine").err().map(|error| error.to_string())
        };
        assert_eq!(said(1, Some(vk::GeometryTypeKHR::AABBS)), None);
        // A structure built elsewhere may be of either kind.
        assert_eq!(said(1, None), None);
        for (record, kind, words) in [
            (2, None, "has the hit record 2, and the shader binding table of 'mine' has 2"),
            (
                0,
                Some(vk::GeometryTypeKHR::AABBS),
                "of boxes has the hit record 0, which is a hit group for triangles",
            ),
            (
                1,
                Some(vk::GeometryTypeKHR::TRIANGLES),
                "of triangles has the hit record 1, which is a hit group for boxes",
            ),
        ] {
            let line = said(record, kind).expect("it is refused");
            assert!(line.contains(words), "{line}");
        }
    }
}
