//! Floats for who reads them: the shortest decimal number that is read back as the same float, and its bits as a
//! hexadecimal float.

/// Numbers in decimal, and after `=` in hexadecimal.
pub fn both(words: &[u32]) -> String {
    let numbers = || words.iter().copied().map(f32::from_bits);
    let decimal: Vec<String> = numbers().map(decimal).collect();
    let hexadecimal: Vec<String> = numbers().map(hexadecimal).collect();
    format!("{} = {}", decimal.join(", "), hexadecimal.join(", "))
}

fn decimal(number: f32) -> String {
    match number.abs() {
        0.0 | 1e-4..1e7 => number.to_string(),
        _ if number.is_finite() => format!("{number:e}"),
        _ => number.to_string(),
    }
}

/// As C's `%a` writes it.
fn hexadecimal(number: f32) -> String {
    let bits = number.to_bits();
    let sign = if number.is_sign_negative() { "-" } else { "" };
    let (exponent, fraction) = (bits >> 23 & 0xff, bits & 0x7f_ffff);
    let digits = format!("{:06x}", fraction << 1);
    let digits = match digits.trim_end_matches('0') {
        "" => String::new(),
        digits => format!(".{digits}"),
    };
    match exponent {
        0 if fraction == 0 => format!("{sign}0x0p+0"),
        0 => format!("{sign}0x0{digits}p-126"),
        0xff if fraction == 0 => format!("{sign}inf"),
        0xff => format!("nan({bits:#x})"),
        _ => format!("{sign}0x1{digits}p{:+}", exponent as i32 - 127),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_floats_are_those_of_c() {
        for (number, text) in [
            (0.0, "0x0p+0"),
            (-0.0, "-0x0p+0"),
            (1.0, "0x1p+0"),
            (0.1, "0x1.99999ap-4"),
            (-3.5, "-0x1.cp+1"),
            (1e30, "0x1.93e594p+99"),
            (f32::from_bits(1), "0x0.000002p-126"),
            (f32::INFINITY, "inf"),
        ] {
            assert_eq!(hexadecimal(number), text);
        }
        assert_eq!(both(&[f32::NAN.to_bits()]), "NaN = nan(0x7fc00000)");
    }

    #[test]
    fn decimal_numbers_are_short_and_lead_back() {
        for number in [0.1f32, 1e30, -2.5e-9, 16_777_216.0, 0.0, 123.456] {
            assert_eq!(decimal(number).parse::<f32>().unwrap(), number);
        }
        assert_eq!(decimal(1e30), "1e30");
    }
}
