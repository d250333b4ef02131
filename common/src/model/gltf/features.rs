//! Features of a glTF file that are not shown, or not as the file has them: one line per kind.

/// The features of a file that a picture lacks.
pub(super) struct Features {
    /// The file, in messages.
    shown: String,
    list: Vec<Feature>,
}

struct Feature {
    kind: &'static str,
    first: String,
    count: usize,
}

impl Features {
    /// An empty list, for a file with this name in messages.
    pub fn of(shown: &str) -> Self {
        Self { shown: shown.to_owned(), list: Vec::new() }
    }

    /// Records `count` occurrences of a kind. The line says what is shown in their place, and for the first of a
    /// kind where that is.
    pub fn note(&mut self, kind: &'static str, count: usize, line: impl FnOnce() -> String) {
        match self.list.iter_mut().find(|feature| feature.kind == kind) {
            Some(feature) => feature.count += count,
            None => self.list.push(Feature { kind, first: line(), count }),
        }
    }

    /// The first line of a kind.
    pub fn first(&self, kind: &str) -> Option<&str> {
        let feature = self.list.iter().find(|feature| feature.kind == kind);
        feature.map(|feature| feature.first.as_str())
    }

    /// A line for each kind, in the order of their first occurrence.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        let Self { shown, list } = self;
        list.iter().map(move |Feature { first, count, .. }| match count {
            1 => format!("{shown}: {first}"),
            _ => format!("{shown}: {first} ({count} in all)"),
        })
    }
}
