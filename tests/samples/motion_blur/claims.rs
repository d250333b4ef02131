//! The chapter's claims about shutters, methods and poses.

use common::app::Picture;
use glam::{Quat, Vec3};
use run::{Chapter, Near, bits, device, expected, same_answers, same_colors};
use serde_json::{Value, json};

use super::shutter::{Between, Pose, between};
use super::{NAME, chapter};

/// A view of frame 932 without 14's flag and its shadow.
const VIEW: [&str; 4] =
    ["frame=932", "camera eye=-4,4.6,9", "camera target=-2.2,1.2,0", "field of view=20"];

fn seen_by(name: &str, sets: &[&str]) -> Picture {
    Chapter::new(name).size("96x60").sets(&VIEW).sets(sets).picture()
}

#[test]
fn without_a_shutter_it_is_its_parent_to_the_bit() {
    it_is_its_parent(&["show=picture", "show=shadow origin"]);
}

#[test]
#[ignore = "nightly: the other views; quick: motion_blur::claims::without_a_shutter_it_is_its_parent_to_the_bit"]
fn so_it_is_in_the_other_views() {
    it_is_its_parent(&["show=normal", "show=shadow", "show=ray direction"]);
}

fn it_is_its_parent(shows: &[&str]) {
    for &show in shows {
        let parent = seen_by("14_animation", &[show]);
        for method in ["method=swept", "method=moments"] {
            let own = seen_by(NAME, &[show, method, "shutter=0", "turns=0"]);
            let what = format!("{show} {method}");
            match show {
                "show=shadow origin" | "show=ray direction" => {
                    same_answers(&what, NAME, &own, &parent);
                }
                _ => same_colors(&what, NAME, &own, &parent),
            }
        }
    }
    let parent = seen_by("14_animation", &["show=picture"]);
    let differs = |sets: &[&str]| bits(&seen_by(NAME, sets)) != bits(&parent);
    assert!(differs(&["turns=0"]), "an open shutter shows nothing else");
    assert!(differs(&["shutter=0"]), "nothing turns");
}

/// All samples are equal if nothing moves, and so is their mean.
#[test]
fn a_board_at_rest_is_as_sharp_as_with_one_sample() {
    let [one, many] = ["samples=1", "samples=64"]
        .map(|samples| chapter("96x60").sets(&["frame=2", samples]).picture());
    assert!(bits(&one) == bits(&many));
}

#[test]
fn a_frame_is_the_same_bytes_whether_played_or_jumped_to() {
    let sets = |frame| [frame, "samples=4", "shutter=2"];
    for method in ["method=swept", "method=moments"] {
        let jumped = chapter("96x60").sets(&sets("frame=934")).sets(&[method]).picture();
        let played = chapter("96x60").frames(5).sets(&sets("frame=930")).sets(&[method]).picture();
        assert!(bits(&jumped) == bits(&played), "{method}");
    }
    // A rejected hit must leave the accepted one unchanged, in whatever order the two come.
    for method in ["method=swept", "method=moments"] {
        let sets = [&sets("frame=934")[..], &[method]].concat();
        let [one, other] = [&[][..], &["--unordered"]]
            .map(|order| chapter("96x60").with(order).sets(&sets).picture());
        same_answers(&format!("{method} --unordered"), NAME, &one, &other);
    }
    // At one moment, both methods see the same shadows.
    let one = [&sets("frame=934")[..], &["moments=1", "times=middle", "show=shadow"]].concat();
    let [moments, swept] = ["method=moments", "method=swept"]
        .map(|method| chapter("240x150").sets(&one).sets(&[method]).picture());
    let differ = moments.pixels.iter().zip(&swept.pixels).filter(|(a, b)| a != b).count();
    // Two triangle tests may only differ at edges of shadows; llvmpipe's equals that of the chapter.
    let most =
        if device::is_software() { 8 } else { Near::of(NAME).both().flips(&moments) as usize };
    assert!(differ <= most, "{differ} pixels of {most}");
}

/// Halfway, the mean of two matrices is narrower by the cosine of half the angle, in both directions
/// perpendicular to the axis.
#[test]
fn mean_matrices_shrink_and_rotations_do_not() {
    let mut held = json!({});
    for degrees in [20.0f32, 60.0, 90.0, 150.0] {
        let pose = |yaw: f32| {
            let rotation = Quat::from_rotation_y(yaw.to_radians());
            Pose { place: Vec3::new(1.0, 2.0, 3.0), rotation }
        };
        let ends = [pose(140.0), pose(140.0 + degrees)];
        let half = (0.5 * f64::from(degrees).to_radians()).cos();
        let matrix = between(ends, 0.5, Between::Matrix).matrix3;
        let rotation = between(ends, 0.5, Between::Rotation).matrix3;
        // A few roundings of numbers below 1 in each entry, and a product of two.
        let near = |found: f32, exact: f64| {
            assert!((f64::from(found) - exact).abs() < 2e-6, "{found} {exact}")
        };
        near(matrix.determinant(), half * half);
        near(matrix.x_axis.length(), half);
        near(matrix.y_axis.length(), 1.0);
        near(rotation.determinant(), 1.0);
        near(rotation.x_axis.length(), 1.0);
        held[format!("{degrees}")] = json!(matrix.x_axis.length());
    }
    expected::hold_exact("23_motion_blur/shrink", held);
}

/// In the picture of the middle moment, the knight has its normal size, and is smaller with the mean of
/// matrices.
#[test]
fn the_shrunken_knight_is_seen() {
    let area = |sets: &[&str]| {
        let sets =
            [&["frame=934", "turns=3", "shutter=2", "times=middle", "show=smear"], sets].concat();
        let seen = chapter("120x75").sets(&sets).picture();
        seen.pixels.iter().filter(|pixel| pixel[0] == 1.0).count()
    };
    for method in ["method=swept", "method=moments"] {
        let [rotation, matrix] =
            ["between=rotation", "between=matrix"].map(|set| area(&[set, method, "moments=1"]));
        assert!(matrix < rotation && rotation > 100, "{method}: {matrix} of {rotation}");
    }
    // A single moment is the middle one in both methods: the same triangles at the same places.
    let [swept, once] = ["method=swept", "method=moments"].map(|set| area(&[set, "moments=1"]));
    assert!(swept.abs_diff(once) <= 2, "{swept} {once}: more than rounding at an outline");
}

fn counted(sets: &[&str]) -> Value {
    chapter("240x150").sets(sets).run().report["chapter"].clone()
}

/// The counts of both methods, in one frame of 16 samples.
#[test]
fn methods_cost_what_is_counted() {
    let of = |method| counted(&["frame=934", "shutter=2", "count calls=on", method]);
    let (moments, swept) = (of("method=moments"), of("method=swept"));
    for (name, counted) in [("moments", &moments), ("swept", &swept)] {
        println!("{name}: {counted}");
    }
    assert_eq!(moments["calls"], 0);
    assert!(swept["calls"].as_u64() > Some(100_000), "{swept}");
    // Two objects move: each is included eight times, or once.
    assert_eq!(moments["instances"].as_u64(), swept["instances"].as_u64().map(|few| few + 14));
    assert!(swept["bottom_bytes"].as_u64() > moments["top_bytes"].as_u64());
    assert_eq!(moments["bottom_bytes"], 0);
    let mut held = json!({});
    for (method, counted) in [("moments", &moments), ("swept", &swept)] {
        for name in ["top_bytes", "bottom_bytes", "box_bytes", "instances", "boxes", "calls"] {
            held[format!("{method}-{}", name.replace('_', "-"))] = counted[name].clone();
        }
    }
    expected::hold("23_motion_blur/costs", held);
}

/// With fewer moments than samples, the blur is a row of copies; errors fall as moments are added.
#[test]
#[ignore = "nightly: 1,024 samples per pixel; quick: motion_blur::smear::the_smear_of_a_ball_is_its_closed_form"]
fn moments_come_near_to_the_smear() {
    let of = |sets: &[&str]| {
        chapter("96x60").sets(&["frame=934", "shutter=2", "show=smear"]).sets(sets).picture()
    };
    let exact = of(&["samples=1024"]);
    let errors = ["1", "2", "4", "8"].map(|moments| {
        let moments = format!("moments={moments}");
        error(&of(&["method=moments", &moments, "samples=64"]), &exact)
    });
    println!("{errors:?}");
    assert!(errors.is_sorted_by(|a, b| *b < 0.8 * a), "{errors:?}");
    expected::hold(
        "23_motion_blur/moments",
        json!({ "1": errors[0], "2": errors[1], "4": errors[2], "8": errors[3] }),
    );
}

/// The root of the mean square, over the pixels where the exact value is neither 0 nor 1.
fn error(picture: &Picture, exact: &Picture) -> f64 {
    let pairs = picture.pixels.iter().zip(&exact.pixels);
    let squares: Vec<f64> = pairs
        .filter(|(_, exact)| exact[0] > 0.0 && exact[0] < 1.0)
        .map(|(one, exact)| f64::from(one[0] - exact[0]).powi(2))
        .collect();
    assert!(squares.len() > 50, "{} pixels", squares.len());
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// With random times, the error falls with the root of the samples. With strata, it falls in proportion to
/// them, because a pixel is only wrong where an edge passes within a stratum.
#[test]
#[ignore = "nightly: 2,048 samples per pixel; quick: motion_blur::smear::the_smear_of_a_ball_is_its_closed_form"]
fn strata_are_better_than_chance() {
    let of = |samples: u32, times: &str| {
        let samples = format!("samples={samples}");
        chapter("96x60").sets(&["frame=934", "shutter=2", "show=smear", &samples, times]).picture()
    };
    let exact = of(2048, "times=strata");
    let mut held = json!({});
    let mut slopes = Vec::new();
    for times in ["random", "strata"] {
        let errors =
            [4, 16, 64].map(|samples| error(&of(samples, &format!("times={times}")), &exact));
        slopes.push((errors[2] / errors[0]).ln() / 16f64.ln());
        println!("{times}: {errors:?}");
        for (samples, error) in [4, 16, 64].into_iter().zip(errors) {
            held[format!("{times}-{samples}")] = json!(error);
        }
    }
    (held["random-slope"], held["strata-slope"]) = (json!(slopes[0]), json!(slopes[1]));
    assert!((slopes[0] + 0.5).abs() < 0.1, "{slopes:?}");
    assert!(slopes[1] < -0.85, "{slopes:?}");
    expected::hold("23_motion_blur/error", held);
}
