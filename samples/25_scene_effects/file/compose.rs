//! From the tables of a scene file to what is rendered.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::Path;

use anyhow::Result;
use common::model::text::{Folder, Named, quoted, shown};
use common::model::{Model, gltf, obj, turn_outwards};
use common::scene::{Camera, Instance, Material, Mesh, REACH, Scene, assets, place_position};
use glam::{Affine3A, Mat3A, Vec3};
use toml::Spanned;

use super::departure;
use super::description::{
    CameraTable, Description, LensTable, PieceTable, PlaneTable, Sky, SkyTable, SphereTable,
    TorusTable,
};
use super::names::{Numbers, find, numbers, opaque, some};
use super::polytope;
use super::source::Source;
use crate::composition::{close, pinhole};
use crate::normal_maps::own_map;
use crate::{
    Box, Composition, Environment, Finish, MAX_LIGHTS, Motion, NORMAL_MAPS, Node, SKIES, Sphere,
    Strands, ThinLens, Torus, Way, is_blended, is_body, is_glass,
};

/// Pieces, shapes of each kind, and materials, each.
const MOST: usize = 100_000;

/// Meshes of all pieces: an object of several materials is several.
const MOST_MESHES: usize = 1_000_000;

/// The least radius of a torus's tube, in radii of its ring.
///
/// Where a ray leaves the surface, the error of the polynomial is 8u·R²/r (`shaders/common/torus.glsl`). Below 0.0022,
/// r² = 80u·R², that is more than a tenth of the tube, and no start is safe.
const THINNEST: f32 = 0.0025;

impl Description {
    /// Builds the composition that the file describes.
    ///
    /// # Errors
    /// If it contradicts itself, or names what there is not.
    pub(super) fn compose(&self, path: &Path, source: &Source) -> Result<Composition> {
        source.check(&self.light, MAX_LIGHTS, "lights")?;
        source.check(&self.material, MOST, "materials")?;
        source.check(&self.piece, MOST, "pieces")?;
        source.check(&self.sphere, MOST, "spheres")?;
        source.check(&self.boxes, MOST, "boxes")?;
        source.check(&self.solid, MOST, "solids")?;
        source.check(&self.strand, MOST, "strands")?;
        source.check(&self.torus, MOST, "tori")?;
        let mut model = self.model(path, source)?;
        let (materials, finishes) = self.paint(&mut model, source)?;
        let view = self.camera.get_ref();
        let &CameraTable { eye, target, field_of_view, .. } = view;
        if eye.distance(target) < 1e-9 {
            let what = "the camera stands where it looks; move `eye` or `target`";
            return Err(source.error(self.camera.span().start, what));
        }
        let camera = Camera::new(eye, target, field_of_view);
        let mut lens = pinhole(&camera);
        if let Some(LensTable { diameter, focus, blades }) = view.lens {
            lens = ThinLens { diameter, focus: focus.unwrap_or(lens.focus), blades, ..lens };
        }
        let mut ways = Vec::new();
        let instances = self.instances(&model, &materials, source, &mut ways)?;
        let moves = !ways.is_empty() || view.orbit != 0.0;
        if moves && instances.len() > Motion::MOST {
            let what = format!("a scene that moves has at most {} placed meshes", Motion::MOST);
            return Err(source.error(self.camera.span().start, &what));
        }
        let motion = moves.then_some(Motion {
            frames: self.picture.frames,
            pieces: ways,
            orbit: view.orbit,
        });
        let bodies = instances.iter().filter(|placed| is_body(&model.materials[placed.material]));
        let bodies: HashSet<usize> = bodies.map(|placed| placed.mesh).collect();
        let turned = turn_outwards(&mut model.meshes, |mesh| bodies.contains(&mesh), &shown(path));
        model.warnings.extend(turned);
        let lights = self.light.iter().map(|lamp| {
            let lit = lamp.get_ref().light();
            lit.map_err(|what| source.error(lamp.span().start, what))
        });
        let heightfield = self.heightfield.as_ref().map(|land| {
            let found = land.get_ref().heightfield();
            found.map_err(|what| source.error(land.span().start, what))
        });
        let (sky, environment) = self.sky(path, source, &mut model.warnings)?;
        let mut composition = Composition {
            finishes,
            lens,
            lights: lights.collect::<Result<_>>()?,
            plane: self.plane.as_ref().map(PlaneTable::plane),
            spheres: Vec::new(),
            boxes: Vec::new(),
            solids: Vec::new(),
            faces: Vec::new(),
            solid_bounds: Vec::new(),
            strands: Strands::default(),
            tori: Vec::new(),
            heightfield: heightfield.transpose()?,
            filtered: self.picture.filtered,
            sky,
            environment,
            samples: self.picture.samples,
            light_samples: self.picture.light_samples,
            depth: self.picture.depth,
            bounces: self.picture.bounces,
            motion,
            scene: Scene { model, instances, camera },
        };
        self.add_shapes(&mut composition, &materials, source)?;
        self.warn_of_planets(&mut composition, path, source);
        composition.prune();
        Ok(composition)
    }

    /// The model that pieces are taken from.
    fn model(&self, path: &Path, source: &Source) -> Result<Model> {
        let Some(named) = &self.model else {
            return if self.piece.is_empty() && self.position.is_none() {
                Ok(Model::default())
            } else {
                obj::load_own(&assets().join("chess.obj"))
            };
        };
        let found = find_file(path, "model", named.get_ref(), named.span().start, source)?;
        if gltf::is_gltf(&found.beside) {
            let what = "`model` names a glTF file, which has its own scene; write an OBJ file here, or open the \
                        glTF file by --scene";
            return Err(source.error(named.span().start, what));
        }
        // It keeps its place, because the scene file's other coordinates belong to it.
        let mut model = obj::load(&found.beside)?;
        if let Some(instead) = &found.instead {
            let what = source.error(named.span().start, &of_scene_file(instead));
            model.warnings.insert(0, format!("{what}; the file of that name beside it is taken"));
        }
        Ok(model)
    }

    /// The brightness of the sky, and its picture if it has one.
    fn sky(
        &self,
        path: &Path,
        source: &Source,
        warnings: &mut Vec<String>,
    ) -> Result<(f32, Option<Environment>)> {
        let Some(sky) = &self.sky else { return Ok((1.0, None)) };
        let at = sky.span().start;
        let table = match sky.get_ref() {
            Sky::Brightness(brightness) => return Ok((*brightness, None)),
            Sky::Picture(table) => table,
        };
        let environment = match (&table.file, &table.name) {
            (Some(file), None) => {
                let found = find_file(path, "file", file, at, source)?;
                let (environment, told) = Environment::open(&found.beside)?;
                warnings.extend(found.instead.iter().map(|instead| {
                    let what = source.error(at, &of_scene_file(instead));
                    format!("{what}; the file of that name beside it is taken")
                }));
                warnings.extend(told);
                environment
            }
            (None, Some(name)) if SKIES.contains(&name.as_str()) => Environment::own(name)?,
            _ => {
                let what = "a sky has a `file`, such as \"sky.exr\", or the `name` of one of chapter 46: \"day\" or \
                            \"evening\"";
                return Err(source.error(at, what));
            }
        };
        let &SkyTable { rotation, brightness, .. } = table;
        Ok((1.0, Some(Environment { rotation, brightness, ..environment })))
    }

    /// Adds and changes materials, and returns the number of each name, and the finishes.
    fn paint(&self, model: &mut Model, source: &Source) -> Result<(Numbers, Vec<Finish>)> {
        let Model { materials, textures, .. } = model;
        let mut finishes: Vec<_> = materials.iter().map(Finish::of).collect();
        let mut numbers = numbers(materials.iter().map(|material| &material.name));
        let mut painted = HashSet::new();
        let mut maps = HashMap::new();
        for paint in &self.material {
            let name = &paint.get_ref().name;
            if name.is_empty() {
                return Err(
                    source.error(paint.span().start, "a material has a name: name = \"red\"")
                );
            }
            if !painted.insert(name) {
                let what = format!("a second material {}", quoted(name));
                return Err(source.error(paint.span().start, &what));
            }
            let number = *numbers.entry(name.clone()).or_insert_with(|| {
                materials.push(Material { name: name.clone(), ..Material::default() });
                finishes.push(Finish::NONE);
                materials.len() - 1
            });
            let wrong = |what: &'static str| source.error(paint.span().start, what);
            paint.get_ref().check_rough().map_err(wrong)?;
            paint.get_ref().apply(&mut materials[number]);
            if let Some(map) = paint.get_ref().normal_map {
                if let Entry::Vacant(unread) = maps.entry(map) {
                    unread.insert(textures.len());
                    textures.push(own_map(NORMAL_MAPS[map])?);
                }
                materials[number].normal_texture = Some(maps[&map]);
            }
            if paint.get_ref().normal_scale.is_some() && materials[number].normal_texture.is_none()
            {
                return Err(wrong("`normal_scale` is of a `normal_map`"));
            }
            let blended = is_blended(&materials[number]).into();
            finishes[number] = Finish { blended, ..paint.get_ref().finish().map_err(wrong)? };
            if is_glass(&materials[number]) {
                paint.get_ref().check_glass().map_err(wrong)?;
            } else if paint.get_ref().index.is_some() || paint.get_ref().through.is_some() {
                return Err(wrong("`index` and `through` are of `glass`: \"thick\" or \"thin\""));
            }
            if finishes[number].pattern().is_some() {
                // It takes the place of the material's colour, and so of what multiplies that.
                materials[number].base_texture = None;
            }
        }
        materials.iter_mut().for_each(close);
        Ok((numbers, finishes))
    }

    /// Pieces where they are put, or every mesh where its file has it.
    fn instances(
        &self,
        model: &Model,
        materials: &Numbers,
        source: &Source,
        ways: &mut Vec<Way>,
    ) -> Result<Vec<Instance>> {
        if self.piece.is_empty() && self.position.is_none() {
            return Ok(standing(model));
        }
        let mut instances = place(&self.piece, model, materials, source, ways)?;
        if let Some(position) = &self.position {
            place_position(model, position.get_ref(), &mut instances)
                .map_err(|error| source.error(position.span().start, &error.to_string()))?;
        }
        Ok(instances)
    }

    fn add_shapes(&self, to: &mut Composition, materials: &Numbers, source: &Source) -> Result<()> {
        let model = (&to.scene.model, to.finishes.as_slice());
        let glass = |number: u32| is_glass(&model.0.materials[number as usize]);
        let shines = |number: u32| model.0.materials[number as usize].emission != Vec3::ZERO;
        for ball in self.sphere.iter().map(Spanned::get_ref) {
            let &SphereTable { center, radius, moves, .. } = ball;
            let material = opaque(model, materials, &ball.material, source)?;
            if moves != Vec3::ZERO && (glass(material) || shines(material)) {
                let what = "a sphere that moves is not of glass, and does not shine";
                return Err(source.error(ball.material.span().start, what));
            }
            to.spheres.push(Sphere { center, radius, material, moves });
        }
        for block in &self.boxes {
            let at = block.span().start;
            let block = block.get_ref();
            if !block.low.cmplt(block.high).all() {
                let what = "a box has its `high` above its `low` along every axis";
                return Err(source.error(at, what));
            }
            let material = opaque(model, materials, &block.material, source)?;
            to.boxes.push(Box { low: block.low, high: block.high, material });
        }
        for body in &self.solid {
            let at = body.span().start;
            let body = body.get_ref();
            let material = opaque(model, materials, &body.material, source)?;
            let (solid, bounds) =
                polytope::solid(body.center, &body.planes, material, &mut to.faces)
                    .map_err(|what| source.error(at, what))?;
            to.solids.push(solid);
            to.solid_bounds.push(bounds);
        }
        for chain in self.strand.iter().map(Spanned::get_ref) {
            let material = opaque(model, materials, &chain.material, source)?;
            if glass(material) {
                let what = "a strand is not of glass: its segments overlap";
                return Err(source.error(chain.material.span().start, what));
            }
            let nodes = chain.nodes.iter();
            let node = |&[x, y, z, radius]: &[f32; 4]| Node { center: Vec3::new(x, y, z), radius };
            to.strands.chain(nodes.map(node), material);
        }
        for ring in &self.torus {
            let at = ring.span().start;
            let ring = ring.get_ref();
            let &TorusTable { center, axis, radius: major, tube: minor, .. } = ring;
            if !(THINNEST * major..=major).contains(&minor) {
                let low = THINNEST * major;
                let what = format!(
                    "a torus of radius {major} has a `tube` of {low} to {major}, not {minor}"
                );
                return Err(source.error(at, &what));
            }
            let material = opaque(model, materials, &ring.material, source)?;
            to.tori.push(Torus { center, axis, major, minor, material });
        }
        Ok(())
    }
}

impl Description {
    /// Warns of surfaces that are too large, or too far away, for the objects on them.
    fn warn_of_planets(&self, to: &mut Composition, path: &Path, source: &Source) {
        let told = departure::told(to);
        let line = |span: Range<usize>, what: &str| source.error(span.start, what).to_string();
        let spheres = told.sphere.map(|(number, what)| line(self.sphere[number].span(), &what));
        let boxes = told.block.map(|(number, what)| line(self.boxes[number].span(), &what));
        let solids = told.solid.map(|(number, what)| line(self.solid[number].span(), &what));
        let mesh = told.mesh.map(|what| format!("{}: {what}", shown(path)));
        to.scene.model.warnings.extend([spheres, boxes, solids, mesh].into_iter().flatten());
    }
}

/// A message about a file, in the words of a scene file.
fn of_scene_file(what: &str) -> String {
    what.replace("the OBJ file's folder", "the scene file's folder")
}

/// The file that a key of the scene file names, in its folder or below.
fn find_file(path: &Path, key: &str, named: &str, at: usize, source: &Source) -> Result<Named> {
    Folder::of(path)?.find(key, named, None).map_err(|error| {
        let escape = if named.contains(char::is_control) {
            "; a `\\` in a text begins an escape: write `/` between folders"
        } else {
            ""
        };
        source.error(at, &format!("{}{escape}", of_scene_file(&error.to_string())))
    })
}

/// Every mesh once, where its file has it.
fn standing(model: &Model) -> Vec<Instance> {
    let instance = |(mesh, material)| Instance {
        mesh,
        transform: Affine3A::IDENTITY,
        material,
        record_offset: 0,
    };
    model.meshes.iter().map(|mesh| mesh.material).enumerate().map(instance).collect()
}

fn place(
    pieces: &[Spanned<PieceTable>],
    model: &Model,
    materials: &Numbers,
    source: &Source,
    ways: &mut Vec<Way>,
) -> Result<Vec<Instance>> {
    // An object of several materials is several meshes of its name.
    let mut meshes: HashMap<&str, Vec<usize>> = HashMap::new();
    for (number, mesh) in model.meshes.iter().enumerate() {
        meshes.entry(&mesh.name).or_default().push(number);
    }
    let reaches: Vec<f32> = model.meshes.iter().map(Mesh::reach).collect();
    let mut placed = Vec::new();
    for piece in pieces {
        let PieceTable { mesh, at, turn, size, material, way, spin } = piece.get_ref();
        let wrong = |what: &str| source.error(mesh.span().start, what);
        let name = mesh.get_ref();
        if model.ambiguous.contains(name) {
            let what =
                format!("several objects are named {}; give each a name of its own", quoted(name));
            return Err(wrong(&what));
        }
        let parts = meshes.get(name.as_str()).ok_or_else(|| {
            let known = some(model.meshes.iter().map(|mesh| &mesh.name));
            wrong(&format!("no mesh {}; there is {known}", quoted(name)))
        })?;
        if placed.len() + parts.len() > MOST_MESHES {
            let what = format!("more than {MOST_MESHES} meshes placed, the most that are read");
            return Err(wrong(&what));
        }
        let material =
            material.as_ref().map(|name| find(model, materials, name, source)).transpose()?;
        let reach = parts.iter().map(|&mesh| reaches[mesh]).fold(0.0, f32::max) * size;
        if reach > REACH {
            let what = format!(
                "a piece that reaches {reach:e} from its place; beyond {REACH:e}, products of four coordinates \
                 overflow in 32 bits"
            );
            return Err(source.error(piece.span().start, &what));
        }
        let matrix3 = Mat3A::from_rotation_y(turn.to_radians()) * *size;
        let transform = Affine3A { matrix3, translation: (*at).into() };
        for &mesh in parts {
            let material = material.unwrap_or(model.meshes[mesh].material);
            if *way != Vec3::ZERO || *spin != 0.0 {
                if model.materials[material].emission != Vec3::ZERO {
                    return Err(wrong("a piece that moves does not shine"));
                }
                ways.push(Way { instance: placed.len(), home: transform, way: *way, spin: *spin });
            }
            placed.push(Instance { mesh, transform, material, record_offset: 0 });
        }
    }
    Ok(placed)
}
