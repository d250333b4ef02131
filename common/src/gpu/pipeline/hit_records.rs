//! Compares the hit records used by instances with those in a table. Using a missing record is undefined
//! behaviour, and one of the wrong kind of hit group fails silently: nothing is hit.

use std::collections::BTreeMap;

use anyhow::{Result, ensure};
use ash::vk;
use serde::{Deserialize, Serialize};

use super::sbt::hit_record;

/// A hit record, as used by instances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct AskedRecord {
    /// The record of the first geometry for a ray with `sbtRecordOffset` 0.
    pub record: u32,
    /// The kind of geometry, if it is known and every ray sees it.
    pub kind: Option<vk::GeometryTypeKHR>,
    /// The number of geometries of the bottom level.
    pub geometries: u32,
}

/// Records used by instances, each with the name of a bottom level that uses it.
pub type Asked = BTreeMap<AskedRecord, String>;

/// The part of a record's number that a ray adds, as far as it is constant.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RayRecord {
    /// The shader that traces the ray.
    pub shader: String,
    /// Its `sbtRecordOffset`.
    pub offset: u32,
    /// Its `sbtRecordStride`.
    pub stride: u32,
    /// Its flags, if they are constant.
    pub flags: Option<u32>,
}

impl RayRecord {
    /// `gl_RayFlagsSkipTrianglesEXT` and `gl_RayFlagsSkipAABBEXT`.
    const SKIP_TRIANGLES: u32 = 0x100;
    const SKIP_BOXES: u32 = 0x200;

    /// True if the ray may skip all geometry of a kind. If its flags are not known, one that adds to the record is
    /// taken to do so.
    fn may_skip(&self, kind: vk::GeometryTypeKHR) -> bool {
        let boxes = kind == vk::GeometryTypeKHR::AABBS;
        let skips = if boxes { Self::SKIP_BOXES } else { Self::SKIP_TRIANGLES };
        self.flags.map_or(self.offset > 0, |flags| flags & skips != 0)
    }

    /// The additions to the record of an instance, in words.
    fn additions(&self, geometry: u32) -> String {
        let mut words = String::new();
        if self.offset > 0 {
            words += &format!(" + {} (sbtRecordOffset in {})", self.offset, self.shader);
        }
        if geometry * self.stride > 0 {
            words += &format!(" + {} (geometry {geometry})", geometry * self.stride);
        }
        words
    }
}

/// Checks that a table has each record that is used, of the geometry's kind. `table` has the kind of hit group of
/// each of its records, and `rays` those rays of the pipeline whose part of the record is constant.
///
/// # Errors
/// If it does not.
pub(super) fn check(
    asked: &Asked,
    table: &[vk::RayTracingShaderGroupTypeKHR],
    rays: &[RayRecord],
    pipeline: &str,
) -> Result<()> {
    let records = match table.len() {
        1 => "1 hit record".to_owned(),
        count => format!("{count} hit records"),
    };
    let order = "records are counted from 0 in the order of the .hit lines";
    let is_there = |record: u32| (record as usize) < table.len();
    for RayRecord { shader, offset, .. } in rays {
        ensure!(
            is_there(*offset),
            "{shader}: a ray has the sbtRecordOffset {offset}, and the shader binding table of '{pipeline}' has \
             {records}; {order}"
        );
    }
    let plain = [RayRecord::default()];
    for (AskedRecord { record, kind, geometries }, name) in asked {
        ensure!(
            is_there(*record),
            "an instance of '{name}' has the hit record {record}, and the shader binding table of '{pipeline}' \
             has {records}; {order}"
        );
        let Some(kind) = *kind else { continue };
        let (made_of, other, group) = match kind {
            vk::GeometryTypeKHR::AABBS => {
                ("boxes", "triangles", vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP)
            }
            _ => ("triangles", "boxes", vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP),
        };
        let rays = if rays.is_empty() { &plain } else { rays };
        for ray in rays.iter().filter(|ray| !ray.may_skip(kind)) {
            for geometry in 0..*geometries {
                let number = hit_record(*record, geometry, ray.stride, ray.offset);
                let asks = || {
                    let more = ray.additions(geometry);
                    format!("an instance of {made_of}, '{name}', has the hit record {record}{more}")
                };
                ensure!(
                    is_there(number),
                    "{}, and the shader binding table of '{pipeline}' has {records}; {order}",
                    asks()
                );
                ensure!(
                    table[number as usize] == group,
                    "{}, which is a hit group for {other} in '{pipeline}'; {order}",
                    asks()
                );
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLES: vk::RayTracingShaderGroupTypeKHR =
        vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP;
    const BOXES: vk::RayTracingShaderGroupTypeKHR =
        vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP;

    fn asked(record: u32, kind: Option<vk::GeometryTypeKHR>, geometries: u32) -> Asked {
        Asked::from([(AskedRecord { record, kind, geometries }, "cone".to_owned())])
    }

    fn ray(offset: u32, stride: u32, flags: u32) -> RayRecord {
        let flags = Some(flags);
        RayRecord { shader: "camera.rgen".to_owned(), offset, stride, flags }
    }

    fn said(
        asked: &Asked,
        table: &[vk::RayTracingShaderGroupTypeKHR],
        rays: &[RayRecord],
    ) -> Option<String> {
        check(asked, table, rays, "mine").err().map(|error| error.to_string())
    }

    #[test]
    fn a_record_is_there_and_of_the_kind_of_what_asks_for_it() {
        let (triangles, boxes) = (vk::GeometryTypeKHR::TRIANGLES, vk::GeometryTypeKHR::AABBS);
        let said = |record, kind| said(&asked(record, kind, 1), &[TRIANGLES, BOXES], &[]);
        assert_eq!(said(1, Some(boxes)), None);
        // A structure built elsewhere may be of either kind.
        assert_eq!(said(1, None), None);
        for (record, kind, words) in [
            (
                2,
                None,
                "has the hit record 2, and the shader binding table of 'mine' has 2 hit records",
            ),
            (
                0,
                Some(boxes),
                "of boxes, 'cone', has the hit record 0, which is a hit group for triangles",
            ),
            (
                1,
                Some(triangles),
                "of triangles, 'cone', has the hit record 1, which is a hit group for boxes",
            ),
        ] {
            let line = said(record, kind).expect("it is refused");
            assert!(line.contains(words), "{line}");
        }
    }

    #[test]
    fn a_ray_and_a_geometry_add_to_the_record() {
        let triangles = asked(0, Some(vk::GeometryTypeKHR::TRIANGLES), 2);
        let table = [TRIANGLES, BOXES, TRIANGLES];
        let said = |ray| said(&triangles, &table, &[ray]);
        assert_eq!(said(ray(0, 0, 0)), None);
        assert_eq!(said(ray(0, 2, 0)), None);
        assert_eq!(said(ray(2, 0, 0)), None);
        assert_eq!(
            said(ray(1, 0, 0)).unwrap(),
            "an instance of triangles, 'cone', has the hit record 0 + 1 (sbtRecordOffset in camera.rgen), which \
             is a hit group for boxes in 'mine'; records are counted from 0 in the order of the .hit lines"
        );
        assert!(said(ray(0, 1, 0)).unwrap().contains("record 0 + 1 (geometry 1), which is"));
        assert!(said(ray(0, 3, 0)).unwrap().contains("0 + 3 (geometry 1), and the shader"));
        // A ray that skips all triangles uses no record of theirs.
        assert_eq!(said(ray(1, 0, RayRecord::SKIP_TRIANGLES)), None);
        let beyond = said(ray(3, 0, 0)).unwrap();
        assert!(beyond.contains("camera.rgen: a ray has the sbtRecordOffset 3"), "{beyond}");
        // An instance that some rays may not see is shielded from those that would add too much.
        let hidden = asked(1, None, 1);
        assert_eq!(super::check(&hidden, &table, &[ray(2, 0, 0)], "mine").ok(), Some(()));
    }
}
