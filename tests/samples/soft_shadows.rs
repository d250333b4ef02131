//! 35_soft_shadows: the visible fraction of a disk, and the cost of its points.

use run::{Chapter, bits, render, same_colors};

const NAME: &str = "35_soft_shadows";
const SIZE: &str = "240x150";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

#[test]
fn a_light_without_size_costs_one_ray_and_no_noise() {
    for light in ["light=directional", "light=point"] {
        let set = ["--set", light];
        let hard = render("34_lights", SIZE, &set).picture;
        for samples in ["light samples=1", "light samples=64"] {
            let sets = [light, "light size=0", samples];
            same_colors(&format!("{sets:?}"), NAME, &chapter().sets(&sets).picture(), &hard);
        }
    }
}

#[test]
fn a_penumbra_lies_between_light_and_shadow() {
    for (light, size) in
        [("light=directional", "light size=0.05"), ("light=point", "light size=0.4")]
    {
        let soft = chapter().sets(&[light, size, "show=shadow"]).picture();
        let hard = chapter().sets(&[light, "light size=0", "show=shadow"]).picture();
        let (mut between, mut opposite) = (0, 0);
        for (soft, hard) in
            soft.pixels.iter().zip(&hard.pixels).filter(|(_, hard)| hard[0] == hard[2])
        {
            let part = soft[0] * 16.0;
            if hard[0] != 0.0 && hard[0] != 1.0 {
                continue; // the sky
            }
            assert!((0.0..=16.0).contains(&part) && part.fract() == 0.0, "{part} of 16");
            between += usize::from(part > 0.0 && part < 16.0);
            opposite += usize::from(part == 16.0 * (1.0 - hard[0]));
        }
        println!("{light}: {between} in the penumbra, {opposite} opposite");
        assert!(between > 2000, "{light}: {between}");
        // Pixels that cannot see the light's middle are hardly ever fully lit, and those that can are hardly
        // ever dark.
        assert!(opposite * 200 < soft.pixels.len(), "{light}: {opposite}");
    }
}

#[test]
fn a_penumbra_needs_no_luck() {
    let sets = ["light samples=5"];
    assert_eq!(bits(&chapter().sets(&sets).picture()), bits(&chapter().sets(&sets).picture()));
}
