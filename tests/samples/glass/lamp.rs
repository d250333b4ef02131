//! The lamp's light, found by shadow rays and by rays that hit it at random: both equal the light of a disk.

use glam::DVec3;
use run::{Chapter, evaluate, shaders_with};

use super::NAME;

/// Distances of the lamp, in radii, and angles between the surface's normal and the direction to it, in
/// radians.
const CASES: [(f64, f64); 4] = [(1.5, 0.0), (3.0, 0.0), (3.0, 0.4), (6.0, 0.7)];
const SIZE: &str = "64x64";
/// Rows of the picture for each case.
const ROWS: usize = 16;

/// The light of a disk of radius 1 that arrives at a surface, at strength 1: radiance 1/π over the disk, by
/// its solid angle and the surface's cosine, summed over rings and sectors of equal area.
fn of_disk(distance: f64, tilt: f64) -> f64 {
    let normal = DVec3::new(tilt.sin(), tilt.cos(), 0.0);
    let (rings, sectors) = (400, 400);
    let mut sum = 0.0;
    for i in 0..rings * sectors {
        let radius = ((f64::from(i / sectors) + 0.5) / f64::from(rings)).sqrt();
        let (sine, cosine) =
            ((f64::from(i % sectors) + 0.5) / f64::from(sectors) * std::f64::consts::TAU).sin_cos();
        let way = DVec3::new(radius * cosine, distance, radius * sine);
        let squared = way.length_squared();
        sum += normal.dot(way) * distance / (squared * squared);
    }
    sum / f64::from(rings * sectors)
}

#[test]
fn a_disk_on_the_axis_has_its_closed_form() {
    // The light of a disk straight ahead: strength / (d² + r²).
    for (distance, tilt) in CASES {
        if tilt == 0.0 {
            let off = of_disk(distance, tilt) * (distance * distance + 1.0) - 1.0;
            assert!(off.abs() < 1e-5, "{distance}: {off}");
        }
    }
}

#[test]
fn shadow_rays_and_other_rays_count_the_same_lamp() {
    let files = "
        #include \"common/random.glsl\"
        #include \"common/disk.glsl\"
        #include \"27_glass/light_disk.glsl\"
    ";
    let cases = CASES.map(|(distance, tilt)| format!("vec2({distance:?}, {tilt:?})")).join(", ");
    let body = format!(
        "
        vec2 of_case = vec2[]({cases})[at.y / {ROWS}];
        DiskLight lamp = DiskLight(Light(vec3(0.0, of_case.x, 0.0), LIGHT_POINT, vec3(1.0)), 1.0, 1);
        vec3 normal = vec3(sin(of_case.y), cos(of_case.y), 0.0);
        vec3 right = vec3(cos(of_case.y), -sin(of_case.y), 0.0);
        vec2 mean = vec2(0.0);
        for (uint i = 0; i < 256; i++) {{
            vec4 u = random(uvec2(at), i, 0, DIMENSION_LIGHT);
            vec3 to_light = towards_disk(lamp, vec3(0.0), disk_point(0, 1, u.xy));
            mean.x += arriving_from(lamp, vec3(0.0), to_light).x * dot(normal, normalize(to_light));
            // A direction with a density proportional to its cosine: each represents pi times the light it
            // finds.
            vec2 flat_part = disk_point(0, 1, u.zw);
            float height = sqrt(max(1.0 - dot(flat_part, flat_part), 0.0));
            vec3 direction = flat_part.x * right + flat_part.y * vec3(0.0, 0.0, 1.0) + height * normal;
            mean.y += 3.14159265 * seen_of_light(lamp, vec3(0.0), direction, -1.0).x;
        }}
        answer = vec4(mean / 256.0, 0.0, 0.0);
        "
    );
    let answers = evaluate(files, &body, SIZE);
    for (pixels, (distance, tilt)) in answers.pixels.chunks(ROWS * 64).zip(CASES) {
        let exact = of_disk(distance, tilt);
        // A random ray above the surface hits a lamp at 6 radii once in forty times.
        for (way, (name, most)) in
            [("by shadow rays", 0.003), ("by other rays", 0.06)].into_iter().enumerate()
        {
            let values = || pixels.iter().map(|pixel| f64::from(pixel[way]) / exact);
            let count = pixels.len() as f64;
            let mean = values().sum::<f64>() / count;
            let variance = values().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
            let confidence = 4.0 * (variance / count).sqrt();
            println!("{distance}, {tilt} {name}: off by {:.5} ± {confidence:.5}", mean - 1.0);
            assert!((mean - 1.0).abs() < confidence, "{distance}, {tilt} {name}: {mean}");
            assert!(confidence < most, "too few rays to tell");
        }
    }
}

#[test]
fn a_floor_is_as_bright_without_shadow_rays() {
    let folder = tempfile::tempdir().unwrap();
    let mtl = "newmtl floor\nKd 0.5 0.5 0.5\nillum 1\n";
    std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    let obj =
        "mtllib a.mtl\no floor\nusemtl floor\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n";
    let file = folder.path().join("a.obj");
    std::fs::write(&file, obj).unwrap();
    // The lamp is behind the camera, a radius and a half above the floor.
    let floor = Chapter::new(NAME).size("32x32").frames(256).scene(&file).sets(&[
        "lamp position=0,1.5,0",
        "camera eye=0,0.6,0.1",
        "camera target=0,0,0",
        "field of view=20",
    ]);
    let chance = shaders_with(
        "27_glass/path.glsl",
        "bool asks = path.media.x == AIR;",
        "bool asks = false;",
    );
    let of = |chapter: Chapter| {
        let picture = chapter.picture();
        let values: Vec<f64> = picture.pixels.iter().map(|pixel| pixel[0].into()).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        (mean, (variance / count).sqrt())
    };
    let ((asked, error), (met, other)) = (of(floor.clone()), of(floor.shaders(chance.path())));
    let confidence = 4.0 * error.hypot(other);
    println!("{asked:.4} by shadow rays, {met:.4} without, ± {confidence:.4}");
    assert!((asked - met).abs() < confidence, "{asked} {met}");
    assert!(confidence < 0.05 * asked, "too few rays to tell");
}
