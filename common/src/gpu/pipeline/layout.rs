//! The layout of structures that Rust writes and shaders read.
//!
//! [`shader_struct!`](crate::shader_struct) declares a `#[repr(C)]` structure and remembers its fields, the
//! structures nested in it and those it refers to by address. When a pipeline is created, each is compared with
//! the structure of the same name in the SPIR-V: a field that was moved, or is missing on one side, causes an
//! error that names it instead of a wrong picture.

use std::marker::PhantomData;

/// A device address inside a structure for shaders, where it is a `buffer_reference` to a `T`, or to an array of them.
///
/// The referenced structure is compared with the shaders too. `T` may be omitted for plain numbers.
///
/// The alignment is that of `u32`, so that a structure needs no padding at its end; the shader needs a multiple of
/// 8, which the comparison of offsets enforces.
#[repr(transparent)]
pub struct Address<T = ()>([u32; 2], PhantomData<fn() -> T>);

impl<T> From<ash::vk::DeviceAddress> for Address<T> {
    fn from(address: ash::vk::DeviceAddress) -> Self {
        Self([address as u32, (address >> 32) as u32], PhantomData)
    }
}

impl<T> From<Address<T>> for ash::vk::DeviceAddress {
    fn from(Address([low, high], _): Address<T>) -> Self {
        Self::from(low) | Self::from(high) << 32
    }
}

impl<T> Default for Address<T> {
    /// The null address.
    fn default() -> Self {
        0.into()
    }
}

impl<T> Clone for Address<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Address<T> {}

impl<T> std::fmt::Debug for Address<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

// SAFETY: it is two u32 and nothing else.
unsafe impl<T: 'static> bytemuck::Zeroable for Address<T> {}
// SAFETY: it is two u32 and nothing else.
unsafe impl<T: 'static> bytemuck::Pod for Address<T> {}

/// The kind of number that a field is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// `f32`, in GLSL `float` and its vectors.
    Float,
    /// `i32`, in GLSL `int` and its vectors.
    Int,
    /// `u32`, in GLSL `uint` and its vectors.
    Uint,
}

impl Scalar {
    /// The word in Rust.
    pub fn in_rust(self) -> &'static str {
        match self {
            Self::Float => "f32",
            Self::Int => "i32",
            Self::Uint => "u32",
        }
    }

    /// The word in GLSL.
    pub fn in_glsl(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Int => "int",
            Self::Uint => "uint",
        }
    }
}

/// A type allowed as a field of a structure for shaders.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be a field of a structure for shaders",
    note = "use f32, i32, u32, the vectors of glam, an array of them, an `Address` or another `shader_struct!`; for a \
            bool, a u32 that is 0 or 1"
)]
pub trait ShaderType {
    /// The numbers it is made of; `None` for addresses and structures.
    const SCALAR: Option<Scalar> = None;

    /// Adds the declarations that shaders have under the same name: by default none.
    fn reach(_: &mut Known) {}

    /// Adds the offsets of the addresses in a value that begins `_at` bytes from the start: by default none.
    fn addresses(_at: usize, _found: &mut Vec<usize>) {}
}

/// Structures and enumerations declared in Rust and also in shaders.
#[derive(Clone, Default, Hash)]
pub struct Known {
    pub(in crate::gpu) structs: Vec<StructLayout>,
    pub(in crate::gpu) enums: Vec<EnumLayout>,
}

impl Known {
    /// A structure, those nested in it, and those it refers to.
    pub fn of<T: ShaderType>() -> Self {
        let mut known = Self::default();
        T::reach(&mut known);
        known
    }

    /// The structures.
    pub fn structs(&self) -> &[StructLayout] {
        &self.structs
    }

    /// Adds a structure; returns true if it is new.
    pub fn add_struct(&mut self, layout: StructLayout) -> bool {
        let is_new = self.structs.iter().all(|known| known.name != layout.name);
        if is_new {
            self.structs.push(layout);
        }
        is_new
    }

    /// Adds an enumeration.
    pub fn add_enum(&mut self, layout: EnumLayout) {
        if !self.enums.contains(&layout) {
            self.enums.push(layout);
        }
    }
}

macro_rules! made_of {
    ($scalar:expr => $($type:ty),+) => {
        $(impl ShaderType for $type { const SCALAR: Option<Scalar> = $scalar; })+
    };
}
made_of!(None => ());
made_of!(Some(Scalar::Float) => f32, glam::Mat3, glam::Vec2, glam::Vec3, glam::Vec4);
made_of!(Some(Scalar::Int) => i32);
made_of!(Some(Scalar::Uint) => u32, glam::UVec2, glam::UVec3);

impl<T: ShaderType> ShaderType for Address<T> {
    fn reach(known: &mut Known) {
        T::reach(known);
    }

    fn addresses(at: usize, found: &mut Vec<usize>) {
        found.push(at);
    }
}

impl<T: ShaderType, const N: usize> ShaderType for [T; N] {
    const SCALAR: Option<Scalar> = T::SCALAR;

    fn reach(known: &mut Known) {
        T::reach(known);
    }

    fn addresses(at: usize, found: &mut Vec<usize>) {
        (0..N).for_each(|element| T::addresses(at + element * size_of::<T>(), found));
    }
}

/// One field: name, offset in bytes, and the numbers it is made of.
pub type Field = (&'static str, usize, Option<Scalar>);

/// A structure shared with shaders. Implemented by [`shader_struct!`](crate::shader_struct).
pub trait ShaderStruct: bytemuck::Pod + ShaderType {
    /// Its name and fields.
    const LAYOUT: StructLayout;
}

/// The name and the fields of a Rust structure.
#[derive(Clone, Copy, Debug, Hash)]
pub struct StructLayout {
    /// The name, the same in GLSL.
    pub name: &'static str,
    /// The fields in order.
    pub fields: &'static [Field],
    /// Bytes of the whole structure.
    pub size: usize,
}

/// The names of a Rust enumeration, in the order of its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct EnumLayout {
    /// The name in Rust.
    pub name: &'static str,
    /// The prefix of the shaders' constants; empty if there are none.
    pub prefix: &'static str,
    /// The variants in Rust.
    pub variants: &'static [&'static str],
    /// The words in the panel, for `--set` and in `--list-controls`.
    pub words: &'static [&'static str],
}

/// Declares a `#[repr(C)]`, `Pod` structure that shaders declare under the same names.
///
/// ```
/// raybook::shader_struct! {
///     /// The values that every ray of a frame needs.
///     pub struct Push { pub origin: raybook::glam::Vec3, pub samples: u32 }
/// }
/// ```
#[macro_export]
macro_rules! shader_struct {
    ($(#[$attribute:meta])* $access:vis struct $name:ident {
        $($(#[$field_attribute:meta])* $field_access:vis $field:ident : $type:ty),+ $(,)?
    }) => {
        $(#[$attribute])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        $access struct $name { $($(#[$field_attribute])* $field_access $field: $type),+ }

        // Expansion of bytemuck's derive macros. They need this crate's name as text, and it has two: its own, and
        // `common` in the book.
        const _: () = {
            const fn are_plain<T: $crate::bytemuck::Pod>() -> usize {
                ::std::mem::size_of::<T>()
            }
            let fields = 0 $(+ are_plain::<$type>())+;
            assert!(fields == ::std::mem::size_of::<$name>(), "a gap lies between two fields");
        };
        // SAFETY: each field is plain data, for which all bytes 0 are a value; as checked above.
        unsafe impl $crate::bytemuck::Zeroable for $name {}
        // SAFETY: its layout is C's, each field is plain data, and no gap lies between them; as checked above.
        unsafe impl $crate::bytemuck::Pod for $name {}

        impl $crate::gpu::ShaderStruct for $name {
            const LAYOUT: $crate::gpu::StructLayout = $crate::gpu::StructLayout {
                name: stringify!($name),
                fields: &[$((
                    stringify!($field),
                    ::std::mem::offset_of!($name, $field),
                    <$type as $crate::gpu::ShaderType>::SCALAR,
                )),+],
                size: ::std::mem::size_of::<$name>(),
            };
        }

        impl $crate::gpu::ShaderType for $name {
            fn reach(known: &mut $crate::gpu::Known) {
                if known.add_struct(<Self as $crate::gpu::ShaderStruct>::LAYOUT) {
                    $(<$type as $crate::gpu::ShaderType>::reach(known);)+
                }
            }

            fn addresses(at: usize, found: &mut Vec<usize>) {
                $(<$type as $crate::gpu::ShaderType>::addresses(
                    at + ::std::mem::offset_of!($name, $field),
                    found,
                );)+
            }
        }
    };
}
