//! A pawn that becomes a queen while the shutter is open, and rotations by half a turn and nearly so.

use std::path::Path;

use glam::{DQuat, Quat, Vec3};
use run::{bits, evaluate};

use super::leg::{Motion, UNDER_WAY};
use super::shutter::{Between, Pose, between};
use super::{chapter, legs};

const METHODS: [&str; 2] = ["method=swept", "method=moments"];

/// A pawn that moves two squares, lifted or pushed, and arrives in frame 34 as the piece `becomes`.
fn promoted(folder: &Path, lift: u32, becomes: &str) -> String {
    let file = folder.join(format!("{becomes}{lift}.legs"));
    let text = format!(
        "last 60\npiece white pawn -1 0 0.5\npiece black rook 3 0 0.5\nleg 0 0 1 0 0.5 {lift} {becomes}\n"
    );
    std::fs::write(&file, text).unwrap();
    file.to_str().unwrap().to_owned()
}

fn seen(scene: &str, sets: &[&str]) -> Vec<[u32; 4]> {
    bits(&chapter("96x60").scene(scene).sets(sets).picture())
}

/// The shutter opens in the last frame of the move and closes after it: the pawn is not a queen yet, bit for
/// bit and in every respect. One frame later it is one, and at rest.
#[test]
fn a_pawn_is_a_pawn_until_the_shutter_opens_upon_a_queen() {
    a_pawn_becomes_a_queen(&[2], &["show=picture"]);
}

#[test]
#[ignore = "nightly: the other views; quick: motion_blur::hard::a_pawn_is_a_pawn_until_the_shutter_opens_upon_a_queen"]
fn so_it_is_lifted_and_pushed_in_all_that_is_seen() {
    a_pawn_becomes_a_queen(&[0, 2], &["show=picture", "show=normal", "show=smear"]);
}

fn a_pawn_becomes_a_queen(lifts: &[u32], shows: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    for &lift in lifts {
        let [pawn, queen] = ["", "queen"].map(|becomes| promoted(folder.path(), lift, becomes));
        for method in METHODS {
            let both = |frame: &str, show: &str| {
                [&pawn, &queen]
                    .map(|file| seen(file, &[frame, "shutter=2", "samples=8", method, show]))
            };
            for show in shows {
                let [pawn, queen] = both("frame=33", show);
                assert!(pawn == queen, "lift {lift}, {method}, {show}: a queen before it arrives");
            }
            let [pawn, queen] = both("frame=34", "show=normal");
            assert!(pawn != queen, "lift {lift}, {method}: no queen");
        }
    }
    // From then on, it is as if it had always been one.
    let queen = promoted(folder.path(), 2, "queen");
    let stands = folder.path().join("stands.legs");
    std::fs::write(&stands, "last 60\npiece white queen 1 0 0.5\npiece black rook 3 0 0.5\n")
        .unwrap();
    for method in METHODS {
        let sets = ["frame=34", "shutter=2", "samples=8", method];
        let [arrived, stands] = [&queen, stands.to_str().unwrap()].map(|file| seen(file, &sets));
        assert!(arrived == stands, "{method}: a queen that was a pawn is another queen");
    }
}

fn about(axis: Vec3, degrees: f64) -> Pose {
    let (sin, cos) = (0.5 * degrees.to_radians()).sin_cos();
    let axis = axis.as_dvec3().normalize() * sin;
    let rotation = DQuat::from_xyzw(axis.x, axis.y, axis.z, cos).as_quat();
    Pose { place: Vec3::new(1.0, 2.0, 3.0), rotation }
}

const AXES: [Vec3; 4] = [Vec3::Y, Vec3::X, Vec3::new(1.0, 2.0, -3.0), Vec3::new(-0.2, 1.0, 0.1)];
/// Degrees around half a turn: where the f32 cosine of half the angle is 0, and a few units on either side.
const NEARLY: [f64; 9] =
    [170.0, 179.0, 179.99, 179.999_99, 180.0, 180.000_01, 180.01, 181.0, 190.0];

/// A rotation takes the shorter way for either sign of its quaternion, evenly to a few percent, and never
/// shrinks. At exactly half a turn both ways are equally long, and it takes one of them.
#[test]
fn half_a_turn_goes_one_of_two_ways_and_less_goes_the_shorter() {
    for axis in AXES {
        for start in [0.0, 77.0, -140.0] {
            for degrees in NEARLY {
                let open = about(axis, start);
                for sign in [1.0, -1.0] {
                    let mut close = about(axis, start + degrees);
                    close.rotation *= sign;
                    let ends = [open, close.near(open)];
                    let what = format!("{axis}, {start} and {degrees} degrees, sign {sign}");
                    assert!(ends[0].rotation.dot(ends[1].rotation) >= 0.0, "{what}");
                    halfway(ends, axis, degrees, &what);
                }
            }
        }
    }
}

fn halfway(ends: [Pose; 2], axis: Vec3, degrees: f64, what: &str) {
    let at = |part| between(ends, part, Between::Rotation).matrix3;
    for part in (0..=16).map(|i| i as f32 / 16.0) {
        let matrix = at(part);
        // A few roundings of numbers below 1 in each entry, and products of three.
        let size = matrix.determinant();
        assert!((size - 1.0).abs() < 4e-6, "{what}: {size} at {part}");
    }
    // Both ends are unchanged, with whichever sign they are written.
    for (part, end) in [(0.0, ends[0]), (1.0, ends[1])] {
        let end = Quat::from_mat3a(&at(part)).dot(end.rotation).abs();
        assert!((end - 1.0).abs() < 1e-6, "{what}: {end}");
    }
    // From one end to the middle is half of the shorter way.
    let turned = Quat::from_mat3a(&(at(0.5) * at(0.0).transpose()));
    let way = 2.0 * f64::from(turned.xyz().dot(axis.normalize())).atan2(turned.w.into());
    let way = (way.to_degrees() + 540.0).rem_euclid(360.0) - 180.0;
    let half = 0.5 * degrees.min(360.0 - degrees);
    assert!((way.abs() - half).abs() < 1e-3, "{what}: {way}");
    if (degrees - 180.0).abs() > 1e-3 {
        assert!((way > 0.0) == (degrees < 180.0), "{what}: the longer way, {way}");
    }
}

/// No setting of the controls shows the shutter half a turn, which might go the wrong way.
#[test]
fn no_control_asks_for_half_a_turn() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("knight.legs");
    std::fs::write(&file, "last 60\npiece white knight -2 0 0.5\nleg 0 0 2 0 0.5 2\n").unwrap();
    let motion: Motion = legs::open(&file).unwrap();
    // The maximum of the controls.
    let (turns, shutter) = (3, 2.0);
    let yaw = |time: f64| f64::from(motion.at(time, turns).next().unwrap().yaw);
    // Where it arrives, it has turned by whole circles, and is recorded as not turned.
    let circles = 360.0 * f64::from(turns);
    let times = (0..4 * UNDER_WAY).map(|quarter| f64::from(quarter) / 4.0);
    let ways = times.map(|time| yaw(time + shutter) - yaw(time));
    let most = ways.map(|way| if way < 0.0 { way + circles } else { way }).fold(0.0, f64::max);
    assert!(most > 150.0 && most < 170.0, "{most} degrees");
}

/// The shader's own poses and boxes at half a turn: a rotation at every time, with each vertex inside its
/// box.
#[test]
fn the_box_of_half_a_turn_holds_its_arc() {
    let shader = |file: &str| {
        let path = run::root().join("shaders/23_motion_blur").join(file);
        std::fs::read_to_string(path).unwrap()
    };
    let sweep = shader("sweep.comp");
    let (_, own) = sweep.split_once("\nBounds swept(").unwrap();
    let (own, _) = own.split_once("\n}\n").unwrap();
    let own = format!("\nBounds swept({own}\n}}\n");
    assert_eq!(own.matches("sweep.margin").count(), 1);
    let own = own.replace("sweep.margin", "0.0");
    let quaternion = |[x, y, z, w]: [f32; 4]| format!("vec4({x:?}, {y:?}, {z:?}, {w:?})");
    let mut pairs = Vec::new();
    // From a start at 0 degrees, a vertex's arc comes as close to its box as possible.
    for start in [0.0, 140.0] {
        for axis in AXES {
            for degrees in NEARLY {
                for sign in [1.0, -1.0] {
                    let open = about(axis, start);
                    let mut close = about(axis, start + degrees);
                    close.rotation *= sign;
                    pairs.push([open.rotation, close.near(open).rotation]);
                }
            }
        }
    }
    let list = |end: usize| {
        let all = pairs.iter().map(|pair| quaternion(pair[end].to_array()));
        all.collect::<Vec<_>>().join(", ")
    };
    let (count, opens, closes) = (pairs.len(), list(0), list(1));
    // Its buffer of moving objects is behind an address that is unknown to Rust here.
    let mover = shader("mover.glsl");
    let mover: String = mover
        .lines()
        .filter(|line| !line.contains("buffer_reference"))
        .map(|line| format!("{line}\n"))
        .collect();
    let declared = format!(
        "struct Bounds {{ vec3 low; vec3 high; }};
         const float ROUNDING = 5.9604645e-8;
         {mover}{own}
         const vec4 OPENS[{count}] = vec4[]({opens});
         const vec4 CLOSES[{count}] = vec4[]({closes});"
    );
    // One column per time, one row per turn: the largest distance of a vertex outside its box, and the change
    // of a volume.
    let body = "
        vec3 way = at.y < OPENS.length() / 2 ? vec3(0.0) : vec3(0.5, 0.0, -1.0);
        vec3 place = vec3(1.0, 2.0, 3.0);
        Mover mover = Mover(OPENS[at.y], CLOSES[at.y], place, place + way, 0, 1);
        vec3 corners[3] = vec3[](vec3(0.2, 1.3, 0.1), vec3(0.0, 1.0, 0.7), vec3(0.1, 0.7, -0.3));
        Bounds bounds = swept(mover, corners);
        mat4x3 pose = pose_at(mover, float(at.x) / 64.0);
        float outside = -1e30;
        for (int i = 0; i < 3; i++) {
            vec3 p = pose * vec4(corners[i], 1.0);
            vec3 beyond = max(bounds.low - p, p - bounds.high);
            outside = max(outside, max(beyond.x, max(beyond.y, beyond.z)));
        }
        answer = vec4(outside, determinant(mat3(pose)), bounds.high.y - bounds.low.y, 1.0);";
    let found = evaluate(&declared, body, &format!("65x{count}"));
    let mut nearest = f32::MIN;
    for (i, &[outside, volume, height, _]) in found.pixels.iter().enumerate() {
        let (time, turn) = (i % 65, i / 65);
        assert!(outside <= 0.0, "turn {turn} at {time}/64 leaves its box by {outside}");
        // A quaternion's components and products, each with a few roundings.
        assert!((volume - 1.0).abs() < 4e-6, "turn {turn} at {time}/64: {volume}");
        // Half a turn's arc is off its chord by half of it, so no box is larger than three times the shape.
        assert!(height < 6.0, "turn {turn}: a box {height} high");
        nearest = nearest.max(outside);
    }
    // The remaining margin is 64 roundings of about 8.
    assert!(nearest > -1e-4, "{nearest}: no arc comes near to its box, so nothing was held");
}
