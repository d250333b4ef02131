//! A corner of a face.

use super::index::{index, out_of_range, position};
use super::parts::{Corner, NONE};
use super::tally::Tally;
use super::text::quoted;
use super::warnings::Kind;

/// Reads a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`, of the lists up to here. A texture coordinate or a normal that
/// is not there is left out, with a warning.
///
/// # Errors
/// If it has no position.
pub(crate) fn corner(
    word: &str,
    lists: &Tally,
    mut warn: impl FnMut(Kind, String),
) -> Result<Corner, String> {
    let mut parts = word.split('/');
    let mut part = || parts.next().unwrap_or_default();
    let (v, vt, vn) = (part(), part(), part());
    if parts.next().is_some() {
        return Err(format!(
            "the corner {} has too many parts; v, v/vt, v//vn or v/vt/vn is right",
            quoted(word)
        ));
    }
    let find = |word: &str, of: &str, count: usize, what: &str| -> Result<u32, String> {
        let index = index(word, of)?;
        let position = position(index, count);
        position
            .map(|position| position as u32 - 1)
            .ok_or_else(|| out_of_range(index, of, count, what))
    };
    let mut other = |word: &str, kind, of, count, what| match word {
        "" => NONE,
        _ => find(word, of, count, what).unwrap_or_else(|what| {
            warn(kind, what);
            NONE
        }),
    };
    let (of, what) = ("texture coordinate", "texture coordinates");
    Ok(Corner {
        position: find(v, "face", lists.positions, "positions")?,
        coordinate: other(vt, Kind::Coordinate, of, lists.coordinates, what),
        normal: other(vn, Kind::Normal, "normal", lists.normals, "normals"),
    })
}
