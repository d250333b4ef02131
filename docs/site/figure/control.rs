//! A figure's controls, parsed from its mark.
//!
//! | in the mark | what it is |
//! |---|---|
//! | `rung = stable in textbook \| stable` | a choice |
//! | `instance = 3 in 0..7` | a whole number |
//! | `height = 80 in 0..200 slide` | a slider of whole numbers |
//! | `distance = 100 in 1..1e6 log` | a slider, 20 steps to ten times as much |
//! | `stride = 2` | a number or a word that the reader cannot change |

use crate::color::escaped;

/// Steps of a logarithmic slider per factor of ten.
const STEPS: f64 = 20.0;

/// The controls of a mark as HTML in one line.
///
/// # Errors
/// The fault of the mark.
pub fn html(mark: &str) -> Result<String, String> {
    let controls = mark.split(';').map(str::trim).filter(|control| !control.is_empty());
    controls.map(one).collect()
}

fn one(control: &str) -> Result<String, String> {
    let wrong = |why: &str| format!("the control '{control}' {why}");
    let (name, rest) = control.split_once('=').ok_or_else(|| wrong("has no value"))?;
    let (value, range) = rest.split_once(" in ").unwrap_or((rest, ""));
    let [name, value, range] = [name, value, range].map(|part| escaped(part.trim()));
    let labelled =
        |input: &str| format!("<label class=\"control\"><span>{name}</span> {input}</label>");
    if range.is_empty() {
        return Ok(format!("<input type=\"hidden\" name=\"{name}\" value=\"{value}\">"));
    }
    let Some((low, high)) = range.split_once("..") else {
        let mut options = String::new();
        for choice in range.split('|').map(str::trim) {
            let chosen = if choice == value { " selected" } else { "" };
            options.push_str(&format!("<option{chosen}>{choice}</option>"));
        }
        if !options.contains(" selected>") {
            return Err(wrong("has a value that is none of its choices"));
        }
        return Ok(labelled(&format!("<select name=\"{name}\">{options}</select>")));
    };
    let (high, form) = ["log", "slide"]
        .into_iter()
        .find_map(|form| Some((high.strip_suffix(form)?, form)))
        .unwrap_or((high, ""));
    let log = form == "log";
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong("is no number"));
    let (at, from, to) = (number(&value)?, number(low)?, number(high)?);
    if !(from <= at && at <= to && (from > 0.0 || !log)) {
        return Err(wrong("has a value outside its range"));
    }
    if log {
        let [at, to] = [at, to].map(|number| ((number / from).log10() * STEPS).round());
        let input = format!(
            "<input type=\"range\" name=\"{name}\" data-low=\"{from}\" data-steps=\"{STEPS}\" min=\"0\" \
             max=\"{to}\" value=\"{at}\"> <output></output>"
        );
        return Ok(labelled(&input));
    }
    if form == "slide" {
        let input = format!(
            "<input type=\"range\" name=\"{name}\" min=\"{from}\" max=\"{to}\" value=\"{at}\"> <output></output>"
        );
        return Ok(labelled(&input));
    }
    Ok(labelled(&format!(
        "<input type=\"number\" inputmode=\"numeric\" name=\"{name}\" min=\"{from}\" max=\"{to}\" \
         value=\"{at}\">"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_control_has_its_form() {
        let cases = [
            ("", ""),
            ("a b = 2", "<input type=\"hidden\" name=\"a b\" value=\"2\">"),
            (
                "a = y in x | y",
                "<label class=\"control\"><span>a</span> <select name=\"a\"><option>x</option>\
                 <option selected>y</option></select></label>",
            ),
            (
                "n = 3 in 0..7;",
                "<label class=\"control\"><span>n</span> <input type=\"number\" inputmode=\"numeric\" \
                 name=\"n\" min=\"0\" max=\"7\" value=\"3\"></label>",
            ),
            (
                "h = -3 in -9..7 slide",
                "<label class=\"control\"><span>h</span> <input type=\"range\" name=\"h\" min=\"-9\" \
                 max=\"7\" value=\"-3\"> <output></output></label>",
            ),
            (
                "d = 100 in 1..1e6 log",
                "<label class=\"control\"><span>d</span> <input type=\"range\" name=\"d\" data-low=\"1\" \
                 data-steps=\"20\" min=\"0\" max=\"120\" value=\"40\"> <output></output></label>",
            ),
        ];
        for (mark, expected) in cases {
            assert_eq!(html(mark).as_deref(), Ok(expected));
        }
    }

    #[test]
    fn a_control_that_makes_no_sense_is_named() {
        let cases = [
            ("a", "the control 'a' has no value"),
            (
                "a = z in x | y",
                "the control 'a = z in x | y' has a value that is none of its choices",
            ),
            ("a = 1; b = 9 in 0..7", "the control 'b = 9 in 0..7' has a value outside its range"),
            ("a = 0 in 0..7 log", "the control 'a = 0 in 0..7 log' has a value outside its range"),
            ("a = x in 0..7", "the control 'a = x in 0..7' is no number"),
        ];
        for (mark, expected) in cases {
            assert_eq!(html(mark), Err(expected.to_owned()));
        }
    }
}
