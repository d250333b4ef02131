//! 42's digits of a discriminant, compared with exact products and with floats.

use reference::rational::rational;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "42_distant_spheres.html";

/// b² and a·c, exactly, in millionths and rounded down.
fn operands([ox, oy]: [f32; 2], [dx, dy]: [f32; 2]) -> [String; 2] {
    let [ox, oy, dx, dy] = [ox, oy, dx, dy].map(|x| rational(x.into()));
    let b = &ox * &dx + &oy * &dy;
    let a = &dx * &dx + &dy * &dy;
    let c = &ox * &ox + &oy * &oy - rational(1.0);
    [&b * &b, a * c].map(|product| (product * rational(1e6)).floor().to_string())
}

/// The discriminant computed in floats as in `sphere_textbook`, and as in `sphere_stable`.
fn discriminants(o: [f32; 2], d: [f32; 2]) -> [f32; 2] {
    let dot = |a: [f32; 2], b: [f32; 2]| a[0] * b[0] + a[1] * b[1];
    let [a, b, c] = [dot(d, d), dot(o, d), dot(o, o) - 1.0];
    let foot = [0, 1].map(|i| o[i] + -b / a * d[i]);
    [b * b - a * c, a * (1.0 - dot(foot, foot))]
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_digits_are_exact_and_the_discriminants_those_of_floats() {
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(PAGE), "digits");
    let what = "[found.o, found.d, found.operands, [found.textbook, found.stable], found.same, found.held]";
    // The number of wrong hits and misses of each rung: a miss is a discriminant below 0.
    let mut wrong = [0; 2];
    for step in (0..=100).step_by(4) {
        for aside in [0, 30, 50, 80, 94, 106, 110] {
            let controls = [step, aside].map(|number: u32| number.to_string());
            let controls = [("distance", &*controls[0]), ("aside", &*controls[1])];
            let told = found(&mut browser, &controls, what);
            type Told = ([f32; 2], [f32; 2], [String; 2], [f32; 2], usize, usize);
            let (o, d, told, drawn, same, held): Told = serde_json::from_value(told).unwrap();
            let (exact, floats) = (operands(o, d), discriminants(o, d));
            let at = format!("{controls:?}");
            assert_eq!((&told, drawn), (&exact, floats), "{at}");
            let [one, other] = exact.each_ref().map(|digits| digits.as_bytes());
            let length = one.len() == other.len();
            let alike = one.iter().zip(other).take_while(|(one, other)| one == other).count();
            assert_eq!(same, if length { alike } else { 0 }, "{at}");
            // The last correct digit is worth more than the float's last bit, the next one less.
            let square: f64 =
                one.iter().fold(0.0, |sum, digit| sum * 10.0 + f64::from(digit - b'0'));
            let bit = 2f64.powi((square * 1e-6).log2().floor() as i32 - 23);
            let last = 10f64.powi(one.len() as i32 - 6 - held as i32);
            assert!(last >= bit && (last / 10.0 < bit || last < 2e-6), "{at}: {last} {bit}");
            for (wrong, float) in wrong.iter_mut().zip(floats) {
                *wrong += usize::from((float >= 0.0) != (aside < 100));
            }
        }
    }
    assert!(wrong[0] > 20 && wrong[1] == 0, "{wrong:?}");
}
