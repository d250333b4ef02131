//! Which runs are under validation.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::process::Command;
use std::sync::{LazyLock, Mutex, PoisonError};

/// Returns whether a run is to be validated: the first of those that differ only in numbers, because the same
/// choices make the same pipelines and record the same commands. 0 differs from other numbers, since it may mean
/// that there is nothing to build. `VALIDATE=all`, as at night, validates each run.
///
/// `command` has what the run's environment is; `arguments` are those that follow.
pub fn is_new(command: &Command, arguments: &[&str]) -> bool {
    static SEEN: LazyLock<Mutex<BTreeSet<Vec<OsString>>>> = LazyLock::new(Mutex::default);
    static ALL: LazyLock<bool> =
        LazyLock::new(|| std::env::var_os("VALIDATE").is_some_and(|value| value == "all"));
    let mut key = vec![command.get_program().to_owned()];
    key.extend(command.get_args().map(OsString::from));
    key.extend(
        command
            .get_envs()
            .filter_map(|(name, value)| Some([name, value?]))
            .flatten()
            .map(OsString::from),
    );
    key.extend(arguments.iter().map(|argument| without_numbers(argument).into()));
    SEEN.lock().unwrap_or_else(PoisonError::into_inner).insert(key) || *ALL
}

/// The argument, or the value that a control is set to, with each number replaced by a sign: 0 or not.
fn without_numbers(argument: &str) -> String {
    let (name, value) = argument.split_once('=').unwrap_or(("", argument));
    let sign =
        |number: &str| number.parse::<f64>().map(|number| if number == 0.0 { "0" } else { "#" });
    let signs: Result<Vec<_>, _> = value.split(',').map(sign).collect();
    signs.map_or_else(|_| argument.to_owned(), |signs| format!("{name}={}", signs.join(",")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_left_out_and_choices_kept() {
        let key =
            ["64", "view=inside", "height=-3.5", "height=0", "eye=1,0,2e3", "0..16", "a.scene"];
        let signs = ["=#", "view=inside", "height=#", "height=0", "eye=#,0,#", "0..16", "a.scene"];
        assert_eq!(key.map(without_numbers), signs);
    }

    #[test]
    fn only_the_first_run_of_equal_choices_is_new() {
        let is_new = |setting: &str| is_new(&Command::new("chapter"), &["--set", setting]);
        assert!(is_new("view=inside") && is_new("height=1") && is_new("height=0"));
        let all = std::env::var_os("VALIDATE").is_some_and(|value| value == "all");
        assert_eq!(is_new("height=2"), all);
    }
}
