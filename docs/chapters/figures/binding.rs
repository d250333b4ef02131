//! What a page's comments name: a measurement and a value for each number of a passage.

use std::collections::BTreeMap;

use manuscript::page::Page;

use super::passage::{Comment, Passage};
use super::record::Record;

/// The measurements that are stored, by page and name.
pub type Records = BTreeMap<String, Record>;

/// The measurement and the value for each number of a passage.
pub fn names(page: &Page, passage: &Passage, stored: &Records) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (_, comment) in &passage.comments {
        let Comment::Figures(groups) = comment else { continue };
        let whole = |name: &String| match name.contains('/') {
            true => name.clone(),
            false => format!("{}/{name}", page.stem()),
        };
        let groups = groups.iter().map(|(name, keys)| (whole(name), keys));
        let groups: Vec<(String, &Vec<String>)> = groups.collect();
        let has_rows = groups.iter().any(|(_, keys)| keys.iter().any(|key| key.contains('*')));
        if has_rows && groups.iter().all(|(name, _)| stored.contains_key(name)) {
            found.extend(passage.rows.iter().flat_map(|row| of_row(row, &groups, stored)));
            continue;
        }
        for (name, keys) in groups {
            let all = stored.get(&name).map(|stored| stored.values.keys().cloned().collect());
            let keys = match &keys[..] {
                [] => all.unwrap_or_else(|| vec![String::new()]),
                _ => keys.clone(),
            };
            found.extend(keys.into_iter().map(|key| (name.clone(), key)));
        }
    }
    found
}

/// The values of a table's row: those that are named for it, and are there.
fn of_row(row: &str, groups: &[(String, &Vec<String>)], stored: &Records) -> Vec<(String, String)> {
    let row = row.trim().replace(' ', "-");
    let named = groups.iter().flat_map(|(name, keys)| keys.iter().map(move |key| (name, key)));
    let own = named.map(|(name, key)| (name.clone(), key.replace('*', &row)));
    own.filter(|(name, key)| stored[name].values.contains_key(key)).collect()
}
