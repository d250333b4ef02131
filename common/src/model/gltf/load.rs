//! Loading an untrusted glTF file as a scene.

use std::collections::HashMap;
use std::path::Path;

use anyhow::{Result, anyhow, ensure};
use glam::{Affine3A, DAffine3, DMat4, DVec3, Vec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::extent::{bounds, check_size, is_solid};
use super::features::Features;
use super::file::File;
use super::image::Images;
use super::material::Look;
use super::nodes::{self, Placed};
use super::pose::Pose;
use super::{camera, container, extensions, lights, name, pose, tally};
use crate::model::glass::{is_body, turn_outwards};
use crate::model::limits::Limits;
use crate::model::obj::Model;
use crate::model::positions::Far;
use crate::model::text::quoted;
use crate::scene::light::LightSource;
use crate::scene::material::Material;
use crate::scene::mesh::Mesh;
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
        tally::check(file, &placed, limits)?;
        pose::note(file, &placed, features);

        let mut images = Images::new(file, limits);
        let looks = root.materials.iter().enumerate();
        let look = |(number, source)| {
            let moved = file.normal_transforms.get(number).and_then(Option::as_ref);
            Look::of(source, number, moved, &mut images, features)
        };
        let looks: Vec<_> = looks.map(look).collect();
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
                    let name = name::of(mesh.name.as_ref(), "mesh", index.value());
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
        let tangents = self.file.attribute(primitive, Semantic::Tangents);
        if tangents.is_some() && look.material.normal_texture.is_some() {
            features.note("tangents", 1, || {
                let mesh = quoted(name);
                format!("mesh {mesh} has tangents, which are not used; they follow from the texture coordinates")
            });
        }
        let tint = self.tint(name, primitive, features);
        let count = self.materials.len();
        let number = number.filter(|&number| number < self.looks.len());
        let material =
            *self.known.entry((number, tint.to_array().map(f32::to_bits))).or_insert(count);
        if material == count {
            let base_color = look.material.base_color * tint;
            let mut material = Material { base_color, ..look.material };
            if let Some(microfacet) = &mut material.microfacet {
                microfacet.color *= tint;
            }
            self.materials.push(material);
        }
        self.meshes.push(Mesh { material, ..mesh });
        Some(self.meshes.len() - 1)
    }

    /// The colour that multiplies a primitive's material: the mean of its vertices' colours.
    fn tint(&self, name: &str, primitive: &Primitive, features: &mut Features) -> Vec3 {
        let Some(accessor) = self.file.attribute(primitive, Semantic::Colors(0)) else {
            return Vec3::ONE;
        };
        let positions = self.file.attribute(primitive, Semantic::Positions);
        let count = positions.and_then(|accessor| self.file.count(accessor).ok());
        let count = count.unwrap_or_default() as usize;
        let colors = self.file.colors(accessor, count).unwrap_or_else(|error| {
            features.note("attribute", 1, || format!("COLOR_0 is left out: {error}"));
            Vec::new()
        });
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

/// The names that several meshes of a file have.
fn ambiguous(file: &File) -> Vec<String> {
    let meshes = file.root.meshes.iter().enumerate();
    let mut names: Vec<_> =
        meshes.map(|(number, mesh)| name::of(mesh.name.as_ref(), "mesh", number)).collect();
    names.sort_unstable();
    let mut twice: Vec<_> =
        names.windows(2).filter(|two| two[0] == two[1]).map(|two| two[0].clone()).collect();
    twice.dedup();
    twice
}
