//! Faults of a model that do not prevent it from being shown: one line per kind.

use std::fmt::Display;

use super::text::Statement;

/// A kind of fault, and its replacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A missing MTL file.
    Library,
    /// A second definition of a material.
    Definition,
    /// A material that no MTL file defines.
    Material,
    /// A texture that is missing, outside the model's folder, or not a picture.
    Texture,
    /// A texture of numbers that is missing, outside the model's folder, or not a picture.
    Numbers,
    /// A normal map that is missing, outside the model's folder, or not a picture.
    NormalMap,
    /// A map of heights that has colours.
    Colored,
    /// A normal map in grey.
    Grey,
    /// A normal map and a map of heights in one material.
    Relief,
    /// A texture on faces without texture coordinates.
    Untextured,
    /// A normal map on such faces.
    Unmapped,
    /// A file of the name beside the model, but not where the name leads.
    Elsewhere,
    /// A texture of which the end is missing.
    Cut,
    /// A texture that its file requires to be turned.
    Turned,
    /// An option or a form of a statement that is not supported.
    Option,
    /// A position that is wrong.
    Position,
    /// A texture coordinate that is wrong or out of range.
    Coordinate,
    /// A normal that is wrong or out of range.
    Normal,
    /// The colour of a vertex.
    Color,
    /// A face that crosses itself.
    Crossing,
    /// A face that cannot be shown.
    Face,
    /// A statement of another format, or with a wrong value.
    Line,
    /// A statement about something that is not shown, by the keywords of its kind.
    Unread,
    /// A number for which another is taken; the message names it, as in the next.
    Number,
    /// More numbers than are taken.
    Count,
    /// A material that would not be seen, for it is not opaque; the message says what is shown, as in the next two.
    Opacity,
    /// Glass that would not be seen.
    Glass,
    /// A texture that would be black.
    Black,
}

impl Kind {
    /// The replacement for the missing part.
    fn instead(self) -> Option<&'static str> {
        match self {
            Self::Library => Some("its materials are not known"),
            Self::Definition => Some("the first definition stands"),
            Self::Material => Some("a grey stands for it"),
            Self::Texture => Some("the plain colour stands for it"),
            Self::Numbers => Some("the material's number alone counts"),
            Self::NormalMap | Self::Unmapped => Some("the surface is smooth"),
            Self::Colored | Self::Grey => Some("it is taken as a normal map"),
            Self::Relief => Some("the normal map counts"),
            Self::Elsewhere => Some("the file of that name beside the model is taken"),
            Self::Cut => Some("what there is of it is shown"),
            Self::Turned => Some("it is turned, as viewers of photographs do"),
            Self::Untextured => Some("one texel counts for the whole face"),
            Self::Option => Some("it is ignored"),
            Self::Position => Some("the faces that use it are left out"),
            Self::Coordinate => Some("the corner has none"),
            Self::Normal => Some("the triangle's own stands for it"),
            Self::Color => Some("the material's stands for it"),
            Self::Crossing => Some("some triangles stand for it"),
            Self::Face => Some("the face is left out"),
            Self::Line | Self::Unread => Some("the line is ignored"),
            Self::Number | Self::Count | Self::Opacity | Self::Glass | Self::Black => None,
        }
    }
}

/// The most words of a kind that have a line each.
const WORDS: usize = 8;

/// The faults of a model that is still shown. A file may have millions: of each kind, the first is reported and
/// the others are counted.
#[derive(Default)]
pub(crate) struct Warnings(Vec<Warning>);

struct Warning {
    kind: Kind,
    /// The word that is wrong, or the keyword whose value is; of other kinds, and of further words, none.
    word: String,
    first: String,
    count: usize,
}

impl Warnings {
    /// Records a fault of a statement.
    pub fn add<E: Display>(&mut self, kind: Kind, statement: &Statement, what: impl FnOnce() -> E) {
        self.add_many(kind, 1, || statement.at(what()).to_string());
    }

    /// Records a fault of a word: each of the first few is reported, and the first of the others.
    pub fn add_word<E: Display>(
        &mut self,
        kind: Kind,
        word: &str,
        statement: &Statement,
        what: impl FnOnce() -> E,
    ) {
        let known = self.0.iter().any(|warning| (warning.kind, &*warning.word) == (kind, word));
        let is_full = || self.0.iter().filter(|warning| warning.kind == kind).count() >= WORDS;
        let word = if !known && is_full() { "" } else { word };
        self.count(kind, word, 1, || statement.at(what()).to_string());
    }

    /// Records `count` faults of a kind; `first` is one line with the first and its place.
    pub fn add_many(&mut self, kind: Kind, count: usize, first: impl FnOnce() -> String) {
        self.count(kind, "", count, first);
    }

    fn count(&mut self, kind: Kind, word: &str, count: usize, first: impl FnOnce() -> String) {
        match self.0.iter_mut().find(|warning| (warning.kind, &*warning.word) == (kind, word)) {
            Some(warning) => warning.count += count,
            None => self.0.push(Warning { kind, word: word.to_owned(), first: first(), count }),
        }
    }

    /// A line for each kind and word, in the order of their first occurrence.
    pub fn lines(&self) -> Vec<String> {
        let line = |Warning { kind, first, count, .. }: &Warning| match kind.instead() {
            Some(instead) => format!("{first}; {instead} ({count} in all)"),
            None => format!("{first} ({count} in all)"),
        };
        self.0.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests;
