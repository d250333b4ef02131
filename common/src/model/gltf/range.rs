//! Numbers of a material outside the range that glTF allows.

use gltf::json::material::Material as Source;
use gltf::json::validation::Checked;

use super::features::Features;

/// Records the first number of a material that is out of range, and an alpha mode that glTF does not have.
pub(super) fn check(source: &Source, features: &mut Features, place: &str) {
    let extensions = source.extensions.as_ref();
    let transmission = extensions.and_then(|all| all.transmission.as_ref());
    let pbr = &source.pbr_metallic_roughness;
    let factors = [
        ("metallicFactor", Some(pbr.metallic_factor.0)),
        ("roughnessFactor", Some(pbr.roughness_factor.0)),
        ("transmissionFactor", transmission.map(|glass| glass.transmission_factor.0)),
    ];
    let colors = pbr.base_color_factor.0.map(|part| ("baseColorFactor", Some(part)));
    let mut numbers = factors.into_iter().chain(colors);
    let is_out = |number: &f32| !(0.0..=1.0).contains(number);
    let found = numbers.find_map(|(name, number)| Some((name, number.filter(is_out)?)));
    if let Some((name, number)) = found {
        features.note("range", 1, || {
            format!("{place} has the {name} {number}; the nearest number from 0 to 1 is taken")
        });
    }
    if let Some(cutoff) = source.alpha_cutoff.filter(|cutoff| cutoff.0 < 0.0) {
        let cutoff = cutoff.0;
        features.note("cutoff", 1, || {
            format!("{place} has the alphaCutoff {cutoff}, below 0; nothing is cut away")
        });
    }
    if matches!(source.alpha_mode, Checked::Invalid) {
        features.note("alpha mode", 1, || {
            format!("{place} has an alphaMode that glTF does not have; it is shown opaque")
        });
    }
}
