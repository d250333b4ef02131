//! Nesting of tables and lists, for which `toml` has a bound but names no line.

use toml_parser::parser::{Event, EventKind};

/// The maximum nesting: no key of a scene file is nested deeper than 3.
pub(super) const MOST: usize = 16;

/// Follows a parser into tables and lists, and out again.
#[derive(Default)]
pub(super) struct Nesting {
    /// Tables that the last headline names.
    headline: usize,
    /// Tables that the dots of the last key name.
    key: usize,
    /// The same for each table in braces and each list that is open, with itself.
    open: Vec<usize>,
    /// The byte at which the nesting exceeds the limit.
    pub too_deep: Option<usize>,
}

impl Nesting {
    /// Continues after a token of the parser.
    pub fn add(&mut self, event: &Event) {
        use EventKind as Kind;
        if self.too_deep.is_some() {
            return;
        }
        match event.kind() {
            Kind::StdTableOpen | Kind::ArrayTableOpen => (self.headline, self.key) = (0, 0),
            Kind::StdTableClose | Kind::ArrayTableClose => {
                (self.headline, self.key) = (self.key + 1, 0)
            }
            Kind::KeySep => self.key += 1,
            Kind::InlineTableOpen | Kind::ArrayOpen => {
                self.open.push(self.key + 1);
                self.key = 0;
            }
            Kind::InlineTableClose | Kind::ArrayClose => {
                self.open.pop();
                self.key = 0;
            }
            Kind::ValueSep | Kind::Newline => self.key = 0,
            _ => {}
        }
        if self.headline + self.open.iter().sum::<usize>() + self.key > MOST {
            self.too_deep = Some(event.span().start());
        }
    }
}

#[cfg(test)]
mod tests {
    use toml_parser::Source;
    use toml_parser::parser::parse_document;

    use super::*;

    /// The offset at which a text is nested too deeply.
    fn too_deep(text: &str) -> Option<usize> {
        let mut depth = Nesting::default();
        let tokens = Source::new(text).lex().into_vec();
        parse_document(&tokens, &mut |event: Event| depth.add(&event), &mut ());
        depth.too_deep
    }

    #[test]
    fn dots_headlines_braces_and_lists_count_alike() {
        fn dots(count: usize) -> String {
            "a.".repeat(count) + "a"
        }
        type Case = (usize, fn(usize) -> String);
        let cases: [Case; 6] = [
            (17, |n| format!("{} = 1", dots(n))),
            (16, |n| format!("[{}]\n\nb.c = 1", dots(n - 1))),
            (17, |n| format!("[[{}]]", dots(n - 1))),
            (17, |n| format!("a = {}{}", "[".repeat(n), "]".repeat(n))),
            (17, |n| format!("a = {}{}", "{a = ".repeat(n), "}".repeat(n))),
            (6, |n| format!("[a.b]\n{} = [{{{} = [1]}}]", dots(n), dots(n))),
        ];
        for (least, text) in cases {
            assert_eq!(too_deep(&text(least - 1)), None, "{}", text(least - 1));
            assert!(too_deep(&text(least)).is_some(), "{}", text(least));
        }
    }

    #[test]
    fn what_is_beside_is_not_deeper() {
        let rows = "a.b.c = [[1, 2], {x.y = 1, z.w = 2}]\n[t.u]\nk.l = [\n[1],\n[2],\n]\n[[v.w]]\n";
        assert_eq!(too_deep(&rows.repeat(50)), None);
    }
}
