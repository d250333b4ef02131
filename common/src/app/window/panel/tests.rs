//! The panel with simulated input.

use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::Vec3;

use super::*;
use crate::scene::Camera;

struct Demo {
    panel: Panel,
    height: f32,
    depth: u32,
    shadows: bool,
    show: u32,
    tint: Vec3,
    normal: Vec3,
    camera: Camera,
    changes: usize,
    asked: Vec<Ask>,
}

impl Demo {
    fn controls(&mut self, c: &mut Controls) {
        c.one_of("show", &mut self.show, &["picture", "normal"]);
        c.slider("height", &mut self.height, 0.0..=10.0);
        c.integer("depth", &mut self.depth, 0..=8);
        c.checkbox("shadows", &mut self.shadows);
        c.vector("tint", &mut self.tint, 0.0..=1.0);
        c.direction("plane", &mut self.normal, 0.0..=1.0);
        c.camera(&mut self.camera);
    }
}

fn harness() -> Harness<'static, Demo> {
    harness_with(Facts::default())
}

fn harness_with(facts: Facts) -> Harness<'static, Demo> {
    harness_of(960.0, facts)
}

fn harness_of(width: f32, facts: Facts) -> Harness<'static, Demo> {
    let demo = Demo {
        panel: Panel::new("test"),
        height: 5.0,
        depth: 1,
        shadows: false,
        show: 0,
        tint: Vec3::ZERO,
        normal: Vec3::new(0.0, 0.02, 0.0),
        camera: Camera::default(),
        changes: 0,
        asked: Vec::new(),
    };
    let builder = Harness::builder().with_size(vec2(width, 700.0));
    builder.build_ui_state(
        move |ui, demo: &mut Demo| {
            let mut panel = std::mem::replace(&mut demo.panel, Panel::new("test"));
            let outcome = panel.show(ui, &facts, &mut |c| demo.controls(c));
            demo.panel = panel;
            demo.changes += usize::from(outcome.changed);
            demo.asked.extend(outcome.asked);
        },
        demo,
    )
}

#[test]
fn a_driver_that_tells_of_its_programs_is_quoted_when_asked() {
    let program = crate::gpu::Executable {
        name: "raygen".to_owned(),
        statistics: vec![("Register Count".to_owned(), 48.0)],
        ..Default::default()
    };
    let mut harness = harness_with(Facts { programs: vec![program], ..Facts::default() });
    harness.run();
    assert!(harness.query_by_label("Register Count").is_none(), "folded away at first");
    harness.get_by_label("compiler: 1 program").click();
    harness.run();
    harness.get_by_label("Register Count");
    harness.get_by_label("48");
}

#[test]
fn each_kind_of_control_changes_its_value() {
    let mut harness = harness();
    harness.run();
    assert_eq!(harness.state().changes, 0, "nothing was touched");
    harness.get_by_role_and_label(Role::CheckBox, "shadows").click();
    harness.run();
    assert!(harness.state().shadows);
    harness.get_by_role_and_label(Role::Slider, "height").focus();
    harness.key_press(Key::ArrowRight);
    harness.run();
    assert!(harness.state().height > 5.0);
    harness.get_by_role_and_label(Role::ComboBox, "show").click();
    harness.run();
    harness.get_by_label("normal").click();
    harness.run();
    assert_eq!(harness.state().show, 1);
    assert_eq!(harness.state().changes, 3, "each once");
    assert_eq!(harness.state().camera, Camera::default());
}

#[test]
fn in_a_small_window_the_panel_waits_until_it_is_asked_for() {
    let mut harness = harness_of(480.0, Facts::default());
    harness.run();
    assert!(harness.query_by_label("shadows").is_none(), "it covers the picture");
    harness.get_by_label("Panel (Tab)").click();
    harness.run();
    harness.get_by_role_and_label(Role::CheckBox, "shadows");
    harness.key_press(Key::Tab);
    harness.run();
    assert!(harness.query_by_label("shadows").is_none(), "Tab hides it");
    assert!(harness.query_by_label("Panel (Tab)").is_none(), "whoever has hidden it knows how");
    // Tab also opens it immediately, and an error is shown in its place.
    let mut harness = harness_of(480.0, Facts::default());
    harness.key_press(Key::Tab);
    harness.run();
    harness.get_by_role_and_label(Role::CheckBox, "shadows");
    let mut harness = harness_of(480.0, Facts::default());
    harness.state_mut().panel.error = Some("camera.rgen:3: nonsense".to_owned());
    harness.run();
    harness.get_by_label("camera.rgen:3: nonsense");
}

#[test]
fn a_direction_keeps_a_length() {
    let mut harness = harness();
    harness.run();
    harness.get_by_label("plane y").focus();
    for _ in 0..20 {
        harness.key_press(Key::ArrowDown);
        harness.run();
    }
    let normal = harness.state().normal;
    assert!(harness.state().changes > 0 && normal.y < 0.02, "it was not changed: {normal}");
    assert!(normal.y > 0.0, "{normal} is no direction");
}

#[test]
fn a_drag_on_the_picture_orbits_and_one_on_the_panel_does_not() {
    let mut harness = harness();
    harness.run();
    for (from, moves) in [(egui::pos2(40.0, 30.0), false), (egui::pos2(600.0, 300.0), true)] {
        harness.drag_at(from);
        harness.run();
        harness.hover_at(from + vec2(60.0, 0.0));
        harness.run();
        harness.drop_at(from + vec2(60.0, 0.0));
        harness.run();
        assert_eq!(harness.state().camera != Camera::default(), moves, "{from}");
    }
    harness.key_press(Key::Home);
    harness.run();
    assert_eq!(harness.state().camera, Camera::default());
}

#[test]
fn an_error_is_shown_until_it_is_mended_and_without_the_panel_too() {
    let mut harness = harness();
    let error = "02_basic/shade.rchit:12: 'colour' : undeclared identifier";
    harness.state_mut().panel.error = Some(error.to_owned());
    harness.run();
    harness.get_by_label(error);
    harness.key_press(Key::Tab);
    harness.run();
    assert!(harness.query_by_label("height").is_none(), "Tab hides the panel");
    harness.get_by_label(error);
    harness.state_mut().panel.error = None;
    harness.run();
    assert!(harness.query_by_label(error).is_none());
}

#[test]
fn the_panel_grows_with_what_it_holds_as_far_as_the_window_does() {
    let mut harness = harness();
    harness.run();
    let footer = |harness: &Harness<Demo>| {
        let hint = "F1 keys · F2 picture · F5 shaders · Tab panel";
        harness.query_by_label(hint).map(|node| node.rect().bottom())
    };
    let before = footer(&harness).expect("the footer shows");
    harness.state_mut().panel.error = Some("wrong\n".repeat(8));
    harness.run();
    let after = footer(&harness).expect("the footer shows");
    assert!(after > before + 80.0 && after < 700.0 - MARGIN, "{before} {after}");
}

#[test]
fn keys_ask_and_the_overlay_lists_them() {
    let mut harness = harness();
    harness.run();
    harness.key_press(Key::F1);
    harness.run();
    harness.get_by_label("reload shaders · also on save");
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.query_by_label("orbit").is_none(), "Esc closes the overlay first");
    // Two presses of a slow frame count as two: the overlay closes, then the window.
    harness.key_press(Key::F1);
    harness.run();
    harness.key_press(Key::Escape);
    harness.key_press(Key::Escape);
    harness.run();
    assert_eq!(std::mem::take(&mut harness.state_mut().asked), [Ask::Leave]);
    for key in [Key::F2, Key::F5, Key::Escape] {
        harness.key_press_modifiers(Modifiers::NONE, key);
        harness.run();
    }
    assert_eq!(harness.state().asked, [Ask::Picture, Ask::Reload, Ask::Leave]);
}

#[test]
fn what_is_only_shown_is_not_rounded() {
    let mut harness = harness();
    let third = 1.0 / 3.0;
    harness.state_mut().height = third;
    harness.state_mut().camera.eye.x = f64::from(third);
    harness.run();
    assert_eq!(harness.state().height, third);
    assert_eq!(harness.state().camera.eye.x, f64::from(third));
    assert_eq!(harness.state().changes, 0);
}

#[test]
fn every_control_has_a_row() {
    let mut harness = harness();
    harness.run();
    for name in ["show", "height", "depth", "shadows", "tint x", "camera eye z"] {
        assert!(harness.query_all_by_label(name).count() > 0, "{name}");
    }
    let depth = harness.get_by_role_and_label(Role::Slider, "depth");
    assert!(depth.rect().right() < MARGIN + WIDTH + 28.0, "{:?}", depth.rect());
    let _ = depth.accesskit_node();
}
