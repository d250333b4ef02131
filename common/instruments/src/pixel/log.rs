//! The rays of a pixel as text, from the log that shaders write.

use std::fmt::Write;

use super::float::both;
use super::stages::Known;

/// Capacity of the log, in words.
pub const WORDS: u64 = 1 << 18;

/// Kinds of entries: the start of a ray, the return of its trace, the call of a closest hit, any-hit or miss shader,
/// the output of a shader.
pub const RAY: u32 = 1;
pub const BACK: u32 = 2;
pub const HIT: u32 = 3;
pub const ANY_HIT: u32 = 4;
pub const MISS: u32 = 5;
pub const PRINT: u32 = 6;
/// The start of a ray, with several pixels.
pub const MANY: u32 = 7;

/// `gl_RayFlagsSkipClosestHitShaderEXT`.
const SKIPS_CLOSEST_HIT: u32 = 8;

/// The deepest indentation. No device allows more than 31 nested rays, but the words are untrusted.
const DEEPEST: usize = 31;

/// An unfinished ray.
struct Open {
    /// True if a closest hit or miss shader was called.
    ended: bool,
    flags: u32,
}

/// The words that shaders logged.
pub struct Log<'a> {
    words: &'a [u32],
    known: &'a [Known],
    /// The lines printed by the layer, if there is one for each `PRINT`.
    printed: std::slice::Iter<'a, String>,
    open: Vec<Open>,
    rays: usize,
    text: String,
}

impl<'a> Log<'a> {
    /// The text of a log, including the printed lines; and the number of rays.
    pub fn text(words: &'a [u32], known: &'a [Known], printed: &'a [String]) -> (String, usize) {
        let (open, text) = (Vec::new(), String::new());
        let mut log = Self { words, known, printed: [].iter(), open, rays: 0, text };
        let prints = log.entries().filter(|(kind, ..)| *kind == PRINT).count();
        let in_place = prints == printed.len();
        if in_place {
            log.printed = printed.iter();
        }
        for (kind, shader, words) in log.entries().collect::<Vec<_>>() {
            log.add(kind, shader, words);
        }
        if !in_place {
            for line in printed {
                log.line(format_args!("PRINT      {line}"));
            }
            log.line(format_args!(
                "{prints} calls of PRINT, and the validation layer tells of {}: an old one tells of none in a \
                 hit shader",
                printed.len()
            ));
        }
        (log.text, log.rays)
    }

    /// True if several pixels were traced.
    pub fn is_of_many(words: &'a [u32]) -> bool {
        words.iter().take(1).any(|head| head & 0xff == MANY)
    }

    /// The entries: kind, shader, and the words after them.
    fn entries(&self) -> impl Iterator<Item = (u32, &'a str, &'a [u32])> + use<'a> {
        let (mut rest, known) = (self.words, self.known);
        std::iter::from_fn(move || {
            let (&head, after) = rest.split_first()?;
            let kind = head & 0xff;
            let count = match kind {
                RAY => 14,
                HIT | ANY_HIT => 6,
                _ => 0,
            };
            let (words, after) = after.split_at_checked(count)?;
            rest = after;
            let shader = known.get(head as usize >> 8).map_or("?", |known| &known.path);
            Some((kind, shader, words))
        })
    }

    fn line(&mut self, line: std::fmt::Arguments) {
        let depth = self.open.len().min(DEEPEST);
        let _ = writeln!(self.text, "{:1$}{line}", "", 2 * depth);
    }

    fn add(&mut self, kind: u32, shader: &str, words: &[u32]) {
        let name = shader.rsplit('/').next().unwrap_or(shader);
        match (kind, words) {
            (RAY, &[payload, flags, mask, offset, stride, miss, ref numbers @ ..]) => {
                self.rays += 1;
                let known = self.known.iter().find(|known| known.path == shader);
                let of = |known: &Known| {
                    let found = known.payloads.iter().find(|(at, _)| *at == payload)?;
                    Some(found.1.clone())
                };
                let variable = known.and_then(of).unwrap_or_default();
                let number = self.rays;
                self.line(format_args!(
                    "ray {number} · {name} · payload {payload} {variable} · flags {flags:#x} · mask {mask:#x} · \
                     record offset {offset}, stride {stride} · miss {miss}"
                ));
                self.open.push(Open { ended: false, flags });
                let rows = [
                    ("origin", &numbers[..3]),
                    ("direction", &numbers[3..6]),
                    ("tmin", &numbers[6..7]),
                    ("tmax", &numbers[7..]),
                ];
                for (name, words) in rows {
                    self.line(format_args!("{name:9}  {}", both(words)));
                }
            }
            (HIT | ANY_HIT, &[t, instance, custom, geometry, primitive, hit_kind]) => {
                let word = if kind == HIT { "hit" } else { "any-hit" };
                let t = both(&[t]);
                self.line(format_args!(
                    "{word:9}  t {t} · instance {instance} · custom index {custom} · geometry {geometry} · \
                     primitive {primitive} · hit kind {hit_kind:#x} · {name}"
                ));
                self.end(kind == HIT);
            }
            (MISS, _) => {
                self.line(format_args!("miss       {name}"));
                self.end(true);
            }
            (BACK, _) => {
                let silent = self.open.last().filter(|open| !open.ended).map(|open| open.flags);
                match silent {
                    Some(flags) if flags & SKIPS_CLOSEST_HIT != 0 => {
                        self.line(format_args!(
                            "hit        no closest hit shader is called: the flags skip it"
                        ));
                    }
                    Some(_) => self
                        .line(format_args!("           no closest hit or miss shader was called")),
                    None => {}
                }
                self.open.pop();
            }
            (PRINT, _) => {
                if let Some(line) = self.printed.next() {
                    self.line(format_args!("PRINT      {line}"));
                }
            }
            _ => {}
        }
    }

    fn end(&mut self, ended: bool) {
        if let Some(open) = self.open.last_mut() {
            open.ended |= ended;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_words_become_a_text_of_bounded_length() {
        let mut random = 1u32;
        let mut next = || {
            random = random.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            random.swap_bytes()
        };
        let any: Vec<u32> = (0..WORDS).map(|_| next()).collect();
        let kinds = any.iter().map(|word| word % 8).collect();
        // Zeros, the same word repeated, and rays that begin but never return.
        for words in [vec![0; WORDS as usize], vec![RAY; WORDS as usize], any, kinds] {
            let (text, _) = Log::text(&words, &[], &[]);
            assert!(text.len() < 100 * words.len(), "{} bytes", text.len());
        }
    }
}
