//! Plots for the page of 28_depth_of_field. Drawn on request: `cargo test --test samples
//! depth_of_field::plots -- --ignored`.

use run::plot::{Axis, Chart, Series, draw};

use super::aperture::{DIMENSION_LENS, in_polygon, numbers, on_disk};

#[test]
#[ignore = "by hand: draws docs/images/28_places.svg"]
fn places() {
    let u: Vec<[f64; 2]> =
        (0..256).map(|i| numbers([480, 300], 0, i, DIMENSION_LENS, false)).collect();
    let square = u.iter().map(|&[u, v]| [2.0 * u - 1.0, 2.0 * v - 1.0]).collect();
    let disk = u.iter().map(|&u| on_disk(u).to_array()).collect();
    let blades = u.iter().map(|&u| in_polygon(6, u).to_array()).collect();
    let axis = Axis { label: "", ticks: &[-1.0, -0.5, 0.0, 0.5, 1.0], logarithmic: false };
    let chart = |(title, points): (&'static str, Vec<[f64; 2]>)| {
        let series = Series { points, dots: true, ..Default::default() };
        Chart { title, x: axis, y: axis, series: vec![series] }
    };
    let charts = [("256 points", square), ("on a disk", disk), ("within six blades", blades)];
    draw("28_places.svg", (300, 320), &charts.map(chart));
}
