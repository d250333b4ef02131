//! Code that a solution removes. A picture cannot show whether it was replaced.

use anyhow::Result;

/// The place where the code is still used, in one line; `read` returns the contents of a file.
///
/// # Errors
/// If a file cannot be read.
pub fn left(
    code: &str,
    files: &[&str],
    read: impl Fn(&str) -> Result<String>,
) -> Result<Option<String>> {
    // A comment may still mention the removed code.
    let holds = |line: &str| line.split("//").next().is_some_and(|before| before.contains(code));
    for file in files {
        if read(file)?.lines().any(holds) {
            let shown = file.trim_start_matches("shaders/");
            return Ok(Some(format!("the picture is right, but '{code}' still stands in {shown}")));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_is_no_code() {
        let left = |text: &str| left("0xff", &["shaders/a.rgen"], |_| Ok(text.to_owned())).unwrap();
        let told = "the picture is right, but '0xff' still stands in a.rgen";
        assert_eq!(left("x(0xff);\n").as_deref(), Some(told));
        assert_eq!(left("x(0x00); // 0xff\n// x(0xff);\n"), None);
    }
}
