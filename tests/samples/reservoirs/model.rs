//! The reservoirs of 32 on a few pixels and lamps, with every outcome of every random choice, in rational numbers.
//!
//! It follows `candidates.glsl` and `merge.glsl` line by line: what is a random number there is a sum over all outcomes
//! here. A lamp has one point.

use std::collections::BTreeMap;

use dashu::rational::RBig;

/// The lamps that could light each pixel.
pub struct World {
    /// The probability of each lamp as a candidate.
    pub chosen: Vec<RBig>,
    /// The light of each lamp at each pixel, without shadows: `light[pixel][lamp]`.
    pub light: Vec<Vec<RBig>>,
    /// True if the pixel sees the lamp.
    pub seen: Vec<Vec<bool>>,
}

/// The weight of a sample that several reservoirs could have made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    OneOverM,
    OneOverZ,
    Balance,
}

impl Weights {
    /// With their names in the controls.
    pub const ALL: [(Self, &str); 3] =
        [(Self::OneOverM, "1/M"), (Self::OneOverZ, "1/Z"), (Self::Balance, "balance")];
}

/// The controls.
#[derive(Clone, Copy)]
pub struct Rules {
    pub weights: Weights,
    pub visibility: bool,
    pub candidates: u32,
    /// The largest count of a history.
    pub most: u32,
}

/// A lamp, or none if the weight is 0.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Reservoir {
    pub lamp: usize,
    pub weight: RBig,
    pub count: u32,
}

/// Outcomes and their probabilities.
pub type Outcomes<T> = BTreeMap<T, RBig>;

/// A reservoir and the pixel it was made for.
pub type Source = (usize, Reservoir);

pub fn whole(n: u32) -> RBig {
    RBig::from(n)
}

fn add<T: Ord>(outcomes: &mut Outcomes<T>, outcome: T, probability: RBig) {
    let so_far = outcomes.entry(outcome).or_insert(RBig::ZERO);
    *so_far = &*so_far + probability;
}

/// All pairs of two independent choices.
pub fn both<A: Ord + Clone, B: Ord + Clone>(a: &Outcomes<A>, b: &Outcomes<B>) -> Outcomes<(A, B)> {
    let pairs =
        a.iter().flat_map(|(x, p)| b.iter().map(move |(y, q)| ((x.clone(), y.clone()), p * q)));
    pairs.collect()
}

/// Replaces each outcome by those that follow from it.
pub fn then<A: Ord, B: Ord>(
    outcomes: &Outcomes<A>,
    next: impl Fn(&A) -> Outcomes<B>,
) -> Outcomes<B> {
    let mut all = Outcomes::new();
    for (outcome, probability) in outcomes {
        for (following, part) in next(outcome) {
            add(&mut all, following, probability * part);
        }
    }
    all
}

/// The numbers of kept weights, if each replaces the one before in proportion to its part of the sum so far.
fn kept(weights: &[RBig]) -> (Vec<(Option<usize>, RBig)>, RBig) {
    let mut sum = RBig::ZERO;
    let mut outcomes = vec![(None, RBig::ONE)];
    for (i, weight) in weights.iter().enumerate() {
        if *weight == RBig::ZERO {
            continue;
        }
        sum = &sum + weight;
        let replaces = weight / &sum;
        let stays = RBig::ONE - &replaces;
        let new: RBig = outcomes.iter().map(|(_, p)| p * &replaces).fold(RBig::ZERO, |a, b| a + b);
        outcomes.iter_mut().for_each(|(_, p)| *p = &*p * &stays);
        outcomes.push((Some(i), new));
    }
    outcomes.retain(|(_, p)| *p != RBig::ZERO);
    (outcomes, sum)
}

impl World {
    /// All light that arrives at a pixel.
    pub fn truth(&self, pixel: usize) -> RBig {
        (0..self.chosen.len()).map(|lamp| self.arriving(pixel, lamp)).fold(RBig::ZERO, |a, b| a + b)
    }

    fn arriving(&self, pixel: usize, lamp: usize) -> RBig {
        if self.seen[pixel][lamp] { self.light[pixel][lamp].clone() } else { RBig::ZERO }
    }

    /// As in `candidates.glsl`.
    pub fn candidates(&self, rules: Rules, pixel: usize) -> Outcomes<Reservoir> {
        let lamps = self.chosen.len();
        let mut all = Outcomes::new();
        for choice in 0..lamps.pow(rules.candidates) {
            let digit = |i: u32| choice / lamps.pow(i) % lamps;
            let chosen: Vec<usize> = (0..rules.candidates).map(digit).collect();
            let probability = chosen.iter().fold(RBig::ONE, |p, &lamp| p * &self.chosen[lamp]);
            let weight = |&lamp: &usize| &self.light[pixel][lamp] / &self.chosen[lamp];
            let (outcomes, sum) = kept(&chosen.iter().map(weight).collect::<Vec<_>>());
            for (number, part) in outcomes {
                let mut reservoir =
                    Reservoir { lamp: 0, weight: RBig::ZERO, count: rules.candidates };
                if let Some(number) = number {
                    let lamp = chosen[number];
                    if !rules.visibility || self.seen[pixel][lamp] {
                        reservoir.lamp = lamp;
                        reservoir.weight =
                            &sum / (whole(rules.candidates) * &self.light[pixel][lamp]);
                    }
                }
                add(&mut all, reservoir, &probability * part);
            }
        }
        all
    }

    fn could_make(&self, rules: Rules, pixel: usize, lamp: usize) -> bool {
        self.light[pixel][lamp] != RBig::ZERO && (!rules.visibility || self.seen[pixel][lamp])
    }

    /// As `share` in `merge.glsl`.
    fn share(&self, rules: Rules, i: usize, sources: &[Source]) -> RBig {
        let lamp = sources[i].1.lamp;
        let target =
            |(pixel, reservoir): &Source| whole(reservoir.count) * &self.light[*pixel][lamp];
        let mut all = RBig::ZERO;
        for (j, other) in sources.iter().enumerate() {
            if j == i || self.could_make(rules, other.0, lamp) {
                all += target(other);
            }
        }
        target(&sources[i]) / all
    }

    /// As in `merge.glsl`: source 0 is the pixel's own.
    pub fn merged(&self, rules: Rules, sources: &[Source]) -> Outcomes<Reservoir> {
        let pixel = sources[0].0;
        let weight = |i: usize| {
            let (_, Reservoir { lamp, weight, count }) = &sources[i];
            if *weight == RBig::ZERO || !self.could_make(rules, pixel, *lamp) {
                return RBig::ZERO;
            }
            let part = match rules.weights {
                Weights::Balance => self.share(rules, i, sources),
                _ => whole(*count),
            };
            part * &self.light[pixel][*lamp] * weight
        };
        let (outcomes, sum) = kept(&(0..sources.len()).map(weight).collect::<Vec<_>>());
        let count = sources.iter().map(|source| source.1.count).sum();
        let mut all = Outcomes::new();
        for (maker, probability) in outcomes {
            let mut reservoir = Reservoir { lamp: 0, weight: RBig::ZERO, count };
            if let Some(maker) = maker {
                let lamp = sources[maker].1.lamp;
                let able = |source: &Source| {
                    if self.could_make(rules, source.0, lamp) { source.1.count } else { 0 }
                };
                let divisor = match rules.weights {
                    Weights::OneOverM => whole(count),
                    Weights::OneOverZ => whole(sources.iter().map(able).sum()),
                    Weights::Balance => RBig::ONE,
                };
                reservoir.lamp = lamp;
                reservoir.weight = &sum / (divisor * &self.light[pixel][lamp]);
            }
            add(&mut all, reservoir, probability);
        }
        all
    }

    /// The first frame of two pixels: each merges with the other.
    pub fn space(
        &self,
        rules: Rules,
        fresh: &Outcomes<(Reservoir, Reservoir)>,
    ) -> Outcomes<(Reservoir, Reservoir)> {
        then(fresh, |(a, b)| {
            let [own, other] = [(0, a.clone()), (1, b.clone())];
            let at_a = self.merged(rules, &[own.clone(), other.clone()]);
            let at_b = self.merged(rules, &[other, own]);
            both(&at_a, &at_b)
        })
    }

    /// A further frame of two pixels: new candidates, those that were kept, and then each other's.
    pub fn next(
        &self,
        rules: Rules,
        kept: &Outcomes<(Reservoir, Reservoir)>,
    ) -> Outcomes<(Reservoir, Reservoir)> {
        let fresh = [0, 1].map(|pixel| self.candidates(rules, pixel));
        let in_time = then(kept, |(a, b)| {
            let [at_a, at_b] = [(0, a), (1, b)].map(|(pixel, before)| {
                let count = before.count.min(rules.most);
                let before = Reservoir { count, ..before.clone() };
                then(&fresh[pixel], |new| {
                    self.merged(rules, &[(pixel, new.clone()), (pixel, before.clone())])
                })
            });
            both(&at_a, &at_b)
        });
        self.space(rules, &in_time)
    }

    /// The mean, and the mean of the square, of the light that a pixel's reservoirs give it.
    pub fn moments(&self, pixel: usize, outcomes: &Outcomes<Reservoir>) -> (RBig, RBig) {
        let mut moments = (RBig::ZERO, RBig::ZERO);
        let mut all = RBig::ZERO;
        for (reservoir, probability) in outcomes {
            let light = self.arriving(pixel, reservoir.lamp) * &reservoir.weight;
            moments.0 += probability * &light;
            moments.1 += probability * &light * &light;
            all += probability;
        }
        assert_eq!(all, RBig::ONE, "every outcome");
        moments
    }
}

/// The outcomes of the first pixel of two.
pub fn first(outcomes: &Outcomes<(Reservoir, Reservoir)>) -> Outcomes<Reservoir> {
    then(outcomes, |(a, _)| Outcomes::from([(a.clone(), RBig::ONE)]))
}

/// The outcomes of the second one.
pub fn second(outcomes: &Outcomes<(Reservoir, Reservoir)>) -> Outcomes<Reservoir> {
    then(outcomes, |(_, b)| Outcomes::from([(b.clone(), RBig::ONE)]))
}
