//! Textures that load, and those that cause warnings.

use super::super::obj::tests::{TRIANGLE, load_files};
use super::*;
use crate::model::texture::png::BESIDE_BYTES;
use crate::scene::material::Material;
use image::{DynamicImage, GrayImage, ImageFormat, RgbImage, RgbaImage};
use std::io::Cursor;

fn encoded(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A PNG file of rows of `width` texels.
pub fn png(texels: &[[u8; 4]], width: u32) -> Vec<u8> {
    let height = texels.len() as u32 / width;
    encoded(RgbaImage::from_raw(width, height, texels.concat()).unwrap())
}

fn opaque_png(texels: &[[u8; 3]]) -> Vec<u8> {
    encoded(RgbImage::from_raw(texels.len() as u32, 1, texels.concat()).unwrap())
}

pub fn load(mtl: &str, files: &[(&str, &[u8])]) -> Result<(Vec<Material>, Vec<Texture>), String> {
    let obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let mut all: Vec<(&str, &[u8])> =
        vec![("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    all.extend_from_slice(files);
    load_files(&all, &Limits::DEFAULT).map(|model| (model.materials, model.textures))
}

/// Line 2 of `m.mtl` causes a warning that begins with this text, and the plain colour is used.
#[track_caller]
pub fn warned(line: &str, file: &[u8], start: &str) {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let mtl = format!("newmtl a\n{line}\n");
    let files: [(&str, &[u8]); 3] =
        [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("t.png", file)];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
    let end = "; the plain colour stands for it (1 in all)";
    assert!(warning.starts_with(&format!("m.mtl:2: {start}")), "{warning}");
    assert!(warning.ends_with(end), "{warning}");
    let plain = Material { name: "a".to_owned(), ..Material::default() };
    assert_eq!((model.materials, model.textures), (vec![plain], vec![]));
}

#[test]
fn rows_come_from_the_top_and_alpha_is_kept() {
    let texels = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [13, 14, 15, 16]];
    let (materials, textures) =
        load("newmtl a\nmap_Kd my tex\\t 1.png\n", &[("my tex/t 1.png", &png(&texels, 2))])
            .unwrap();
    let rgba = texels.concat();
    let name = "my tex/t 1.png".to_owned();
    assert_eq!(
        textures,
        [Texture {
            name,
            width: 2,
            height: 2,
            rgba,
            srgb: true,
            slopes: false,
            sampling: Sampling::default()
        }]
    );
    assert_eq!(materials[0].base_texture, Some(0));
    assert_eq!(materials[0].base_color, glam::Vec3::ONE);
}

#[test]
fn a_file_of_numbers_is_linear_and_one_of_colours_too_is_two_textures() {
    let texel = png(&[[1, 2, 3, 255]], 1);
    let files: [(&str, &[u8]); 1] = [("t.png", &texel)];
    let (materials, textures) =
        load("newmtl a\nmap_Kd t.png\nmap_Pr t.png\nmap_Pm t.png\n", &files).unwrap();
    assert_eq!(textures.iter().map(|texture| texture.srgb).collect::<Vec<_>>(), [true, false]);
    let microfacet = materials[0].microfacet.as_ref().unwrap();
    assert_eq!(materials[0].base_texture, Some(0));
    assert_eq!((microfacet.roughness_texture, microfacet.metallic_texture), (Some(1), Some(1)));
    assert_eq!((microfacet.roughness, microfacet.metallic), (1.0, 1.0));
    assert_eq!(microfacet.color, glam::Vec3::ONE);
}

#[test]
fn a_normal_map_is_linear_and_comes_before_heights() {
    let map = png(&[[1, 2, 3, 255]], 1);
    let heights = png(&[[9, 9, 9, 255]], 1);
    let files: [(&str, &[u8]); 2] = [("n.png", &map), ("h.png", &heights)];
    let mtl = "newmtl a\nmap_Bump -bm 3 h.png\nnorm -bm 0.5 n.png\nbump h.png\nmap_Kd n.png\n";
    let (materials, textures) = load(mtl, &files).unwrap();
    let material = &materials[0];
    assert_eq!(material.normal_scale, 0.5);
    let normals = &textures[material.normal_texture.unwrap()];
    assert_eq!((normals.srgb, &normals.rgba[..]), (false, &[1, 2, 3, 255][..]));
    assert!(textures[material.base_texture.unwrap()].srgb);
    let (materials, textures) = load("newmtl a\nmap_Bump -bm 3 h.png\n", &files).unwrap();
    assert_eq!(materials[0].normal_scale, 3.0 / 16.0);
    let slopes = &textures[materials[0].normal_texture.unwrap()];
    // Two half floats of 1/2, which mean no slope.
    assert_eq!((slopes.slopes, &slopes.rgba[..]), (true, &[0, 0x38, 0, 0x38][..]));
}

#[test]
fn heights_with_colours_are_a_normal_map_with_one_warning() {
    let map = png(&[[1, 2, 255, 255]], 1);
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    for (mtl, rgba, end) in [
        (
            "newmtl a\nbump t.png\n",
            Some([1, 2, 255, 255]),
            "it is taken as a normal map (1 in all)",
        ),
        ("newmtl a\nbump u.png\n", None, "the surface is smooth (1 in all)"),
    ] {
        let files: [(&str, &[u8]); 3] =
            [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("t.png", &map)];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        let material = &model.materials[model.meshes[0].material];
        let texels = material.normal_texture.map(|texture| &model.textures[texture].rgba[..]);
        assert_eq!(texels, rgba.as_ref().map(|rgba| &rgba[..]));
        assert!(model.warnings.iter().any(|line| line.ends_with(end)), "{:?}", model.warnings);
    }
}

#[test]
fn two_maps_of_relief_are_one_warning_and_so_is_a_grey_normal_map() {
    let coloured = png(&[[1, 2, 255, 255]], 1);
    let grey = png(&[[9, 9, 9, 255]], 1);
    let obj = "mtllib m.mtl\nusemtl a\nvt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n";
    let both =
        "the material has a normal map and a map of heights; the normal map counts (1 in all)";
    let is_grey = "the texture g.png: is grey, and a normal map has colours; perhaps these are heights, for \
                   map_Bump in an MTL file; it is taken as a normal map (1 in all)";
    for (lines, warning) in [
        ("norm c.png\nbump g.png\n", format!("m.mtl:3: {both}")),
        ("bump g.png\nnorm c.png\n", format!("m.mtl:3: {both}")),
        ("norm g.png\n", format!("m.mtl:2: {is_grey}")),
        (
            "norm c.png -bm 3\n",
            "m.mtl:2: norm names \"c.png -bm 3\", which is not there; options come before the name; the surface \
             is smooth (1 in all)"
                .to_owned(),
        ),
    ] {
        let mtl = format!("newmtl a\n{lines}");
        let files: [(&str, &[u8]); 4] = [
            ("model.obj", obj.as_bytes()),
            ("m.mtl", mtl.as_bytes()),
            ("c.png", &coloured),
            ("g.png", &grey),
        ];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        assert_eq!(model.warnings, [warning], "{lines}");
    }
}

#[test]
fn the_size_of_bumps_is_a_number() {
    let map = png(&[[9, 9, 9, 255]], 1);
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    for (size, what) in [
        ("x", "is no number"),
        ("nan", "is no number"),
        ("inf", "is too large, at most 1000000"),
        ("1e9", "is too large, at most 1000000"),
    ] {
        let mtl = format!("newmtl a\nbump -bm {size} t.png\n");
        let files: [(&str, &[u8]); 3] =
            [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("t.png", &map)];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        assert_eq!(model.materials[model.meshes[0].material].normal_scale, 1.0 / 16.0);
        let line = format!("m.mtl:2: -bm \"{size}\" of bump {what}; 1 is taken");
        assert!(model.warnings[0].starts_with(&line), "{:?}", model.warnings);
    }
}

#[test]
fn a_file_of_numbers_that_is_none_leaves_the_numbers() {
    for (name, bytes) in [("t.png", &b"text"[..]), ("other.png", b"")] {
        let mtl = b"newmtl a\nPr 0.25\nmap_Pr t.png\nmap_Pm t.png\n";
        let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
        let files: [(&str, &[u8]); 3] =
            [("model.obj", obj.as_bytes()), ("m.mtl", mtl), (name, bytes)];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        let microfacet = model.materials[model.meshes[0].material].microfacet.clone().unwrap();
        assert_eq!((microfacet.roughness, microfacet.metallic), (0.25, 0.0), "{name}");
        assert_eq!((microfacet.roughness_texture, microfacet.metallic_texture), (None, None));
        let end = "; the material's number alone counts";
        assert!(model.warnings[0].contains(end), "{:?}", model.warnings);
    }
}

#[test]
fn a_file_of_numbers_on_faces_without_coordinates_has_a_warning() {
    let texel = png(&[[1, 2, 3, 255]], 1);
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let files: [(&str, &[u8]); 3] =
        [("model.obj", obj.as_bytes()), ("m.mtl", b"newmtl a\nmap_Pr t.png\n"), ("t.png", &texel)];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    assert!(
        model.warnings[0].starts_with("m.mtl:2: map_Pr is on faces without"),
        "{:?}",
        model.warnings
    );
}

#[test]
fn paths_start_at_the_mtl_file_and_names_at_the_obj_file() {
    let obj = format!("mtllib sub/m.mtl\n{TRIANGLE}");
    let texel = png(&[[1, 2, 3, 4]], 1);
    let files: [(&str, &[u8]); 3] = [
        ("model.obj", obj.as_bytes()),
        ("sub/m.mtl", b"newmtl a\nKd 0.5 0.5 0.5\nmap_Kd t.png\n"),
        ("sub/t.png", &texel),
    ];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    assert_eq!(model.textures[0].name, "sub/t.png");
    assert_eq!(model.materials[0].base_color, glam::Vec3::splat(0.5));
}

#[test]
fn alpha_is_luminance_only_where_opacity_has_no_alpha() {
    let opaque = opaque_png(&[[255, 255, 255], [0, 255, 0], [80, 80, 80]]);
    let alpha =
        |texture: &Texture| texture.rgba.iter().skip(3).step_by(4).copied().collect::<Vec<_>>();
    let files: [(&str, &[u8]); 1] = [("t.png", &opaque)];

    let (_, color) = load("newmtl a\nmap_Kd t.png\n", &files).unwrap();
    assert_eq!((alpha(&color[0]), color[0].srgb), (vec![255; 3], true));
    let (materials, opacity) = load("newmtl a\nmap_d t.png\n", &files).unwrap();
    assert_eq!((alpha(&opacity[0]), opacity[0].srgb), (vec![255, 182, 80], false));
    assert!(materials[0].has_cutout() && materials[0].base_texture.is_none());
    let (materials, both) = load("newmtl a\nmap_d t.png\nmap_Kd ./t.png\n", &files).unwrap();
    assert_eq!((both.len(), alpha(&both[0]), both[0].srgb), (1, vec![255, 182, 80], true));
    assert_eq!((materials[0].base_texture, materials[0].opacity_texture), (Some(0), Some(0)));

    let clear = png(&[[255, 255, 255, 7]], 1);
    let (_, own) = load("newmtl a\nmap_d t.png\n", &[("t.png", &clear)]).unwrap();
    assert_eq!(own[0].rgba, [255, 255, 255, 7]);
    let grey = encoded(GrayImage::from_raw(1, 1, vec![99]).unwrap());
    let (_, grey) = load("newmtl a\nmap_d t.png\n", &[("t.png", &grey)]).unwrap();
    assert_eq!(grey[0].rgba, [99; 4]);
}

#[test]
fn files_that_are_wrong() {
    let good = png(&[[1, 2, 3, 4]; 4096], 64);
    warned("map_Kd gone.png", &good, "map_Kd names \"gone.png\", which is not there");
    warned("map_d", &good, "map_d is not followed by a name");
    let texture = |what: &str| format!("the texture t.png: {what}");
    warned("map_Kd t.png", b"", &texture("is empty"));
    warned("map_Kd t.png", b"hello", &texture("is neither a PNG nor a JPEG file; convert it"));
    let mut unmarked = good.clone();
    unmarked[0] = 0x09;
    warned("map_Kd t.png", &unmarked, &texture("is a PNG file whose first bytes are damaged"));
    for (head, kind) in [
        (&b"BM\x46\0\0\0"[..], "a BMP"),
        (b"GIF89a", "a GIF"),
        (b"RIFF\x24\0\0\0WEBPVP8 ", "a WebP"),
        (b"DDS |\0\0\0", "a DDS"),
        (b"\0\0\x02\0\0\0\0\0\0\0\0\0\x08\0\x08\0\x20\x08", "a TGA"),
        (b"<svg xmlns=", "an SVG or XML"),
    ] {
        let words =
            texture(&format!("is {kind} file, which is not read; convert it to PNG or JPEG"));
        warned("map_Kd t.png", head, &words);
    }
    warned("map_Kd .", b"", "map_Kd names \".\", which is a folder");
    for cut in [9, 40, good.len() / 2, good.len() - 20] {
        let start =
            "the texture t.png: cannot be decoded, it is damaged or cut off: it ends too soon";
        warned("map_d t.png", &good[..cut], start);
    }
    let mut changed = good.clone();
    let middle = good.len() / 2;
    changed[middle] ^= 0xff;
    let start =
        "the texture t.png: cannot be decoded, it is damaged or cut off: its data contradict";
    warned("map_d t.png", &changed, start);
}

#[test]
fn textures_after_one_that_is_wrong_keep_their_materials() {
    let mtl = "newmtl a\nmap_Kd bad.png\nnewmtl b\nmap_Kd t.png\nmap_d bad.png\n";
    let texel = png(&[[1, 2, 3, 4]], 1);
    let (materials, textures) = load(mtl, &[("bad.png", b""), ("t.png", &texel)]).unwrap();
    assert_eq!((textures.len(), textures[0].name.as_str()), (1, "t.png"));
    assert_eq!((materials[0].base_texture, materials[1].base_texture), (None, Some(0)));
    assert_eq!(materials[1].opacity_texture, None);
    assert_eq!(materials[0].base_color, glam::Vec3::splat(0.5));
    assert_eq!(materials[1].base_color, glam::Vec3::ONE);
}

#[test]
fn paths_that_leave_the_folder() {
    let outside = |name: &str| {
        format!("map_Kd names {name:?}, outside the OBJ file's folder; copy it into the folder")
    };
    for name in ["../u.png", "a/../../u.png", "..\\u.png", "/etc/passwd", "D:/u.png"] {
        warned(&format!("map_Kd {name}"), b"", &outside(name));
    }
}

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    std::fs::create_dir(folder.path().join("in")).unwrap();
    write("secret.png", &png(&[[0; 4]], 1));
    write("in/model.obj", format!("mtllib m.mtl\n{TRIANGLE}").as_bytes());
    write("in/m.mtl", b"newmtl a\nmap_Kd link.png\n");
    let (link, obj) = (folder.path().join("in/link.png"), folder.path().join("in/model.obj"));
    std::os::unix::fs::symlink("../secret.png", &link).unwrap();
    let model = super::super::obj::load(&obj).unwrap();
    let message = "in/m.mtl:2: map_Kd names \"link.png\", outside the OBJ file's folder";
    assert!(model.warnings[0].contains(message), "{:?}", model.warnings);
    assert!(model.textures.is_empty());

    write("in/inside.png", &png(&[[0; 4]], 1));
    std::fs::remove_file(&link).unwrap();
    std::os::unix::fs::symlink("inside.png", &link).unwrap();
    assert_eq!(super::super::obj::load(&obj).unwrap().textures[0].name, "inside.png");
}

#[test]
fn textures_that_are_too_large() {
    let wide = encoded(GrayImage::new(16385, 1));
    let side = "the texture t.png: is 16385 x 1 texels, at most 16384 x 16384 are read";
    warned("map_Kd t.png", &wide, side);

    // Two textures of 576 bytes; the second needs as much again while it is read.
    let small = png(&[[0; 4]; 144], 12);
    let deep = encoded(DynamicImage::new_rgba16(12, 12));
    for (most, second, need) in [(1000, &small, 576), (2000, &deep, 1728)] {
        let limits = Limits { texture_bytes: most, ..Limits::DEFAULT };
        let obj = format!("mtllib m.mtl\n{TRIANGLE}");
        let mtl: &[u8] = b"newmtl a\nmap_Kd a.png\nmap_d b.png\n";
        let obj = ("model.obj", obj.as_bytes());
        let all = [obj, ("m.mtl", mtl), ("a.png", &small), ("b.png", second)];
        let model = load_files(&all, &limits).unwrap();
        let words = format!(
            "m.mtl:3: the texture b.png: is 12 x 12 texels, which take {need} bytes to decode; all \
             textures together may take {most} bytes, of which {} bytes are left; the plain colour stands \
             for it (1 in all)",
            most - 576
        );
        assert_eq!(model.warnings, [words]);
        assert_eq!(model.textures.len(), 1);
    }
}

/// A chunk of a PNG file, as in PNG, third edition, 5.3.
fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let content = [kind, data].concat();
    let crc = crc32fast::hash(&content).to_be_bytes();
    [&(data.len() as u32).to_be_bytes()[..], &content, &crc].concat()
}

#[test]
fn a_row_that_no_decoder_has_room_for_is_too_wide_and_no_text() {
    let mut wide = png(&[[1, 2, 3, 4]], 1);
    let header = [&(1u32 << 30).to_be_bytes()[..], &wide[20..29]].concat();
    wide.splice(8..33, chunk(b"IHDR", &header));
    let words = "the texture t.png: is 1073741824 x 1 texels, at most 16384 x 16384 are read";
    warned("map_Kd t.png", &wide, words);
}

#[test]
fn a_palette_of_half_a_colour_is_no_mistake_of_the_program() {
    let plain = png(&[[1, 2, 3, 4]], 1);
    let header = chunk(b"IHDR", &[0, 0, 0, 1, 0, 0, 0, 1, 8, 3, 0, 0, 0]);
    let with =
        |palette: &[u8]| [&plain[..8], &header, &chunk(b"PLTE", palette), &plain[33..]].concat();
    for (palette, size) in [(&b"abcd"[..], 4), (&[0; 767], 767), (b"a", 1)] {
        let words = format!(
            "the texture t.png: cannot be decoded, it is damaged or cut off: its palette has {size} \
             bytes, no multiple of 3"
        );
        warned("map_Kd t.png", &with(palette), &words);
    }
    let other = [&plain[..8], &chunk(b"CgBI", b"abcd"), &plain[8..]].concat();
    let words =
        "the texture t.png: cannot be decoded, it is damaged or cut off: its first chunk is";
    warned("map_Kd t.png", &other, words);
}

#[test]
fn a_profile_that_unpacks_to_gigabytes_is_passed_over_and_a_long_text_refused() {
    let plain = png(&[[1, 2, 3, 4]], 1);
    // End of the header's chunk.
    let (start, end) = plain.split_at(33);
    let with = |chunk: Vec<u8>| [start, &chunk, end].concat();
    let mut packed =
        flate2::write::ZlibEncoder::new(b"p\0\0".to_vec(), flate2::Compression::best());
    let zeros = vec![0; 1 << 20];
    for _ in 0..(2 * BESIDE_BYTES) >> 20 {
        std::io::Write::write_all(&mut packed, &zeros).unwrap();
    }
    let profile = with(chunk(b"iCCP", &packed.finish().unwrap()));
    let (_, textures) = load("newmtl a\nmap_Kd t.png\n", &[("t.png", &profile)]).unwrap();
    assert_eq!(textures[0].rgba, [1, 2, 3, 4]);
    let text = with(chunk(b"tEXt", &[b"a\0".to_vec(), vec![b'a'; BESIDE_BYTES as usize]].concat()));
    let words = "the texture t.png: has texts of more than 16777216 bytes beside its texels; save it \
                 without";
    warned("map_Kd t.png", &text, words);
}
