//! The families of `--compile-for`, and whose compiler each one has.

use clap::ValueEnum;

/// A GPU family for which Mesa compiles ray tracing pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Family {
    /// Radeon, RDNA2
    Navi21,
    /// Radeon, RDNA3
    Navi31,
    /// Radeon, RDNA4
    Gfx1201,
    /// Intel Arc A-series
    Dg2,
    /// Intel Arc B-series
    Bmg,
    /// All of them
    All,
}

/// Names of the Radeon families.
pub const RADEON: [&str; 3] = ["navi21", "navi31", "gfx1201"];
/// Names of the Intel families.
pub const INTEL: [&str; 2] = ["dg2", "bmg"];

impl Family {
    /// Mesa's names of the selected families; `all` has Intel's only where their cards can be had.
    pub fn names(self, has_intel: bool) -> &'static [&'static str] {
        match self {
            Self::Navi21 => &["navi21"],
            Self::Navi31 => &["navi31"],
            Self::Gfx1201 => &["gfx1201"],
            Self::Dg2 => &["dg2"],
            Self::Bmg => &["bmg"],
            Self::All if has_intel => &["navi21", "navi31", "gfx1201", "dg2", "bmg"],
            Self::All => &RADEON,
        }
    }
}

/// A maker of GPUs with a driver of Mesa's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maker {
    /// AMD, with RADV.
    Amd,
    /// Intel, with ANV.
    Intel,
}

impl Maker {
    /// The maker of a family or card, by the name that Mesa's shim has for it.
    pub fn of(card: &str) -> Self {
        let intel = ["dg2", "bmg", "mtl", "arl", "lnl", "ptl"];
        if intel.contains(&card) { Self::Intel } else { Self::Amd }
    }

    /// True if a device of this name is this card.
    pub fn is(self, card: &str, name: &str) -> bool {
        let card = card.to_uppercase();
        match self {
            // Such as "AMD Radeon RX 7900 XTX (RADV NAVI31)", or "Null hardware (RADV NAVI31)".
            Self::Amd => name.ends_with(&format!("(RADV {card})")),
            // Such as "Intel(R) Arc(tm) A770M Graphics (DG2)", or "Intel(R) Graphics (BMG G21)".
            Self::Intel => {
                let own = name.rsplit_once('(').map_or("", |(_, own)| own);
                own.split([' ', ')']).next() == Some(card.as_str())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_card_is_known_by_its_device_s_name() {
        for (card, name) in [
            ("navi31", "AMD Radeon RX 7900 XTX (RADV NAVI31)"),
            ("gfx1201", "Null hardware (RADV GFX1201)"),
            ("dg2", "Intel(R) Arc(tm) A770M Graphics (DG2)"),
            ("bmg", "Intel(R) Graphics (BMG G21)"),
        ] {
            assert!(Maker::of(card).is(card, name), "{name}");
            assert!(!Maker::of(card).is(card, "llvmpipe (LLVM 15.0.6, 256 bits)"));
        }
        assert!(!Maker::Intel.is("dg2", "Intel(R) Graphics (BMG G21)"));
    }
}
