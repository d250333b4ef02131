//! Structures of a `pNext` chain that are missing in ash 0.38.

/// A structure of a `pNext` chain, zeroed by default.
macro_rules! chained {
    ($(#[$about:meta])* $name:ident = $kind:literal { $($field:ident: $type:ty = $zero:expr),* $(,)? }) => {
        $(#[$about])*
        #[repr(C)]
        #[derive(Clone, Copy)]
        #[allow(missing_docs, reason = "they are Vulkan's")]
        pub struct $name {
            pub s_type: vk::StructureType,
            pub p_next: *mut c_void,
            $(pub $field: $type),*
        }

        impl Default for $name {
            fn default() -> Self {
                let s_type = vk::StructureType::from_raw($kind);
                Self { s_type, p_next: ptr::null_mut(), $($field: $zero),* }
            }
        }

        // SAFETY: its pointers are used only in calls that receive the whole chain.
        unsafe impl Send for $name {}
        // SAFETY: as above.
        unsafe impl Sync for $name {}
    };
}

pub(crate) use chained;
