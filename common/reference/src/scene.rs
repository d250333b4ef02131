//! Many triangles under many instances: closest hit, all hits, and near misses.

use glam::DVec3;

use super::bound::Bounds;
use super::bvh::Bvh;
use super::crossing::Shear;
use super::hit::{Candidate, Hit};
use super::ray::Ray;
use super::transform::{Transform, U};
use super::triangle::Triangle;

/// One instance of a mesh, as a top-level acceleration structure holds it.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Object to world.
    pub transform: Transform,
    /// Vertices in object space as the GPU has them; the index is the primitive's number.
    pub triangles: Vec<[[f32; 3]; 3]>,
}

#[derive(Clone, Copy, Debug)]
struct Item {
    instance: u32,
    primitive: u32,
    triangle: Triangle,
}

/// The triangles of all instances in world space, under one hierarchy an instance: boxes grow with
/// the matrix, and one that stretches a thousandfold must not make all others useless.
///
/// Vertices are transformed in f64 from the f32 of matrix and mesh, which rounds 2^29 times more
/// finely than the GPU: what it leaves is part of the bounds.
#[derive(Clone, Debug)]
pub struct Scene {
    transforms: Vec<Transform>,
    /// Index of the first item of each instance, and the number of items at the end.
    starts: Vec<usize>,
    items: Vec<Item>,
    bvhs: Vec<Bvh>,
}

impl Scene {
    /// Builds the scene; the order of the instances is that of `gl_InstanceID`.
    pub fn new(instances: impl IntoIterator<Item = Instance>) -> Self {
        let mut scene =
            Self { transforms: Vec::new(), starts: vec![0], items: Vec::new(), bvhs: Vec::new() };
        for Instance { transform, triangles } in instances {
            let instance = scene.transforms.len() as u32;
            for (vertices, primitive) in triangles.into_iter().zip(0..) {
                let triangle =
                    vertices.map(|v| transform.point(DVec3::from_array(v.map(f64::from))));
                scene.items.push(Item { instance, primitive, triangle });
            }
            scene.starts.push(scene.items.len());
            scene.transforms.push(transform);
        }
        let bound =
            |Item { triangle: [a, b, c], .. }: &Item| (a.min(*b).min(*c), a.max(*b).max(*c));
        let boxes: Vec<_> = scene.items.iter().map(bound).collect();
        scene.bvhs =
            scene.starts.windows(2).map(|ends| Bvh::new(&boxes[ends[0]..ends[1]])).collect();
        scene
    }

    /// Number of triangles, over all instances.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// True if there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// A triangle in world space; `None` if there is no such instance or primitive.
    pub fn triangle(&self, instance: u32, primitive: u32) -> Option<&Triangle> {
        self.item(instance, primitive).map(|item| &item.triangle)
    }

    fn item(&self, instance: u32, primitive: u32) -> Option<&Item> {
        let &[start, end] = self.starts.get(instance as usize..)?.first_chunk()?;
        self.items[start..end].get(primitive as usize)
    }

    /// The nearest hit that `accept` takes; among several at one t, the first in instance and
    /// primitive order.
    ///
    /// `accept` stands for culling and any-hit shaders; `|_| true` takes all.
    pub fn closest_hit(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let shear = Shear::new(ray);
        let mut closest: Option<Hit> = None;
        for (instance, bvh) in self.bvhs.iter().enumerate() {
            let items = &self.items[self.starts[instance]..];
            let shorter = Ray { tmax: closest.map_or(ray.tmax, |hit| hit.t), ..*ray };
            bvh.traverse(&shorter, self.pad(ray, instance), |index| {
                let item = &items[index as usize];
                if shear.is_inside(&item.triangle) {
                    let hit = self.hit(&shear, item);
                    let key = |hit: &Hit| (hit.t, hit.instance, hit.primitive);
                    let nearer = closest.as_ref().is_none_or(|closest| key(&hit) < key(closest));
                    if nearer && ray.contains(hit.t) && accept(&hit) {
                        closest = Some(hit);
                    }
                }
                closest.map_or(ray.tmax, |hit| hit.t)
            });
        }
        closest
    }

    /// All hits along the ray, by t, then by instance and primitive.
    pub fn all_hits(&self, ray: &Ray) -> Vec<Hit> {
        self.collect(ray, |shear, item| {
            let inside = shear.is_inside(&item.triangle);
            inside.then(|| self.hit(shear, item)).filter(|hit| ray.contains(hit.t))
        })
    }

    /// All triangles that an f32 renderer may report as hits, by t, then by instance and primitive.
    ///
    /// If one of them is not a hit, or need not be one, the renderer has a choice.
    pub fn near_candidates(&self, ray: &Ray) -> Vec<Candidate> {
        let hits = self.collect(ray, |shear, item| Some(self.hit(shear, item)));
        let candidates = hits.into_iter().map(|hit| self.candidate(ray, hit));
        candidates.filter(|candidate| candidate.may_hit(ray)).collect()
    }

    /// One triangle as a candidate, wherever the ray passes; `None` if there is no such triangle.
    pub fn candidate_at(&self, ray: &Ray, instance: u32, primitive: u32) -> Option<Candidate> {
        let item = self.item(instance, primitive)?;
        Some(self.candidate(ray, self.hit(&Shear::new(ray), item)))
    }

    /// A hit of this scene with its bounds.
    ///
    /// # Panics
    /// If the hit is that of another scene and has no like here.
    pub fn candidate(&self, ray: &Ray, hit: Hit) -> Candidate {
        let item = self.item(hit.instance, hit.primitive).expect("a hit of this scene");
        let transform = &self.transforms[hit.instance as usize];
        let bounds = Bounds::new(ray, &item.triangle, transform, hit.t);
        Candidate { hit, graze: bounds.graze(&hit.crossing), t_bound: bounds.t }
    }

    fn collect(&self, ray: &Ray, test: impl Fn(&Shear, &Item) -> Option<Hit>) -> Vec<Hit> {
        let shear = Shear::new(ray);
        let mut hits = Vec::new();
        for (instance, bvh) in self.bvhs.iter().enumerate() {
            let items = &self.items[self.starts[instance]..];
            bvh.traverse(ray, self.pad(ray, instance), |index| {
                hits.extend(test(&shear, &items[index as usize]));
                ray.tmax
            });
        }
        hits.sort_by(|p, q| {
            let order = (p.instance, p.primitive).cmp(&(q.instance, q.primitive));
            p.t.total_cmp(&q.t).then(order)
        });
        hits
    }

    fn hit(&self, shear: &Shear, item: &Item) -> Hit {
        let crossing = shear.cross(&item.triangle);
        let mirrored = self.transforms[item.instance as usize].determinant < 0.0;
        Hit {
            instance: item.instance,
            primitive: item.primitive,
            t: crossing.t,
            barycentrics: crossing.barycentrics(),
            counterclockwise: crossing.counterclockwise != mirrored,
            crossing,
        }
    }

    /// The padding of an instance's boxes, large enough to keep every triangle whose moved copy the ray touches.
    ///
    /// The module [`bound`](super::bound) lets a ray stray by u·H·(..) and vertices move by 13u·R',
    /// in the world `13u·‖L‖‖L^-1‖·R`; twice that leaves room for the rounded products.
    fn pad(&self, ray: &Ray, instance: usize) -> f64 {
        let Some((low, high)) = self.bvhs[instance].extent() else { return 0.0 };
        let transform = &self.transforms[instance];
        let reach = (low - ray.origin).abs().max((high - ray.origin).abs());
        let [x, y, z] = transform.inverse.to_cols_array_2d().map(DVec3::from_array);
        let shrink = (x.length_squared() + y.length_squared() + z.length_squared()).sqrt();
        let vertices = 13.0 * U * transform.stretch * shrink * reach.length();
        2.0 * (transform.stray(ray.origin, reach).length() + vertices)
    }
}

#[cfg(test)]
mod tests;
