//! Reflections in the plane, and reflections of the plane in mirrors.

use common::app::Picture;
use common::scene::Camera;
use glam::{DVec3, Vec3};
use reference::Ray;
use reference::ulp::ulp_error;

use super::{Octahedron, PLANE, chapter, level, pieces};
use run::primary_hits::rays;

/// The eye of the board preset, and its mirror image in the plane.
const EYE: [&str; 2] = ["camera eye=-3.4,1.6,7.2", "camera target=0.6,0.62,0"];
const IMAGE: [&str; 2] = ["camera eye=-3.4,-1.6,7.2", "camera target=0.6,-0.62,0"];

/// Compares every hit of a view of the board preset with the exact one; returns the numbers of hits on the
/// plane and on pieces. Rays from below pass through the plane.
fn hits_are_exact(exact: &reference::scene::Scene, sets: &[&str], sign: f64) -> [usize; 2] {
    let show = |view| chapter().sets(sets).sets(&[view]).picture();
    let (hits, directions) = (show("show=hit"), show("show=ray direction"));
    let camera =
        Camera::new(DVec3::new(-3.4, sign * 1.6, 7.2), DVec3::new(0.6, sign * 0.62, 0.0), 37.0);
    let ([mut of_plane, mut of_pieces, mut edges], mut worst) = ([0; 3], 0.0f64);
    for (ray, hit) in rays(&camera, &directions).zip(&hits.pixels) {
        let scene = exact.closest_hit(&ray, |_| true);
        let plane = level(0.0).intersect(&ray).filter(|_| sign > 0.0);
        let first_of_both = match (scene, plane) {
            (Some(scene), Some(plane)) if scene.t < plane.t => Some(scene.instance as f32),
            (_, Some(_)) => Some(PLANE),
            (Some(scene), None) => Some(scene.instance as f32),
            (None, None) => None,
        };
        if first_of_both.unwrap_or(-1.0) != hit[0] {
            // Excused where an edge is grazed, or where a piece's foot and the plane coincide.
            let near = exact.near_candidates(&ray);
            let foot = plane.is_some_and(|plane| {
                near.iter().any(|near| (near.hit.t - plane.t).abs() <= near.t_bound)
            });
            let grazed = near.iter().any(|near| near.may_hit(&ray) && !near.must_hit(&ray));
            assert!(foot || grazed, "{ray:?} {hit:?} {scene:?} {plane:?}");
            edges += 1;
            continue;
        }
        if hit[0] == PLANE {
            worst = worst.max(ulp_error(hit[2], plane.unwrap().t) * plane.unwrap().normal.y.abs());
            of_plane += 1;
        } else if hit[0] >= 0.0 {
            of_pieces += 1;
        }
    }
    println!(
        "{of_plane} rays end on the plane, {of_pieces} on pieces, {edges} at edges; \
         t on the plane is off by {worst:.1} ULP at most"
    );
    assert!(edges * 200 < hits.pixels.len(), "{edges}");
    [of_plane, of_pieces]
}

#[test]
fn the_plane_mirrors_the_pieces() {
    let exact = pieces();
    let image = [&IMAGE[..], &["inside=through", "depth=0"]].concat();
    let [of_plane, of_pieces] = hits_are_exact(&exact, &EYE, 1.0);
    assert!(of_plane > 3000 && of_pieces > 1000, "{of_plane} {of_pieces}");
    let [of_plane, of_pieces] = hits_are_exact(&exact, &image, -1.0);
    assert!(of_plane == 0 && of_pieces > 1000, "{of_plane} {of_pieces}");

    // A plane that only mirrors shows the view from the mirrored eye.
    let mirror = [
        "plane reflection=1",
        "plane specular=0",
        "light squares=0,0,0",
        "dark squares=0,0,0",
        "depth=1",
    ];
    let mirrored = chapter().sets(&EYE).sets(&mirror).picture();
    let [direct, behind] =
        [&[][..], &["show=hit"]].map(|view| chapter().sets(&image).sets(view).picture());
    let met = chapter().sets(&EYE).sets(&["show=hit"]).picture();
    let (width, height) = (120, 75);
    let ([mut alike, mut other], mut piece) = ([0; 2], 0);
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        let (at, image) = (row * width + column, (height - 1 - row) * width + column);
        if met.pixels[at][0] != PLANE {
            continue;
        }
        let (a, b) = (mirrored.pixels[at], direct.pixels[image]);
        let close = (0..3).all(|i| (a[i] - b[i]).abs() < 1e-3 * (1.0 + b[i]));
        *if close { &mut alike } else { &mut other } += 1;
        piece += usize::from(close && behind.pixels[image][0] >= 0.0);
    }
    println!("{alike} pixels mirror what the image sees, {piece} of them a piece; {other} do not");
    assert!(piece > 300 && other * 50 < alike, "{piece} {alike} {other}");
}

#[test]
fn what_mirrors_mirrors_the_plane() {
    // Seen from below: the plane's underside shines in squares, and nothing is visible above it.
    let model = Octahedron::new(&[Vec3::Y]);
    let sets = [
        "plane distance=3",
        "inside=color",
        "inside color=1,1,1",
        "minimum contribution=0",
        "camera eye=-1,1.4,2.4",
        "camera target=0,1,0",
    ];
    // A reflected ray starts where the shadow ray of the same hit does.
    let show = |more: &[&str]| model.picture(&[&sets[..], more].concat());
    let [once, twice] = ["depth=0", "depth=1"].map(|depth| show(&[depth]));
    let [hits, normals, starts, directions] = ["hit", "normal", "shadow origin", "ray direction"]
        .map(|view| show(&[&format!("show={view}")]));
    let ([mut square, mut sky, mut borders], mut light) = ([0; 3], 0);
    for i in (0..hits.pixels.len()).filter(|&i| hits.pixels[i][0] >= 0.0) {
        let vector = |picture: &Picture| DVec3::from_slice(&picture.pixels[i].map(f64::from)[..3]);
        let (normal, incoming) = (2.0 * vector(&normals) - 1.0, vector(&directions));
        let cosine = -normal.dot(incoming);
        let direction = incoming + 2.0 * cosine * normal;
        let mirror = (1.0 - cosine).powi(5) * DVec3::new(0.6, 0.7, 0.8) + DVec3::new(0.4, 0.3, 0.2);
        let seen = (vector(&twice) - vector(&once)) / mirror;
        let ray = Ray {
            origin: vector(&starts),
            direction,
            ..Ray::from_f32([0.0; 3], [1.0; 3], 0.0, 1e30)
        };
        let Some(plane) = level(3.0).intersect(&ray) else {
            // The sky is blue.
            assert!(seen.z - seen.x > 0.01, "{ray:?} {seen}");
            sky += 1;
            continue;
        };
        let at = ray.origin + plane.t * ray.direction;
        if [at.x, at.z].iter().any(|x| (x - x.round()).abs() < 2e-3) {
            borders += 1;
            continue;
        }
        let is_light = (at.x.floor() + at.z.floor()) % 2.0 == 0.0;
        // Squares fade where the ray grazes the plane.
        let part = ((direction.y.abs() - 0.02) / 0.08).clamp(0.0, 1.0);
        let part = part * part * (3.0 - 2.0 * part);
        let expected = 0.5 + part * if is_light { 0.5 } else { -0.5 };
        assert!((seen - expected).abs().max_element() < 1e-3, "{ray:?} {seen} {expected}");
        square += 1;
        light += usize::from(is_light);
    }
    println!(
        "{square} mirrored rays meet a square, {light} a light one, {borders} a border, {sky} the sky"
    );
    assert!(light > 100 && square - light > 100 && sky > 100, "{square} {light} {sky}");
    assert!(borders * 20 < square, "{borders}");
}
