//! Costs of each effect: the picture's time with it, less the time without.

use anyhow::Result;
use common::Frame;
use common::gpu::{Gpu, Timer, barrier};
use effects::Effect;

use crate::recipe::Recipe;

/// Rounds of a measurement, between one that warms up and one that nobody reads. A frame is a round.
const ROUNDS: usize = 5;

/// The cost of an effect.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Index of the surface.
    pub effect: Effect,
    /// Milliseconds: the median of the rounds' differences.
    pub milliseconds: f64,
    /// The time without it over the time with it.
    pub ratio: f64,
}

/// A measurement of one recipe.
pub struct Costs {
    recipe: Recipe,
    /// A timer for each effect that is left out in its turn, and for none.
    timers: Vec<(Option<Effect>, Timer)>,
    /// Milliseconds by round and timer.
    rounds: Vec<Vec<f64>>,
    /// True if the timers hold a band that is not in the last round yet.
    is_due: bool,
}

impl Costs {
    /// Goes on with the measurement of a recipe, or begins it.
    ///
    /// # Errors
    /// If the device fails.
    pub fn for_recipe(gpu: &Gpu, last: Option<Self>, recipe: Recipe) -> Result<Self> {
        if let Some(last) = last.filter(|last| last.recipe == recipe) {
            return Ok(last);
        }
        let effects = recipe.effects.all();
        // Last with all of them: that is the picture which stays.
        let timers =
            effects.map(Some).chain([None]).map(|left_out| Ok((left_out, Timer::new(gpu)?)));
        let timers = timers.collect::<Result<_>>()?;
        Ok(Self { recipe, timers, rounds: Vec::new(), is_due: false })
    }

    /// Records the picture without each effect and with all of them. `trace` records it by a recipe, and
    /// says whether that recipe's pipeline was there.
    ///
    /// # Errors
    /// If a pipeline cannot be made, or the device fails.
    pub fn record(
        &mut self,
        frame: &Frame,
        mut trace: impl FnMut(Recipe) -> Result<bool>,
    ) -> Result<()> {
        self.read()?;
        if frame.is_first_band() {
            self.rounds.push(vec![0.0; self.timers.len()]);
        }
        let mut all_there = true;
        for (left_out, timer) in &self.timers {
            let effects = left_out.map_or(self.recipe.effects, |e| self.recipe.effects.without(e));
            timer.start(frame.cmd);
            all_there &= trace(Recipe { effects, ..self.recipe })?;
            timer.stop(frame.cmd);
            barrier::trace_to_trace(frame.gpu, frame.cmd);
        }
        self.is_due = all_there;
        if !all_there {
            self.rounds.clear();
        }
        Ok(())
    }

    /// Adds the last band to its round.
    fn read(&mut self) -> Result<()> {
        if let (true, Some(round)) = (self.is_due, self.rounds.last_mut()) {
            for (sum, (_, timer)) in round.iter_mut().zip(&self.timers) {
                *sum += timer.milliseconds()?;
            }
        }
        self.is_due = false;
        Ok(())
    }

    /// Tests whether there are rounds to come.
    pub fn wants_more(&self) -> bool {
        self.rounds.len() < ROUNDS + 2
    }

    /// The costs by all rounds but the first and that which may go on.
    pub fn all(&self) -> Vec<Cost> {
        let rounds = &self.rounds[..self.rounds.len().saturating_sub(1)];
        let rounds = rounds.iter().skip(1);
        let median = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied()
        };
        let costs = self.timers.iter().enumerate().filter_map(|(number, (effect, _))| {
            let pairs = rounds.clone().filter_map(|times| Some((times[number], *times.last()?)));
            let (differences, ratios) =
                pairs.map(|(without, all)| (all - without, without / all)).unzip();
            Some(Cost {
                effect: (*effect)?,
                milliseconds: median(differences)?,
                ratio: median(ratios)?,
            })
        });
        costs.collect()
    }
}
