//! A program of another crate that uses `raybook::run!`: its errors are reported like those of the book's
//! samples.

use std::fs;
use std::process::{Command, Output};

use crate::refused_by;

/// A copy of the template's shaders with one edited file.
struct Edited(tempfile::TempDir);

impl Edited {
    fn new(steps: &[&str], file: &str, from: &str, to: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for step in steps {
            let own = run::root().join("docs/chapters/start").join(step).join("shaders");
            run::copy(&own, folder.path());
        }
        run::replace_line(folder.path(), file, from, to);
        Self(folder)
    }

    /// The program, small and headless, with these shaders.
    fn command(&self, program: &str) -> Command {
        let mut command = small(program);
        command.env("SHADERS", self.0.path());
        command
    }
}

fn small(program: &str) -> Command {
    let mut command = run::command(program);
    command.args(["--headless", "--size", "16x10"]);
    command
}

/// The single line on standard error of a successful run.
fn warning(output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr).trim_end().to_owned();
    assert!(output.status.success() && said.lines().count() == 1, "{said}");
    said
}

const TEMPLATE: [&str; 1] = ["template"];
const SPHERE: [&str; 3] = ["template", "second_light", "sphere"];
const RAYGEN: &str = "my_tracer/camera.rgen";
const STORE: &str = "vec4(color, 1.0)";

/// An index far beyond an array behind an address. On a GPU, it leads to the loss of the device.
#[cfg(target_os = "linux")]
#[test]
fn a_shader_that_reads_beyond_an_array_ends_in_a_line() {
    use std::os::unix::process::ExitStatusExt;

    if !run::device::is_software() {
        return;
    }
    let file = "my_tracer/mesh.rchit";
    let own = Edited::new(
        &TEMPLATE,
        file,
        "hit = report(push.scene, barycentrics);",
        "hit = report(push.scene, barycentrics);\n    \
         hit.color = push.scene.materials.at[hit.material + (1 << 25)].base_color;",
    );
    let book = run::shaders_with(
        "02_basic/shade.rchit",
        "payload = vec4(color, 1.0);",
        "payload = vec4(push.scene.materials.at[1 << 25].base_color + color, 1.0);",
    );
    let mut sample = small("02_basic");
    sample.env("SHADERS", book.path());
    let words = [
        "the driver or the shader compiler crashed (SIGSEGV) while the device worked: most likely a shader read \
         beyond an array behind an address, by a custom index, a material or a triangle that is too large",
    ];
    refused_by(own.command("my_tracer"), 1, &words);
    refused_by(sample, 1, &words);
    // With a backtrace requested the line is the same, and the crash is passed on to the system.
    let traced = own.command("my_tracer").env("RUST_BACKTRACE", "1").output().expect("it starts");
    let said = String::from_utf8_lossy(&traced.stderr);
    assert_eq!(traced.status.signal(), Some(11), "{said}");
    assert!(
        said.starts_with("error: ") && said.contains(words[0]) && said.lines().count() == 1,
        "{said}"
    );
}

#[test]
fn pixels_that_are_no_numbers_are_counted_in_a_picture() {
    let black = Edited::new(&TEMPLATE, RAYGEN, STORE, "vec4(sqrt(color - 1e9), 1.0)");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in ["out.png", "out.exr"] {
        let mut command = black.command("my_tracer");
        command.arg("--out").arg(folder.path().join(file));
        let said = warning(&command.output().expect("it starts"));
        assert!(
            said.starts_with(
                "warning: 160 pixels are not finite, the first at 0, 0: [NaN, NaN, NaN, 1.0]"
            ),
            "{said}"
        );
    }
}

#[test]
fn an_image_has_the_format_that_the_shader_declares() {
    let layout = "layout(set = 0, binding = 1, rgba32f)";
    let own = Edited::new(&TEMPLATE, RAYGEN, layout, "layout(set = 0, binding = 1, rgba8)");
    let words = [
        "my_tracer/camera.rgen: set 0, binding 1 is an image of layout(rgba8), and the program binds one of \
         R32G32B32A32_SFLOAT: layout(rgba32f) is right",
    ];
    refused_by(own.command("my_tracer"), 1, &words);
}

#[test]
fn a_ray_asks_for_records_that_are_there_and_of_the_right_kind() {
    let (from, to) = ("gl_RayFlagsNoneEXT, 0xff, 0, 1,", "gl_RayFlagsNoneEXT, 0xff, 1, 1,");
    let beyond = Edited::new(&TEMPLATE, RAYGEN, from, to);
    let words = [
        "my_tracer/camera.rgen: a ray has the sbtRecordOffset 1, and the shader binding table of 'my_tracer' has 1 \
         hit record; records are counted from 0",
    ];
    refused_by(beyond.command("my_tracer"), 1, &words);
    let other = Edited::new(&SPHERE, RAYGEN, from, to);
    let words = [
        "an instance of triangles, 'ground', has the hit record 0 + 1 (sbtRecordOffset in my_tracer/camera.rgen), \
         which is a hit group for boxes in 'my_tracer'",
    ];
    refused_by(other.command("my_tracer_sphere"), 1, &words);
}

#[test]
fn a_picture_that_is_written_nowhere_is_a_warning() {
    let line = "warning: the picture is not written: add --out FILE.png or --out FILE.exr";
    for program in ["my_tracer", "02_basic"] {
        assert_eq!(warning(&small(program).output().expect("it starts")), line);
    }
    // A run with validation or a report still has its result.
    for arguments in [&["--validate"][..], &["--report", "-"]] {
        let output = small("02_basic").args(arguments).output().expect("it starts");
        assert!(output.status.success() && output.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn records_are_listed_with_their_shaders_and_what_asks_for_them() {
    // A sample that builds its pipelines for a frame.
    let output = run::command("05_shadow_miss").arg("--list-records").output().expect("it starts");
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(
        told.contains("05_shadow_miss\thit 0\t05_shadow_miss/shade.rchit\tfor triangles,"),
        "{told}"
    );
    let edited = Edited::new(&SPHERE, RAYGEN, STORE, STORE);
    let mut command = run::command("my_tracer_sphere");
    let output = command.env("SHADERS", edited.0.path()).arg("--list-records").output();
    let output = output.expect("it starts");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "my_tracer\traygen 0\tmy_tracer/camera.rgen\n\
         my_tracer\tmiss 0\tcommon/sky.rmiss\n\
         my_tracer\tmiss 1\tcommon/shadow.rmiss\n\
         my_tracer\thit 0\tmy_tracer/mesh.rchit\tfor triangles, asked for by 'ground'\n\
         my_tracer\thit 1\tmy_tracer/sphere.rint, my_tracer/sphere.rchit\tfor boxes, asked for by 'sphere'\n"
    );
}

/// A checkout that was copied with its `target/`: its programs read the files of the original.
#[test]
fn a_program_in_a_copy_of_its_folder_says_where_it_was_built() {
    let copy = tempfile::tempdir().expect("a temporary folder");
    let home = copy.path().canonicalize().expect("a folder");
    let debug = home.join("target/debug");
    fs::create_dir_all(&debug).expect("a folder");
    let picture = home.join("out.png");
    for (program, marks) in
        [("my_tracer", "shaders/my_tracer/a"), ("02_basic", "common/src/paths.rs")]
    {
        let mark = home.join(marks);
        fs::create_dir_all(mark.parent().expect("it has one")).expect("a folder");
        fs::write(mark, "").expect("a file");
        let copied = debug.join(program);
        fs::copy(run::program(program), &copied).expect("a copy");
        let mut command = Command::new(&copied);
        command.env_remove("RUST_BACKTRACE").args(["--headless", "--size", "8x8", "--out"]);
        let said = warning(&command.arg(&picture).output().expect("it starts"));
        let words = format!(
            "and reads the shaders and files there, not those in '{}', where it lies",
            home.display()
        );
        assert!(
            said.starts_with("warning: this program was built in '") && said.contains(&words),
            "{said}"
        );
    }
}
