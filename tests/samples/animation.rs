//! 14_animation: a frame is the same bytes however it is reached, moving objects are where their formulas
//! place them, and the game obeys the rules.

mod cloth;
mod decay;
mod hostile;
mod moves;
mod structures;

#[allow(dead_code)]
#[path = "../../samples/assets/chess_game/game.rs"]
mod game;
#[path = "../../samples/14_animation/leg.rs"]
mod leg;
#[path = "../../samples/14_animation/legs.rs"]
mod legs;
#[path = "../../samples/14_animation/motion.rs"]
mod motion;
#[path = "../../samples/14_animation/pole.rs"]
mod pole;
#[allow(dead_code)]
#[path = "../../samples/assets/chess_game/position.rs"]
mod position;
#[path = "../../samples/14_animation/turned.rs"]
pub mod turned;

use common::model::{Model, obj};
use common::scene::{self, Camera, Scene, assets};
use glam::{Affine3A, DVec3, Vec3};
use leg::Motion;
use motion::KINDS;
use reference::Ray;
use reference::hit::Hit;
use reference::ulp::ulp_error;
use run::primary_hits::{answer, rays, reference};
use run::{Chapter, bits, expected, same_answers, same_colors};
use serde_json::json;
use turned::TABLE;

const NAME: &str = "14_animation";
const SIZE: &str = "96x60";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// The opera game, as played by the sample.
fn opera() -> Motion {
    legs::open(&assets().join("games/opera.legs")).unwrap()
}

/// Every way to reach frame 934: played, stepped, jumped to; built, updated from a near and from a distant
/// frame.
#[test]
fn a_frame_is_the_same_bytes_whichever_way_it_was_reached() {
    every_way_leads_to_the_frame(&["show=hit"]);
}

#[test]
#[ignore = "nightly: the other views; quick: animation::a_frame_is_the_same_bytes_whichever_way_it_was_reached"]
fn so_it_is_in_colour_and_where_shadow_rays_start() {
    every_way_leads_to_the_frame(&["show=picture", "show=shadow origin"]);
}

fn every_way_leads_to_the_frame(views: &[&str]) {
    for show in views.iter().copied() {
        let jumped = chapter().sets(&[show, "frame=934"]).picture();
        let other = chapter().sets(&[show, "frame=930"]).picture();
        assert!(bits(&jumped) != bits(&other), "{show}: nothing moves");
        for (arguments, sets) in [
            // Played, past a frame at which both levels are built (920 is 115 times 8).
            (&["--frames", "20"][..], &["frame=915", "build every=8"][..]),
            (&["--frames", "20"], &["frame=915", "flag=rebuilt", "top level=rebuilt"]),
            (&["--frames", "5"], &["frame=930", "flag=updated", "top level=rebuilt"]),
            // Paused at this frame.
            (&["--frames", "3"], &["frame=934", "play=off"]),
            // Built at this frame, at the previous one, and at the very first.
            (&[], &["frame=934", "build every=1"]),
            (&[], &["frame=934", "build every=933"]),
            (&[], &["frame=934", "build every=3600"]),
            (&["--unordered"], &["frame=934"]),
        ] {
            let reached = chapter().with(arguments).sets(&[show]).sets(sets).picture();
            let what = format!("{show} {arguments:?} {sets:?}");
            let same = if show == "show=picture" { same_colors } else { same_answers };
            same(&what, NAME, &reached, &jumped);
        }
    }
}

#[test]
fn the_first_frames_are_played_as_they_are_jumped_to() {
    let played = bits(&chapter().frames(70).sets(&["build every=32"]).picture());
    assert!(played == bits(&chapter().sets(&["frame=69"]).picture()));
    // Playing stops at the last frame, however many are requested.
    let last = opera().last;
    let ended = chapter().frames(6).sets(&[format!("frame={}", last - 2)]).picture();
    assert!(bits(&ended) == bits(&chapter().set("frame", last).picture()));
}

/// Everything visible in a frame, with each instance's record, in the sample's order.
fn exact(frame: u32) -> (reference::scene::Scene, Vec<usize>) {
    let mut model: Model = obj::load(&assets().join("chess.obj")).unwrap();
    model.meshes.extend([turned::table(9.6, 0), pole::pole(6.4, 0), cloth::mesh(frame, 48)]);
    let mesh = |name: &str| model.meshes.iter().position(|mesh| mesh.name == name).unwrap();
    let screen = Vec3::new(0.0, 0.02, -4.28);
    let mut instances = Vec::new();
    let mut records = Vec::new();
    let mut add = |mesh, transform, record| {
        instances.push(scene::Instance { mesh, transform, material: 0, record_offset: 0 });
        records.push(record);
    };
    for (record, (name, at)) in [
        ("board_light", Vec3::ZERO),
        ("board_dark", Vec3::ZERO),
        ("board_frame", Vec3::ZERO),
        ("screen", screen),
        ("screen_frame", screen),
        ("table", Vec3::new(0.0, TABLE, 0.0)),
        ("pole", cloth::POLE),
    ]
    .into_iter()
    .enumerate()
    {
        add(mesh(name), Affine3A::from_translation(at), 12 + record);
    }
    for piece in opera().at(frame) {
        add(mesh(KINDS[piece.kind]), piece.at, 6 * piece.side + piece.kind);
    }
    add(mesh("flag"), cloth::place(), 19);
    let scene = Scene { model, instances, camera: camera() };
    (reference(&scene), records)
}

fn camera() -> Camera {
    Camera::new(DVec3::new(-6.3, 4.6, 10.9), DVec3::new(0.6, 1.35, -0.6), 38.5)
}

/// Pieces in motion, a knight in the air, and the flag, compared with exact answers in 64 bits: the pieces
/// from their legs, the cloth from its formula.
#[test]
fn everything_is_where_its_formula_says() {
    let mut largest = 0f64;
    for frame in [0, 932, 1824] {
        let set = format!("frame={frame}");
        let [directions, hits] =
            ["show=ray direction", "show=hit"].map(|show| chapter().sets(&[show, &set]).picture());
        let (exact, records) = exact(frame);
        let (mut right, mut at_edges, mut of_flag) = (0, 0, 0);
        for (ray, pixel) in rays(&camera(), &directions).zip(&hits.pixels) {
            let found = answer(pixel).map(|hit| (hit.instance as usize, hit.primitive, hit.t));
            let is_right = |hit: &Hit| {
                let record = records[hit.instance as usize];
                // The cloth's corners come from sines; llvmpipe's are accurate enough for this.
                let near = if record == 19 {
                    |t: f32, exact: f64| (f64::from(t) - exact).abs() < 1e-5 * exact
                } else {
                    |t: f32, exact: f64| ulp_error(t, exact) < 64.0
                };
                found.is_some_and(|(found, triangle, t)| {
                    (found, triangle) == (record, hit.primitive) && near(t, hit.t)
                })
            };
            let nearest = exact.closest_hit(&ray, |_| true);
            if nearest.as_ref().map_or(found.is_none(), is_right) {
                right += 1;
                if let (Some((19, _, t)), Some(hit)) = (found, nearest) {
                    of_flag += 1;
                    largest = largest.max((f64::from(t) - hit.t).abs());
                }
            } else {
                assert!(
                    is_at_an_edge(&exact, &ray, found.is_none(), is_right),
                    "{ray:?} {found:?}"
                );
                at_edges += 1;
            }
        }
        println!("frame {frame}: {right} right, {of_flag} on the flag, {at_edges} at edges");
        assert!(at_edges < 60 && of_flag > 60, "{frame}: {right} {of_flag} {at_edges}");
    }
    let hundred_millionths = (1e8 * largest).ceil();
    expected::hold("14_animation/cloth", json!({ "largest": hundred_millionths / 1e8 }));
}

/// Returns whether a ray whose hit differs from the exact one passes close enough to an edge: its hit is a
/// candidate within the bounds, or it is on the flag, whose corners are rounded differently here.
fn is_at_an_edge(
    exact: &reference::scene::Scene,
    ray: &Ray,
    missed: bool,
    is_right: impl Fn(&Hit) -> bool,
) -> bool {
    let candidates = exact.near_candidates(ray);
    let flag = exact.all_hits(ray).iter().any(|hit| hit.instance == 39);
    flag || missed && !candidates.iter().any(|near| near.must_hit(ray))
        || candidates.iter().any(|near| is_right(&near.hit))
}
