//! JPEG files that load, and those that cause warnings.

use image::{ImageFormat, RgbImage};
use std::io::Cursor;

use super::super::Texture;
use super::super::tests::{load, warned};
use crate::model::limits::Limits;
use crate::model::obj::tests::{TRIANGLE, load_files};

/// A JPEG file of one colour.
fn jpeg(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = RgbImage::from_pixel(width, height, image::Rgb([200, 100, 50]));
    image.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
    bytes.into_inner()
}

#[test]
fn jpeg_files_are_read_whatever_their_name() {
    for name in ["t.jpg", "t.JPEG", "t.png"] {
        let mtl = format!("newmtl a\nmap_Kd {name}\n");
        let (materials, textures) = load(&mtl, &[(name, &jpeg(9, 3))]).unwrap();
        assert_eq!(materials[0].base_texture, Some(0), "{name}");
        let Texture { width, height, rgba, srgb, .. } = &textures[0];
        assert_eq!((*width, *height, *srgb), (9, 3, true));
        for texel in rgba.chunks_exact(4) {
            let near =
                texel.iter().zip([200, 100, 50, 255]).all(|(&is, right)| is.abs_diff(right) < 4);
            assert!(near, "{texel:?}");
        }
    }
    let (_, opacity) = load("newmtl a\nmap_d t.jpg\n", &[("t.jpg", &jpeg(1, 1))]).unwrap();
    assert!((110..130).contains(&opacity[0].rgba[3]), "{:?}", opacity[0].rgba);
}

#[test]
fn jpeg_files_that_are_wrong() {
    let good = jpeg(64, 64);
    let frame = good.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    let with = |at: usize, bytes: &[u8]| {
        let mut changed = good.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        changed
    };
    for (file, words) in [
        (good[..20].to_vec(), "cannot be decoded, it is damaged or cut off: it ends in its header"),
        (b"\xff\xd8\xff\xd9".repeat(9), "cannot be decoded, it is damaged: it has no image"),
        (with(frame + 1, &[0xc9]), "is a lossless, hierarchical or arithmetic-coded JPEG file"),
        (with(frame + 4, &[12]), "is a JPEG file of 12 bits per channel, which is not read"),
        (with(frame + 5, &[0xff; 4]), "is 65535 x 65535 texels, at most 16384 x 16384 are read"),
        (with(frame + 5, &[0; 2]), "is 64 x 0 texels, and so has none"),
        (with(frame + 9, &[77]), "cannot be decoded, it is damaged or of a rare kind"),
    ] {
        warned("map_Kd t.png", &file, &format!("the texture t.png: {words}"));
    }
    // The part that was read is shown.
    let textured = TRIANGLE.replace("f 1 2 3", "vt 0 0\nf 1/1 2/1 3/1");
    let obj = format!("mtllib m.mtl\nusemtl a\n{textured}");
    let mtl: &[u8] = b"newmtl a\nmap_Kd t.jpg\n";
    let cut = &good[..good.len() - 9];
    let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl), ("t.jpg", cut)];
    let model = load_files(&files, &Limits::DEFAULT).unwrap();
    let words = "m.mtl:2: the texture t.jpg: has no end mark, and so is cut off; copy it again; what there \
                 is of it is shown (1 in all)";
    assert_eq!((&model.warnings[..], model.textures.len()), (&[words.to_owned()][..], 1));
}

/// A JPEG file with the EXIF segment of a camera that was turned.
fn turned(mut jpeg: Vec<u8>, orientation: u8) -> Vec<u8> {
    let tag = [0x12, 1, 3, 0, 1, 0, 0, 0, orientation, 0, 0, 0];
    let tiff = [&b"II*\0\x08\0\0\0\x01\0"[..], &tag, &[0; 4]].concat();
    let segment = [&b"Exif\0\0"[..], &tiff].concat();
    let length = (segment.len() as u16 + 2).to_be_bytes();
    jpeg.splice(2..2, [&[0xff, 0xe1], &length[..], &segment].concat());
    jpeg
}

#[test]
fn a_photograph_that_lies_on_its_side_is_turned() {
    // Dark, except for 8 light columns at the left.
    let light = |x: u32| if x < 8 { [250; 3] } else { [5; 3] };
    let image = RgbImage::from_fn(24, 16, |x, _| image::Rgb(light(x)));
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
    let upright = bytes.into_inner();
    let textured = TRIANGLE.replace("f 1 2 3", "vt 0 0\nf 1/1 2/1 3/1");
    let obj = format!("mtllib m.mtl\nusemtl a\n{textured}");
    // As EXIF 2.32 has them: the side at which the left one is shown.
    let all = [
        (0, (24, 16), "left"),
        (1, (24, 16), "left"),
        (2, (24, 16), "right"),
        (3, (24, 16), "right"),
        (4, (24, 16), "left"),
        (5, (16, 24), "top"),
        (6, (16, 24), "top"),
        (7, (16, 24), "bottom"),
        (8, (16, 24), "bottom"),
        (9, (24, 16), "left"),
    ];
    for (orientation, size, side) in all {
        let file = turned(upright.clone(), orientation);
        let mtl: &[u8] = b"newmtl a\nmap_Kd t.jpg\n";
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl), ("t.jpg", &file)];
        let model = load_files(&files, &Limits::DEFAULT).unwrap();
        let texture = &model.textures[0];
        assert_eq!((texture.width, texture.height), size, "{orientation}");
        let at = |x: u32, y: u32| texture.rgba[4 * (y * texture.width + x) as usize];
        let (x, y) = (texture.width / 2, texture.height / 2);
        let sides = [
            ("left", (1, y)),
            ("right", (texture.width - 2, y)),
            ("top", (x, 1)),
            ("bottom", (x, texture.height - 2)),
        ];
        for (other, (x, y)) in sides {
            assert_eq!(at(x, y) > 128, other == side, "{orientation}, {other}");
        }
        let words = "m.mtl:2: the texture t.jpg: says in its EXIF data that it does not stand upright; save it \
                     upright; it is turned, as viewers of photographs do (1 in all)";
        let expected: &[&str] = if (2..9).contains(&orientation) { &[words] } else { &[] };
        assert_eq!(model.warnings, expected, "{orientation}");
        // Both of them are in memory at once.
        let need = 3 * file.len() + 7 * 24 * 16 + if expected.is_empty() { 0 } else { 3 * 24 * 16 };
        let limits = Limits { texture_bytes: need as u64 - 1, ..Limits::DEFAULT };
        let refused = load_files(&files, &limits).unwrap().warnings;
        assert!(refused[0].contains(&format!("which take {need} bytes")), "{refused:?}");
    }
}

#[test]
fn damaged_jpeg_files_end_in_a_line() {
    let good = jpeg(24, 24);
    let mut random = 1u32;
    let mut next = |below: usize| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 8) as usize % below
    };
    for _ in 0..300 {
        let mut bad = good.clone();
        for _ in 0..1 + next(4) {
            let at = 2 + next(bad.len() - 2);
            bad[at] = next(256) as u8;
        }
        bad.truncate(good.len() - next(good.len() / 2));
        load("newmtl a\nmap_Kd t.jpg\n", &[("t.jpg", &bad)]).unwrap();
    }
}

#[test]
fn the_memory_of_a_jpeg_is_counted_before_it_is_taken() {
    let file = jpeg(100, 100);
    let size = file.len() as u64;
    let frame = file.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    let mut progressive = file.clone();
    progressive[frame + 1] = 0xc2;
    // Three channels, then four; the decoder's copies of the file; the coefficients of whole blocks.
    let need = 3 * size + 7 * 100 * 100;
    for (file, need) in [(file, need), (progressive, need + 8 * 132 * 132)] {
        let limits = Limits { texture_bytes: need - 1, ..Limits::DEFAULT };
        let obj = format!("mtllib m.mtl\n{TRIANGLE}");
        let mtl: &[u8] = b"newmtl a\nmap_Kd a.jpg\n";
        let all = [("model.obj", obj.as_bytes()), ("m.mtl", mtl), ("a.jpg", &file)];
        let warnings = load_files(&all, &limits).unwrap().warnings;
        let words = format!("is 100 x 100 texels, which take {need} bytes to decode");
        assert!(warnings[0].contains(&words), "{warnings:?}");
    }
}
