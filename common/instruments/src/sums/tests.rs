use super::*;

/// Sums of a picture of two pixels, like those of a render of a few samples.
fn some(samples: Range<u32>) -> Sums {
    let origin = Origin {
        chapter: "04_jitter_camera".to_owned(),
        version: "0.1.0".to_owned(),
        size: [2, 1],
        settings: [("seed".to_owned(), "0".to_owned())].into(),
        scene: [("chess.obj".to_owned(), 7)].into(),
        shaders: Some(1),
        device: "a device".to_owned(),
        driver: "a driver".to_owned(),
        ..Origin::default()
    };
    let one = i128::from(samples.end - samples.start) << FRACTION;
    let values = vec![one, 3 * one, -one, one, 0, one / 3, i128::from(samples.start), one];
    Sums { header: Header { origin, samples: samples.into(), ..Header::default() }, values }
}

/// The reason why bytes are refused.
fn refused(bytes: &[u8]) -> String {
    Sums::parse(bytes, "a.sums").unwrap_err().to_string()
}

/// The bytes of a file with a custom header and a correct checksum.
fn forged(header: &str, sums: &[u8]) -> Vec<u8> {
    let length = header.len() as u32;
    let mut bytes = [&MAGIC[..], &FORM.to_le_bytes(), &length.to_le_bytes()].concat();
    bytes.extend(header.as_bytes());
    let mut packed = ZlibEncoder::new(bytes, Compression::fast());
    packed.write_all(sums).unwrap();
    let mut bytes = packed.finish().unwrap();
    let crc = crc32fast::hash(&bytes);
    bytes.extend(crc.to_le_bytes());
    bytes
}

#[test]
fn a_file_gives_back_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.sums");
    some(3..9).save(&file).unwrap();
    assert_eq!(Sums::open(&file).unwrap(), some(3..9));
    assert_eq!(Header::open(&file).unwrap(), some(3..9).header);
    assert_eq!(some(3..9).bytes().unwrap(), std::fs::read(&file).unwrap());
}

#[test]
fn whatever_bit_is_wrong_the_file_is_refused() {
    let whole = some(0..4).bytes().unwrap();
    for at in 0..whole.len() {
        for bit in 0..8 {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << bit;
            assert!(refused(&bytes).starts_with("a.sums: "), "byte {at}, bit {bit}");
        }
    }
    for length in 0..whole.len() {
        let line = refused(&whole[..length]);
        assert!(
            line.contains("is damaged") || line.contains("was not written by --save"),
            "{line}"
        );
    }
    assert!(refused(&[&whole[..], b"more"].concat()).contains("is damaged: it is cut off, or"));
}

#[test]
fn what_is_no_file_of_sums_is_named_so() {
    for bytes in [&b""[..], b"RTSU", b"\x89PNG\r\n\x1a\n and so on and on", b"RTSUMZ\x01\0\0\0\0\0"]
    {
        assert_eq!(refused(bytes), "a.sums: was not written by --save");
    }
    let mut bytes = some(0..4).bytes().unwrap();
    bytes[6] = 2;
    assert_eq!(refused(&bytes), "a.sums: has form 2; this program reads form 1");
}

#[test]
fn a_file_that_promises_too_much_is_refused_before_memory_is_taken() {
    let header = |size: [u32; 2], samples: &str| {
        let header = Header { origin: Origin { size, ..Origin::default() }, ..Header::default() };
        serde_json::to_string(&header).unwrap().replace("\"samples\":[]", samples)
    };
    let some = "\"samples\":[[0,4]]";
    for size in [[0, 1], [8193, 8192], [u32::MAX, u32::MAX]] {
        assert!(refused(&forged(&header(size, some), b"")).contains("is empty or too large"));
    }
    // 4 GiB of sums, of which 16 bytes exist.
    let line = refused(&forged(&header([8192, 8192], some), &[0; 16]));
    assert_eq!(line, "a.sums: is damaged: it has too few sums");
    let line = refused(&forged(&header([1, 1], some), &[0; 65]));
    assert_eq!(line, "a.sums: is damaged: it has too many sums");
    let line = refused(&forged(&header([1, 1], "\"samples\":[]"), &[0; 64]));
    assert_eq!(line, "a.sums: is damaged: it has no samples");
    let line = refused(&forged(&header([1, 1], "\"samples\":[[4,2]]"), &[0; 64]));
    assert!(line.contains("4..2 is not a range of samples"), "{line}");
    for spoiled in ["3,\"first\":1", "0,\"first\":0", "9,\"first\":0"] {
        let header = header([1, 1], some).replace("0,\"first\":null", spoiled);
        let line = refused(&forged(&header, &[0; 64]));
        assert!(line.ends_with("its number of spoiled samples is impossible"), "{line}");
    }
    for (sum, fits) in [(4i128 << 95, true), ((4 << 95) + 1, false), (i128::MIN, false)] {
        let bytes = forged(&header([1, 1], some), &[sum.to_le_bytes(); 4].concat());
        assert_eq!(Sums::parse(&bytes, "a.sums").is_ok(), fits, "{sum}");
    }
    let mut long = MAGIC.to_vec();
    long.extend([1, 0, 255, 255, 255, 255]);
    assert_eq!(refused(&long), "a.sums: is damaged: its header is too long");
}

#[test]
fn a_file_longer_than_its_picture_can_be_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.sums");
    some(0..4).save(&file).unwrap();
    // Four gigabytes as a hole in the file.
    std::fs::File::options().write(true).open(&file).unwrap().set_len(4 << 30).unwrap();
    let line = Sums::open(&file).unwrap_err().to_string();
    assert!(line.contains("is too large: 4294967296 bytes, at most 1049736"), "{line}");
}

#[test]
fn what_does_not_fit_is_named() {
    let mine = some(0..4).header.origin;
    let line = |change: &dyn Fn(&mut Origin)| {
        let mut other = mine.clone();
        change(&mut other);
        mine.difference(&other).map(|difference| difference.line(["in it", "here"]))
    };
    assert_eq!(line(&|_| {}), None);
    assert_eq!(line(&|o| o.shaders = None), None, "not compiled yet");
    type Case<'a> = (&'a dyn Fn(&mut Origin), &'a str);
    let cases: [Case; 9] = [
        (&|o| o.chapter = "11".into(), "the chapter is '04_jitter_camera' in it and '11' here"),
        (&|o| o.version = "0.2.0".into(), "the version is '0.1.0' in it and '0.2.0' here"),
        (&|o| o.size = [4, 1], "the size is 2x1 in it and 4x1 here"),
        (&|o| _ = o.settings.insert("seed".into(), "1".into()), "'seed' is '0' in it and '1' here"),
        (
            &|o| _ = o.settings.insert("new".into(), "1".into()),
            "'new' is nothing in it and '1' here",
        ),
        (
            &|o| _ = o.scene.insert("chess.obj".into(), 8),
            "the CRC-32 of 'chess.obj' is 00000007 in it and 00000008 here",
        ),
        (&|o| o.shaders = Some(2), "the CRC-32 of the shaders is 00000001 in it and 00000002 here"),
        (&|o| o.device = "another".into(), "the device is 'a device' in it and 'another' here"),
        (&|o| o.unordered = true, "--unordered is false in it and true here"),
    ];
    for (change, expected) in cases {
        assert_eq!(line(change).as_deref(), Some(expected));
    }
}

#[test]
fn files_merge_in_any_order_and_no_sample_twice() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, sums: &Sums| {
        let path = folder.path().join(name);
        sums.save(&path).unwrap();
        path
    };
    let [a, b, c] = [("a", 0..4), ("b", 4..6), ("c", 8..9)].map(|(n, s)| file(n, &some(s)));
    let forwards = merge(&[&a, &b, &c]).unwrap();
    assert_eq!(forwards.bytes().unwrap(), merge(&[&c, &b, &a]).unwrap().bytes().unwrap());
    assert_eq!(forwards.header.samples.to_string(), "0..6, 8..9");
    assert!(check_complete(&forwards.header.samples, 0..6).is_ok());
    let line = check_complete(&forwards.header.samples, 0..10).unwrap_err().to_string();
    assert_eq!(line, "samples 6..8, 9..10 are missing");

    let twice = file("twice", &some(3..5));
    let line = merge(&[&a, &c, &twice]).unwrap_err().to_string();
    assert!(line.starts_with("samples 3..4 are in both ") && line.ends_with("twice"), "{line}");
    let line = merge(&[&a, &a]).unwrap_err().to_string();
    assert!(line.starts_with("samples 0..4 are in both "), "{line}");

    let mut other = some(4..6);
    other.header.origin.settings.insert("seed".to_owned(), "1".to_owned());
    let line = merge(&[&a, &file("other", &other)]).unwrap_err().to_string();
    assert!(line.contains("other does not fit: 'seed' is '0' in ") && line.contains("'1' in "));

    let mut huge = some(4..6);
    huge.values[0] = i128::MAX;
    let line = merge(&[&a, &file("huge", &huge)]).unwrap_err().to_string();
    assert!(line.ends_with("huge: is damaged: a sum is larger than its samples can be"), "{line}");
    let line = huge.add(&some(0..4)).unwrap_err();
    assert_eq!(line, "sums too large to be those of colours");
}

#[test]
fn a_mean_is_rounded_once() {
    // The mean of 2^k equal samples, or of three, is the sample; ties go to even, computed by hand.
    for value in [1.0f32, 0.1, 1e-9, 3.4e9, -0.3, f32::EPSILON] {
        let sum = (f64::from(value) * 2f64.powi(FRACTION)) as i128;
        for count in [1u64, 3, 4096, 1 << 31] {
            assert_eq!(quotient(sum * i128::from(count), count), value, "{value}, {count}");
        }
    }
    let one = 1i128 << FRACTION;
    let ulp = one >> 23;
    assert_eq!(quotient(one + ulp / 2, 1), 1.0);
    assert_eq!(quotient(one + ulp / 2 + 1, 1), 1.0f32.next_up());
    assert_eq!(quotient(one + ulp + ulp / 2, 1), 1.0f32.next_up().next_up());
    assert_eq!(quotient(-(one + ulp + ulp / 2), 1), -1.0f32.next_up().next_up());
    assert_eq!(quotient(2 * one - 1, 1), 2.0);
    // A third of it: the remainder of the division decides.
    assert_eq!(quotient(3 * (one + ulp / 2) + 1, 3), 1.0f32.next_up());
    assert_eq!(quotient(one, 3), (1.0f64 / 3.0) as f32);
    assert_eq!((quotient(0, 5), quotient(1, 1 << 32)), (0.0, 2f32.powi(-96)));
    assert_eq!(quotient(i128::MIN, 1), -(2f32.powi(63)));
}
