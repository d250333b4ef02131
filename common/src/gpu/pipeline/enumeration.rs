//! Words, numbers and GLSL constants of an enumeration, from one declaration.
//!
//! A shader has its own lines `const uint SHOW_NORMAL = 1;`, so that it can be read on its own and compiled by any
//! tool. Like structures, they are compared with Rust when a pipeline is created. SPIR-V does not contain
//! constants that were folded away, so the comparison uses the text.

use std::marker::PhantomData;

use anyhow::{Result, bail, ensure};

use crate::gpu::pipeline::layout::{EnumLayout, Known, Scalar, ShaderType};

/// An enumeration known to Rust, the panel and perhaps shaders. Implemented by
/// [`shader_enum!`](crate::shader_enum).
pub trait ShaderEnum: Copy + PartialEq + Into<u32> + Send + 'static {
    /// Every variant, in the order of its number.
    const ALL: &'static [Self];
    /// Its names.
    const LAYOUT: EnumLayout;
}

/// Declares an enumeration that is a control, and the shader constants for it.
///
/// The word of a variant is its name in lower case, unless another is given; its constant is prefix and name in
/// capitals. Without a prefix, there are no shader constants.
///
/// ```
/// raybook::shader_enum! {
///     /// What a pixel shows: `SHOW_PICTURE`, `SHOW_HIT_KIND` and `SHOW_DIRECTION`.
///     pub enum Show: SHOW { Picture, HitKind, Direction = "ray direction" }
/// }
/// use raybook::gpu::ShaderEnum;
/// assert_eq!(Show::LAYOUT.words, ["picture", "hit kind", "ray direction"]);
/// assert_eq!(u32::from(Show::Direction), 2);
/// ```
#[macro_export]
macro_rules! shader_enum {
    (@word $variant:ident $word:literal) => { $word };
    (@word $variant:ident) => {{
        const NAME: &str = stringify!($variant);
        const WORDS: [u8; $crate::gpu::words_len(NAME)] = $crate::gpu::words(NAME);
        match ::std::str::from_utf8(&WORDS) {
            Ok(words) => words,
            Err(_) => panic!("the name of a variant is ASCII"),
        }
    }};
    ($($(#[$attribute:meta])* $access:vis enum $name:ident $(: $prefix:ident)? {
        $($(#[$variant_attribute:meta])* $variant:ident $(= $word:literal)?),+ $(,)?
    })+) => {$(
        $(#[$attribute])*
        #[repr(u32)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $access enum $name { $($(#[$variant_attribute])* $variant),+ }

        impl ::std::convert::From<$name> for u32 {
            fn from(variant: $name) -> Self {
                variant as u32
            }
        }

        impl $crate::gpu::ShaderEnum for $name {
            const ALL: &'static [Self] = &[$(Self::$variant),+];
            const LAYOUT: $crate::gpu::EnumLayout = $crate::gpu::EnumLayout {
                name: stringify!($name),
                prefix: concat!($(stringify!($prefix))?),
                variants: &[$(stringify!($variant)),+],
                words: &[$($crate::shader_enum!(@word $variant $($word)?)),+],
            };
        }
    )+};
}

/// Length of the [`words`] of a name.
#[doc(hidden)]
pub const fn words_len(name: &str) -> usize {
    let (name, mut length, mut i) = (name.as_bytes(), 0, 0);
    while i < name.len() {
        length += if i > 0 && name[i].is_ascii_uppercase() { 2 } else { 1 };
        i += 1;
    }
    length
}

/// `HitKind` as `hit kind`.
#[doc(hidden)]
pub const fn words<const N: usize>(name: &str) -> [u8; N] {
    let (name, mut words, mut at, mut i) = (name.as_bytes(), [b' '; N], 0, 0);
    while i < name.len() {
        if i > 0 && name[i].is_ascii_uppercase() {
            at += 1;
        }
        words[at] = name[i].to_ascii_lowercase();
        at += 1;
        i += 1;
    }
    words
}

/// A value for a specialization constant: a number, a bool, or a variant of an enumeration.
pub trait ShaderConstant {
    /// The enumeration it belongs to, if any.
    const ENUM: Option<EnumLayout> = None;

    /// Its 32 bits.
    fn bits(self) -> u32;
}

impl ShaderConstant for u32 {
    fn bits(self) -> u32 {
        self
    }
}

impl ShaderConstant for bool {
    fn bits(self) -> u32 {
        self.into()
    }
}

impl<T: ShaderEnum> ShaderConstant for T {
    const ENUM: Option<EnumLayout> = Some(T::LAYOUT);

    fn bits(self) -> u32 {
        self.into()
    }
}

/// The number of a variant, as a field of a structure for shaders, where it is a `uint`.
#[repr(transparent)]
pub struct Number<T>(u32, PhantomData<fn() -> T>);

impl<T: ShaderEnum> From<T> for Number<T> {
    fn from(variant: T) -> Self {
        Self(variant.into(), PhantomData)
    }
}

impl<T: ShaderEnum> Number<T> {
    /// The variant.
    pub fn variant(self) -> T {
        T::ALL[self.0 as usize]
    }
}

impl<T: ShaderEnum> PartialEq<T> for Number<T> {
    fn eq(&self, variant: &T) -> bool {
        self.0 == (*variant).into()
    }
}

impl<T> From<Number<T>> for u32 {
    fn from(number: Number<T>) -> Self {
        number.0
    }
}

impl<T> Clone for Number<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Number<T> {}

impl<T> PartialEq for Number<T> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<T> std::fmt::Debug for Number<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

// SAFETY: it is a u32 and nothing else.
unsafe impl<T: 'static> bytemuck::Zeroable for Number<T> {}
// SAFETY: it is a u32 and nothing else.
unsafe impl<T: 'static> bytemuck::Pod for Number<T> {}

impl<T: ShaderEnum> ShaderType for Number<T> {
    const SCALAR: Option<Scalar> = Some(Scalar::Uint);

    fn reach(known: &mut Known) {
        known.add_enum(T::LAYOUT);
    }
}

/// A number with a name in a shader.
pub(in crate::gpu) struct Constant {
    name: String,
    value: u32,
    /// File and line.
    place: String,
}

/// The lines `const uint NAME = 1;` of a stage's whole text, in which `#line` gives file and line.
pub(in crate::gpu) fn constants(path: &str, text: &str) -> Vec<Constant> {
    let (mut file, mut number) = (path, 0_i64);
    let mut found = Vec::new();
    for line in text.lines() {
        if let Some((next, name)) = line.strip_prefix("#line ").and_then(|at| at.split_once(' ')) {
            file = name.trim_matches('"');
            number = next.parse::<u32>().map_or(0, |next| i64::from(next) - 1);
            continue;
        }
        number += 1;
        if let Some((name, value)) = constant(line) {
            found.push(Constant {
                name: name.to_owned(),
                value,
                place: format!("{file}:{number}"),
            });
        }
    }
    found
}

/// Name and value of a line `const uint NAME = 1;`.
fn constant(line: &str) -> Option<(&str, u32)> {
    let (name, rest) = line.trim_start().strip_prefix("const uint ")?.split_once('=')?;
    let (value, _) = rest.split_once(';')?;
    Some((name.trim(), value.trim().trim_end_matches('u').parse().ok()?))
}

impl EnumLayout {
    /// The names of the shaders' constants, in the order of their numbers.
    fn names(&self) -> impl Iterator<Item = String> {
        let capitals = |name: &str| {
            let words = name.char_indices().map(|(i, letter)| {
                let gap = if i > 0 && letter.is_ascii_uppercase() { "_" } else { "" };
                format!("{gap}{}", letter.to_ascii_uppercase())
            });
            words.collect::<String>()
        };
        self.variants.iter().map(move |name| format!("{}_{}", self.prefix, capitals(name)))
    }

    /// Compares every shader constant that has the prefix with the variants.
    ///
    /// # Errors
    /// On the first that differs or is missing on one side; names both.
    pub(in crate::gpu) fn check(&self, pipeline: &str, found: &[Constant]) -> Result<()> {
        if self.prefix.is_empty() {
            return Ok(());
        }
        let (name, begin) = (self.name, format!("{}_", self.prefix));
        let constants: Vec<_> = self.names().collect();
        let found = found.iter().filter(|found| found.name.starts_with(&begin));
        let found: Vec<_> = found.collect();
        for Constant { name: constant, value, place } in &found {
            let Some(number) = constants.iter().position(|known| known == constant) else {
                bail!(
                    "{place}: {constant} is in the shader, but Rust's {name} has no such variant"
                );
            };
            let variant = self.variants[number];
            ensure!(
                *value == number as u32,
                "{place}: {constant} is {value} in the shader, and {name}::{variant} is {number} in Rust"
            );
        }
        let missing = constants.iter().position(|known| !found.iter().any(|c| c.name == *known));
        match missing {
            None => Ok(()),
            Some(number) => bail!(
                "{pipeline}: Rust has {name}::{}, but no shader says `const uint {} = {number};`",
                self.variants[number],
                constants[number]
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    common::shader_enum! {
        /// The quantity shown per pixel.
        enum Show: SHOW { Picture, HitKind, Direction = "ray direction" }
        /// Shaders know nothing of it.
        enum Preset { Board, FourSpheres }
    }

    #[test]
    fn one_declaration_gives_words_numbers_and_constants() {
        assert_eq!(Show::LAYOUT.words, ["picture", "hit kind", "ray direction"]);
        assert_eq!(Preset::LAYOUT.words, ["board", "four spheres"]);
        assert_eq!(Show::ALL.iter().map(|show| u32::from(*show)).collect::<Vec<_>>(), [0, 1, 2]);
        let constants: Vec<_> = Show::LAYOUT.names().collect();
        assert_eq!(constants, ["SHOW_PICTURE", "SHOW_HIT_KIND", "SHOW_DIRECTION"]);
        assert!(Number::from(Show::HitKind) == Show::HitKind);
        assert_eq!(bytemuck::bytes_of(&Number::from(Show::Direction)), 2u32.to_ne_bytes());
    }

    #[test]
    fn constants_that_differ_are_named_on_both_sides() {
        let check = |lines: &[(&str, u32)]| {
            let line = |(name, value): &(&str, u32)| format!("const uint {name} = {value};\n");
            let lines: String = lines.iter().map(line).collect();
            let text = format!(
                "#version 460\n#line 1 \"a/push.glsl\"\n{lines}#line 9 \"a/camera.rgen\"\n"
            );
            Show::LAYOUT
                .check("a", &constants("a/camera.rgen", &text))
                .map_err(|error| error.to_string())
        };
        let [picture, kind, direction] =
            [("SHOW_PICTURE", 0), ("SHOW_HIT_KIND", 1), ("SHOW_DIRECTION", 2)];
        assert_eq!(check(&[picture, kind, direction, ("SHOWN", 7)]), Ok(()));
        assert_eq!(
            check(&[picture, ("SHOW_HIT_KIND", 3), direction]).unwrap_err(),
            "a/push.glsl:2: SHOW_HIT_KIND is 3 in the shader, and Show::HitKind is 1 in Rust"
        );
        assert_eq!(
            check(&[picture, kind, direction, ("SHOW_FOG", 3)]).unwrap_err(),
            "a/push.glsl:4: SHOW_FOG is in the shader, but Rust's Show has no such variant"
        );
        assert_eq!(
            check(&[picture, direction]).unwrap_err(),
            "a: Rust has Show::HitKind, but no shader says `const uint SHOW_HIT_KIND = 1;`"
        );
        assert!(Preset::LAYOUT.check("a", &[]).is_ok());
    }
}
