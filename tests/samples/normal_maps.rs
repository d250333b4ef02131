//! 47_normal_maps
use run::Chapter;

const NAME: &str = "47_normal_maps";

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(4).repeats();
}
