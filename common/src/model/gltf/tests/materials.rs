//! Materials and their textures.

use base64::Engine;
use glam::{Vec2, Vec3};

use super::{CORNERS, Data, one, shown};
use crate::gpu::{Sampling, Wrap};
use crate::scene::Microfacet;

/// A picture of one texel.
fn texel(rgba: [u8; 4]) -> String {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_pixel(1, 1, image::Rgba(rgba));
    image::DynamicImage::from(image).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let data = base64::engine::general_purpose::STANDARD.encode(bytes.into_inner());
    format!("data:image/png;base64,{data}")
}

/// A quad in a material, with a texture, and two sets of texture coordinates.
fn quad(material: &str, rgba: [u8; 4]) -> String {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let first = data.floats(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let second =
        data.add(&[0, 0, 255, 0, 255, 255, 0, 255], 4, ("VEC2", 5121), r#","normalized":true"#);
    let color = data.add(
        &[255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255],
        4,
        ("VEC4", 5121),
        r#","normalized":true"#,
    );
    let primitive = format!(
        r#""attributes":{{"POSITION":{at},"TEXCOORD_0":{first},"TEXCOORD_1":{second}COLOR}},"mode":6,"material":0"#
    );
    let primitive = primitive.replace(
        "COLOR",
        &if material.contains("tinted") { format!(r#","COLOR_0":{color}"#) } else { String::new() },
    );
    data.file(&format!(
        r#"{},"materials":[{{{material}}}],"textures":[{{"source":0,"sampler":0}}],"samplers":[{{"wrapS":33071,"wrapT":33648,"magFilter":9728}}],"images":[{{"uri":"{}"}}]"#,
        one(&primitive),
        texel(rgba)
    ))
}

#[test]
fn materials_become_todays() {
    let base = r#""pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.5],"metallicFactor":0,"baseColorTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,3],"rotation":0}}}}"#;
    let scene = shown(&quad(&format!(r#""name":"a",{base}"#), [255, 0, 0, 99]));
    let material = &scene.model.materials[0];
    assert_eq!(material.base_color, Vec3::new(0.5, 0.25, 1.0));
    assert_eq!((material.base_texture, material.opacity_texture), (Some(0), None));
    assert_eq!((material.opacity, material.illumination), (1.0, 2));
    let sampling = Sampling { u: Wrap::Clamp, v: Wrap::Mirror, nearest: true };
    assert_eq!(scene.model.textures[0].sampling, sampling);
    assert!(scene.model.textures[0].srgb);
    assert_eq!(scene.model.meshes[0].vertices[1].uv, Vec2::new(2.5, 3.0));
    // A threshold of 0.3 with a factor of one half cuts where the texture has less than 0.6.
    for (alpha, is_solid) in [(150, false), (156, true)] {
        let text =
            quad(&format!(r#""alphaMode":"MASK","alphaCutoff":0.3,{base}"#), [9, 9, 9, alpha]);
        let scene = shown(&text);
        assert_eq!(scene.model.materials[0].opacity_texture, Some(0));
        assert_eq!(scene.model.textures[0].rgba[3] >= 128, is_solid);
    }
    let scene = shown(&quad(&format!(r#""alphaMode":"BLEND",{base}"#), [9, 9, 9, 255]));
    assert_eq!(scene.model.materials[0].opacity, 0.5);
    let tinted = shown(&quad(&format!(r#""name":"tinted",{base}"#), [9, 9, 9, 255]));
    assert_eq!(tinted.model.materials[0].base_color, Vec3::new(0.5, 0.0, 0.0));
    let metal = shown(&quad(
        r#""pbrMetallicRoughness":{"roughnessFactor":0,"baseColorFactor":[1,0.5,0,1]}"#,
        [0; 4],
    ));
    assert!(metal.model.materials[0].is_mirror());
    assert_eq!(metal.model.materials[0].specular, Vec3::new(1.0, 0.5, 0.0));
    let gold = Microfacet {
        color: Vec3::new(1.0, 0.5, 0.0),
        roughness: 0.0,
        metallic: 1.0,
        roughness_texture: None,
        metallic_texture: None,
    };
    assert_eq!(metal.model.materials[0].microfacet, Some(gold.clone()));
    // A texture of both is kept, linear; its mean decides what other chapters show.
    let both = quad(
        r#""pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1],"metallicRoughnessTexture":{"index":0}}"#,
        [255, 51, 0, 255],
    );
    let both = shown(&both);
    let rough = Microfacet {
        roughness: 1.0,
        roughness_texture: Some(0),
        metallic_texture: Some(0),
        ..gold
    };
    assert_eq!(both.model.materials[0].microfacet, Some(rough));
    assert!(!both.model.textures[0].srgb && !both.model.materials[0].is_mirror());
    assert_eq!(both.model.materials[0].base_texture, None);
    let old = r#""extensions":{"KHR_materials_pbrSpecularGlossiness":{"glossinessFactor":0.5}}"#;
    assert_eq!(shown(&quad(old, [0; 4])).model.materials[0].microfacet, None);
    let glass = r#""extensions":{"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.3},"KHR_materials_volume":{"thicknessFactor":1,"attenuationColor":[0.25,1,1],"attenuationDistance":2}}"#;
    let glass = shown(&quad(glass, [0; 4]));
    let material = &glass.model.materials[0];
    assert_eq!((material.illumination, material.refraction), (7, 1.3));
    assert_eq!(material.transmission, Vec3::new(0.5, 1.0, 1.0));
    let lamp = r#""emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}}"#;
    assert_eq!(shown(&quad(lamp, [0; 4])).model.materials[0].emission, Vec3::new(4.0, 2.0, 0.0));
}

#[test]
fn a_normal_map_is_linear_and_brings_its_coordinates() {
    let map = r#""normalTexture":{"index":0,"scale":-0.5,"texCoord":1}"#;
    let scene = shown(&quad(map, [0, 128, 255, 255]));
    let material = &scene.model.materials[0];
    assert_eq!((material.normal_texture, material.normal_scale), (Some(0), -0.5));
    assert!(!scene.model.textures[0].srgb && scene.model.warnings.is_empty());
    assert_eq!(scene.model.meshes[0].vertices[1].uv, Vec2::ONE);
    // One set of coordinates per material: that of its colour.
    let color = r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0}}"#;
    let scene = shown(&quad(&format!("{map},{color}"), [0, 128, 255, 255]));
    let srgb: Vec<_> = scene.model.textures.iter().map(|texture| texture.srgb).collect();
    assert_eq!(srgb, [true, false]);
    assert_eq!(scene.model.materials[0].normal_texture, Some(1));
    let [warning] = &scene.model.warnings[..] else { panic!("{:?}", scene.model.warnings) };
    assert!(warning.ends_with(
        "has a normal map with texture coordinates of its own; those of its colour count"
    ));
    // It may be moved as its colour is, or alone.
    let moved =
        |by: &str| format!(r#","extensions":{{"KHR_texture_transform":{{"scale":[{by}]}}}}"#);
    let map = |by: &str| format!(r#""normalTexture":{{"index":0{}}}"#, moved(by));
    let color =
        format!(r#""pbrMetallicRoughness":{{"baseColorTexture":{{"index":0{}}}}}"#, moved("4,2"));
    let scene = shown(&quad(&map("4,2"), [0, 128, 255, 255]));
    assert_eq!(scene.model.meshes[0].vertices[1].uv, Vec2::new(4.0, 2.0));
    let both = shown(&quad(&format!("{},{color}", map("4,2")), [0, 128, 255, 255]));
    assert!(both.model.warnings.is_empty(), "{:?}", both.model.warnings);
    let other = shown(&quad(&format!("{},{color}", map("3,3")), [0, 128, 255, 255]));
    assert_eq!(other.model.warnings, [warning.as_str()]);
    assert_eq!(other.model.meshes[0].vertices[1].uv, Vec2::new(4.0, 2.0));
    let missing = shown(&quad(r#""normalTexture":{"index":7}"#, [0; 4]));
    assert_eq!(missing.model.materials[0].normal_texture, None);
    let [warning] = &missing.model.warnings[..] else { panic!("{:?}", missing.model.warnings) };
    assert!(warning.ends_with("; the surface is smooth"), "{warning}");
}

#[test]
fn unlikely_normal_maps_have_a_warning_each() {
    let steep = r#""normalTexture":{"index":0,"scale":1e30}"#;
    let grey = r#""normalTexture":{"index":0}"#;
    let bare = r#""normalTexture":{"index":0,"texCoord":2}"#;
    for (map, texel, scale, end) in [
        (steep, [0, 128, 255, 255], 1e6, "more than 1000000; 1000000 is taken"),
        (grey, [9, 9, 9, 255], 1.0, "it is taken as a normal map"),
        (bare, [0, 128, 255, 255], 1.0, "has a normal map and no TEXCOORD_2; it is smooth"),
    ] {
        let scene = shown(&quad(map, texel));
        assert_eq!(scene.model.materials[0].normal_scale, scale);
        let [warning] = &scene.model.warnings[..] else { panic!("{:?}", scene.model.warnings) };
        assert!(warning.ends_with(end), "{warning}");
    }
}
