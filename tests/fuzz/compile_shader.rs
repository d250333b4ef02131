//! Compiles the shader that is named, below the folder that `SHADERS` names, as the driver computes and as
//! badly as Vulkan allows: 1 and a line if that fails.

use std::process::ExitCode;

use common::app::finish;
use common::gpu::Arithmetic;
use common::gpu::shader::compile_with;

fn main() -> ExitCode {
    finish(|| {
        let path = std::env::args().nth(1).expect("the path of a shader");
        let ways = [Arithmetic::Driver, Arithmetic::Worst];
        ways.into_iter().try_for_each(|way| compile_with(&path, &[], way).map(drop))
    })
}
