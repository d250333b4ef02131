//! The ladders: the primitives, and the ways to intersect each, from cheap to exact.

use ash::vk;
use common::gpu::Gpu;

/// The primitive, or sum, that a query tests, in the order of `PRIMITIVE` in `query.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    Sphere,
    Box,
    Plane,
    Triangle,
    Capsule,
    Instance,
    Heightfield,
    SecondaryOrigin,
    Accumulation,
    Cone,
    Quadric,
    Patch,
    Voxel,
    Algebraic,
}

impl Primitive {
    pub const ALL: [Self; 14] = [
        Self::Sphere,
        Self::Box,
        Self::Plane,
        Self::Triangle,
        Self::Capsule,
        Self::Instance,
        Self::Heightfield,
        Self::SecondaryOrigin,
        Self::Accumulation,
        Self::Cone,
        Self::Quadric,
        Self::Patch,
        Self::Voxel,
        Self::Algebraic,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Box => "box",
            Self::Plane => "plane",
            Self::Triangle => "triangle",
            Self::Capsule => "capsule",
            Self::Instance => "instance",
            Self::Heightfield => "heightfield",
            Self::SecondaryOrigin => "secondary origin",
            Self::Accumulation => "accumulation",
            Self::Cone => "cone",
            Self::Quadric => "quadric",
            Self::Patch => "patch",
            Self::Voxel => "voxel",
            Self::Algebraic => "algebraic",
        }
    }

    /// Tests whether an acceleration structure can trace it.
    pub fn is_traced(self) -> bool {
        self != Self::Accumulation
    }

    pub fn ladder(self) -> &'static [Rung] {
        match self {
            Self::Sphere => &SPHERE,
            Self::Box => &BOX,
            Self::Plane => &PLANE,
            Self::Triangle => &TRIANGLE,
            Self::Capsule => &CAPSULE,
            Self::Instance => &INSTANCE,
            Self::Heightfield => &HEIGHTFIELD,
            Self::SecondaryOrigin => &SECONDARY_ORIGIN,
            Self::Accumulation => &ACCUMULATION,
            Self::Cone => &CONE,
            Self::Quadric => &QUADRIC,
            Self::Patch => &PATCH,
            Self::Voxel => &VOXEL,
            Self::Algebraic => &ALGEBRAIC,
        }
    }
}

/// The place of a rung's code, and so what the device must support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Plain GLSL, any device.
    Plain,
    /// Needs rounding to nearest even and signed zeros, which it declares.
    Exact,
    /// Needs 64-bit floats.
    Float64,
    /// The device's own triangles: traced only.
    Device,
}

impl Code {
    /// The reason why this device cannot run it; `None` if it can.
    pub fn unavailable(self, gpu: &Gpu) -> Option<String> {
        let (floats, features) = (&gpu.limits.vulkan12, &gpu.features.core);
        let lacks = |what: &str| Some(format!("{} does not offer {what}", gpu.name));
        match self {
            Self::Exact | Self::Float64 if floats.shader_rounding_mode_rte_float32 == vk::FALSE => {
                lacks("shaderRoundingModeRTEFloat32")
            }
            Self::Exact | Self::Float64
                if floats.shader_signed_zero_inf_nan_preserve_float32 == vk::FALSE =>
            {
                lacks("shaderSignedZeroInfNanPreserveFloat32")
            }
            Self::Float64 if features.shader_float64 == vk::FALSE => lacks("shaderFloat64"),
            _ => None,
        }
    }
}

/// One way to intersect.
#[derive(Debug)]
pub struct Rung {
    /// Its place on the ladder, such as `S2`.
    pub label: &'static str,
    /// Name in a word or two.
    pub name: &'static str,
    /// Its number in the shader.
    pub constant: u32,
    pub code: Code,
    /// True if every hard case must be right.
    pub is_top: bool,
}

impl Rung {
    /// The reason why this device lacks the rung; `None` if it has it.
    pub fn unavailable(&self, gpu: &Gpu) -> Option<String> {
        self.code.unavailable(gpu)
    }

    /// Tests whether every hard case must be right here: in the worst arithmetic, 64 bits are worth 32.
    pub fn is_held(&self, gpu: &Gpu) -> bool {
        self.is_top && !(self.code == Code::Float64 && gpu.driver_shim.name() != "driver")
    }
}

const fn rung(label: &'static str, name: &'static str, constant: u32) -> Rung {
    Rung { label, name, constant, code: Code::Plain, is_top: false }
}

const fn exact(label: &'static str, name: &'static str, constant: u32) -> Rung {
    Rung { label, name, constant, code: Code::Exact, is_top: false }
}

const fn top(rung: Rung) -> Rung {
    Rung { is_top: true, ..rung }
}

const fn float64(label: &'static str, constant: u32) -> Rung {
    Rung { label, name: "64 bits", constant, code: Code::Float64, is_top: true }
}

static SPHERE: [Rung; 7] = [
    rung("S0", "textbook", 0),
    rung("S0h", "host c", 3),
    rung("S1", "projection", 1),
    rung("S2", "stable", 2),
    exact("S3", "compensated", 5),
    top(exact("S4", "two-float", 6)),
    float64("S5", 7),
];

static BOX: [Rung; 5] = [
    rung("B0", "reciprocal", 0),
    rung("B1", "padded", 2),
    rung("B2", "division", 1),
    top(exact("B3", "two-float", 3)),
    float64("B4", 4),
];

static PLANE: [Rung; 6] = [
    rung("P0", "POV form", 0),
    rung("P1", "point", 1),
    rung("P1ε", "cut-off", 2),
    exact("P2", "compensated", 3),
    top(exact("P3", "two-float", 4)),
    float64("P4", 5),
];

static TRIANGLE: [Rung; 4] = [
    Rung { label: "T0", name: "device", constant: 0, code: Code::Device, is_top: false },
    rung("T1", "Möller-Trumbore", 0),
    rung("T2", "watertight", 1),
    top(exact("T3", "two-float", 2)),
];

static CAPSULE: [Rung; 4] = [
    rung("C0", "textbook", 0),
    rung("C1", "stable", 1),
    top(exact("C2", "two-float", 2)),
    float64("C3", 3),
];

static INSTANCE: [Rung; 3] =
    [rung("I0", "matrix", 0), rung("I1", "host inverse", 1), top(exact("I2", "two-float", 2))];

static HEIGHTFIELD: [Rung; 4] = [
    rung("H0", "relaxed", 0),
    rung("H1", "Lipschitz", 1),
    rung("H2", "over-relaxed", 2),
    top(rung("H3", "bisected", 3)),
];

static SECONDARY_ORIGIN: [Rung; 6] = [
    rung("O0", "nothing", 0),
    rung("O1", "tmin", 1),
    rung("O2", "normal", 2),
    rung("O3", "integers", 3),
    rung("O4", "reprojected", 4),
    top(exact("O5", "bound", 5)),
];

static ACCUMULATION: [Rung; 4] = [
    rung("A0", "sum", 0),
    rung("A1", "mean", 1),
    exact("A2", "Kahan", 2),
    top(rung("A3", "fixed point", 3)),
];

static CONE: [Rung; 4] = [
    rung("K0", "textbook", 0),
    rung("K1", "stable", 1),
    top(exact("K2", "two-float", 2)),
    float64("K3", 3),
];

static QUADRIC: [Rung; 4] = [
    rung("Q0", "textbook", 0),
    rung("Q1", "stable", 1),
    top(exact("Q2", "two-float", 2)),
    // Along an asymptote the coefficient of t² needs more than 53 bits.
    Rung { is_top: false, ..float64("Q3", 3) },
];

static PATCH: [Rung; 4] = [
    rung("L0", "textbook", 0),
    rung("L1", "stable", 1),
    top(exact("L2", "two-float", 2)),
    float64("L3", 3),
];

static VOXEL: [Rung; 5] = [
    rung("V0", "march", 0),
    rung("V1", "Cardano", 1),
    rung("V2", "bracketed", 2),
    top(exact("V3", "two-float", 3)),
    float64("V4", 4),
];

static ALGEBRAIC: [Rung; 5] = [
    rung("F0", "Ferrari", 0),
    rung("F1", "polished", 1),
    rung("F2", "bracketed", 2),
    top(exact("F3", "two-float", 3)),
    float64("F4", 4),
];
