//! A faulty shader in the folder named by `SHADERS`: the message says where the fault is.

use std::fs;
use std::path::Path;

use crate::{refused_by, sample};

/// A copy of `shaders/` in which `edit` has changed one file of the sample.
fn folder(file: &str, edit: impl FnOnce(String) -> String) -> tempfile::TempDir {
    let folder = run::copy_of_shaders();
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    let edited = edit(text.clone());
    assert_ne!(edited, text, "the edit of {file} has found nothing to change");
    fs::write(path, edited).unwrap();
    folder
}

#[track_caller]
fn shaders_refused(folder: &Path, words: &[&str]) {
    let mut command = sample();
    command.env("SHADERS", folder);
    refused_by(command, 1, words);
}

fn appended(line: &str) -> impl FnOnce(String) -> String {
    move |text| format!("{text}{line}\n")
}

fn line_count(file: &str) -> usize {
    fs::read_to_string(run::root().join("shaders").join(file)).unwrap().lines().count()
}

#[test]
fn what_does_not_compile_has_file_and_line() {
    for file in ["02_basic/sky.rmiss", "02_basic/push.glsl", "common/false_color.glsl"] {
        let folder = folder(file, appended("vec3 unfinished( {"));
        let place = format!("shader does not compile: {file}:{}: ", line_count(file) + 1);
        shaders_refused(folder.path(), &[&place]);
    }
    let sky = "02_basic/sky.rmiss";
    for (text, words) in [
        ("", "shader does not compile: 02_basic/sky.rmiss: "),
        ("#version 460\n", "02_basic/sky.rmiss: Linking miss stage: Missing entry point"),
        ("#version 460\nvoid main() { discard; }\n", "02_basic/sky.rmiss:2: 'discard'"),
    ] {
        shaders_refused(folder(sky, |_| text.to_owned()).path(), &[words]);
    }
}

#[test]
fn what_a_compiler_cannot_be_shown_has_a_place_too() {
    let file = "02_basic/camera.rgen";
    let zero = folder(file, |text| format!("{text}// \0\n"));
    let place = format!("{file}:{}: holds a zero byte", line_count(file) + 1);
    shaders_refused(zero.path(), &[&place]);
    let place = format!("{file}:{}: the byte 0xE9 is not UTF-8", line_count(file) + 1);
    let latin = run::copy_of_shaders();
    let path = latin.path().join(file);
    let text = fs::read(&path).unwrap();
    fs::write(&path, [&text[..], b"// caf\xe9\n"].concat()).unwrap();
    shaders_refused(latin.path(), &[&place]);
    fs::write(&path, [b"\xff\xfe", &text[..]].concat()).unwrap();
    shaders_refused(latin.path(), &[&format!("{file}:1: this is UTF-16 text; save it as UTF-8")]);
    let old = folder(file, |text| text.replace("#version 460", "#version 110"));
    shaders_refused(old.path(), &["shader '02_basic/camera.rgen': the profile is invalid"]);
}

#[test]
fn includes_that_are_wrong() {
    let file = "02_basic/push.glsl";
    let place = format!("{file}:{}: #include ", line_count(file) + 1);
    for (name, words) in [
        ("gone.glsl", "there is no shader 'gone.glsl' in '"),
        ("../common/scene.glsl/../../../secret.glsl", "is not below"),
        ("/etc/passwd", "is not below"),
        ("", "it is not a file"),
    ] {
        let folder = folder(file, appended(&format!("#include \"{name}\"")));
        shaders_refused(folder.path(), &[&place, words]);
    }
}

#[test]
fn an_include_without_its_extension() {
    let file = "02_basic/sky.rmiss";
    let extension = "#extension GL_GOOGLE_include_directive : require\n";
    let folder = folder(file, |text| text.replace(extension, ""));
    shaders_refused(
        folder.path(),
        &[&format!("{file}:2: #include takes the line `{}`", extension.trim())],
    );
}

#[test]
fn a_mark_at_the_beginning_is_passed_over() {
    let marked = |text: String| format!("\u{feff}{text}");
    for file in ["02_basic/camera.rgen", "02_basic/push.glsl"] {
        let folder = folder(file, marked);
        let output = sample().env("SHADERS", folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn a_circle_of_includes_is_spliced_once() {
    let folder = folder("common/false_color.glsl", appended("#include \"02_basic/push.glsl\""));
    let status = sample().env("SHADERS", folder.path()).status().unwrap();
    assert!(status.success());
}

#[test]
fn includes_that_double_level_by_level_come_to_an_end() {
    let folder = folder("02_basic/push.glsl", appended("#include \"0.glsl\""));
    for level in 0..12 {
        let next = format!("#include \"{}.glsl\"\n", level + 1);
        fs::write(folder.path().join(format!("02_basic/{level}.glsl")), next.repeat(8)).unwrap();
    }
    fs::write(folder.path().join("02_basic/12.glsl"), "").unwrap();
    shaders_refused(folder.path(), &["with its includes it has more than 4194304 bytes"]);
}

#[test]
fn what_takes_more_memory_than_a_device_has_is_refused() {
    let sky = "02_basic/sky.rmiss";
    let main = "void main() {\n";
    let buffer = "layout(binding = 1, scalar) readonly buffer Large { float large[1 << 29]; };";
    let computed = "layout(constant_id = 77) const int L = 1 << 15;\nfloat large[L * L];";
    for (before, inside, words) in [
        ("float large[2147483647];", "large[SHOW] = 1.0;", "its variables take 858993"),
        ("", "vec4 large[1 << 17]; large[SHOW].x = 1.0;", "its variables take 2097"),
        (buffer, "payload.x = large[SHOW];", "a type takes 2147483648 bytes"),
        (computed, "large[SHOW] = 1.0;", "an array's length is computed from specialization"),
    ] {
        let edited = format!("{before}\n{main}{inside}\n");
        let folder = folder(sky, |text| text.replacen(main, &edited, 1));
        shaders_refused(folder.path(), &[&format!("{sky}: {words}")]);
    }
}

#[cfg(unix)]
#[test]
fn a_compiler_that_crashes_takes_its_own_process_alone() {
    // The compiler recurses into a sum term by term, with a stack of a few megabytes.
    let terms = " + x * y".repeat(100_000);
    let sum = format!("float much(float x) {{ float y = 0.0; y += x{terms}; return y; }}");
    let folder = folder("02_basic/sky.rmiss", appended(&sum));
    let words = "shader '02_basic/sky.rmiss' does not compile: the compiler crashed (signal: ";
    for backtrace in ["0", "1"] {
        let mut command = sample();
        command.env("SHADERS", folder.path()).env("RUST_BACKTRACE", backtrace);
        refused_by(command, 1, &[words]);
    }
}

/// Otherwise it would keep working for half a minute.
#[cfg(target_os = "linux")]
#[test]
fn a_compiler_ends_with_the_program_that_asks_it() {
    use std::time::{Duration, Instant};

    use time_limit::{ASLEEP, Work};

    let doubling: String =
        (1..30).map(|i| format!("#define A{i} A{j}+A{j}\n", j = i - 1)).collect();
    let bomb = format!("#define A0 1+1\n{doubling}int x = A29;\n");
    let folder = folder("02_basic/sky.rmiss", appended(&bomb));
    let mut command = sample();
    let mut parent = command.env("SHADERS", folder.path()).spawn().unwrap();
    let children = format!("/proc/{0}/task/{0}/children", parent.id());
    let start = Instant::now();
    let compiler = |text: String| text.split_whitespace().next().map(str::to_owned);
    let child = loop {
        assert!(start.elapsed() < ASLEEP, "no compiler was started");
        // The first shaders compile at once.
        std::thread::sleep(Duration::from_millis(20));
        let Some(child) = compiler(fs::read_to_string(&children).unwrap_or_default()) else {
            continue;
        };
        std::thread::sleep(Duration::from_millis(1500));
        if Path::new("/proc").join(&child).exists() {
            break child;
        }
    };
    let work = Work::of_process(child.parse().expect("a process's number"));
    parent.kill().unwrap();
    parent.wait().unwrap();
    let stat = Path::new("/proc").join(child).join("stat");
    let is_alive = || {
        // An orphan that has ended may not have been reaped yet.
        let stat = fs::read_to_string(&stat).unwrap_or_default();
        stat.rsplit(')').next().is_some_and(|rest| !rest.is_empty() && !rest.starts_with(" Z"))
    };
    // Measured in processor time, because its end may take long on a busy machine.
    let done = || work.done().unwrap_or_default();
    let before = done();
    while is_alive() {
        assert!(done() < before + Duration::from_secs(2), "it is at work still");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_descriptor_that_nothing_is_bound_to_is_refused() {
    let image = "layout(set = 0, binding = 1";
    let text = fs::read_to_string(run::root().join("shaders/02_basic/camera.rgen")).unwrap();
    assert!(text.contains(image), "{text}");
    let folder =
        folder("02_basic/camera.rgen", |text| text.replace(image, "layout(set = 5, binding = 1"));
    let words =
        "02_basic/camera.rgen: set 5, binding 1 is an image, where the program binds nothing";
    shaders_refused(folder.path(), &[words]);
}

#[test]
fn shaders_that_are_missing() {
    let folder = folder("02_basic/sky.rmiss", appended(""));
    fs::remove_file(folder.path().join("02_basic/sky.rmiss")).unwrap();
    shaders_refused(folder.path(), &["there is no shader '02_basic/sky.rmiss' in '"]);
    let words = ["in 'no such folder'; SHADERS names it; a copy of the book's shaders is right"];
    shaders_refused(Path::new("no such folder"), &words);
    shaders_refused(Path::new(""), &["SHADERS in the environment is empty"]);
    let file = folder.path().join("02_basic/camera.rgen");
    shaders_refused(
        &file,
        &["SHADERS names '", "camera.rgen', a file; a folder of shaders is right"],
    );
}

#[test]
fn structures_that_differ_name_the_field() {
    for (file, from, to, words) in [
        (
            "02_basic/push.glsl",
            "DirectionalLight light;",
            "DirectionalLight light; uint extra;",
            "Push.extra is in the shader but not in Rust",
        ),
        (
            "02_basic/push.glsl",
            "SceneAddresses scene;",
            "uint extra; SceneAddresses scene;",
            "Push.extra",
        ),
        (
            "common/camera.glsl",
            "vec3 right;",
            "vec3 right; float pad;",
            "CameraBasis.pad is in the shader but not in Rust",
        ),
        (
            "common/scene.glsl",
            "float shininess;",
            "float shininess; float extra;",
            "MaterialRecord.extra is in the shader but not in Rust",
        ),
        (
            "common/scene.glsl",
            "uint illumination;",
            "uvec2 illumination;",
            "MaterialRecord takes 60 bytes in the shader, 56 in Rust",
        ),
        ("common/scene.glsl", "uint mesh;", "", "InstanceRecord lacks mesh, which Rust has"),
        (
            "common/scene.glsl",
            "uint mesh;",
            "int mesh;",
            "InstanceRecord.mesh is made of int in the shader, and of u32 in Rust",
        ),
    ] {
        let folder = folder(file, |text| text.replacen(from, to, 1));
        shaders_refused(folder.path(), &["02_basic/camera.rgen: ", words]);
    }
}

#[test]
fn what_lies_at_an_address_is_declared_in_rust() {
    // The structure is renamed, so that only the shader has one of that name.
    let (from, to) =
        ("struct MaterialRecord", "#define MaterialRecord Substance\nstruct MaterialRecord");
    let folder = folder("common/scene.glsl", |text| text.replacen(from, to, 1));
    let words = [
        "02_basic/camera.rgen: the shader reads a Substance through an address",
        "declare it with shader_struct! { struct Substance { ... } }",
        "and the address as Address<Substance>",
    ];
    shaders_refused(folder.path(), &words);
}

#[test]
fn constants_that_differ_name_both_sides() {
    let line = "const uint SHOW_NORMAL = 1;";
    for (to, words) in [
        ("const uint SHOW_NORMAL = 2;", "SHOW_NORMAL is 2 in the shader, and Show::Normal is 1"),
        (
            "const uint SHOW_NORMAL = 1; // as\nconst uint SHOW_FOG = 5;",
            "SHOW_FOG is in the shader, but Rust's Show has no such variant",
        ),
    ] {
        let folder = folder("02_basic/push.glsl", |text| text.replacen(line, to, 1));
        shaders_refused(folder.path(), &["02_basic/push.glsl:", words]);
    }
    let gone = |text: String| text.replacen("const uint SHOW_HIT = 3;", "#define SHOW_HIT 3", 1);
    let folder = folder("02_basic/push.glsl", gone);
    let words = "02_basic: Rust has Show::Hit, but no shader says `const uint SHOW_HIT = 3;`";
    shaders_refused(folder.path(), &[words]);
}

/// Mistakes about bands of a picture, and about payloads: each used to be silent, with a black or striped
/// picture.
#[test]
fn a_launch_is_a_band_and_no_picture() {
    let raygen = "02_basic/camera.rgen";
    let size = "gl_LaunchSizeEXT is the size of a band of the picture here; imageSize(picture) is";
    let index =
        "gl_LaunchIDEXT counts from the first row of a band of the picture here; pixel_id() of";
    for (file, from, to, words) in [
        (raygen, "imageSize(picture)", "gl_LaunchSizeEXT.xy", size),
        (raygen, "uvec2 id = pixel_id();", "uvec2 id = gl_LaunchIDEXT.xy;", index),
        (raygen, "void main() {\n", "void main() {\n    payload.x = gl_LaunchIDEXT.x;\n", index),
        (
            "02_basic/shade.rchit",
            "payload = vec4(color, 1.0);",
            "payload = vec4(color, gl_LaunchIDEXT.y);",
            index,
        ),
    ] {
        let folder = folder(file, |text| text.replacen(from, to, 1));
        shaders_refused(folder.path(), &[&format!("{file}: {words}")]);
    }
}

#[test]
fn a_payload_is_of_the_type_that_is_passed() {
    // The payloads of the closest hit shader and of the miss shader.
    let hit = folder("02_basic/shade.rchit", |text| {
        text.replace("rayPayloadInEXT vec4 payload;", "rayPayloadInEXT vec3 passed;\nvec4 payload;")
            .replace("payload = vec4(color, 1.0);", "payload = vec4(color, 1.0);\npassed = color;")
    });
    let words =
        "no traceRayEXT of the pipeline passes a payload of the type that this shader takes";
    shaders_refused(hit.path(), &[&format!("02_basic/shade.rchit: {words}")]);
    let miss = folder("02_basic/sky.rmiss", |text| {
        text.replace("rayPayloadInEXT vec4 payload;", "rayPayloadInEXT vec3 payload;")
            .replace("payload = vec4(sky(gl_WorldRayDirectionEXT), 1.0)", "payload = vec3(1.0)")
            .replace("payload = vec4(-1.0)", "payload = vec3(-1.0)")
            .replace("payload = vec4(gl_WorldRayDirectionEXT, -1.0)", "payload = vec3(0.0)")
    });
    let words = "a ray has the missIndex 0, which is 02_basic/sky.rmiss, and passes a payload of another type";
    shaders_refused(miss.path(), &[&format!("02_basic/camera.rgen: {words}")]);
}

/// A shadow ray of 05 that names the sky's miss shader: it used to be silent, and everything was dark.
#[test]
fn a_ray_that_names_the_miss_shader_of_another_payload_is_refused() {
    let (from, to) = ("1,                          // missIndex", "0, // missIndex");
    let folder = folder("common/shadow.glsl", |text| text.replace(from, to));
    let mut command = run::command("05_shadow_miss");
    command.args(["--headless", "--size", "8x8"]).env("SHADERS", folder.path());
    let words = "a ray has the missIndex 0, which is common/sky.rmiss, and passes a payload of another type";
    refused_by(command, 1, &[&format!("05_shadow_miss/camera.rgen: {words}")]);
}

#[test]
fn a_ray_names_a_miss_shader_that_is_there() {
    let file = "02_basic/camera.rgen";
    let (from, to) = ("0,                          // missIndex", "1,      // missIndex");
    let folder = folder(file, |text| text.replace(from, to));
    let words = "a ray has the missIndex 1, and the pipeline has 1 miss shader, counted from 0 in the order";
    shaders_refused(folder.path(), &[&format!("{file}: {words}")]);
}

#[test]
fn what_is_seldom_meant_is_a_warning() {
    let hidden = "02_basic/camera.rgen: a ray has the cull mask 0, which every instance's mask hides from it";
    let opaque =
        "03_any_hit/decide.rahit is never asked: every ray has the flag gl_RayFlagsOpaqueEXT";
    let backward = "02_basic/camera.rgen: a ray begins at tmin = 2e30 and ends before, at tmax = 1e30: it hits nothing";
    let folder_out = tempfile::tempdir().unwrap();
    let out = folder_out.path().join("out.png");
    for (program, from, to, line) in [
        ("02_basic", "        0xff,  ", "        0x00,  ", hidden),
        ("02_basic", "0.0,                        // tmin", "2e30, // tmin", backward),
        ("03_any_hit", "        flags,\n", "        gl_RayFlagsOpaqueEXT,\n", opaque),
    ] {
        let folder = folder(&format!("{program}/camera.rgen"), |text| text.replace(from, to));
        let arguments = ["--headless", "--size", "16x10", "--out", crate::text(&out)];
        let mut command = std::process::Command::new(run::program(program));
        let ended = command.args(arguments).env("SHADERS", folder.path()).output().unwrap();
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.success(), "{said}");
        assert_eq!(said.trim_end(), format!("warning: {line}"));
    }
}

/// Silent without the check: a hit is shaded by another group, or by whatever follows the table.
#[test]
fn a_ray_adds_to_a_hit_record_what_the_table_has() {
    let file = "02_basic/camera.rgen";
    let (from, to) = ("        0,                          // sbtR", "        1, // sbtR");
    let folder = folder(file, |text| text.replace(from, to));
    let words = "a ray has the sbtRecordOffset 1, and the shader binding table of '02_basic' has 1 hit record;";
    shaders_refused(folder.path(), &[&format!("{file}: {words}")]);
}

/// Silent without the check: a sphere is shaded with wrong normals, a triangle without barycentrics.
#[test]
fn a_hit_attribute_is_of_the_type_that_is_written() {
    for (program, shader, from, to, line) in [
        (
            "08_intersection",
            "shape.rchit",
            "hitAttributeEXT vec3 outward;",
            "hitAttributeEXT vec4 all;\n#define outward all.xyz",
            "its hitAttributeEXT is not of the type of that of 08_intersection/sphere.rint, which writes it",
        ),
        (
            "02_basic",
            "shade.rchit",
            "hitAttributeEXT vec2 barycentrics;",
            "hitAttributeEXT vec3 all;\n#define barycentrics all.xy",
            "its hitAttributeEXT is no vec2, and a triangle's are two weights",
        ),
    ] {
        let file = format!("{program}/{shader}");
        let folder = folder(&file, |text| text.replace(from, to));
        let mut command = run::command(program);
        command.args(["--headless", "--size", "8x8"]).env("SHADERS", folder.path());
        refused_by(command, 1, &[&format!("{file}: {line}")]);
    }
}

#[test]
fn a_name_of_a_file_that_is_not_included_names_the_file() {
    let file = "05_shadow_miss/camera.rgen";
    let folder = folder(file, |text| text.replace("#include \"common/hit.glsl\"\n", ""));
    let mut command = run::command("05_shadow_miss");
    command.args(["--headless", "--size", "8x8"]).env("SHADERS", folder.path());
    let words = "Hit stands in common/hit.glsl, which is not included before this line";
    refused_by(command, 1, &[words]);
}

/// Each used to be a crash or a silently wrong picture.
#[test]
fn what_a_pipeline_does_not_go_with_is_refused() {
    let head = "hitAttributeEXT vec3 outward;";
    for (program, shader, edits, line) in [
        (
            "02_basic",
            "camera.rgen",
            &[
                ("binding = 0", "binding = 9"),
                ("binding = 1", "binding = 0"),
                ("binding = 9", "binding = 1"),
            ][..],
            "set 0, binding 0 is an image, where the program binds an acceleration structure; bindings are counted",
        ),
        (
            "02_basic",
            "shade.rchit",
            &[(
                "void main() {",
                "layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;\n\
                  layout(location = 1) rayPayloadEXT vec4 next;\nvoid main() {\n\
                  traceRayEXT(tlas, 0, 0xff, 0, 1, 0, vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), 1.0, 1);",
            )],
            "a ray from this shader takes .recursion(2) at least, and the pipeline '02_basic' has 1",
        ),
        (
            "02_basic",
            "sky.rmiss",
            &[("rayPayloadInEXT", "rayPayloadEXT")],
            "it traces no ray, and has a rayPayloadEXT",
        ),
        (
            "08_intersection",
            "box.rint",
            &[(head, ""), ("outward = ", "vec3 outward = ")],
            "it reads a hitAttributeEXT, and 08_intersection/box.rint writes none",
        ),
        (
            "02_basic",
            "sky.rmiss",
            &[(
                "#include \"common/extensions.glsl\"",
                "#extension GL_EXT_buffer_reference2 : require\n#extension GL_EXT_scalar_block_layout : require",
            )],
            "the shader lacks the line `#extension GL_EXT_ray_tracing : require`",
        ),
    ] {
        let file = format!("{program}/{shader}");
        let edit =
            |text: String| edits.iter().fold(text, |text, (from, to)| text.replace(from, to));
        let folder = folder(&file, edit);
        let mut command = run::command(program);
        command.args(["--headless", "--size", "8x8"]).env("SHADERS", folder.path());
        refused_by(command, 1, &[line]);
    }
}
