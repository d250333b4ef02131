//! Camera navigation: orbit, pan, zoom, look and fly, home and bookmarks.

use egui::{InputState, Key, PointerButton, Response};
use glam::{DQuat, DVec2, DVec3};

use super::bookmarks::Bookmarks;
use super::transport::Transport;
use crate::scene::Camera;

/// Rotation by a drag over the whole height of the window: half a circle.
const TURN: f64 = std::f64::consts::PI;
/// The closest the orbit comes to the pole, in radians.
const POLE: f64 = 0.02;
/// Speed of flight per second, in distances to the target.
const SPEED: f64 = 0.6;
/// Factor by which Shift speeds up flight.
const HURRY: f64 = 4.0;
/// The digits that store and recall bookmarks.
const DIGITS: [Key; 9] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];

/// Camera input since the last frame; drags in heights of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Turn around the target.
    pub orbit: DVec2,
    /// Turn around the eye.
    pub look: DVec2,
    /// Move eye and target in the plane of the picture.
    pub pan: DVec2,
    /// Approach (positive) or retreat, as the logarithm of the distance.
    pub zoom: f64,
    /// Move eye and target to the right, up and forward, in distances to the target.
    pub fly: DVec3,
}

impl Motion {
    /// Moves a camera; `false` if there was nothing to do.
    pub fn apply(&self, camera: &mut Camera) -> bool {
        if *self == Self::default() {
            return false;
        }
        let around_target = turned(camera, camera.eye - camera.target, self.orbit, 1.0);
        camera.eye = camera.target + around_target;
        let around_eye = turned(camera, camera.target - camera.eye, self.look, -1.0);
        camera.target = camera.eye + around_eye;
        camera.eye = camera.target + (camera.eye - camera.target) * (-self.zoom).exp();
        let [right, up, forward] = camera.axes();
        let distance = (camera.target - camera.eye).length();
        let height = 2.0 * distance * (camera.fov_y.to_radians() / 2.0).tan();
        let shift = (up * self.pan.y - right * self.pan.x) * height
            + (right * self.fly.x + up * self.fly.y + forward * self.fly.z) * distance;
        camera.eye += shift;
        camera.target += shift;
        true
    }
}

/// `arm` rotated sideways around the camera's up and then towards or away from it, stopping before the poles.
fn turned(camera: &Camera, arm: DVec3, drag: DVec2, rise: f64) -> DVec3 {
    let up = camera.up.try_normalize().unwrap_or(DVec3::Y);
    if drag == DVec2::ZERO || arm.length_squared() == 0.0 {
        return arm;
    }
    let arm = DQuat::from_axis_angle(up, -drag.x * TURN) * arm;
    let elevation = (arm.dot(up) / arm.length()).clamp(-1.0, 1.0).asin();
    let most = std::f64::consts::FRAC_PI_2 - POLE;
    let wanted = (elevation + rise * drag.y * TURN).clamp(-most, most);
    let side = arm.cross(up).try_normalize().unwrap_or_else(|| camera.axes()[0]);
    DQuat::from_axis_angle(side, wanted - elevation) * arm
}

/// Reads input, stores bookmarks, moves the camera.
pub struct Navigation {
    /// Input for an animation.
    pub transport: Transport,
    motion: Motion,
    home: Option<Camera>,
    go_home: bool,
    store: Option<usize>,
    recall: Option<usize>,
    bookmarks: Bookmarks,
}

impl Navigation {
    /// Navigation with the bookmarks of the chapter `name`.
    pub fn new(name: &str) -> Self {
        let (motion, bookmarks) = (Motion::default(), Bookmarks::open(name));
        let transport = Transport::default();
        Self { transport, motion, home: None, go_home: false, store: None, recall: None, bookmarks }
    }

    /// The next camera seen is the chapter's own, and becomes home.
    pub fn forget_home(&mut self) {
        self.home = None;
    }

    /// Reads drags and scrolling on the picture.
    pub fn drag(&mut self, picture: &Response, input: &InputState) {
        let height = f64::from(picture.rect.height().max(1.0));
        // Only flags of the response are read: reading the input again here would deadlock.
        if picture.dragged() {
            let delta = input.pointer.delta();
            let drag = DVec2::new(delta.x.into(), delta.y.into()) / height;
            let left = input.pointer.button_down(PointerButton::Primary);
            if left && input.modifiers.command {
                self.motion.look += drag;
            } else if left && !input.modifiers.shift {
                self.motion.orbit += drag;
            } else {
                self.motion.pan += drag;
            }
        }
        if picture.hovered() {
            self.motion.zoom += f64::from(input.smooth_scroll_delta().y) / 300.0;
            self.motion.zoom += f64::from(input.zoom_delta()).ln();
        }
    }

    /// Reads the keys.
    pub fn keys(&mut self, input: &InputState) {
        let digit = DIGITS.iter().position(|&key| input.key_pressed(key));
        if input.modifiers.command {
            self.store = digit;
            return;
        }
        self.recall = digit;
        self.go_home |= input.key_pressed(Key::R) || input.key_pressed(Key::Home);
        let axis = |plus, minus| {
            f64::from(i8::from(input.key_down(plus)) - i8::from(input.key_down(minus)))
        };
        let fly = DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
        let hurry = if input.modifiers.shift { HURRY } else { 1.0 };
        self.motion.fly += fly * SPEED * hurry * f64::from(input.stable_dt.min(0.1));
    }

    /// Applies the collected input to the camera; returns true if it moved.
    pub fn apply(&mut self, camera: &mut Camera) -> bool {
        let home = *self.home.get_or_insert(*camera);
        let before = *camera;
        if std::mem::take(&mut self.go_home) {
            *camera = home;
        }
        if let Some(place) = self.recall.take().and_then(|digit| self.bookmarks.get(digit)) {
            *camera = place;
        }
        std::mem::take(&mut self.motion).apply(camera);
        if let Some(digit) = self.store.take() {
            self.bookmarks.set(digit, *camera);
        }
        *camera != before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 45.0)
    }

    fn moved(motion: Motion) -> Camera {
        let mut camera = camera();
        motion.apply(&mut camera);
        camera
    }

    #[test]
    fn an_orbit_keeps_the_distance_and_stops_short_of_the_pole() {
        let right = moved(Motion { orbit: DVec2::new(0.5, 0.0), ..Motion::default() });
        assert!((right.eye - DVec3::new(-5.0, 0.0, 0.0)).length() < 1e-9, "{right:?}");
        let down = moved(Motion { orbit: DVec2::new(0.0, 3.0), ..Motion::default() });
        assert!((down.eye.length() - 5.0).abs() < 1e-9 && down.eye.y > 4.9, "{down:?}");
        let [side, ..] = down.axes();
        assert!((side - DVec3::X).length() < 1e-6, "no flip over the pole: {side}");
    }

    #[test]
    fn a_pan_moves_the_target_by_as_much_as_the_pointer() {
        let pan = moved(Motion { pan: DVec2::new(1.0, 0.0), ..Motion::default() });
        let height = 10.0 * (22.5f64).to_radians().tan();
        assert!((pan.target - DVec3::new(-height, 0.0, 0.0)).length() < 1e-9, "{pan:?}");
        assert_eq!(pan.eye - pan.target, camera().eye);
    }

    #[test]
    fn looking_keeps_the_eye_and_zooming_the_target() {
        let look = moved(Motion { look: DVec2::new(0.1, 0.1), ..Motion::default() });
        assert!((look.eye - camera().eye).length() < 1e-12);
        // As with a hand-held camera: a drag to the right and down turns it right and down.
        assert!(look.target.x > 0.0 && look.target.y < 0.0, "{look:?}");
        let zoom = moved(Motion { zoom: 1.0, ..Motion::default() });
        assert_eq!(zoom.target, DVec3::ZERO);
        assert!((zoom.eye.z - 5.0 / std::f64::consts::E).abs() < 1e-12);
    }

    #[test]
    fn home_is_the_first_camera_seen() {
        let mut navigation = Navigation::new("test");
        let mut camera = camera();
        assert!(!navigation.apply(&mut camera));
        navigation.motion.fly = DVec3::X;
        assert!(navigation.apply(&mut camera));
        assert!(camera.target.x > 0.0);
        navigation.go_home = true;
        assert!(navigation.apply(&mut camera));
        assert_eq!(camera, self::camera());
    }
}
