//! The page *What hardware computes*: its figures and charts come from the cards.

use run::expected;
use run::plot::{self, Axis, Chart, Series};
use serde_json::{Map, Value};

use super::{case, cases, number, row};

/// The cards of the page, by the names of their measurements.
const CARDS: [(&str, &str); 4] = [
    ("llvmpipe", "llvmpipe-llvm-15-0-6-256-bits"),
    ("newer", "llvmpipe-llvm-22-1-8-256-bits"),
    ("worst", "llvmpipe-llvm-15-0-6-256-bits-worst"),
    ("h200", "nvidia-h200"),
];

/// The atlas of a card.
fn card(file: &str) -> Value {
    let path = run::root().join(format!("docs/devices/{file}.json"));
    let text = std::fs::read_to_string(&path).expect("the page's card is there");
    serde_json::from_str::<Value>(&text).expect("a card is JSON")["atlas"].take()
}

/// Every number of every case, under its name on the page: `distance-10.t-max`.
fn values(atlas: &Value) -> Map<String, Value> {
    let mut values = Map::new();
    for row in atlas["rows"].as_array().expect("rows") {
        for case in cases(row) {
            let name = case["case"].as_str().expect("a name");
            for (what, value) in case["found"].as_object().expect("numbers") {
                let name = format!("{name}.{what}").replace([' ', ','], "-");
                if value.is_number() {
                    values.insert(name.replace("--", "-"), value.clone());
                }
            }
        }
    }
    for of in ["t", "weights"] {
        let part = |case: &Value| case["found"][format!("{of}, part of what is excused")].as_f64();
        let most = cases(row(atlas, "triangles")).iter().filter_map(part).fold(0.0, f64::max);
        values.insert(format!("excused.{of}"), most.into());
    }
    values.insert("rays".to_owned(), atlas["rays"].clone());
    values
}

#[test]
fn the_page_tells_what_cards_say() {
    for (name, file) in CARDS {
        expected::hold_exact(&format!("what-hardware-computes/{name}"), values(&card(file)).into());
    }
}

/// The points of a row's cases whose names begin with `varied`, by the number after it.
fn points(
    atlas: &Value,
    name: &str,
    varied: &str,
    x: impl Fn(f64) -> f64,
    y: &str,
) -> Vec<[f64; 2]> {
    let of = |case: &Value| {
        let value = case["case"].as_str()?.strip_prefix(varied)?.trim().parse().ok()?;
        Some([x(value), number(case["found"].as_object()?, y)])
    };
    let mut points: Vec<_> = cases(row(atlas, name)).iter().filter_map(of).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

const fn logarithmic<'a>(label: &'a str, ticks: &'a [f64]) -> Axis<'a> {
    Axis { label, ticks, logarithmic: true }
}

/// The errors in a chart.
struct Shown<'a> {
    file: &'a str,
    /// The name on the cards, and a factor.
    of: &'a str,
    scale: f64,
    label: &'a str,
    ticks: &'a [f64],
}

/// A panel per varied parameter: the largest errors, and those that 99 of 100 rays do not exceed.
fn triangles(shown: &Shown, [llvmpipe, worst, h200]: [&Value; 3]) {
    let panel = |varied, x: &dyn Fn(f64) -> f64, axis| {
        let line = |name, atlas, part: &str| {
            let y = format!("{} {part}", shown.of);
            let mut points = points(atlas, "triangles", varied, x, &y);
            if varied == "size" {
                // A case that varies nothing: among the distances, this is 10.
                let found = case(atlas, "triangles", "distance 10");
                points.push([1.0, number(found, &y)]);
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            }
            points.iter_mut().for_each(|point| point[1] *= shown.scale);
            // One legend, next to the panels, is enough.
            let name = if varied == "tilt" { name } else { "" };
            Series { name, points, line: true, dots: true, ..Series::default() }
        };
        Chart {
            title: "",
            x: axis,
            y: logarithmic(if varied == "distance" { shown.label } else { "" }, shown.ticks),
            series: vec![
                line("llvmpipe, 99 of 100", llvmpipe, "p99"),
                line("llvmpipe, largest", llvmpipe, "max"),
                line("H200, largest", h200, "max"),
                line("worst, largest", worst, "max"),
            ],
        }
    };
    let same = |x: f64| x;
    let [distances, sizes, tilts] =
        [[1.0, 100.0, 1e4, 1e6], [1e-6, 1e-3, 1.0, 1e4], [0.01, 0.1, 1.0, 100.0]];
    let charts = [
        panel("distance", &same, logarithmic("distance (of a triangle of size 1)", &distances)),
        panel("size", &same, logarithmic("size (of a triangle 10 away)", &sizes)),
        panel("tilt", &|tilt| 90.0 - tilt, logarithmic("degrees between ray and triangle", &tilts)),
    ];
    plot::draw(shown.file, (330, 300), &charts);
}

/// One dot per case: the lost rays, and the rays that hit two triangles.
fn seams(atlas: &Value) {
    let rays = atlas["rays"].as_f64().expect("rays");
    let dots = |what: &'static str| {
        let of = |case: &Value| {
            let name = case["case"].as_str()?.strip_prefix(what)?.trim();
            let found = case["found"].as_object()?;
            let part = |of: &str| 100.0 * number(found, of) / rays;
            Some((name.to_owned(), [part("lost"), part("doubled")]))
        };
        let rows = ["seams", "instances"].map(|name| cases(row(atlas, name)));
        rows.into_iter().flatten().filter_map(of).unzip()
    };
    let (names, corners): (Vec<String>, Vec<_>) = dots("corners");
    let (_, edges): (Vec<String>, Vec<_>) = dots("edges");
    let series = |name, points, names| Series { name, points, names, dots: true, line: false };
    let chart = Chart {
        title: "Rays at edges and corners, llvmpipe",
        x: Axis { label: "lost, of 100", ticks: &[0.0, 1.0, 2.0, 3.0, 4.0], logarithmic: false },
        y: Axis {
            label: "met two triangles, of 100",
            ticks: &[0.0, 20.0, 40.0, 60.0, 80.0],
            logarithmic: false,
        },
        series: vec![
            // The first colour is the darkest: names are small, and need contrast.
            series("corners", corners, names.iter().map(String::as_str).collect()),
            series("edges", edges, Vec::new()),
        ],
    };
    plot::draw("what-hardware-computes_seams.svg", (620, 380), &[chart]);
}

/// The growth of a box, by distance.
fn boxes(atlas: &Value) {
    let line = |name, y| Series {
        name,
        points: points(atlas, "boxes", "box from", |x| x, y)
            .into_iter()
            .filter(|point| point[0] < 1e6)
            .collect(),
        line: true,
        dots: true,
        ..Series::default()
    };
    let chart = Chart {
        title: "Rays near a box: the farthest outside and the deepest inside, llvmpipe",
        x: logarithmic("distance of the ray's origin", &[1.0, 10.0, 100.0, 1e3, 1e4, 1e5]),
        y: Axis {
            label: "ULP of the distance",
            ticks: &[-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0],
            logarithmic: false,
        },
        series: vec![
            line("outside, and offered", "offered up to, ULP of way"),
            line("inside, and lost", "refused from, ULP of way"),
        ],
    };
    plot::draw("what-hardware-computes_boxes.svg", (620, 340), &[chart]);
}

#[test]
#[ignore = "by hand: draws the charts of docs/what-hardware-computes.md from the cards"]
fn charts() {
    let cards = CARDS.map(|(_, file)| card(file));
    let [llvmpipe, _, worst, h200] = cards.each_ref();
    let t = Shown {
        file: "what-hardware-computes_t.svg",
        of: "t",
        scale: 1.0,
        label: "error of t, ULP",
        ticks: &[0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5],
    };
    let weights = Shown {
        file: "what-hardware-computes_weights.svg",
        of: "weights",
        scale: 1e3 * 0.5f64.powi(24),
        label: "error of a weight, thousandths",
        ticks: &[0.00001, 0.001, 0.1, 10.0, 1000.0],
    };
    triangles(&t, [llvmpipe, worst, h200]);
    triangles(&weights, [llvmpipe, worst, h200]);
    seams(llvmpipe);
    boxes(llvmpipe);
    let worst = case(worst, "duplicates", "without the flag");
    assert!(number(worst, "called again") > 0.0, "the second card is the worst arithmetic's");
}
