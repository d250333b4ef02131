//! The indices of positions, normals and texture coordinates in the faces of an OBJ file.

use super::text::quoted;

/// An index of a face; it may be out of range.
///
/// # Errors
/// If it is not a whole number.
pub(crate) fn index(word: &str, of: &str) -> Result<i64, String> {
    word.parse().map_err(|_| format!("{of} index {} is not a whole number", quoted(word)))
}

/// The index as a position from 1, if it is in range. Negative indices count back from the last of `count`.
pub(crate) fn position(index: i64, count: usize) -> Option<usize> {
    let position = if index > 0 { index } else { index.saturating_add(count as i64 + 1) };
    usize::try_from(position).ok().filter(|position| (1..=count).contains(position))
}

/// The message for an index that is out of range.
pub(crate) fn out_of_range(index: i64, of: &str, count: usize, what: &str) -> String {
    match index {
        0 => format!("{of} index 0 is out of range: indices start at 1, or at -1 backwards"),
        _ => format!(
            "{of} index {index} is out of range: the file has {count} {what} up to this line"
        ),
    }
}
