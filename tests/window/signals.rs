//! Signals to a window, from its start to the writing of a picture: it ends by the signal, and leaves nothing
//! half-written.

use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::Duration;

use reference::random::Random;

use crate::alone;
use crate::desk::{self, Desk, KEY_F2};

/// The number of windows that get a signal, each at another moment.
const TRIES: u32 = 3;
const SIGNALS: [(&str, i32); 3] = [("INT", 2), ("TERM", 15), ("HUP", 1)];

/// Sends a random signal, and returns its number.
fn signal(random: &mut Random, id: u32) -> i32 {
    let (name, number) = SIGNALS[random.below(3)];
    let sent = Command::new("kill").args(["-s", name, &id.to_string()]).status();
    assert!(sent.expect("kill").success());
    number
}

/// Checks that the signal has ended it, without output.
#[track_caller]
fn ended_by(number: i32, output: &Output) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.signal(), &*errors), (Some(number), ""));
}

#[test]
fn a_signal_may_come_while_a_window_opens() {
    let _alone = alone();
    let mut random = Random(1);
    for _ in 0..TRIES {
        let mut sent = 0;
        let output = desk::outcome_with("02_basic", &["--size", "320x200"], &[], |id| {
            sleep(Duration::from_secs_f64(random.between(0.0, 1.2)));
            sent = signal(&mut random, id);
        });
        ended_by(sent, &output);
    }
}

#[test]
fn a_signal_may_come_while_a_window_writes_a_picture() {
    let _alone = alone();
    let mut random = Random(2);
    for _ in 0..TRIES {
        let desk = Desk::open("02_basic", &["--size", "640x420"], &[]);
        let folder = desk.folder.path().to_owned();
        desk.key(KEY_F2);
        sleep(Duration::from_secs_f64(random.between(0.0, 0.06)));
        let sent = signal(&mut random, desk.id());
        // The folder is removed with the desk.
        let (output, files) = desk.end_with(|| {
            let files =
                folder.read_dir().expect("a folder").map(|file| file.expect("a file").path());
            files.map(|file| (image::open(&file).is_ok(), file)).collect::<Vec<_>>()
        });
        ended_by(sent, &output);
        assert!(files.iter().all(|(whole, _)| *whole), "{files:?}");
    }
}
