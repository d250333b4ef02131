//! Formulas in plain text for a terminal: `$e^{-t/20}$` on a page becomes `e^(-t/20)`.

/// The characters shown for LaTeX commands. Any other command only loses its `\`.
const SIGNS: [(&str, &str); 10] = [
    ("cdot", "·"),
    ("times", "×"),
    ("le", "≤"),
    ("ge", "≥"),
    ("approx", "≈"),
    ("pi", "π"),
    ("sqrt", "√"),
    // These only change the look of the next letter.
    ("mathbf", ""),
    ("mathrm", ""),
    ("text", ""),
];

/// Replaces each formula between two `$` by plain text.
pub fn plain(text: &str) -> String {
    let parts: Vec<&str> = text.split('$').collect();
    // A `$` without a second one does not begin a formula.
    let closed = parts.len() - (parts.len() + 1) % 2;
    let plain = parts.iter().enumerate().map(|(index, part)| match index {
        _ if index >= closed => format!("${part}"),
        _ if index % 2 == 1 => formula(part),
        _ => (*part).to_owned(),
    });
    plain.collect()
}

fn formula(latex: &str) -> String {
    let mut plain = String::new();
    let mut rest = latex;
    while let Some(letter) = rest.chars().next() {
        rest = &rest[letter.len_utf8()..];
        match letter {
            '\\' => {
                let end = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
                let (name, after) = rest.split_at(end);
                let sign = SIGNS.iter().find(|(known, _)| *known == name);
                let sign = sign.map_or(name, |(_, sign)| *sign);
                plain.push_str(sign);
                rest = if sign.is_empty() { after.trim_start() } else { after };
            }
            '{' => {
                let (group, after) = rest.split_once('}').unwrap_or((rest, ""));
                let group = formula(group);
                let one = group.trim_start_matches('-').chars().all(char::is_alphanumeric);
                plain.push_str(&if one { group } else { format!("({group})") });
                rest = after;
            }
            _ => plain.push(letter),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_plain_and_nothing_else_does() {
        for (text, expected) in [
            ("$D > 4096r$ with r = 1", "D > 4096r with r = 1"),
            ("as $N^{-1/2}$, so", "as N^(-1/2), so"),
            ("$10^{-4}$ and $2^{20}$", "10^-4 and 2^20"),
            (r"$f = L|\mathbf d_{xz}| - d_y$ is", "f = L|d_xz| - d_y is"),
            (r"$a \cdot b \le \sqrt{2}$", "a · b ≤ √2"),
            ("a {b} costs 5 $", "a {b} costs 5 $"),
            ("$x$ and 5 $ more", "x and 5 $ more"),
        ] {
            assert_eq!(plain(text), expected);
        }
    }
}
