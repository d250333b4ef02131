//! The keywords of MTL, and of its extensions by other programs.

/// The keywords that are read.
pub(crate) const READ: [&str; 22] = [
    "newmtl",
    "Kd",
    "Ks",
    "Ke",
    "Tf",
    "Ns",
    "Ni",
    "d",
    "Tr",
    "illum",
    "map_Kd",
    "map_d",
    "Pr",
    "Pm",
    "map_Pr",
    "map_Pm",
    "norm",
    "map_norm",
    "map_normal",
    "map_Kn",
    "bump",
    "map_Bump",
];

/// Keywords of what is not shown, by kind: its names, what is said of one. A file of many materials has
/// each many times: one warning for a kind is enough.
const LEFT_OUT: [(&str, &str); 7] = [
    ("disp map_disp", "is a map of displacement, which is not shown; map_Bump and norm are"),
    ("map_Ks map_Ns", "is a map of highlights, which is not read; Ks and Ns are"),
    ("map_Ke", "is a map of emission, which is not read; Ke is"),
    (
        "map_Tr map_Tf map_Ni",
        "is a map of what a material lets through, which is not read; map_d is",
    ),
    ("refl map_refl", "is a picture to be reflected; rays find what is really there"),
    ("decal", "is a second texture, which is not shown; map_Kd is"),
    (
        "Ps Pc Pcr aniso anisor map_Ps map_Pc map_Pcr map_aniso map_anisor map_RMA map_ORM Pfr Pfg Pl Pf map_Pfr",
        "is a property of physically based materials that is not read; Pr, Pm, map_Pr and map_Pm are",
    ),
];

/// Keywords without which a picture is the same, for it has no ambient light, and no filter for reflections.
const PASSED_OVER: &str = "Ka Km sharpness map_Ka map_aat";

/// Numbers of these that are 0 change nothing.
const NOTHING_AT_0: &str = "Ps Pc Pcr aniso anisor";

/// True if a list of keywords has this word, in any case.
fn has(list: &str, word: &str) -> bool {
    list.split(' ').any(|keyword| keyword.eq_ignore_ascii_case(word))
}

/// The use of a keyword.
pub(crate) enum Keyword {
    Read(&'static str),
    /// Not shown: the names of its kind, and what is said of it.
    LeftOut(&'static str, &'static str),
    PassedOver,
    Unknown,
}

impl Keyword {
    /// The use of a word, written in any case, before these arguments.
    pub fn of(word: &str, rest: &str) -> Self {
        let is = |keyword: &&str| keyword.eq_ignore_ascii_case(word);
        if let Some(keyword) = READ.into_iter().find(is) {
            return Self::Read(keyword);
        }
        let is_0 =
            || rest.split_whitespace().next().is_some_and(|word| word.parse::<f64>() == Ok(0.0));
        if has(PASSED_OVER, word) || has(NOTHING_AT_0, word) && is_0() {
            return Self::PassedOver;
        }
        match LEFT_OUT.into_iter().find(|(names, _)| has(names, word)) {
            Some((names, what)) => Self::LeftOut(names, what),
            None => Self::Unknown,
        }
    }
}
