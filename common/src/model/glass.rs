//! Bodies of glass whose faces point inwards.

use glam::Vec3;

use super::text::quoted;
use crate::scene::material::Material;
use crate::scene::mesh::Mesh;

/// The number of bodies of which one may have another as its bubble.
const OUTER: usize = 1000;

/// True for the material of a body that refracts light.
pub(crate) fn is_body(material: &Material) -> bool {
    matches!(material.illumination, 6 | 7)
}

/// Turns the faces of bodies of glass outwards, and returns a warning about them. A body within the box around
/// another one is perhaps its bubble, and stays. `is_glass` is about the mesh of a number.
pub fn turn_outwards(
    meshes: &mut [Mesh],
    is_glass: impl Fn(usize) -> bool,
    shown: &str,
) -> Option<String> {
    let glass: Vec<usize> = (0..meshes.len()).filter(|&number| is_glass(number)).collect();
    let mut bounds: Vec<_> = glass.iter().map(|&number| meshes[number].bounds()).collect();
    let size = |&(low, high): &(Vec3, Vec3)| high.distance_squared(low);
    bounds.sort_by(|a, b| size(b).total_cmp(&size(a)));
    bounds.truncate(OUTER);
    let mut first = None;
    let mut count = 0;
    for mesh in glass {
        let mesh = &mut meshes[mesh];
        let (low, high) = mesh.bounds();
        let holds = |&(l, h): &(Vec3, Vec3)| l.cmplt(low).all() && high.cmplt(h).all();
        if !bounds.iter().any(holds) && mesh.is_inside_out() {
            mesh.turn_inside_out();
            first.get_or_insert_with(|| quoted(&mesh.name));
            count += 1;
        }
    }
    let name = first?;
    Some(format!(
        "{shown}: the faces of {name}, a closed body of glass, point inwards; they are turned around ({count} \
         in all)"
    ))
}

#[cfg(test)]
mod tests {
    use super::super::obj::tests::load_files;
    use crate::model::limits::Limits;

    /// A cube of this size with its faces outwards, or inwards.
    fn cube(name: &str, size: f32, outwards: bool) -> String {
        let mut text = format!("o {name}\nusemtl g\n");
        for corner in 0..8 {
            let side = |bit: u32| if corner & bit == 0 { -size } else { size };
            text += &format!("v {} {} {}\n", side(1), side(2), side(4));
        }
        for mut face in
            [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]]
        {
            if !outwards {
                face.reverse();
            }
            let [a, b, c, d] = face.map(|corner| corner - 9);
            text += &format!("f {a} {b} {c} {d}\n");
        }
        text
    }

    fn load(obj: &str, illumination: u32) -> crate::model::Model {
        let obj = format!("mtllib m.mtl\n{obj}");
        let mtl = format!("newmtl g\nillum {illumination}\nNi 1.5\n");
        let files = [("model.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
        load_files(&files, &Limits::DEFAULT).unwrap()
    }

    #[test]
    fn a_body_of_glass_has_its_faces_outwards() {
        let right = load(&cube("body", 1.0, true), 7);
        let turned = load(&cube("body", 1.0, false), 7);
        assert_eq!(right.warnings, [""; 0]);
        let line = "model.obj: the faces of \"body\", a closed body of glass, point inwards; they are turned \
                    around (1 in all)";
        assert_eq!(turned.warnings, [line]);
        assert!(!turned.meshes[0].is_inside_out());
        // A sheet of glass and what is opaque have no inside.
        for illumination in [2, 4] {
            let other = load(&cube("body", 1.0, false), illumination);
            assert!(other.warnings.is_empty() && other.meshes[0].is_inside_out());
        }
    }

    #[test]
    fn a_bubble_stays_as_it_is() {
        let bubble = cube("bubble", 0.5, false);
        let model = load(&(cube("body", 1.0, true) + &bubble), 7);
        assert_eq!(model.warnings, [""; 0]);
        assert!(model.meshes[1].is_inside_out());
    }
}
