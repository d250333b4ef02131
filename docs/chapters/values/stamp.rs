//! The stamp of a page: the devices that produced its values and the dates, in one line.

use std::collections::{BTreeMap, BTreeSet};

use manuscript::page::{Kind, Page};
use manuscript::project::Project;

use super::binding;
use super::record::{self, Record};

/// The devices of values from a GPU's compiler that runs without the GPU.
const COMPILERS: [&str; 2] = ["RADV", "ANV"];

/// Returns whether a page has a stamp.
pub fn is_on(page: &Page) -> bool {
    page.blocks.iter().any(|block| block.kind == Kind::Stamp)
}

/// The text of a page's stamp.
pub fn text(project: &Project, page: &Page) -> String {
    let (stored, _) = Record::all(project);
    let names = binding::measurements(project, page);
    let up = "../".repeat(page.path.matches('/').count() - 1);
    match line(names.iter().filter_map(|name| stored.get(name))) {
        said if said.is_empty() => "Nothing on this page was measured.\n".to_owned(),
        said => format!("> {said} [What the figures mean]({up}reading.md#what-the-figures-mean)\n"),
    }
}

/// A sentence for each device and driver.
fn line<'a>(records: impl Iterator<Item = &'a Record>) -> String {
    let mut days = BTreeMap::<(bool, String), BTreeSet<&str>>::new();
    let mut families = BTreeMap::<&str, BTreeSet<&str>>::new();
    for Record { device, driver, date, .. } in records.filter(|known| known.device != record::HOST)
    {
        let is_compiler = COMPILERS.contains(&&**device);
        let mut words = driver.split(", ");
        let version = version(words.next().unwrap_or_default());
        families.entry(device).or_default().extend(words.filter(|_| is_compiler));
        days.entry((is_compiler, format!("{device}, {version}"))).or_default().insert(date);
    }
    let of = |((is_compiler, by), days): ((bool, String), BTreeSet<&str>)| {
        let first = days.first().copied().unwrap_or_default();
        let days = match days.last() {
            Some(last) if *last != first => format!("{first} to {last}"),
            _ => first.to_owned(),
        };
        if is_compiler {
            let device = by.split(',').next().unwrap_or_default();
            let families = families.get(device).into_iter().flatten().copied();
            let families: Vec<&str> = families.collect();
            format!("Estimated by the compiler of {by}, for {}, {days}.", families.join(", "))
        } else {
            format!("Measured on {by}, {days}.")
        }
    };
    days.into_iter().map(of).collect::<Vec<_>>().join(" ")
}

/// A driver's version: Mesa 25.0.7 for `llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)`.
fn version(driver: &str) -> String {
    match driver.rsplit_once("Mesa ") {
        Some((_, rest)) => {
            let end = rest.find(['-', ' ', '~']).unwrap_or(rest.len());
            format!("Mesa {}", &rest[..end])
        }
        None => driver.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(device: &str, driver: &str, date: &str) -> Record {
        let text = format!(
            r#"{{ "command": "", "timed": false, "device": "{device}", "driver": "{driver}",
                "date": "{date}", "values": {{}} }}"#
        );
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn devices_and_days_are_told_once() {
        let cpu = |day| record("llvmpipe", "llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)", day);
        let radv = |family: &str| {
            record("RADV", &format!("radv Mesa 25.0.7-2~bpo12+1, {family}"), "2026-11-22")
        };
        let host = record("host", "", "2026-11-20");
        let records = [
            cpu("2026-11-25"),
            radv("RDNA3"),
            host,
            cpu("2026-11-22"),
            radv("RDNA2"),
            radv("RDNA3"),
            record(
                "ANV",
                "Intel open-source Mesa driver Mesa 25.0.7-2~bpo12+1, Arc A-series, Arc B-series",
                "2026-11-29",
            ),
        ];
        let expected = "Measured on llvmpipe, Mesa 25.0.7, 2026-11-22 to 2026-11-25. Estimated by the \
                        compiler of ANV, Mesa 25.0.7, for Arc A-series, Arc B-series, 2026-11-29. Estimated by the \
                        compiler of RADV, Mesa 25.0.7, for RDNA2, RDNA3, 2026-11-22.";
        assert_eq!(line(records.iter()), expected);
        assert_eq!(
            line([record("NVIDIA", "NVIDIA 570.1", "2026-11-22")].iter()),
            "Measured on NVIDIA, NVIDIA 570.1, 2026-11-22."
        );
    }
}
