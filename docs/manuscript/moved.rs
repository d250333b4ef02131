//! Moved lines: removed in one place of a chapter and added in another, possibly in another file.

use std::collections::HashMap;

use similar::DiffOp;

use crate::diff::{FileDiff, Line};

/// A block with fewer letters and digits than this may match by chance.
const LETTERS: usize = 20;

/// The place of a line: the file's number, and the line's index in it.
type Place = (usize, usize);

/// Marks the moved lines in all files: blocks of lines removed in one place and added in another, whatever
/// their indentation.
pub fn mark(diffs: &mut [FileDiff]) {
    let mut removed: HashMap<String, Vec<Place>> = HashMap::new();
    for (file, diff) in diffs.iter().enumerate() {
        for at in places(diff, |op| op.old_range()) {
            removed.entry(key(&diff.old.lines[at])).or_default().push((file, at));
        }
    }
    for file in 0..diffs.len() {
        let added = places(&diffs[file], |op| op.new_range());
        let mut next = 0;
        while next < added.len() {
            let block = longest(diffs, &removed, file, &added[next..]);
            for &(at, (from, old)) in &block {
                diffs[file].new.lines[at].moved = true;
                diffs[from].old.lines[old].moved = true;
            }
            next += block.len().max(1);
        }
    }
}

/// The places of lines that are only on one side.
fn places(diff: &FileDiff, side: impl Fn(&DiffOp) -> std::ops::Range<usize>) -> Vec<usize> {
    diff.changes().flat_map(side).collect()
}

/// The longest block at the start of `added` that was removed elsewhere as a whole; empty if it is too short
/// to be certain.
fn longest(
    diffs: &[FileDiff],
    removed: &HashMap<String, Vec<Place>>,
    file: usize,
    added: &[usize],
) -> Vec<(usize, Place)> {
    let new = &diffs[file].new.lines;
    let starts = removed.get(&key(&new[added[0]])).map_or(&[][..], Vec::as_slice);
    let block = |&(from, start): &Place| -> Vec<(usize, Place)> {
        let old = &diffs[from].old.lines;
        let follows = |i: usize| {
            let (at, was) = (added[i], start + i);
            let is_next = i == 0 || at == added[i - 1] + 1;
            is_next
                && old.get(was).is_some_and(|line| !line.moved && key(line) == key(&new[at]))
                && gone(&diffs[from], was)
        };
        let pairs = (0..added.len()).take_while(|&i| follows(i));
        pairs.map(|i| (added[i], (from, start + i))).collect()
    };
    let best = starts.iter().map(block).max_by_key(Vec::len).unwrap_or_default();
    let letters: usize = best
        .iter()
        .map(|&(at, _)| new[at].text.chars().filter(|c| c.is_alphanumeric()).count())
        .sum();
    if letters >= LETTERS { best } else { Vec::new() }
}

/// True if a line of the older file is not in the newer one.
fn gone(diff: &FileDiff, at: usize) -> bool {
    diff.changes().any(|op| op.old_range().contains(&at))
}

fn key(line: &Line) -> String {
    line.key.trim().to_owned()
}
