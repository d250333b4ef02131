//! A window that is used for a long time: memory, handles and threads do not increase.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use reference::random::Random;
use run::layer::Layer;
use time_limit::{Limit, Work};

use crate::desk::{
    Desk, KEY_COMMA, KEY_F1, KEY_F5, KEY_HOME, KEY_PERIOD, KEY_SPACE, KEY_TAB, wait,
};
use crate::{LIGHT_SHADOWS, alone, copy_shaders, ended_well};

const NAME: &str = "25_scene_effects";

/// The resources of a process: megabytes of memory, open files, threads.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    megabytes: usize,
    files: usize,
    threads: usize,
}

impl Held {
    fn by(process: u32) -> Self {
        let folder = Path::new("/proc").join(process.to_string());
        let count = |name| fs::read_dir(folder.join(name)).expect("it runs").count();
        let pages = fs::read_to_string(folder.join("statm")).expect("it runs");
        let pages = pages.split(' ').nth(1).and_then(|text| text.parse::<usize>().ok());
        Self {
            megabytes: pages.expect("pages in memory") * 4 / 1024,
            files: count("fd"),
            threads: count("task"),
        }
    }

    fn most(all: &[Self]) -> Self {
        let most = |of: fn(&Self) -> usize| all.iter().map(of).max().unwrap_or_default();
        Self {
            megabytes: most(|held| held.megabytes),
            files: most(|held| held.files),
            threads: most(|held| held.threads),
        }
    }
}

/// Uses a window: drags in the panel and on the picture, keys, sizes, edited shaders.
struct Hand<'a> {
    random: Random,
    desk: &'a Desk,
    shaders: &'a Path,
    size: [u32; 2],
    counts: [usize; 6],
}

impl Hand<'_> {
    fn play(&mut self) {
        let kind = [0, 0, 0, 0, 1, 2, 3, 3, 4, 5][self.random.below(10)];
        self.counts[kind] += 1;
        match kind {
            0 => self.drag(20, 340),
            1 => self.drag(360, 760),
            2 => {
                let keys =
                    [KEY_F1, KEY_F1, KEY_HOME, KEY_TAB, KEY_TAB, KEY_SPACE, KEY_COMMA, KEY_PERIOD];
                self.desk.key(keys[self.random.below(keys.len())]);
            }
            3 => {
                self.size = [500, 300].map(|least| least + self.random.below(400) as u32);
                self.desk.resize(self.size[0], self.size[1]);
            }
            4 => self.edit(),
            _ => self.desk.key(KEY_F5),
        }
        sleep(Duration::from_millis(self.random.below(60) as u64));
    }

    /// Drags from a random place between two columns to one near it: a click, a slider, a rotation.
    fn drag(&mut self, left: i16, right: i16) {
        let x = left + self.random.below((right - left) as usize) as i16;
        let y = 15 + self.random.below(self.size[1] as usize - 20) as i16;
        let by = self.random.below(60) as i16 - 30;
        let steps = 1 + self.random.below(4) as i16;
        self.desk.drag((x, y), (x + by, y), steps);
    }

    /// One edit in eight breaks the shader, and the next fixes it.
    fn edit(&mut self) {
        let file = self.shaders.join(NAME).join("sky.rmiss");
        let good = fs::read_to_string(run::root().join("shaders").join(NAME).join("sky.rmiss"));
        let broken = if self.random.below(8) == 0 { "nonsense" } else { "" };
        let text = format!("{}{broken}\n// {}\n", good.expect("the sky"), self.random.bits());
        fs::write(file, text).expect("an edit");
    }
}

#[test]
#[ignore = "nightly only: ten minutes, or as many as MINUTES says"]
fn a_window_that_is_played_with_for_long_holds_no_more_than_before() {
    let _alone = alone();
    let minutes = std::env::var("MINUTES").map_or(10.0, |text| text.parse().expect("a number"));
    let [folder, shaders] = [(); 2].map(|()| tempfile::tempdir().expect("a temporary folder"));
    copy_shaders(shaders.path(), &["common", NAME]);
    let calls = folder.path().join("calls");
    let layer = Layer::fail_nth_call("");
    let environment = layer.environment();
    let mut environment: Vec<_> =
        environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
    environment.extend([("CALLS", &*calls), ("SHADERS", shaders.path())]);
    let arguments = ["--size", "800x700", "--set", "scene=opening"];
    let desk = Desk::open(NAME, &arguments, &environment);
    let random = Random(3);
    let mut hand =
        Hand { random, desk: &desk, shaders: shaders.path(), size: [800, 700], counts: [0; 6] };
    let (start, mut held) = (Instant::now(), Vec::new());
    while start.elapsed().as_secs_f64() < 60.0 * minutes {
        for _ in 0..25 {
            hand.play();
        }
        held.push(Held::by(desk.id()));
    }
    let counts = hand.counts;
    // It still responds.
    fs::copy(
        run::root().join("shaders").join(NAME).join("sky.rmiss"),
        shaders.path().join(NAME).join("sky.rmiss"),
    )
    .expect("an edit");
    desk.resize(640, 420);
    wait("the size", || (desk.shown().width() == 640).then_some(()));
    desk.close();
    ended_well(desk.end());
    let quarters: Vec<_> = held.chunks(held.len().div_ceil(4)).map(Held::most).collect();
    println!("panel, picture, keys, sizes, edits, F5: {counts:?}; the most of each quarter:");
    quarters.iter().for_each(|quarter| println!("{quarter:?}"));
    for line in fs::read_to_string(calls).expect("it was told").lines() {
        if ["RayTracingPipelines", "CreateSwapchain", "QueueSubmit2"]
            .iter()
            .any(|n| line.contains(n))
        {
            println!("{line}");
        }
    }
    // Per hour: enough pictures of other sizes, and edits, for the test to be meaningful.
    let least = |count: usize, hourly: f64| count as f64 >= hourly * minutes / 60.0;
    assert!(least(counts[3], 2000.0) && least(counts[4], 500.0), "{counts:?}");
    let (early, late) = (quarters[1], quarters[3]);
    assert!(late.megabytes <= early.megabytes * 5 / 4 + 32, "memory grows");
    assert!(
        late.files <= early.files + 4 && late.threads <= early.threads + 2,
        "handles stay open"
    );
}

#[test]
#[ignore = "nightly: many pipelines; quick: a_pipeline_that_is_made_in_the_background_changes_the_picture_when_it_is_there"]
fn controls_may_change_faster_than_pipelines_are_made() {
    let _alone = alone();
    let arguments = ["--validate", "--size", "800x700", "--set", "scene=opening"];
    let folder = tempfile::tempdir().expect("a temporary folder");
    let calls = folder.path().join("calls");
    let layer = Layer::fail_nth_call("");
    let environment = layer.environment();
    let mut environment: Vec<_> =
        environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
    environment.push(("CALLS", &calls));
    let desk = Desk::open(NAME, &arguments, &environment);
    let (mut random, mut clicks) = (Random(4), 0);
    let (start, work) = (Instant::now(), Work::of_process(desk.id()));
    let enough = Limit::worked(8);
    while !enough.is_over(work, start) {
        // The switch of an effect, or a place near it.
        let switch = (LIGHT_SHADOWS.0, 390 + random.below(270) as i16);
        desk.drag(switch, switch, 1);
        clicks += 1;
    }
    desk.picture();
    desk.close();
    ended_well(desk.end());
    let made = Layer::calls(&calls)["vkCreateRayTracingPipelinesKHR"];
    println!("{clicks} clicks, {made} pipelines");
    // The first, and some in the background; settings changed meanwhile were never built.
    assert!((3..clicks).contains(&made), "{clicks} clicks, {made} pipelines");
}
