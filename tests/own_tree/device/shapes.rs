//! Triangles for which a tree is easy or hard to build.

use glam::Vec3;

/// Vertices and triangles, and their name in messages.
#[derive(Clone, Debug)]
pub struct Shape {
    pub name: String,
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    pub fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|corner| self.vertices[corner as usize])
    }

    pub fn scaled(self, by: f32) -> Self {
        self.stretched(Vec3::splat(by))
    }

    pub fn stretched(mut self, by: Vec3) -> Self {
        self.vertices.iter_mut().for_each(|at| *at *= by);
        self.name += &format!(" times {by}");
        self
    }

    pub fn reversed(mut self) -> Self {
        self.triangles.reverse();
        self
    }

    pub fn shuffled(mut self, seed: u32) -> Self {
        let mut random = Random(seed);
        for i in (1..self.triangles.len()).rev() {
            self.triangles.swap(i, random.word() as usize % (i + 1));
        }
        self
    }
}

/// Pseudorandom numbers, the same each time.
struct Random(u32);

impl Random {
    fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        let mut x = self.0;
        x = (x ^ x >> 16).wrapping_mul(0x21f0_aaad);
        x = (x ^ x >> 15).wrapping_mul(0x735a_2d97);
        x ^ x >> 15
    }

    fn part(&mut self) -> f32 {
        (self.word() >> 8) as f32 / (1 << 24) as f32
    }

    fn point(&mut self) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|_| self.part()))
    }
}

fn apart(name: &str, corners: impl Iterator<Item = [Vec3; 3]>) -> Shape {
    let vertices: Vec<Vec3> = corners.flatten().collect();
    let triangles = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    Shape { name: name.to_owned(), triangles: triangles.collect(), vertices }
}

/// Small triangles, anywhere in a cube.
pub fn soup(count: u32, seed: u32) -> Shape {
    let mut random = Random(seed);
    let size = 2.0 / (1.0 + count as f32).cbrt();
    let triangle = |_| {
        let at = 2.0 * random.point() - 1.0;
        [0, 1, 2].map(|_| at + size * (random.point() - 0.5))
    };
    apart(&format!("{count} anywhere"), (0..count).map(triangle))
}

/// A plane of cells, two triangles each.
pub fn cloth(across: u32, down: u32) -> Shape {
    let corner = |x: u32, y: u32| y * (across + 1) + x;
    let at = |x: u32, y: u32| Vec3::new(x as f32 / across as f32, y as f32 / across as f32, 0.0);
    let rows =
        |x_end: u32, y_end: u32| (0..y_end).flat_map(move |y| (0..x_end).map(move |x| (x, y)));
    let vertices = rows(across + 1, down + 1).map(|(x, y)| at(x, y)).collect();
    let triangles = rows(across, down).flat_map(|(x, y)| {
        let [a, b] = [corner(x, y), corner(x, y + 1)];
        [[a, b, b + 1], [a, b + 1, a + 1]]
    });
    Shape { name: "a cloth".to_owned(), vertices, triangles: triangles.collect() }
}

/// The same triangle again and again.
pub fn in_one_place(count: u32) -> Shape {
    let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let name = format!("{count} in one place");
    Shape { name, vertices, triangles: vec![[0, 1, 2]; count as usize] }
}

/// Each at half the distance of the previous one, along alternating axes, down to the smallest float.
pub fn halving(count: u32) -> Shape {
    let triangle = |i: u32| {
        let at =
            Vec3::splat(0.5f32.powi(i as i32 / 3)) * [Vec3::X, Vec3::Y, Vec3::Z][i as usize % 3];
        [at, at, at]
    };
    apart("halving", (0..count).map(triangle))
}

/// Points and lines in a plane.
pub fn flat(count: u32) -> Shape {
    let mut shape = soup(count, 77).stretched(Vec3::new(1.0, 0.0, 1.0));
    for triangle in shape.triangles.iter_mut().step_by(3) {
        triangle[2] = triangle[1];
    }
    shape
}
