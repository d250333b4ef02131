//! Loading an untrusted glTF file as a scene.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use anyhow::{Result, anyhow, ensure};
use glam::{Affine3A, DAffine3, DMat3, DMat4, DVec3, Vec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::features::Features;
use super::file::File;
use super::image::Images;
use super::material::Look;
use super::nodes::{self, Placed};
use super::pose::Pose;
use super::tally::Tally;
use super::{camera, container, extensions, lights};
use crate::model::glass::{is_body, turn_outwards};
use crate::model::limits::Limits;
use crate::model::obj::Model;
use crate::model::positions::Far;
use crate::model::text::quoted;
use crate::scene::light::LightSource;
use crate::scene::material::Material;
use crate::scene::mesh::{LEAST, Mesh, REACH};
use crate::scene::world::{Instance, Scene};

/// True for a file that is to be read as glTF, by its name or by its first bytes.
pub fn is_gltf(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    if ["gltf", "glb"].iter().any(|known| extension.eq_ignore_ascii_case(known)) {
        return true;
    }
    let mut head = [0; 4];
    let is_file = std::fs::metadata(path).is_ok_and(|data| data.is_file());
    let mut read = || std::io::Read::read_exact(&mut std::fs::File::open(path)?, &mut head);
    is_file && read().is_ok() && head == container::MAGIC
}

/// Reads a glTF 2.0 file, binary or text, with its buffers and images.
///
/// Each primitive is a mesh, and an instance wherever a node places it. A model that is far from the origin is moved
/// there. What a picture lacks is a line in [`Model::warnings`].
///
/// # Errors
/// If the file cannot be read or is not glTF 2, requires an unknown extension, holds no triangle that can be shown,
/// extends too far or is too small, or needs too much memory; the message is one line.
pub fn load(path: &Path) -> Result<Scene> {
    load_within(path, &Limits::DEFAULT)
}

pub(super) fn load_within(path: &Path, limits: &Limits) -> Result<Scene> {
    let file = File::read(path, limits)?;
    let mut features = Features::of(&file.shown);
    let scene = Loading::of(&file, limits, &mut features);
    scene.map_err(|error| anyhow!("{}: {error:#}", file.shown))
}

/// A file while its scene is made.
struct Loading<'a> {
    file: &'a File,
    meshes: Vec<Mesh>,
    materials: Vec<Material>,
    looks: Vec<Look>,
    /// The materials of the model by that of the file and the colour of the vertices.
    known: HashMap<(Option<usize>, [u32; 3]), usize>,
}

impl<'a> Loading<'a> {
    fn of(file: &'a File, limits: &Limits, features: &mut Features) -> Result<Scene> {
        let root = &file.root;
        extensions::check(root, features)?;
        let placed = nodes::visit(root, features)?;
        count(file, &placed, limits)?;
        note_what_moves(file, &placed, features);

        let mut images = Images::new(file, limits);
        let looks = root.materials.iter().enumerate();
        let looks: Vec<_> =
            looks.map(|(number, source)| Look::of(source, number, &mut images, features)).collect();
        let textures = images.textures;
        let mut loading =
            Self { file, meshes: Vec::new(), materials: Vec::new(), looks, known: HashMap::new() };
        let mut instances = loading.place(&placed, features)?;
        if instances.is_empty() {
            let why =
                ["primitive", "flat", "twice", "node"].iter().find_map(|kind| features.first(kind));
            let why = why.unwrap_or("its nodes place no triangles");
            return Err(anyhow!("nothing to show: {why}"));
        }

        let Self { mut meshes, materials, .. } = loading;
        let bodies: Vec<bool> =
            meshes.iter().map(|mesh| is_body(&materials[mesh.material])).collect();
        let turned = turn_outwards(&mut meshes, |mesh| bodies[mesh], &file.shown);
        let (low, high) = bounds(&meshes, &instances);
        let middle = (low + high) * 0.5;
        let camera = camera::first(file, &placed, middle, features);
        let mut lights = lights::of_scene(file, &placed, middle, features);

        let far = Far::of(low, high);
        let origin = far.as_ref().map_or(DVec3::ZERO, |far| far.middle);
        for (_, transform) in &mut instances {
            transform.translation -= origin;
        }
        for light in &mut lights {
            if let LightSource::Point(lamp) = light {
                lamp.position = (lamp.position.as_dvec3() - origin).as_vec3();
            }
        }
        check_size(low - origin, high - origin)?;
        let mut warnings: Vec<_> = features.lines().collect();
        warnings.extend(file.elsewhere().into_iter().map(|what| format!("{}: {what}", file.shown)));
        warnings.extend(turned);
        warnings.extend(far.map(|far| format!("{}: {}", file.shown, far.moved())));
        if !meshes.iter().any(Mesh::has_area) {
            let is_compressed = |name: &String| extensions::COMPRESSED.contains(&name.as_str());
            ensure!(
                !root.extensions_used.iter().any(is_compressed),
                "its geometry is compressed; export it without compression"
            );
            let what = "none of its triangles has an area, and so nothing of it is seen";
            warnings.push(format!("{}: {what}", file.shown));
        }
        let instances = instances.into_iter().map(|(mesh, transform)| Instance {
            mesh,
            transform: Affine3A::from_cols(
                transform.matrix3.x_axis.as_vec3a(),
                transform.matrix3.y_axis.as_vec3a(),
                transform.matrix3.z_axis.as_vec3a(),
                transform.translation.as_vec3a(),
            ),
            material: meshes[mesh].material,
            record_offset: 0,
        });
        let instances = instances.collect();
        let ambiguous = ambiguous(file);
        let model = Model { meshes, materials, textures, lights, warnings, ambiguous };
        let mut scene = Scene { model, instances, camera: Default::default() };
        scene.camera = match camera {
            Some(mut camera) => {
                camera.eye -= origin;
                camera.target -= origin;
                camera
            }
            None => scene.camera_on_all(),
        };
        Ok(scene)
    }

    /// The meshes of all nodes, and where they are.
    fn place(
        &mut self,
        placed: &[Placed],
        features: &mut Features,
    ) -> Result<Vec<(usize, DAffine3)>> {
        let mut places = vec![None; self.file.root.nodes.len()];
        for node in placed {
            places[node.number] = Some(node.transform);
        }
        // The mesh of each primitive, and of its pose if it is not at rest; none if it cannot be shown.
        let mut made: HashMap<(usize, usize, Option<usize>), Option<usize>> = HashMap::new();
        let mut instances = Vec::new();
        for Placed { number, node, transform } in placed {
            let Some(index) = node.mesh else { continue };
            let Some(mesh) = self.file.root.get(index) else {
                features.note("primitive", 1, || {
                    format!("node {number} names mesh {}, which is not there", index.value())
                });
                continue;
            };
            let pose = Pose::of(self.file, node, &places).unwrap_or_else(|error| {
                features.note("pose", 1, || format!("node {number} stands in no pose: {error}"));
                Pose::default()
            });
            let transform = if pose.is_in_world() { DMat4::IDENTITY } else { *transform };
            if !is_solid(&transform) {
                features.note("flat", 1, || {
                    format!("node {number} makes its mesh flat, or its place is not finite; it is left out")
                });
                continue;
            }
            let transform = DAffine3::from_mat4(transform);
            let posed = (!pose.is_rest()).then_some(*number);
            for (part, primitive) in mesh.primitives.iter().enumerate() {
                let key = (index.value(), part, posed);
                let known = made.entry(key).or_insert_with(|| {
                    let name =
                        mesh.name.clone().unwrap_or_else(|| format!("mesh {}", index.value()));
                    self.primitive(&name, primitive, &pose, features)
                });
                instances.extend(known.map(|mesh| (mesh, transform)));
            }
        }
        Ok(instances)
    }

    /// The position of a primitive's mesh; a note says why there is none.
    fn primitive(
        &mut self,
        name: &str,
        primitive: &Primitive,
        pose: &Pose,
        features: &mut Features,
    ) -> Option<usize> {
        if let Checked::Valid(
            mode @ (Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip),
        ) = primitive.mode
        {
            let what = if mode == Mode::Points { "points" } else { "lines" };
            features.note("primitive", 1, || {
                format!("mesh {} has {what}, which are not shown", quoted(name))
            });
            return None;
        }
        let number = primitive.material.map(|material| material.value());
        let look = match number {
            Some(number) => self.looks.get(number).cloned().unwrap_or_else(|| {
                features.note("material", 1, || {
                    format!(
                        "mesh {} names material {number}, which is not there; white stands for it",
                        quoted(name)
                    )
                });
                Look::of_none()
            }),
            None => Look::of_none(),
        };
        let made = self.file.mesh(name, primitive, &look.coordinates, pose, features);
        let mesh = match made {
            Ok(mesh) => mesh,
            Err(error) => {
                features.note("primitive", 1, || {
                    format!("a part of mesh {} is left out: {error:#}", quoted(name))
                });
                return None;
            }
        };
        let tint = self.tint(name, primitive, features);
        let count = self.materials.len();
        let number = number.filter(|&number| number < self.looks.len());
        let material =
            *self.known.entry((number, tint.to_array().map(f32::to_bits))).or_insert(count);
        if material == count {
            let base_color = look.material.base_color * tint;
            self.materials.push(Material { base_color, ..look.material });
        }
        self.meshes.push(Mesh { material, ..mesh });
        Some(self.meshes.len() - 1)
    }

    /// The colour that multiplies a primitive's material: the mean of its vertices' colours.
    fn tint(&self, name: &str, primitive: &Primitive, features: &mut Features) -> Vec3 {
        let Some(accessor) = self.file.attribute(primitive, Semantic::Colors(0)) else {
            return Vec3::ONE;
        };
        let colors = self.file.colors(accessor).unwrap_or_default();
        let Some(&first) = colors.first() else { return Vec3::ONE };
        if colors.iter().any(|color| *color != first) {
            features.note("colors", 1, || {
                format!("mesh {} has colours at its vertices; their mean is shown", quoted(name))
            });
        }
        let sum: DVec3 = colors.iter().map(|&color| Vec3::from(color).as_dvec3()).sum();
        let mean = (sum / colors.len() as f64).as_vec3();
        if mean.is_finite() { mean.clamp(Vec3::ZERO, Vec3::ONE) } else { Vec3::ONE }
    }
}

/// Counts the memory that all meshes will take.
fn count(file: &File, placed: &[Placed], limits: &Limits) -> Result<()> {
    let mut tally = Tally::default();
    let mut seen = BTreeSet::new();
    let mut instances = 0;
    for Placed { node, number, .. } in placed {
        let Some(index) = node.mesh else { continue };
        let Some(mesh) = file.root.get(index) else { continue };
        instances += mesh.primitives.len();
        let weights = node.weights.is_some() || mesh.weights.is_some();
        let own = (node.skin.is_some() || weights).then_some(*number);
        if seen.insert((index.value(), own)) {
            mesh.primitives.iter().for_each(|primitive| tally.add(file, primitive));
        }
    }
    tally.check(instances, limits)
}

/// Notes what would move.
fn note_what_moves(file: &File, placed: &[Placed], features: &mut Features) {
    let animations = file.root.animations.len();
    if animations > 0 {
        features.note("animation", animations, || {
            "has animations; the model stands as its nodes say".to_owned()
        });
    }
    let has_skin = |placed: &&Placed| placed.node.skin.is_some();
    let skins = placed.iter().filter(has_skin).count();
    if skins > 0 {
        features
            .note("skin", skins, || "has a skin; it is shown in the pose of its nodes".to_owned());
    }
    let meshes = placed.iter().filter_map(|placed| file.root.get(placed.node.mesh?));
    let has_targets = |primitive: &Primitive| primitive.targets.is_some();
    let morphs = meshes.filter(|mesh| mesh.primitives.iter().any(has_targets)).count();
    if morphs > 0 {
        features.note("morph", morphs, || {
            "has morph targets; it is shown with their first weights".to_owned()
        });
    }
}

/// The box around everything, in 64 bits.
fn bounds(meshes: &[Mesh], instances: &[(usize, DAffine3)]) -> (DVec3, DVec3) {
    let boxes: Vec<_> = meshes.iter().map(Mesh::bounds).collect();
    let moved = |&(mesh, transform): &(usize, DAffine3)| {
        let (low, high): (Vec3, Vec3) = boxes[mesh];
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let half = (high - low) * 0.5;
        let middle = transform.transform_point3((low + high) * 0.5);
        let DMat3 { x_axis, y_axis, z_axis } = transform.matrix3;
        let reach = x_axis.abs() * half.x + y_axis.abs() * half.y + z_axis.abs() * half.z;
        (middle - reach, middle + reach)
    };
    instances
        .iter()
        .map(moved)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (l, h)| {
            (low.min(l), high.max(h))
        })
}

/// Checks that rays can hit the model.
fn check_size(low: DVec3, high: DVec3) -> Result<()> {
    let reach = low.abs().max(high.abs()).max_element();
    ensure!(
        reach <= REACH.into(),
        "reaches {reach:e} from the origin; beyond {REACH:e}, products of four coordinates overflow in 32 bits"
    );
    let size = (high - low).max_element();
    ensure!(
        size == 0.0 || size >= LEAST.into(),
        "is {size:e} from end to end; below {LEAST:e}, products of two lengths vanish in 32 bits"
    );
    Ok(())
}

/// True if a transform is finite and does not make everything flat.
fn is_solid(transform: &DMat4) -> bool {
    let small = DAffine3::from_mat4(*transform);
    let columns = [small.matrix3.x_axis, small.matrix3.y_axis, small.matrix3.z_axis];
    let columns = columns.map(|column| column.as_vec3().as_dvec3());
    let is_finite =
        columns.iter().all(|column| column.is_finite()) && small.translation.as_vec3().is_finite();
    let [x, y, z] = columns.map(DVec3::normalize_or_zero);
    is_finite && x.dot(y.cross(z)) != 0.0
}

/// The names that several meshes of a file have.
fn ambiguous(file: &File) -> Vec<String> {
    let mut names: Vec<_> = file.root.meshes.iter().filter_map(|mesh| mesh.name.clone()).collect();
    names.sort_unstable();
    let mut twice: Vec<_> =
        names.windows(2).filter(|two| two[0] == two[1]).map(|two| two[0].clone()).collect();
    twice.dedup();
    twice
}
