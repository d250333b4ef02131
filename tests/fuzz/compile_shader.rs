//! Compiles the named shader, below the folder in `SHADERS`, for the driver's arithmetic and for the worst
//! that Vulkan allows; exits with 1 and a message if that fails.

use std::process::ExitCode;

use common::exit::finish;
use common::gpu::DriverShim;
use common::gpu::shader::Shader;
use instruments::arithmetic::Arithmetic;

fn main() -> ExitCode {
    finish(|| {
        let path = std::env::args().nth(1).expect("the path of a shader");
        let ways = [Arithmetic::Driver, Arithmetic::Worst];
        ways.iter().try_for_each(|way| Shader::of(&path, &[], |stage| way.words(&stage)).map(drop))
    })
}
