//! 33_roots: what the chapter claims.

use run::{Chapter, bits};

const NAME: &str = "33_roots";

#[test]
fn the_picture_repeats() {
    let [first, second] = [0, 1].map(|_| Chapter::new(NAME).picture());
    assert_eq!(bits(&first), bits(&second));
}
