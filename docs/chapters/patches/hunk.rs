//! A hunk of a unified diff: lines of a file and their replacement.

/// Lines of a file and their replacement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hunk {
    /// Its line in the diff, from 1.
    pub line: usize,
    /// Its file.
    pub file: String,
    /// True if the file is new.
    pub new_file: bool,
    /// The line of its old lines when the patch was made, from 0.
    pub at: usize,
    /// The old lines.
    pub old: Vec<String>,
    /// The new lines.
    pub new: Vec<String>,
}

impl Hunk {
    /// The present line of its old lines, from 0: their only occurrence, or else the original line.
    pub fn place(&self, lines: &[String]) -> Option<usize> {
        let old = self.old.len();
        let mut found = (0..(lines.len() + 1).saturating_sub(old))
            .filter(|&at| lines[at..at + old] == self.old[..]);
        let first = found.next()?;
        match found.next() {
            None => Some(first),
            Some(second) => [first, second].into_iter().chain(found).find(|at| *at == self.at),
        }
    }

    /// The item of a text that contains its first change, by the item's first line.
    pub fn item(&self, text: &str) -> Option<String> {
        let lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let same = self.old.iter().zip(&self.new).take_while(|(old, new)| old == new).count();
        let words = ["fn ", "struct ", "enum ", "impl ", "const ", "static "];
        let item = |line: &&String| {
            let line = line.trim_start().trim_start_matches("pub ");
            let in_shader =
                line.ends_with(") {") && line.starts_with(|c: char| c.is_ascii_alphabetic());
            let control = CONTROL.iter().any(|word| line.starts_with(word));
            words.iter().any(|word| line.starts_with(word)) || in_shader && !control
        };
        let end = (self.place(&lines)? + same + 1).min(lines.len());
        let found = lines[..end].iter().rev().find(item)?;
        Some(found.trim().split(['(', '{', '=', ':']).next().unwrap_or_default().trim().to_owned())
    }
}

/// Statements that look like functions in a shader.
const CONTROL: [&str; 4] = ["if ", "for ", "while ", "switch "];

/// The hunks of a unified diff.
///
/// # Errors
/// A fault in it, with its line.
pub fn hunks(text: &str) -> Result<Vec<Hunk>, (usize, String)> {
    let mut hunks: Vec<Hunk> = Vec::new();
    let (mut file, mut new_file) = (None, false);
    for (index, line) in text.lines().enumerate() {
        if let Some(path) = line.strip_prefix("+++ ") {
            let path = path.split('\t').next().unwrap_or_default().trim().to_owned();
            if path == "/dev/null" {
                return Err((index + 1, "a patch removes no file".to_owned()));
            }
            file = Some(path);
        } else if let Some(path) = line.strip_prefix("--- ") {
            (file, new_file) = (None, path.trim() == "/dev/null");
        } else if let (true, Some(file)) = (line.starts_with("@@"), &file) {
            // The numbers after `+` count the lines added by earlier hunks.
            let start = line.split_once('+').map_or("", |(_, rest)| rest);
            let digits = start.bytes().take_while(u8::is_ascii_digit).count();
            let Ok(start) = start[..digits].parse::<usize>() else {
                return Err((index + 1, format!("'{line}' does not begin a hunk")));
            };
            let (file, at) = (file.clone(), start.saturating_sub(1));
            hunks.push(Hunk { line: index + 1, file, new_file, at, old: vec![], new: vec![] });
        } else if let (Some(_), Some(hunk)) = (&file, hunks.last_mut()) {
            let (sign, rest) = line.split_at_checked(1).unwrap_or((" ", ""));
            match sign {
                "+" => hunk.new.push(rest.to_owned()),
                "-" => hunk.old.push(rest.to_owned()),
                " " => {
                    hunk.old.push(rest.to_owned());
                    hunk.new.push(rest.to_owned());
                }
                // `\ No newline at end of file`
                "\\" => {}
                _ => return Err((index + 1, format!("'{line}' is no line of a diff"))),
            }
        }
    }
    Ok(hunks)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(lines: &[&str]) -> Vec<String> {
        lines.iter().map(|line| (*line).to_owned()).collect()
    }

    #[test]
    fn hunks_hold_what_was_and_what_is() {
        let text =
            "T\n\nCause: -x\n\n--- a\n+++ b/c\n@@ -1,2 +1,2 @@\n x\n-y\n+z\n@@ -9 +9 @@\n+w\n";
        let hunk = |line, at, old: &[&str], new: &[&str]| Hunk {
            line,
            file: "b/c".to_owned(),
            new_file: false,
            at,
            old: lines(old),
            new: lines(new),
        };
        let expected = [hunk(7, 0, &["x", "y"], &["x", "z"]), hunk(11, 8, &[], &["w"])];
        assert_eq!(hunks(text).unwrap(), expected);
        let text = "pub fn f(z) {\n    if a(b) {\nx\ny\n";
        assert_eq!(expected[0].item(text).unwrap(), "pub fn f");
        assert_eq!(expected[0].item("void main() {\nx\ny\n").unwrap(), "void main");
    }
}
