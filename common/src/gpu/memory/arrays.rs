//! The arrays behind device addresses: builds and shaders are given addresses alone, so their lengths are kept here.

use std::collections::BTreeMap;

use ash::vk;

/// An array in a buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Array {
    /// The buffer's name.
    pub name: String,
    /// The buffer.
    pub buffer: vk::Buffer,
    /// Bytes from the start of the buffer to the array.
    pub offset: u64,
    /// Bytes of the array.
    pub bytes: u64,
}

/// Every array of a device that has an address.
#[derive(Debug, Default)]
pub struct Arrays(BTreeMap<vk::DeviceAddress, Array>);

impl Arrays {
    /// Adds an array.
    pub fn add(&mut self, address: vk::DeviceAddress, array: Array) {
        self.0.insert(address, array);
    }

    /// Forgets the arrays of a buffer of so many bytes at an address.
    pub fn forget(&mut self, address: vk::DeviceAddress, bytes: u64) {
        let within: Vec<_> = self.0.range(address..address + bytes).map(|(at, _)| *at).collect();
        within.iter().for_each(|at| _ = self.0.remove(at));
    }

    /// The part of an array that begins at an address; `None` if there is no array.
    pub fn from(&self, address: vk::DeviceAddress) -> Option<Array> {
        let (start, array) = self.0.range(..=address).next_back()?;
        let skipped = address - start;
        (skipped <= array.bytes).then(|| Array {
            offset: array.offset + skipped,
            bytes: array.bytes - skipped,
            ..array.clone()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(name: &str, offset: u64, bytes: u64) -> Array {
        Array { name: name.into(), buffer: vk::Buffer::null(), offset, bytes }
    }

    #[test]
    fn an_address_within_an_array_has_what_is_left_of_it() {
        let mut arrays = Arrays::default();
        arrays.add(0x1000, array("first", 0, 24));
        arrays.add(0x1020, array("second", 32, 12));
        assert_eq!(arrays.from(0x1000), Some(array("first", 0, 24)));
        assert_eq!(arrays.from(0x1010), Some(array("first", 16, 8)));
        assert_eq!(arrays.from(0x1018), Some(array("first", 24, 0)));
        assert_eq!(arrays.from(0x1024), Some(array("second", 36, 8)));
        assert_eq!([0, 0xfff, 0x101f, 0x1030].map(|at| arrays.from(at)), [const { None }; 4]);
        arrays.forget(0x1000, 0x2c);
        assert_eq!(arrays.from(0x1000), None);
        assert_eq!(arrays.from(0x1020), None);
    }
}
