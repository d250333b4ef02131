//! A short fingerprint of texts, used to detect changes.

/// The FNV-1a hash of two texts in their order, in hexadecimal.
pub fn fingerprint(parts: [&[u8]; 2]) -> String {
    let bytes = parts.into_iter().flatten();
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}
