//! Formulas: converts TeX to MathML Core, which browsers draw without scripts or a network.

use math_core::{LatexToMathML, MathCoreConfig, MathDisplay};

/// A formula as MathML that is safe in a line of Markdown, also in a table's cell.
///
/// # Errors
/// The part of the formula that cannot be drawn.
pub fn mathml(tex: &str, display: bool) -> Result<String, String> {
    let converter = LatexToMathML::new(MathCoreConfig::default())
        .map_err(|_| "the converter has no macros to parse".to_owned())?;
    let display = if display { MathDisplay::Block } else { MathDisplay::Inline };
    let converted = converter
        .convert_with_local_state(tex, display)
        .map_err(|error| error.to_string().replace('\n', " "))?;
    let html = shielded(&converted.mathml);
    // A formula wider than its column scrolls in its own box.
    Ok(if matches!(display, MathDisplay::Block) {
        format!("<span class=\"formula\">{html}</span>")
    } else {
        html
    })
}

/// Escapes characters between tags that Markdown might interpret.
fn shielded(html: &str) -> String {
    let mut shielded = String::with_capacity(2 * html.len());
    let mut in_tag = false;
    for c in html.chars() {
        match c {
            '<' => in_tag = true,
            '>' => in_tag = false,
            '\n' => {
                shielded.push(' ');
                continue;
            }
            _ if !in_tag && c.is_ascii_punctuation() && !"&#;".contains(c) => {
                shielded.push_str(&format!("&#{};", c as u32));
                continue;
            }
            _ => {}
        }
        shielded.push(c);
    }
    shielded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_survives_a_table_s_cell() {
        let html = mathml(r"|a| * b_1 > \lfloor x \rfloor", false).unwrap();
        assert!(html.starts_with("<math>") && html.ends_with("</math>"), "{html}");
        let mut text = html.clone();
        while let Some(start) = text.find('<') {
            let end = text[start..].find('>').unwrap();
            text.replace_range(start..=start + end, "");
        }
        assert!(!text.contains(['|', '*', '_', '[', '`']), "{text}");
        assert!(html.contains("&gt;") && html.contains("&#124;"), "{html}");
    }

    #[test]
    fn what_is_unknown_is_named() {
        let error = mathml(r"\nonsense{x}", false).unwrap_err();
        assert!(error.contains("nonsense"), "{error}");
        assert!(mathml(r"\frac{1}{2", true).is_err());
    }
}
