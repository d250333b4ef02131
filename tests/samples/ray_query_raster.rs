//! 17_ray_query_raster: the rasteriser's visible surfaces compared with the reference, and occlusion with its
//! closed form.

mod occlusion;
mod visibility;

use run::{Chapter, bits, flip, refused, render};

const NAME: &str = "17_ray_query_raster";
const SIZE: &str = "240x150";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// Without occlusion it is the picture of 16, except for a few pixels at edges.
#[test]
fn raster_and_rays_give_the_picture_of_16() {
    run::needs!(NAME);
    let of_16 = render("16_ray_query", SIZE, &[]).picture;
    for primary in ["primary=rays", "primary=raster"] {
        let (mean, outliers) =
            flip(&of_16, &chapter(SIZE).sets(&["occlusion rays=0", primary]).picture());
        println!("{primary}: mean FLIP {mean:.6}, {outliers:.6} of the pixels are far off");
        assert!(mean < 0.001 && outliers < 0.002, "{primary}: {mean}, {outliers}");
    }
}

/// The compute shader reads the image drawn in the same frame, not that of the previous frame with another
/// view.
#[test]
fn a_frame_from_elsewhere_is_drawn_anew() {
    run::needs!(NAME);
    // The first value is shown again at the end.
    let views = "camera eye=5,3,6|-5.6,4.8,9.2";
    let arguments = ["--compare", views, "--frames", "1", "--set", "occlusion rays=0"];
    let after = render(NAME, "64x40", &arguments).picture;
    let alone = chapter("64x40").sets(&["camera eye=5,3,6", "occlusion rays=0"]).picture();
    assert!(bits(&after) == bits(&alone));
}

#[test]
fn a_picture_larger_than_a_device_draws_is_refused_in_one_line() {
    run::needs!(NAME);
    let (code, line) = refused(NAME, &["--headless", "--size", "100000x4"]);
    assert_eq!(code, 2);
    assert!(line.contains("100000x4 is too large"), "{line}");
}

#[test]
fn weights_are_numbers_also_where_nothing_is_seen() {
    run::needs!(NAME);
    let picture = chapter("64x40").sets(&["show=weights"]).picture();
    assert!(picture.pixels.iter().flatten().all(|value| value.is_finite()));
}
