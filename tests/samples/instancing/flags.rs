//! Masks and flags: the rays that see a piece, the visible side, and the cuts.

use reference::hit::Hit;

use super::formation::{BLACK, BOARD, WHITE};
use super::{FEW, SPECIMEN, ViewedScene, chapter, indices};
use run::bits;
use run::primary_hits::answer;

#[test]
fn a_mask_hides_from_the_camera_and_keeps_the_shadow() {
    let viewed = ViewedScene::few();
    let mask = |index: u32| viewed.pieces[index as usize].mask;
    let all = chapter().sets(&FEW).sets(&["show=hit"]).picture();
    assert!([BOARD, WHITE, BLACK].iter().all(|&kind| {
        indices(&all).flatten().filter(|&index| viewed.pieces[index].mask == kind).count() > 500
    }));
    let shadows = |sets: &[&str]| bits(&chapter().sets(sets).sets(&["show=shadow"]).picture());
    let (all, all_shadows) = (bits(&all), shadows(&FEW));
    for (sees, hidden) in [("white", WHITE), ("black", BLACK)]
        .map(|(name, bit)| (format!("camera sees=all but {name}"), bit))
    {
        let sets = [&FEW[..], &[sees.as_str()]].concat();
        let hits = viewed.hits(&sets);
        for (ray, hit) in hits.iter().step_by(5) {
            let is_seen = |hit: &Hit| mask(hit.instance) != hidden;
            let verdict = viewed.exact.judge(ray, answer(hit), is_seen);
            assert!(verdict.is_allowed(), "{sees}: {verdict:?}");
        }
        // A pixel with the same surface as before is in the same shadow.
        let hits: Vec<_> = hits.iter().map(|(_, hit)| hit.map(f32::to_bits)).collect();
        let same: Vec<_> = (0..hits.len()).filter(|&i| hits[i][..3] == all[i][..3]).collect();
        let shadows = shadows(&sets);
        assert!(same.len() > 5000 && same.iter().all(|&i| shadows[i] == all_shadows[i]));
    }
    // And without their shadows more is lit, and nothing is darker.
    let lit = |set: &str| {
        chapter().sets(&FEW).sets(&[set, "camera sees=the board", "show=shadow"]).picture()
    };
    let (everything, board) = (lit("shadows of=everything"), lit("shadows of=the board"));
    let pairs = || everything.pixels.iter().zip(&board.pixels);
    assert!(pairs().all(|(all, few)| all[0] <= few[0]));
    let freed = pairs().filter(|(all, few)| all[0] < few[0]).count();
    assert!(freed > 500, "{freed}");
}

#[test]
fn facing_is_the_mesh_s_own_unless_a_flag_flips_it() {
    let flags = ["none", "facing cull disable", "flip facing"];
    // Mirrored and sheared pieces without flags; and pieces that are only rotated.
    let scenes = [
        (ViewedScene::specimens(), &[SPECIMEN][..], &flags[..1]),
        (ViewedScene::few(), &FEW, &flags[..]),
    ];
    for (viewed, sets, flags) in scenes {
        let is_white = |hit: &Hit| viewed.pieces[hit.instance as usize].mask == WHITE;
        let mut pictures = Vec::new();
        for (culling, keeps_front) in [("culling=back faces", true), ("culling=front faces", false)]
        {
            for &flags in flags {
                let set = format!("flags of white={flags}");
                let sets = [sets, &[culling, &set]].concat();
                let accept = |hit: &Hit| {
                    let flipped = flags == "flip facing" && is_white(hit);
                    let is_front = hit.counterclockwise != flipped;
                    is_front == keeps_front || (flags == "facing cull disable" && is_white(hit))
                };
                let hits = viewed.hits(&sets);
                for (ray, hit) in hits.iter().step_by(9) {
                    let verdict = viewed.exact.judge(ray, answer(hit), accept);
                    assert!(verdict.is_allowed(), "{sets:?}: {verdict:?}");
                }
                pictures.push(hits);
            }
        }
        // Closed pieces show their backs only if their fronts are culled.
        if let [back, back_off, back_flipped, front, front_off, front_flipped] = &pictures[..] {
            assert!(back == back_off && back != back_flipped);
            assert!(front != front_off && front_off == front_flipped);
        }
    }
}

#[test]
fn no_opaque_lets_the_any_hit_shader_cut() {
    let viewed = ViewedScene::few();
    let sets = [&FEW[..], &["flags of white=force no-opaque"]].concat();
    let (mut cut, mut doubtful) = (0, 0);
    let whole = viewed.hits(&FEW);
    for ((ray, hit), (_, before)) in viewed.hits(&sets).iter().zip(&whole) {
        // Ten slices per unit, each six tenths thick, in the mesh's own space.
        let slice = |hit: &Hit| {
            let transform = viewed.transform(hit.instance as usize);
            let height = (transform.inverse * (ray.at(hit.t) - transform.translation)).y;
            (10.0 * height).rem_euclid(1.0)
        };
        let is_white = |hit: &Hit| viewed.pieces[hit.instance as usize].mask == WHITE;
        let keep = |hit: &Hit| !is_white(hit) || slice(hit) <= 0.6;
        if !viewed.exact.judge(ray, answer(hit), keep).is_allowed() {
            // A hit close enough to a cut that rounding decides.
            let near = viewed.exact.all_hits(ray).into_iter().any(|hit| {
                let slice = slice(&hit);
                is_white(&hit) && [0.0, 0.6, 1.0].iter().any(|cut| (slice - cut).abs() < 1e-4)
            });
            assert!(near, "{ray:?} {hit:?}");
            doubtful += 1;
        }
        cut += usize::from(hit[..3] != before[..3]);
    }
    println!("{cut} pixels cut, {doubtful} at a cut");
    assert!(cut > 200 && doubtful < 20, "{cut} {doubtful}");
}
