//! `--scene` of chapter 25: every fault in a scene file is refused with file and line.

use std::fs;

use crate::refused_by;

/// A valid scene, up to the line that a case adds.
const HEAD: &str =
    "version = 1\n[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfield_of_view = 40\n";
const PAINT: &str = "[[material]]\nname = \"a\"\n";

fn command(text: &[u8], more: &[(&str, &str)]) -> (tempfile::TempDir, std::process::Command) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), text).unwrap();
    for (name, text) in more {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let mut command = run::command("25_scene_effects");
    command.current_dir(&folder);
    command.args(["--headless", "--size", "8x8", "--scene", "s.toml"]);
    (folder, command)
}

#[track_caller]
fn file_refused(text: &str, words: &str) {
    let (_folder, command) = command(text.as_bytes(), &[]);
    refused_by(command, 1, &[words]);
}

/// As [`file_refused`], for [`HEAD`] followed by a table.
#[track_caller]
fn table_refused(table: &str, words: &str) {
    file_refused(&format!("{HEAD}{table}"), words);
}

#[test]
fn a_right_scene_is_accepted() {
    let (_folder, mut command) = command(HEAD.as_bytes(), &[]);
    let output = command.arg("--validate").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn files_that_are_no_scene() {
    file_refused("", "s.toml:1: a scene file has the key `version = 1`; no other version is known");
    file_refused("version = 2\n", "s.toml:1: a scene file has the key `version = 1`");
    file_refused("\nversion = \"1\"\n", "s.toml:2: a scene file has the key `version = 1`");
    file_refused("version = 1\n", "s.toml:1: the table [camera] is missing");
    file_refused(&HEAD[..HEAD.len() - 30], "s.toml:4: ");
    file_refused(
        "version = 1\nversion = 1\n",
        "s.toml:2: `version` is here for the second time; take one",
    );
    let deep = format!("\n\na{} = 1\n", ".a".repeat(300));
    table_refused(&deep, "s.toml:8: this stands in more than 16 tables and lists");
    table_refused(&format!("x = {}", "[".repeat(300)), "s.toml:6: this stands in more than 16");
    for (text, words) in [
        (
            &b"version = 1\n# caf\xe9\n"[..],
            "s.toml:2: the byte 0xE9 is not UTF-8, but perhaps Latin-1",
        ),
        (b"\xff\xfev\0", "s.toml:1: this is UTF-16 text; save it as UTF-8"),
        (b"version = 1\n\0", "s.toml:2: holds a zero byte: this is a binary file, not text"),
    ] {
        let (_folder, command) = self::command(text, &[]);
        refused_by(command, 1, &[words]);
    }
    let mut command = run::command("25_scene_effects");
    command.args(["--headless", "--scene", "gone.toml"]);
    refused_by(command, 1, &["gone.toml: there is no such file"]);
}

#[test]
fn a_file_and_a_scene_of_the_chapters_own() {
    let (_folder, mut command) = command(HEAD.as_bytes(), &[]);
    command.args(["--set", "scene=lake"]);
    let words = ["--scene s.toml and --set \"scene=lake\" are two scenes", "leave one of them out"];
    refused_by(command, 2, &words);
}

#[test]
fn patterns_and_lines_that_are_wrong() {
    let paint = |keys: &str| format!("{PAINT}{keys}");
    table_refused(
        &paint("pattern = \"marbel\"\nsecond = [0, 0, 0]\n"),
        "s.toml:8: \"marbel\" is no pattern; write \"marble\" or \"wood\" or \"checker\"",
    );
    table_refused(&paint("pattern = \"wood\"\n"), "s.toml:6: a pattern has a `second` colour");
    table_refused(
        &paint("scale = 2\n"),
        "s.toml:6: `second` and `scale` are of a `pattern`: marble, wood or checker",
    );
    table_refused(&paint("scale = 0\n"), "s.toml:8: 0.0 is not a number from 0.000001");
    table_refused(&paint("lines = 21\n"), "s.toml:8: 21.0 is not a number from 0 to 20");
    table_refused(&paint("ink = [0, 0, 0]\n"), "s.toml:6: `ink` is the colour of `lines`");
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";
    table_refused(
        &paint(&format!("lines = 1\n{ball}")),
        "s.toml:12: \"a\" has holes, a texture or lines, which only meshes can have",
    );
}

#[test]
fn values_of_another_type() {
    let camera = |line: &str| HEAD.replace("eye = [0, 1, 5]", line);
    file_refused(&camera("eye = [0, \"1\", 5]"), "s.toml:3: \"1\" is no number");
    file_refused(&camera("eye = [0, 1e38, 5]"), "s.toml:3: 1e38 is not a number from -1000000");
    file_refused("version = 1\ncamera = 3\n", "s.toml:2: write a table here: [camera]");
    let paint = |keys: &str| format!("{PAINT}{keys}");
    table_refused(&paint("pattern = 3\n"), "s.toml:8: 3 is no pattern; write \"marble\"");
    table_refused(&paint("color = 0.5\n"), "s.toml:8: 0.5 is no list of 3 numbers, such as");
    table_refused(&paint("shininess = [1]\n"), "s.toml:8: a list is not a number from 0 to 100000");
    table_refused(&paint("mirror = 1\n"), "s.toml:8: write true or false here");
    table_refused("[picture]\nsamples = 1.5\n", "s.toml:7: 1.5 is not a whole number from 1 to 64");
    file_refused(
        &HEAD.replace("[camera]", "light = 3\n[camera]"),
        "s.toml:2: there may be several of these tables: write each under",
    );
}

#[test]
fn lines_that_are_no_toml_say_what_to_write() {
    let ball = |radius: &str| {
        format!("{PAINT}[[sphere]]\ncenter = [0, 0, 0]\nmaterial = \"a\"\nradius = {radius}\n")
    };
    let eye = |list: &str| HEAD.replace("[0, 1, 5]", list);
    let model = |path: &str| HEAD.replace("[camera]", &format!("model = \"{path}\"\n[camera]"));
    let slash = "a `\\` in a text begins an escape";
    let list = "a list is [0, 1, 5], with commas between its values and a `]` at its end";
    let number = "a number is 7, 0.5 or 1e6";
    let is_none = "this is no number; a number is 7, 0.5 or 1e6, without a unit";
    let quotes = "a text stands in quotes: \"red\"";
    let line = "a line is `key = value`, `[table]` or `[[table]]`; a comment begins with `#`";
    for (text, words) in [
        (model("sub\\car.obj"), format!("s.toml:2: {slash}; write `/` between folders")),
        (model("C:\\Users\\car.obj"), format!("s.toml:2: {slash}; write `/` between folders")),
        // Each of these is an escape, for a tab and for a line break.
        (model("sub\\table\\new.obj"), format!("{slash}: write `/` between folders")),
        (
            HEAD.to_owned() + &ball("1,5"),
            "s.toml:11: a number has a point, not a comma: write 1.5".to_owned(),
        ),
        (HEAD.to_owned() + &ball("-0,25 # small"), "a point, not a comma: write -0.25".to_owned()),
        (HEAD.to_owned() + &ball(".5"), format!("s.toml:11: {number}")),
        (HEAD.to_owned() + &ball("5."), format!("s.toml:11: {number}")),
        (HEAD.to_owned() + &ball("01"), format!("s.toml:11: {number}")),
        (HEAD.to_owned() + &ball("2m"), format!("s.toml:11: {is_none}")),
        (HEAD.to_owned() + &ball("1/2"), format!("s.toml:11: {is_none}")),
        (HEAD.to_owned() + &ball("big"), format!("s.toml:11: {quotes}")),
        (
            HEAD.to_owned() + &ball("99999999999999999999"),
            "the number has too many digits".to_owned(),
        ),
        (
            HEAD.to_owned() + &ball("1") + "sky = 0.5\n",
            "s.toml:12: `sky` is a key of the whole file; write it above the first [table]"
                .to_owned(),
        ),
        (
            HEAD.to_owned() + "picture = 3\n",
            "s.toml:6: `picture` is a table of its own; write it as [picture]".to_owned(),
        ),
        (
            HEAD.to_owned() + "[sphere]\n",
            "there may be several of these tables: write each".to_owned(),
        ),
        (
            HEAD.to_owned() + "[camera]\n",
            "s.toml:6: `camera` is here for the second time".to_owned(),
        ),
        (
            HEAD.replace("[camera]", "[[camera]]"),
            "s.toml:2: there is one table of this name: write [camera]".to_owned(),
        ),
        (HEAD.to_owned() + "[picture\n", "s.toml:6: a table's name stands in brackets".to_owned()),
        (HEAD.to_owned() + "sky =\n", "s.toml:6: the value is missing; write it after".to_owned()),
        (HEAD.to_owned() + "sky: 3\n", format!("s.toml:6: {line}")),
        (format!("// a scene\n{HEAD}"), format!("s.toml:1: {line}")),
        ("{ \"version\": 1 }".to_owned(), format!("s.toml:1: {line}")),
        (
            HEAD.to_owned() + "lens = { diameter 0.1 }\n",
            "s.toml:6: a table within a line is".to_owned(),
        ),
        (
            HEAD.to_owned() + "[[material]]\nname = \"a\n",
            "s.toml:7: a text ends on its line".to_owned(),
        ),
        (
            HEAD.to_owned() + "[[material]]\nname = “a”\n",
            "s.toml:7: write straight quotes".to_owned(),
        ),
        (
            HEAD.to_owned() + "[[material]]\nname = 3\n",
            "s.toml:7: write a text in quotes here".to_owned(),
        ),
        (
            HEAD.to_owned() + PAINT + "mirror = True\n",
            "s.toml:8: write true or false, in".to_owned(),
        ),
        (eye("[0 1 5]"), format!("s.toml:3: {list}")),
        (eye("[0; 1; 5]"), format!("s.toml:3: {list}")),
        (eye("(0, 1, 5)"), format!("s.toml:3: {list}")),
        (eye("[0, 1, 5"), list.to_owned()),
        (HEAD.replace('\n', "\r"), "s.toml:1: its lines end in CR alone".to_owned()),
    ] {
        file_refused(&text, &words);
    }
}

#[test]
fn a_model_in_a_folder_below_is_found_however_the_path_goes() {
    let cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (path, warned) in [
        ("./sub/../sub/car.obj", false),
        ("gone/../sub/car.obj", false),
        ("/home/somebody/sub/car.obj", true),
    ] {
        let text = HEAD.replace("[camera]", &format!("model = \"{path}\"\n[camera]"));
        let (folder, mut command) = command(text.as_bytes(), &[]);
        fs::create_dir(folder.path().join("sub")).unwrap();
        fs::write(folder.path().join("sub/car.obj"), cube).unwrap();
        let output = command.arg("--validate").output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.is_empty() != warned, "{path}: {said}");
        let words = "s.toml:2: model names \"/home/somebody/sub/car.obj\", outside the scene file's folder; \
                     write \"sub/car.obj\"; the file of that name beside it is taken";
        assert!(!warned || said.contains(words), "{said}");
    }
}

#[test]
fn a_planet_is_told_of_that_things_on_it_lose_their_shadows() {
    for (radius, warned) in [("1000000", true), ("1000", false)] {
        let planet = format!(
            "[[sphere]]\ncenter = [0, -{radius}, 0]\nradius = {radius}\nmaterial = \"a\"\n"
        );
        let ball = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nmaterial = \"a\"\n";
        let (_folder, mut command) =
            command(format!("{HEAD}{PAINT}{planet}{ball}").as_bytes(), &[]);
        let output = command.arg("--validate").output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.is_empty() != warned, "{said}");
        let words = "s.toml:8: rays that leave this sphere start up to 2.7 above it";
        assert!(
            !warned || said.contains(words) && said.contains("at most 46000 is right"),
            "{said}"
        );
    }
}

#[test]
fn boxes_solids_and_meshes_are_told_of_as_planets_are() {
    let ball = |height: &str| {
        format!("[[sphere]]\ncenter = [0, {height}, 0]\nradius = 1\nmaterial = \"a\"\n")
    };
    let block = |high: &str| {
        format!(
            "[[box]]\nlow = [-1000000, -1000000, -1000000]\nhigh = [1000000, {high}, 1000000]\nmaterial = \"a\"\n"
        )
    };
    let solid = "[[solid]]\ncenter = [0, -900000, 0]\nplanes = [[0, 1, 0, 900000], [0, -1, 0, 1], [1, 0, 0, \
                 900000], [-1, 0, 0, 900000], [0, 0, 1, 900000], [0, 0, -1, 900000]]\nmaterial = \"a\"\n";
    let ground = "v -1e6 0 -1e6\nv 1e6 0 -1e6\nv 1e6 0 1e6\nv -1e6 0 1e6\no ground\nf 4 3 2 1\n";
    let cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no thing\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
    let leave = |what: &str| format!("rays that leave {what} start up to ");
    for (shape, words) in [
        (block("0") + &ball("1"), String::new()),
        (block("900000") + &ball("900001"), format!("s.toml:8: {}", leave("this box"))),
        (solid.to_owned() + &ball("1"), format!("s.toml:8: {}", leave("this solid"))),
        (
            "[[piece]]\nmesh = \"ground\"\nat = [0, 0, 0]\n".to_owned() + &ball("1"),
            format!("s.toml: {}", leave("the mesh \"ground\"")),
        ),
    ] {
        let head = HEAD.replace("[camera]", "model = \"m.obj\"\n[camera]");
        let head = if shape.contains("ground") { &head } else { HEAD };
        let scene = format!("{head}{PAINT}{shape}");
        let (_folder, mut command) = command(scene.as_bytes(), &[("m.obj", ground)]);
        let output = command.arg("--validate").output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.is_empty() == words.is_empty(), "{said}");
        assert!(said.contains(&words), "{said}");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.obj");
    fs::write(&path, format!("{ground}{cube}")).unwrap();
    let mut command = run::command("25_scene_effects");
    let output =
        command.args(["--headless", "--size", "8x8", "--scene"]).arg(&path).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains(&format!("m.obj: {}", leave("the mesh \"ground\""))), "{said}");
}

#[test]
fn glass_whose_faces_point_inwards_is_turned_around() {
    let tetrahedron = "o body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let scene = HEAD.replace("[camera]", "model = \"m.obj\"\n[camera]")
        + "[[piece]]\nmesh = \"body\"\nat = [0, 0, 0]\nmaterial = \"g\"\n[[material]]\nname = \"g\"\n\
           glass = \"thick\"\n";
    for (faces, warned) in [
        ("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", false),
        ("f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n", true),
    ] {
        let model = format!("{tetrahedron}{faces}");
        let (_folder, mut command) = command(scene.as_bytes(), &[("m.obj", &model)]);
        let output = command.arg("--validate").output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && said.is_empty() != warned, "{said}");
        let words =
            "the faces of \"body\", a closed body of glass, point inwards; they are turned around";
        assert!(!warned || said.contains(words), "{said}");
    }
}

#[test]
fn bounces_glass_and_lenses_that_are_wrong() {
    let paint = |keys: &str| format!("{PAINT}{keys}");
    table_refused("[picture]\nbounces = 9\n", "s.toml:7: 9 is not a whole number from 0 to 8");
    table_refused(
        &paint("glass = \"clear\"\n"),
        "s.toml:8: \"clear\" is no kind of glass; write \"thick\" or \"thin\"",
    );
    table_refused(
        &paint("glass = \"thin\"\nindex = 0\n"),
        "s.toml:9: 0.0 is not a number from 0.1 to 10",
    );
    table_refused(&paint("through = [2, 0, 0]\n"), "s.toml:8: 2.0 is not a number from 0 to 1");
    table_refused(
        &paint("index = 1.5\n"),
        "s.toml:6: `index` and `through` are of `glass`: \"thick\" or",
    );
    let glass = |keys: &str| paint(&format!("glass = \"thick\"\n{keys}"));
    table_refused(&glass("mirror = true\n"), "s.toml:6: a material is a mirror or glass; take");
    table_refused(&glass("opacity = 0.5\n"), "s.toml:6: glass has `through` in place of `opacity`");
    table_refused(&glass("lines = 2\n"), "s.toml:6: glass shows neither a `pattern` nor `lines`");
    let lens = |keys: &str| format!("{HEAD}lens = {{ {keys} }}\n");
    file_refused(&lens("diameter = 2"), "s.toml:6: 2.0 is not a number from 0 to 1");
    file_refused(&lens("focus = 3"), "s.toml:6: the key `diameter` is missing in this table");
    file_refused(
        &lens("diameter = 0.1, focus = 0"),
        "s.toml:6: 0.0 is not a number from 0.015625 to 1024",
    );
    file_refused(
        &lens("diameter = 0.1, focus = nan"),
        "s.toml:6: NaN is not a number from 0.015625 to 1024",
    );
    file_refused(
        &lens("diameter = 0.1, blades = 13"),
        "s.toml:6: 13 is not a whole number from 0 to 12",
    );
    file_refused(
        &lens("diameter = 0.1, f = 2"),
        "s.toml:6: there is no key `f` here; there is diameter,",
    );
    file_refused(&format!("{HEAD}lens = 2\n"), "s.toml:6: write a table here: { diameter = 0.1 }");
}

#[test]
fn another_chapter_says_who_reads_scene_files() {
    for name in ["02_basic", "12_infinite_plane"] {
        let mut command = run::command(name);
        command.args(["--headless", "--scene", "samples/assets/scenes/lake.toml"]);
        let words =
            ["lake.toml: a scene file, which 25_scene_effects alone reads", "an OBJ or glTF file"];
        refused_by(command, 2, &words);
    }
}

#[test]
fn keys_and_values_that_are_wrong() {
    table_refused("[fog]\n", "s.toml:6: there is no key `fog` here; there is version, model");
    table_refused(
        "[plane]\nslope = 1\n",
        "s.toml:7: there is no key `slope` here; there is normal, distance",
    );
    let camera = |line: &str| HEAD.replace("eye = [0, 1, 5]", line);
    file_refused(
        &camera("eye = [0, 1, 5]\nroll = 3"),
        "s.toml:4: there is no key `roll` here; there is eye, target",
    );
    file_refused(
        &camera("eye = [0, nan, 5]"),
        "s.toml:3: NaN is not a number from -1000000 to 1000000",
    );
    file_refused(&camera("eye = [0, inf, 5]"), "s.toml:3: inf is not a number from");
    file_refused(
        &camera("eye = [0, 1e300, 5]"),
        "s.toml:3: 1e300 is not a number from -1000000 to 1000000",
    );
    file_refused(&camera("eye = [0, 1]"), "s.toml:3: 2 numbers where there are 3");
    file_refused(&camera("eye = [0, 1, 5, 2]"), "s.toml:3: 4 numbers where there are 3");
    file_refused(
        &camera("eye = \"here\""),
        "s.toml:3: \"here\" is no list of 3 numbers, such as [1, 1, 1]",
    );
    file_refused(&camera("eye = [0, 0, 0]"), "s.toml:2: the camera stands where it looks");
    table_refused("[picture]\nsamples = 0\n", "s.toml:7: 0 is not a whole number from 1 to 64");
    table_refused(
        "[picture]\nsamples = 99999999\n",
        "s.toml:7: 99999999 is not a whole number from 1",
    );
    table_refused("[picture]\ndepth = -1\n", "s.toml:7: -1 is not a whole number from 0 to 32");
    table_refused(
        "[plane]\nnormal = [0, 0, 0]\n",
        "s.toml:7: a direction is longer than 0.000001: [0, 1, 0] is up",
    );
}

#[test]
fn lights_that_are_wrong() {
    let lamp = "[[light]]\nkind = \"point\"\nposition = [0, 3, 0]\nintensity = [9, 9, 9]\n";
    table_refused(&lamp.repeat(5), "s.toml:22: more than 4 lights");
    table_refused(
        &lamp.replace("point", "laser"),
        "s.toml:7: \"laser\" is no kind of light; write",
    );
    table_refused(
        &lamp.replace("point", "directional"),
        "s.toml:6: a directional light has `azimuth`, `elevation` and `radiance`",
    );
    table_refused(
        &lamp.replace("intensity = [9, 9, 9]\n", ""),
        "s.toml:6: a point light has `position` and `intensity`",
    );
    table_refused(&format!("{lamp}size = 7\n"), "s.toml:10: 7.0 is not a number from 0 to 1");
    table_refused(&lamp.replace("[9,", "[-9,"), "s.toml:9: -9.0 is not a number from 0 to 1000000");
}

#[test]
fn things_that_are_wrong() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";
    table_refused(ball, "s.toml:9: no material \"a\"; add a [[material]]");
    table_refused(
        &format!("{PAINT}{}", ball.replace("\"a\"", "\"b\"")),
        "s.toml:11: no material \"b\"; there is a",
    );
    table_refused(
        &ball.replace("= 1", "= -1"),
        "s.toml:8: -1.0 is not a number from 0.000001 to 1000000",
    );
    table_refused(&PAINT.repeat(2), "s.toml:8: a second material \"a\"");
    let strange = format!("[[material]]\nname = \"b\\n\\u001b[31m\"\n{ball}");
    table_refused(&strange, "s.toml:11: no material \"a\"; there is b\\n\\u{1b}[31m");
    let block = "[[box]]\nlow = [0, 0, 0]\nhigh = [1, 0, 1]\nmaterial = \"a\"\n";
    table_refused(&format!("{PAINT}{block}"), "s.toml:8: a box has its `high` above its `low`");
    let solid = |planes: &str| {
        format!("{PAINT}[[solid]]\ncenter = [0, 0, 0]\nmaterial = \"a\"\nplanes = [{planes}]\n")
    };
    table_refused(&solid("[0, 1, 0, 1]"), "s.toml:11: 1 planes; a solid has 4 to 24");
    table_refused(
        &solid(&"[0, 1, 0, 1],".repeat(5)),
        "s.toml:8: the planes enclose no body that ends within 1e6 of its center",
    );
    table_refused(
        &solid("[1, 1, 1, -1], [1, -1, -1, -1], [-1, 1, -1, -1], [-1, -1, 1, -1]"),
        "s.toml:8: the planes enclose nothing, or a body thinner than 1e-6; a normal points out of the solid",
    );
    let crystal = "[[material]]\nname = \"c\"\nglass = \"thick\"\nspecular = [0.04, 0.04, 0.04]\n";
    let moved = ball.replace("\"a\"", "\"c\"") + "moves = [0, 0, 1]\n";
    table_refused(
        &format!("{crystal}{moved}"),
        "s.toml:13: a sphere that moves is not of glass, and does not shine",
    );
    let chain = "[[strand]]\nnodes = [[0, 1, 0, 1], [0, 2, 0, 1]]\nmaterial = \"c\"\n";
    table_refused(
        &format!("{crystal}{chain}"),
        "s.toml:12: a strand is not of glass: its segments overlap",
    );
    let strand = |nodes: &str| format!("{PAINT}[[strand]]\nmaterial = \"a\"\nnodes = {nodes}\n");
    table_refused(&strand("[[0, 1, 0, 1]]"), "s.toml:10: 1 nodes; a strand has 2 or more");
    table_refused(
        &strand("[[0, 1, 0, 0], [0, 2, 0, 0.0]]"),
        "s.toml:10: every radius is 0, and such a strand has no surface",
    );
    let torus =
        |keys: &str| format!("{PAINT}[[torus]]\ncenter = [0, 1, 0]\nmaterial = \"a\"\n{keys}\n");
    for tube in ["0.0024", "1.0001"] {
        table_refused(
            &torus(&format!("axis = [0, 1, 0]\nradius = 1\ntube = {tube}")),
            &format!("s.toml:8: a torus of radius 1 has a `tube` of 0.0025 to 1, not {tube}"),
        );
    }
    table_refused(
        &torus("axis = [0, 0, 0]\nradius = 1\ntube = 0.5"),
        "s.toml:11: a direction is longer than 0.000001: [0, 1, 0] is up",
    );
    table_refused(
        &torus("axis = [0, 1, 0]\nradius = 1\ntube = 0"),
        "s.toml:13: 0.0 is not a number from 0.000001 to 1000000",
    );
    table_refused(
        &torus("axis = [0, 1, 0]\nradius = 1"),
        "s.toml:8: the key `tube` is missing in this table",
    );
    table_refused("[[material]]\nname = \"\"\n", "s.toml:6: a material has a name: name = \"red\"");
    table_refused(&strand("[[0, 1, 0], [0, 2, 0, 1]]"), "s.toml:10: 3 numbers where there are 4");
    table_refused(
        &strand("[[0, 1, 0, 1], [0, 2, 0, -1]]"),
        "s.toml:10: -1.0 is not a number from 0 to 1000000",
    );
    table_refused(&strand("7"), "s.toml:10: 7 is no list of balls, such as [[0, 1, 0, 0.1], …]");
    table_refused(
        &solid(&"[0, 1, 0, 1],".repeat(2000)),
        "s.toml:11: 2000 planes; a solid has 4 to 24",
    );
    table_refused(
        "[heightfield]\nlow = [0, 0]\nhigh = [1, 1]\nhills = 0\nhill = [1, 1]\nlight = [1, 1, 1]\n\
         dark = [0, 0, 0]\nrock = [0, 0, 0]\n",
        "s.toml:6: a heightfield has its `high` above its `low`, and `hills` or `ridges` above 0",
    );
    table_refused(&solid("[0, 1, 0, 1, 1]"), "s.toml:11: 5 numbers where there are 4");
}

#[test]
fn more_of_anything_than_is_accepted_is_refused_where_it_begins() {
    let ball = "[[sphere]]\ncenter = [0,0,0]\nradius = 1\nmaterial = \"a\"\n";
    let block = "[[box]]\nlow = [0,0,0]\nhigh = [1,1,1]\nmaterial = \"a\"\n";
    let piece = "[[piece]]\nmesh = \"pawn\"\nat = [0,0,0]\n";
    for (table, what) in
        [(ball, "spheres"), (block, "boxes"), (piece, "pieces"), (PAINT, "materials")]
    {
        let line = 6 + 100_000 * table.lines().count();
        table_refused(&table.repeat(100_001), &format!("s.toml:{line}: more than 100000 {what}"));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn as_many_names_as_may_be_are_found_at_once() {
    let paints: String = (0..100_000).map(|i| format!("[[material]]\nname = \"{i}\"\n")).collect();
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"99999\"\n";
    let wrong = ball.replace("99999", "none");
    let text = format!("{HEAD}{paints}{}{wrong}", ball.repeat(99_999));
    let (_folder, mut command) = command(text.as_bytes(), &[]);
    let spent = run::spend(&mut command);
    let (_, line) = run::refusal(spent.output);
    let words = "s.toml:600005: no material \"none\"; there is 0, 1, 2, 3";
    assert!(line.contains(words), "{line}");
    // Searching for each name among all would take minutes.
    assert!(spent.time.as_secs() < 60, "{:?}", spent.time);
}

#[test]
fn pieces_and_models_that_are_wrong() {
    let piece = "[[piece]]\nmesh = \"tower\"\nat = [0, 0, 0]\n";
    table_refused(
        piece,
        "s.toml:7: no mesh \"tower\"; there is pawn, rook, bishop, knight, queen, king",
    );
    let board =
        |position: &str| HEAD.replace("[camera]", &format!("position = \"{position}\"\n[camera]"));
    file_refused(&board("8/8"), "s.toml:2: a position has eight ranks of eight squares");
    file_refused(&board("8/8/8/8/8/8/8/xxxxxxxx"), "s.toml:2: 'x' is no chess piece");
    let model = |name: &str| HEAD.replace("[camera]", &format!("model = {name:?}\n[camera]"));
    file_refused(&model("gone.obj"), "s.toml:2: model names \"gone.obj\", which is not there");
    file_refused(&model("."), "s.toml:2: model names \".\", which is a folder");
    for outside in ["../m.obj", "/etc/passwd", "a/../../m.obj", "C:\\m.obj"] {
        file_refused(
            &model(&outside.replace('\\', "/")),
            "outside the scene file's folder; copy it",
        );
    }
    for (text, words) in [
        ("v 0 nan 0\n", "m.obj:1: v has \"nan\", which is not a finite 32-bit number"),
        ("v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj: reaches 1e30 from the origin"),
    ] {
        let (_folder, command) = command(model("m.obj").as_bytes(), &[("m.obj", text)]);
        refused_by(command, 1, &[words]);
    }
}

/// A chair of two materials, and a table.
const CHAIR: &str = "mtllib m.mtl\no chair\nusemtl wood\nv -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n\
    usemtl cloth\nv -1 2 0\nv 1 2 0\nf 4 3 6 5\no table\nusemtl wood\nv -1 0 1\nv 0 0 1\nv 0 1 1\nf 7 8 9\n";
const CHAIR_MTL: &str = "newmtl wood\nKd 0.6 0.3 0.1\nnewmtl cloth\nKd 0.1 0.1 0.8\n";

#[test]
fn an_object_of_two_materials_is_placed_whole() {
    let scene = HEAD.replace("[camera]", "model = \"m.obj\"\n[camera]")
        + "[[light]]\nkind = \"directional\"\nazimuth = 30\nelevation = 50\nradiance = [3, 3, 3]\n";
    let piece = format!("{scene}[[piece]]\nmesh = \"chair\"\nat = [0, 0, 0]\n");
    let picture = |scene: &str, obj: &str| {
        let (folder, mut command) =
            command(scene.as_bytes(), &[("m.obj", obj), ("m.mtl", CHAIR_MTL)]);
        let output = command.args(["--out", "p.png"]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(folder.path().join("p.png")).unwrap()
    };
    let chair = CHAIR.split("o table").next().unwrap();
    let placed = picture(&piece, CHAIR);
    assert!(placed == picture(&scene, chair), "not the whole chair");
    assert!(placed != picture(&scene, CHAIR), "a table as well");

    let twice = format!("{CHAIR}o chair\nf 7 8 9\n");
    let (_folder, command) = command(piece.as_bytes(), &[("m.obj", &twice), ("m.mtl", CHAIR_MTL)]);
    let words = "s.toml:13: several objects are named \"chair\"; give each a name of its own";
    refused_by(command, 1, &[words]);
}

#[test]
fn names_of_a_scene_command_no_terminal_where_controls_are_listed() {
    let paint = "[[material]]\nname = \"\\u001b[2J\\u0007\\u009b31m\\u202e\\t\\n\"\n";
    let name = paint.split('=').nth(1).unwrap().trim();
    let ball = format!("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = {name}\n");
    let (_folder, mut command) = command(format!("{HEAD}{paint}{ball}").as_bytes(), &[]);
    let output = command.arg("--list-controls").output().unwrap();
    let listed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && listed.contains("\\u{1b}[2J\\u{7}\\u{9b}31m"), "{listed}");
    for line in listed.lines() {
        assert_eq!(line.matches('\t').count(), 3, "{line}");
        assert!(!line.replace('\t', "").contains(char::is_control), "{line}");
    }
}

#[test]
fn models_that_reach_too_far_or_are_too_small() {
    let model = HEAD.replace("[camera]", "model = \"m.obj\"\n[camera]");
    let triangle = |far: &str| format!("o a\nv 0 0 {far}\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let (_folder, command) = command(model.as_bytes(), &[("m.obj", &triangle("1e30"))]);
    refused_by(command, 1, &["m.obj: reaches 1e30 from the origin; beyond 1e9, products of four"]);
    let piece = format!("{model}[[piece]]\nmesh = \"a\"\nat = [0, 0, 0]\nsize = 100\n");
    let (_folder, command) = self::command(piece.as_bytes(), &[("m.obj", &triangle("1e8"))]);
    refused_by(command, 1, &["s.toml:7: a piece that reaches 1e10 from its place; beyond 1e9"]);
    let speck = "v 0 0 1e-25\nv 1e-25 0 0\nv 0 1e-25 0\nf 1 2 3\n";
    let (_folder, command) = self::command(model.as_bytes(), &[("m.obj", speck)]);
    refused_by(command, 1, &["m.obj: is 1e-25 from end to end; below 1e-18, products of two"]);
}
