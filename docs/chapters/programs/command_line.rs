//! Command lines as pages print them: a `cargo run` with its program and arguments.

use manuscript::project::Project;

/// A `cargo run`, or a `cargo chapters`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandLine {
    /// The program, if the command names one.
    pub bin: Option<String>,
    /// The program's arguments.
    pub arguments: Vec<String>,
}

/// Every `cargo run` in a shell text, with its line there, from 0.
pub fn runs(text: &str) -> Vec<(usize, CommandLine)> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((index, first)) = lines.next() {
        let mut command = first.trim().trim_start_matches("$ ").to_owned();
        while let Some(start) = command.strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, line)| line.trim());
            command = format!("{} {next}", start.trim_end());
        }
        let words = shlex::split(&command).unwrap_or_default();
        let separate = |word: &String| ["&&", "||", "|", ";"].contains(&word.as_str());
        found.extend(words.split(separate).filter_map(run).map(|run| (index, run)));
    }
    found
}

fn run(words: &[String]) -> Option<CommandLine> {
    let redirect = |word: &String| word.trim_start_matches(['1', '2', '&']).starts_with('>');
    let words = words.split(redirect).next().unwrap_or_default();
    // The words before it set the environment, `NAME=value`.
    let start = words.iter().position(|word| !word.contains('='))?;
    match words[start..].iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["cargo", "run", ..] => {}
        // The project's own command, `.cargo/config.toml`.
        ["cargo", "chapters", ..] => {
            let arguments = words[start + 2..].to_vec();
            return Some(CommandLine { bin: Some("chapters".to_owned()), arguments });
        }
        _ => return None,
    }
    let words = &words[start + 2..];
    let dashes = words.iter().position(|word| word == "--").unwrap_or(words.len());
    let cargo = &words[..dashes];
    let after = cargo.iter().position(|word| word == "--bin").and_then(|i| cargo.get(i + 1));
    let joined = cargo.iter().find_map(|word| word.strip_prefix("--bin="));
    Some(CommandLine {
        bin: after.map(String::as_str).or(joined).map(str::to_owned),
        arguments: words.get(dashes + 1..).unwrap_or_default().to_vec(),
    })
}

impl CommandLine {
    /// The program that runs: the named one, or else the project's default.
    pub fn program<'a>(&'a self, project: &'a Project) -> Option<&'a str> {
        self.bin.as_deref().or(project.default_run.as_deref())
    }
}

/// A command in one line, its words separated by single blanks.
pub fn in_a_line(command: &str) -> String {
    command.replace("\\\n", " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Words quoted for a shell.
pub fn quoted(words: &[String]) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=.,:/+".contains(c);
    let word =
        |word: &String| if word.chars().all(plain) { word.clone() } else { format!("\"{word}\"") };
    words.iter().map(word).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(usize, Option<String>, String)> {
        runs(text).into_iter().map(|(i, run)| (i, run.bin, run.arguments.join("|"))).collect()
    }

    #[test]
    fn runs_are_found_among_other_commands() {
        let text = "./setup && cargo run --bin 02_basic # as above\n\
                    $ A=1 cargo run --release --bin=x -- --set \"sun azimuth=3\" > file\n\
                    cargo run --bin y -- \\\n  --size 64x40 \\\n  --headless\n\
                    cargo test\ncargo run\ncargo chapters diff 02 03\n";
        let bin = |name: &str| Some(name.to_owned());
        let expected = [
            (0, bin("02_basic"), "".to_owned()),
            (1, bin("x"), "--set|sun azimuth=3".to_owned()),
            (2, bin("y"), "--size|64x40|--headless".to_owned()),
            (6, None, "".to_owned()),
            (7, bin("chapters"), "diff|02|03".to_owned()),
        ];
        assert_eq!(all(text), expected);
    }
}
