//! 12_infinite_plane: every rung held to the exact plane, and a plane that takes part in everything.

use common::app::Picture;
use common::scene::{Camera, Scene, Sun};
use glam::{DVec3, Vec3};
use reference::plane::Plane;
use reference::sphere::Sphere;
use reference::ulp::ulp_error;
use reference::{Ray, Surface};

use run::exact::{rays, reference};
use run::{bits, golden, render};

const NAME: &str = "12_infinite_plane";
const SIZE: &str = "120x75";
/// What `show=hit` says of the plane, instead of an instance.
const PLANE: f32 = -2.0;
/// What one rounding costs at most, relative.
const U: f64 = 1.0 / (1 << 24) as f64;

fn shown(size: &str, sets: &[&str], more: &[&str]) -> Picture {
    let sets = sets.iter().flat_map(|&set| ["--set", set]);
    render(NAME, size, &sets.chain(more.iter().copied()).collect::<Vec<_>>()).picture
}

fn picture(sets: &[&str]) -> Picture {
    shown(SIZE, sets, &[])
}

/// A model of one material that mirrors: an octahedron around `middle`. It loads faster than the pieces.
struct Octahedron(tempfile::TempDir);

impl Octahedron {
    fn new(middle: Vec3) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mtl = "newmtl a\nKd 0.3 0.5 0.2\nKs 0.4 0.3 0.2\nNs 50\nillum 3\nmap_Kd a.png\n";
        std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
        let white = image::RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]));
        white.save(folder.path().join("a.png")).unwrap();
        let mut obj = "mtllib a.mtl\no a\nusemtl a\n".to_owned();
        for corner in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
            let Vec3 { x, y, z } = corner + middle;
            obj += &format!("v {x} {y} {z}\n");
        }
        obj += "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
        std::fs::write(folder.path().join("a.obj"), obj).unwrap();
        Self(folder)
    }

    /// Beyond what a camera sees, so that the plane is alone.
    fn out_of_sight() -> Self {
        Self::new(Vec3::new(0.0, 0.0, 1e9))
    }

    fn path(&self) -> String {
        self.0.path().join("a.obj").display().to_string()
    }

    fn picture(&self, sets: &[&str]) -> Picture {
        shown(SIZE, sets, &["--scene", &self.path()])
    }
}

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden(NAME, &shown("240x150", &[], &[]), 0.002);
}

const RUNGS: [&str; 4] = ["pov", "point", "cut-off", "compensated"];

/// A plane, an eye, and a look along its horizon.
struct View {
    plane: Plane,
    eye: DVec3,
    /// The middle of the picture.
    direction: DVec3,
}

/// A ray, what each rung made of it, and the truth.
struct Judged {
    ray: Ray,
    found: [f32; 4],
    exact: Option<Surface>,
    /// The sine of the angle between ray and plane.
    sine: f64,
}

impl View {
    /// From `height` above a plane, down at a slope (up, if negative), all in f32 numbers.
    fn above(plane: Plane, height: f64, slope: f64) -> Self {
        let n = plane.normal.normalize();
        let along = n.any_orthonormal_vector();
        let eye = (n * (plane.distance + height) + along * 0.3).as_vec3().as_dvec3();
        Self { plane, eye, direction: along - n * slope * height.signum() }
    }

    /// The rays of a picture whose middle row is the given direction and its neighbours to the sides.
    fn judged(&self, model: &Octahedron) -> Vec<Judged> {
        let text = |v: DVec3| format!("{:?},{:?},{:?}", v.x, v.y, v.z);
        let Plane { normal, distance } = self.plane;
        let sets = [
            format!("plane normal={}", text(normal)),
            format!("plane distance={distance}"),
            format!("camera eye={}", text(self.eye)),
            format!("camera target={}", text(self.eye + self.direction)),
            "field of view=60".to_owned(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let show =
            |view| shown("25x25", &[&sets[..], &[view]].concat(), &["--scene", &model.path()]);
        let (directions, found) = (show("show=ray direction"), show("show=rungs"));
        let camera = Camera::new(self.eye, self.eye + self.direction, 60.0);
        let rays = rays(&camera, &directions).zip(&found.pixels);
        let judged = rays.map(|(ray, found)| {
            let exact = self.plane.intersect_exact(&ray).map(|hit| hit.to_f64());
            let along = ray.direction.normalize().dot(normal.normalize());
            Judged { ray, found: *found, exact, sine: along.abs() }
        });
        judged.collect()
    }
}

fn level(distance: f64) -> Plane {
    Plane { normal: DVec3::Y, distance }
}

fn tilted(distance: f64) -> Plane {
    // Any length will do: the square of this one is 0 in 32 bits.
    Plane { normal: DVec3::new(1.0, -3.0, 2.5) * 2f64.powi(-90), distance }
}

#[test]
fn each_rung_is_as_good_as_it_promises() {
    let model = Octahedron::out_of_sight();
    let mut views = Vec::new();
    for (level_height, tilted_height) in [(1e-6, 1e6), (-1e6, -1e-6)] {
        views.push(View::above(level(0.0), level_height, 1e-7));
        views.push(View::above(tilted(0.0), tilted_height, 1e-5));
    }
    views.push(View::above(level(-1e6), 2.0, 1e-7));
    views.push(View::above(tilted(1e6), 2.0, 1e-3));
    let mut lost = 0;
    let mut worst_pov: f64 = 0.0;
    let mut anchored = Vec::new();
    let mut errors = [const { Vec::new() }; 4];
    let (mut hits, mut grazing) = (0, 0);
    for view in &views {
        for Judged { ray, found, exact, sine } in view.judged(&model) {
            let reach = view.plane.distance.abs().max(ray.origin.length());
            let Some(Surface { t, .. }) = exact else {
                // Behind, parallel, or beyond what rays reach: nobody may find it. A rung that gets the
                // side wrong would; the textbook's height may even change its sign.
                assert_eq!(found[1..], [-1.0; 3], "{ray:?}");
                continue;
            };
            hits += 1;
            grazing += usize::from(sine < 1e-5);
            let height = t * sine * ray.direction.length();
            // Cut off is cut off, and otherwise the point's.
            if found[2] < 0.0 {
                assert!(sine < 1.001e-3, "{ray:?} {sine}");
                lost += 1;
            } else {
                assert_eq!(found[1], found[2]);
                assert!(sine > 0.999e-3, "{ray:?} {sine}");
            }
            for rung in [0, 1, 3] {
                errors[rung].push((ulp_error(found[rung], t), sine));
            }
            let relative = (f64::from(found[0]) - t).abs() / t;
            let bar = (reach / height).max(1.0) * (10.0 + 8.0 / sine) * U;
            worst_pov = worst_pov.max(relative / bar);
            assert!(relative <= bar || bar > 1.0, "{ray:?}: {} for {t}", found[0]);
            // The point is near; what is left is the slope of a ray that grazes a tilted plane.
            let level = view.plane.normal == DVec3::Y;
            let relative = (f64::from(found[1]) - t).abs() / t;
            assert!(relative <= (6.0 + 3.0 / sine) * U, "{ray:?}: {} for {t}", found[1]);
            if level || sine > 0.1 {
                anchored.push(ulp_error(found[1], t));
            }
        }
    }
    for (rung, errors) in RUNGS.iter().zip(&mut errors).filter(|(_, errors)| !errors.is_empty()) {
        for (name, from, to) in
            [("below 1e-5", 0.0, 1e-5), ("to 0.05", 1e-5, 0.05), ("above", 0.05, 2.0)]
        {
            let band = errors.iter().filter(|(_, sine)| (from..to).contains(sine));
            let mut band: Vec<f64> = band.map(|(error, _)| *error).collect();
            band.sort_by(f64::total_cmp);
            let at = |part: f64| band.get((band.len() as f64 * part) as usize).unwrap_or(&0.0);
            let worst = band.last().unwrap_or(&0.0);
            println!(
                "{rung:12} sine {name:10}: {} rays, {:.2} ULP median, {:.1} p99, {worst:.1} most",
                band.len(),
                at(0.5),
                at(0.99)
            );
        }
    }
    println!("{hits} hits, {grazing} below 1e-5, {lost} cut off; pov at {worst_pov:.2} of its bar");
    assert!(grazing > 50 && lost > 50, "{grazing} {lost}");
    anchored.sort_by(f64::total_cmp);
    let p99 = anchored[anchored.len() * 99 / 100];
    assert!(p99 <= 4.0, "point: {p99} ULP");
    let worst = errors[3].iter().fold(0.0f64, |worst, (error, _)| worst.max(*error));
    assert!(worst <= 4.0, "compensated: {worst} ULP");
}

#[test]
fn rays_in_the_plane_and_rays_that_begin_on_it_miss() {
    let model = Octahedron::out_of_sight();
    // 1·2 + 2·(-1) = 0: the eye is exactly on the tilted plane.
    let slanted = Plane { normal: DVec3::new(1.0, 2.0, 0.0), distance: 0.0 };
    let on_slanted = DVec3::new(2.0, -1.0, 3.0);
    // Along the plane in the middle row, above it and down through it in the others.
    for (plane, eye) in [(level(1.5), DVec3::Y * 1.5), (slanted, on_slanted)] {
        let judged = View { plane, eye, direction: DVec3::Z }.judged(&model);
        let crossing = judged.iter().filter(|judged| judged.sine > 0.0).count();
        assert!(crossing > 500, "{crossing}");
        for Judged { ray, found, exact, .. } in judged {
            assert!(exact.is_none());
            assert_eq!(found, [-1.0; 4], "{ray:?}");
        }
    }
    // Just above, the middle row goes along the plane, and misses; those below hit.
    let judged = View { plane: level(0.0), eye: DVec3::Y, direction: DVec3::Z }.judged(&model);
    let level: Vec<_> = judged.iter().filter(|judged| judged.sine == 0.0).collect();
    assert_eq!(level.len(), 25);
    assert!(level.iter().all(|judged| judged.found == [-1.0; 4]));
    assert_eq!(judged.iter().filter(|judged| judged.found[1] > 0.0).count(), 12 * 25);
}

// The plane among other things ------------------------------------------------------------------

#[test]
fn testing_before_and_after_give_the_same_bits() {
    let (near, far) = (Octahedron::new(Vec3::Y), Octahedron::new(Vec3::new(6e3, 4801.0, 6.4e3)));
    let at_the_far_one = [
        "plane distance=4800",
        "camera eye=5996.6,4801.6,6407.2",
        "camera target=6000.6,4800.62,6400",
        "light=both",
        "light size=0.1",
        "light samples=4",
    ];
    for (model, sets) in [
        (&near, &["preset=four spheres"][..]),
        (&near, &["preset=pov", "camera eye=-1,-3,2"]),
        (&far, &at_the_far_one),
    ] {
        let [before, after] = ["plane test=before", "plane test=after"]
            .map(|test| model.picture(&[sets, &[test]].concat()));
        assert_eq!(bits(&before), bits(&after), "{sets:?}");
    }
}

#[test]
fn without_the_plane_the_picture_is_that_of_06() {
    let model = Octahedron::new(Vec3::new(0.2, 1.1, 0.0));
    let path = model.path();
    // The sun is the preset's own, the lamp is that of 06.
    let sets = ["light=point", "camera eye=2,3,4", "camera target=0,1,0"];
    let arguments: Vec<&str> =
        sets.iter().flat_map(|set| ["--set", set]).chain(["--scene", &path]).collect();
    let before = render("06_reflection", SIZE, &arguments).picture;
    let after = render(NAME, SIZE, &[&arguments[..], &["--set", "plane=off"]].concat()).picture;
    let with = render(NAME, SIZE, &arguments).picture;
    assert_eq!(bits(&before), bits(&after));
    let changed = bits(&after).iter().zip(bits(&with)).filter(|(a, b)| **a != *b).count();
    assert!(changed > 2000, "{changed}");
}

/// The board preset as the reference sees it.
fn pieces() -> reference::scene::Scene {
    let mut scene = Scene::chess().unwrap();
    let Scene { model, instances, .. } = &mut scene;
    instances.retain(|instance| {
        let name = &model.meshes[instance.mesh].name;
        !name.starts_with("board") && !name.starts_with("screen")
    });
    reference(&scene)
}

/// Where the board preset is looked at from, and from where that eye's image in the plane would look.
const EYE: [&str; 2] = ["camera eye=-3.4,1.6,7.2", "camera target=0.6,0.62,0"];
const IMAGE: [&str; 2] = ["camera eye=-3.4,-1.6,7.2", "camera target=0.6,-0.62,0"];

/// Holds every hit of a view of the board preset to the exact one; tells how many are on the plane and
/// on pieces. Rays that come from below pass the plane.
fn hits_are_exact(exact: &reference::scene::Scene, sets: &[&str], sign: f64) -> [usize; 2] {
    let show = |view| picture(&[sets, &[view]].concat());
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
            // Excused where an edge is grazed, or where a piece's foot and the plane are one.
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

    // A plane that does nothing but mirror shows what an eye sees that is the first one's image.
    let mirror = [
        "plane reflection=1",
        "plane specular=0",
        "light squares=0,0,0",
        "dark squares=0,0,0",
        "depth=1",
    ];
    let mirrored = picture(&[&EYE[..], &mirror].concat());
    let [direct, behind] = [&[][..], &["show=hit"]].map(|view| picture(&[&image, view].concat()));
    let met = picture(&[&EYE[..], &["show=hit"]].concat());
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
    // From below the plane, whose underside shines in squares; above it nothing else is.
    let model = Octahedron::new(Vec3::Y);
    let sets = [
        "plane distance=3",
        "inside=color",
        "inside color=1,1,1",
        "checker=point",
        "smooth terminator=off",
        "minimum contribution=0",
        "camera eye=-1,1.4,2.4",
        "camera target=0,1,0",
    ];
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
        let expected = if (at.x.floor() + at.z.floor()) % 2.0 == 0.0 { 1.0 } else { 0.0 };
        assert!((seen - expected).abs().max_element() < 1e-3, "{ray:?} {seen} {expected}");
        square += 1;
        light += usize::from(expected == 1.0);
    }
    println!(
        "{square} mirrored rays meet a square, {light} a light one, {borders} a border, {sky} the sky"
    );
    assert!(light > 100 && square - light > 100 && sky > 100, "{square} {light} {sky}");
    assert!(borders * 20 < square, "{borders}");
}

#[test]
fn no_ray_meets_the_plane_that_it_leaves() {
    // Tilted and far from the world's origin, the points of a plane lie beside it by rounding.
    let model = Octahedron::out_of_sight();
    let black = ["plane specular=0", "light squares=0,0,0", "dark squares=0,0,0", "depth=1"];
    let near = ["plane distance=1", "camera eye=6.3,2.9,6.1", "camera target=0,0.5,0"];
    let far =
        ["plane distance=1e5", "camera eye=-30144,90458,30156", "camera target=-30150,90453,30150"];
    for place in [near, far] {
        let sets = ["plane normal=-1,3,1", "sun azimuth=300", "sun elevation=40"];
        let place = &[&sets[..], &place].concat()[..];
        let show = |more: &[&str]| model.picture(&[place, more].concat());
        let (hits, shadows) = (show(&["show=hit"]), show(&["show=shadow"]));
        let mirrors = show(&[&black[..], &["plane reflection=1"]].concat());
        let mut count = 0;
        for i in (0..hits.pixels.len()).filter(|&i| hits.pixels[i][0] == PLANE) {
            assert_eq!(shadows.pixels[i][0], 1.0, "{:?}", hits.pixels[i]);
            // The sky is nowhere as dark as the plane's own black.
            assert!(mirrors.pixels[i][2] > 0.2, "{:?}", mirrors.pixels[i]);
            count += 1;
        }
        println!("{count} pixels of {place:?}");
        assert!(count > 1000, "{count}");
    }
}

#[test]
fn pieces_throw_shadows_on_the_plane() {
    let exact = pieces();
    let hits = picture(&["show=hit"]);
    let shadows = picture(&["show=shadow origin"]);
    let sun = Sun { azimuth: 285.0, elevation: 17.0, ..Sun::default() };
    let light = sun.light().direction.to_array();
    let (mut lit, mut dark, mut edges) = (0, 0, 0);
    for (hit, &[x, y, z, visible]) in hits.pixels.iter().zip(&shadows.pixels) {
        if hit[0] != PLANE {
            continue;
        }
        let ray = Ray::from_f32([x, y, z], light, 0.0, 1e30);
        let blocked = exact.closest_hit(&ray, |_| true).is_some();
        if blocked == (visible == 0.0) {
            *if blocked { &mut dark } else { &mut lit } += 1;
        } else {
            let near = exact.near_candidates(&ray);
            assert!(near.iter().any(|near| near.may_hit(&ray) && !near.must_hit(&ray)), "{ray:?}");
            edges += 1;
        }
    }
    println!("{lit} lit, {dark} dark, {edges} at edges");
    assert!(lit > 1000 && dark > 200 && edges < 10, "{lit} {dark} {edges}");
}

#[test]
fn the_plane_throws_its_shadow_on_what_is_below() {
    // An octahedron, the plane above it, and the eye below that.
    let model = Octahedron::new(Vec3::Y);
    let above = ["plane distance=3", "camera eye=-1,1.4,2.4", "camera target=0,1,0"];
    let hits = model.picture(&[&above[..], &["show=hit"]].concat());
    let pixels = hits.pixels.iter().filter(|hit| hit[0] >= 0.0).count();
    assert!(pixels > 2000, "{pixels}");
    let lit = |more: &[&str]| {
        let seen = model.picture(&[&above[..], &["show=shadow origin"], more].concat());
        let on_it = seen.pixels.iter().zip(&hits.pixels).filter(|(_, hit)| hit[0] >= 0.0);
        on_it.filter(|(seen, _)| seen[3] > 0.0).count()
    };
    assert_eq!(lit(&[]), 0);
    // A lamp below the plane is not kept off by it.
    assert!(lit(&["light=point", "lamp position=-3,2,3"]) > 1000);
    assert_eq!(lit(&["light=point", "lamp position=-3,3.5,3"]), 0);
    // Where rays pass from inside to outside, those to the light do so too.
    assert!(lit(&["inside=through"]) > 1000);
    assert_eq!(lit(&["inside=through", "inverse=on"]), 0);
}

#[test]
fn inside_and_outside_are_told_apart() {
    let model = Octahedron::out_of_sight();
    let seen = |sets: &[&str]| {
        let picture = model.picture(&[&["preset=pov", "show=hit"], sets].concat());
        let on_plane: Vec<f32> =
            picture.pixels.iter().filter(|pixel| pixel[0] == PLANE).map(|pixel| pixel[3]).collect();
        let inside = on_plane.iter().filter(|inside| **inside == 1.0).count();
        (on_plane.len() - inside, inside)
    };
    let below = "camera eye=-4.2,-5,6.4";
    let (outside, inside) = seen(&[]);
    assert!(outside > 4000 && inside == 0, "{outside} {inside}");
    assert_eq!(seen(&["inverse=on"]), (0, outside));
    let (outside, inside) = seen(&[below]);
    assert!(outside == 0 && inside > 3000, "{outside} {inside}");
    assert_eq!(seen(&[below, "inverse=on"]), (inside, 0));
    assert_eq!(seen(&[below, "inside=through"]), (0, 0));
    // Whichever side is the inside, the surface is the same.
    let [plain, inverse] =
        ["inverse=off", "inverse=on"].map(|set| model.picture(&["preset=pov", set]));
    assert_eq!(bits(&plain), bits(&inverse));
    // The same plane by a point of it.
    let look = ["camera eye=1,3,4", "camera target=0,0,0"];
    let distance = [&look[..], &["plane distance=0.5"]].concat();
    let point = [&look[..], &["plane form=point and normal", "plane point=7,0.5,-3"]].concat();
    assert_eq!(bits(&model.picture(&distance)), bits(&model.picture(&point)));
}

#[test]
fn the_four_spheres_are_where_they_should_be() {
    let sphere = |x, y, z, radius| Sphere { center: DVec3::new(x, y, z), radius };
    let spheres = [
        sphere(-5.0, -8.0, 15.0, 4.0),
        sphere(5.0, -8.0, 15.0, 4.0),
        sphere(0.0, -8.0, 7.0, 4.0),
        sphere(0.0, 9.0, 16.0, 7.0),
    ];
    let sets = ["preset=four spheres"];
    let model = Octahedron::out_of_sight();
    let show = |view| shown("150x150", &[&sets[..], &[view]].concat(), &["--scene", &model.path()]);
    let (hits, directions) = (show("show=hit"), show("show=ray direction"));
    let eye = DVec3::new(0.0, 0.0, -10.0);
    let camera = Camera::new(eye, DVec3::ZERO, 90.0);
    let mut seen = [0; 6];
    for (index, (ray, hit)) in rays(&camera, &directions).zip(&hits.pixels).enumerate() {
        // The window is 20 by 20 through the origin: pixel by pixel, the ray goes where it says.
        let (column, row) = (index % 150, index / 150);
        let window =
            DVec3::new((75.0 - column as f64 - 0.5) / 7.5, (75.0 - row as f64 - 0.5) / 7.5, 0.0);
        assert!((window - eye).normalize().distance(ray.direction) < 1e-6);
        let nearest = spheres
            .iter()
            .enumerate()
            .filter_map(|(i, sphere)| Some((sphere.intersect(&ray)?.t, i as f32)));
        let plane = level(-14.0).intersect(&ray).map(|hit| (hit.t, PLANE));
        let nearest = nearest.chain(plane).min_by(|a, b| a.0.total_cmp(&b.0));
        let (t, expected) = nearest.unwrap_or((0.0, -1.0));
        if expected != hit[0] {
            // The balls are of triangles: at the silhouette less than 1/2000 of the radius is missing.
            let nearly = spheres.iter().any(|sphere| {
                let to = sphere.center - ray.origin;
                let impact = to.cross(ray.direction).length() / ray.direction.length();
                (impact / sphere.radius - 1.0).abs() < 5e-4
            });
            assert!(nearly, "{ray:?}: {hit:?} instead of {expected}");
            continue;
        }
        assert!(expected == -1.0 || (f64::from(hit[2]) - t).abs() < 0.1, "{hit:?} {t}");
        let place = match hit[0] {
            PLANE => 4,
            -1.0 => 5,
            ball => ball as usize,
        };
        seen[place] += 1;
    }
    println!("pixels of the three red balls, the blue one, the plane, the sky: {seen:?}");
    assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
}

// The checker board -----------------------------------------------------------------------------

#[test]
fn the_checker_board_is_averaged_over_each_pixel() {
    let model = Octahedron::out_of_sight();
    // From above to the horizon.
    let sets = [
        "camera eye=0.3,1.5,0.2",
        "camera target=1,0.9,-2",
        "field of view=60",
        "plane reflection=0",
        "light squares=1,1,1",
        "dark squares=0,0,0",
    ];
    // What the plane is, how light, and how far away.
    let light = |size: &str, checker: &str| {
        let [hits, squares] = ["show=hit", "show=triangle"].map(|show| {
            shown(size, &[&sets[..], &[checker, show]].concat(), &["--scene", &model.path()]).pixels
        });
        let both = hits.iter().zip(squares).map(|(hit, square)| [hit[0], square[0], hit[2]]);
        both.collect::<Vec<_>>()
    };
    const FINE: usize = 12;
    let (width, height) = (64, 40);
    let filtered = light("64x40", "checker=filtered");
    let point = light("64x40", "checker=point");
    let fine = light("768x480", "checker=point");
    let (mut count, mut filtered_error, mut point_error, mut worst) = (0, 0.0, 0.0, 0.0f32);
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        let pixels = (0..FINE * FINE).map(|i| {
            let (y, x) = (row * FINE + i / FINE, column * FINE + i % FINE);
            fine[y * width * FINE + x]
        });
        let pixels: Vec<_> = pixels.collect();
        if pixels.iter().any(|pixel| pixel[0] != PLANE) {
            continue;
        }
        let mean = pixels.iter().map(|pixel| pixel[1]).sum::<f32>() / pixels.len() as f32;
        let at = row * width + column;
        count += 1;
        let error = (filtered[at][1] - mean).abs();
        worst = worst.max(error);
        filtered_error += error;
        point_error += (point[at][1] - mean).abs();
    }
    let (filtered_error, point_error) = (filtered_error / count as f32, point_error / count as f32);
    println!(
        "{count} pixels: filtered off by {filtered_error:.3} (most {worst:.2}), \
         at the middle by {point_error:.3}"
    );
    assert!(count > 1000 && filtered_error < 0.06 && point_error > 4.0 * filtered_error);
    // Towards the horizon all is grey, and nothing is cut off.
    let horizon = filtered.iter().filter(|pixel| pixel[0] == PLANE && pixel[2] > 60.0);
    assert!(horizon.clone().count() > 40);
    assert!(horizon.clone().all(|pixel| (pixel[1] - 0.5).abs() < 0.05));
}
