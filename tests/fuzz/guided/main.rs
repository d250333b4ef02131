//! One of the readers of this process, guided by what its code does with an input: `FUZZ_READER` names it.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use fuzz::format::Function;
use fuzz::formats::FUNCTIONS;
use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;

struct Reader {
    _folder: TempDir,
    file: PathBuf,
    function: Function,
}

static READER: LazyLock<Reader> = LazyLock::new(|| {
    let name = std::env::var("FUZZ_READER").unwrap_or_default();
    let names = FUNCTIONS.map(|(format, ..)| format.name).join(", ");
    let known = FUNCTIONS.into_iter().find(|(format, ..)| format.name == name);
    let (format, function, _) = known.unwrap_or_else(|| panic!("FUZZ_READER is one of {names}"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    (function.beside)(folder.path());
    Reader { file: folder.path().join(format.file), _folder: folder, function }
});

fuzz_target!(|input: &[u8]| {
    std::fs::write(&READER.file, input).expect("an input can be written");
    if let Err(error) = (READER.function.read)(&READER.file) {
        let line = format!("{error:#}");
        assert!(!line.trim().is_empty() && !line.contains('\n'), "no line: {line:?}");
    }
});
