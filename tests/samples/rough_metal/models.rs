//! Metalness and roughness from a file: a texture of them looks as the numbers do.

use std::fs;

use common::app::Picture;

use super::chapter;
use run::bits;

/// A square whose material has these lines, and a texture `t.png` of one texel: roughness 51 and metalness 204 of 255.
fn square(lines: &str) -> Picture {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("a file can be written");
    };
    let corners =
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
    write("m.obj", &format!("mtllib m.mtl\n{corners}usemtl a\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"));
    write("m.mtl", &format!("newmtl a\nKd 0.9 0.6 0.2\n{lines}\n"));
    let texel = image::RgbImage::from_pixel(1, 1, image::Rgb([9, 51, 204]));
    texel.save(folder.path().join("t.png")).expect("a picture can be written");
    chapter("32x20").scene(folder.path().join("m.obj")).frames(2).picture()
}

/// The mean difference of two pictures.
fn apart(one: &Picture, other: &Picture) -> f64 {
    let pairs = one.pixels.iter().flatten().zip(other.pixels.iter().flatten());
    pairs.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / one.pixels.len() as f64
}

#[test]
fn a_texture_of_metalness_and_roughness_looks_as_its_numbers() {
    let numbers = square("Pr 0.2\nPm 0.8");
    let textures = square("map_Pr t.png\nmap_Pm t.png");
    // The texture's numbers are rounded once more.
    assert!(apart(&numbers, &textures) < 1e-5, "{}", apart(&numbers, &textures));
    // A texture replaces the number, which exporters write as well.
    let both = square("Pr 0.5\nPm 0\nmap_Pr t.png\nmap_Pm t.png");
    assert_eq!(bits(&both), bits(&textures));
    for other in ["Pr 0.3\nPm 0.8", "Pr 0.2\nPm 0.7", ""] {
        assert!(apart(&numbers, &square(other)) > 1e-3, "{other:?} looks the same");
    }
}
