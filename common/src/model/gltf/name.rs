//! Names of meshes, materials and images: each mesh has its own copy, so they are cut.

/// Bytes of a name.
const BYTES: usize = 128;

/// A name, or one made of what it is and its number. A long one is cut.
pub(super) fn of(name: Option<&String>, what: &str, number: usize) -> String {
    let Some(name) = name else { return format!("{what} {number}") };
    let end = name.floor_char_boundary(BYTES);
    if end < name.len() { format!("{}…", &name[..end]) } else { name.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_are_cut_between_letters() {
        assert_eq!(of(None, "mesh", 3), "mesh 3");
        assert_eq!(of(Some(&"a".to_owned()), "mesh", 3), "a");
        let long = of(Some(&"ä".repeat(1000)), "mesh", 3);
        assert_eq!(long, "ä".repeat(64) + "…");
    }
}
