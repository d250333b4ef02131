//! 31_history_and_filter: what the chapter claims.

use run::{Chapter, bits};

const NAME: &str = "31_history_and_filter";

#[test]
fn the_picture_repeats() {
    let [first, second] = [0, 1].map(|_| Chapter::new(NAME).picture());
    assert_eq!(bits(&first), bits(&second));
}
