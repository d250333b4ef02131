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
    /// A file of the name beside the model, but not where the name leads.
    Elsewhere,
    /// A texture of which the end is missing.
    Cut,
    /// An option or a form of a statement that is not supported.
    Option,
    /// A texture coordinate out of range.
    Coordinate,
    /// A normal out of range.
    Normal,
    /// A statement of another format.
    Keyword,
}

impl Kind {
    /// The replacement for the missing part.
    fn instead(self) -> &'static str {
        match self {
            Self::Library => "its materials are not known",
            Self::Definition => "the first definition stands",
            Self::Material => "a grey stands for it",
            Self::Texture => "the plain colour stands for it",
            Self::Elsewhere => "the file of that name beside the model is taken",
            Self::Cut => "what there is of it is shown",
            Self::Option => "it is ignored",
            Self::Coordinate => "the corner has none",
            Self::Normal => "the triangle's own stands for it",
            Self::Keyword => "the line is ignored",
        }
    }
}

/// The faults of a model that is still shown. A file may have millions: of each kind, the first is reported and
/// the others are counted.
#[derive(Default)]
pub(crate) struct Warnings(Vec<Warning>);

struct Warning {
    kind: Kind,
    first: String,
    count: usize,
}

impl Warnings {
    /// Records a fault of a statement.
    pub fn add<E: Display>(&mut self, kind: Kind, statement: &Statement, what: impl FnOnce() -> E) {
        self.add_many(kind, 1, || statement.at(what()).to_string());
    }

    /// Records `count` faults of a kind; `first` is one line with the first and its place.
    pub fn add_many(&mut self, kind: Kind, count: usize, first: impl FnOnce() -> String) {
        match self.0.iter_mut().find(|warning| warning.kind == kind) {
            Some(warning) => warning.count += count,
            None => self.0.push(Warning { kind, first: first(), count }),
        }
    }

    /// A line for each kind, in the order of their first occurrence.
    pub fn lines(&self) -> Vec<String> {
        let line = |Warning { kind, first, count }: &Warning| {
            format!("{first}; {} ({count} in all)", kind.instead())
        };
        self.0.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests;
