//! The controls of a sample, as listed by its program.

/// A control, as printed by `--list-controls`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Control {
    /// Its name.
    pub name: String,
    /// Its kind, such as `number`.
    pub kind: String,
    /// The values it may have.
    pub possible: String,
    /// The value at the start.
    pub value: String,
}

/// A sample's controls.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Controls(pub Vec<Control>);

impl Controls {
    /// Parses the output of `--list-controls`.
    pub fn parse(printed: &str) -> Self {
        let control = |line: &str| {
            let fields: Vec<&str> = line.trim_end_matches('\r').split('\t').collect();
            let [name, kind, possible, value] = fields[..] else { return None };
            let [name, kind, possible, value] = [name, kind, possible, value].map(str::to_owned);
            Some(Control { name, kind, possible, value })
        };
        Self(printed.lines().filter_map(control).collect())
    }

    /// The table on the page.
    pub fn table(&self) -> String {
        if self.0.is_empty() {
            return "This chapter has no controls.\n".to_owned();
        }
        let mut table = "| Name | Kind | Values | Default |\n|---|---|---|---|\n".to_owned();
        for Control { name, kind, possible, value } in &self.0 {
            let [name, kind, possible, value] =
                [name, kind, possible, value].map(|text| text.replace('|', "\\|"));
            table.push_str(&format!("| `{name}` | {kind} | {possible} | `{value}` |\n"));
        }
        table
    }

    /// The reason why a control cannot be set to a value; `None` if it can.
    pub fn refuse(&self, name: &str, value: &str) -> Option<String> {
        let Some(control) = self.0.iter().find(|control| control.name == name) else {
            let names: Vec<&str> = self.0.iter().map(|control| &*control.name).collect();
            return Some(format!("there is no control '{name}', only {}", names.join(", ")));
        };
        let possible = match &*control.kind {
            "choice" => control.possible.split(", ").any(|option| option == value),
            "number" | "whole number" => {
                let ends = control.possible.split_once(" to ");
                let number = |text: &str| text.parse::<f64>().ok();
                let ends = ends.and_then(|(low, high)| Some(number(low)?..=number(high)?));
                ends.is_none_or(|range| number(value).is_some_and(|value| range.contains(&value)))
            }
            _ => true,
        };
        let kind = if control.kind == "whole number" { "a whole number from " } else { "" };
        let what = || format!("'{name}' cannot be '{value}': it takes {kind}{}", control.possible);
        (!possible).then(what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_a_control() {
        let controls = Controls::parse("sun\tnumber\t0 to 90\t42\nshow\tchoice\ta, b|c\ta\n");
        let table = controls.table();
        assert!(table.contains("| `sun` | number | 0 to 90 | `42` |\n"), "{table}");
        assert!(table.contains("| a, b\\|c |"), "{table}");
        assert_eq!(Controls::parse("").table(), "This chapter has no controls.\n");
    }

    #[test]
    fn settings_are_held_to_what_is_possible() {
        let controls = Controls::parse("sun\tnumber\t0 to 90\t42\nshow\tchoice\ta, b\ta\n");
        assert_eq!(controls.refuse("sun", "90"), None);
        assert_eq!(controls.refuse("show", "b"), None);
        for (name, value) in [("sun", "91"), ("sun", "x"), ("show", "c"), ("moon", "1")] {
            assert!(controls.refuse(name, value).is_some(), "{name}={value}");
        }
    }
}
