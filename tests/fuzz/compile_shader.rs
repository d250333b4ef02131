//! Compiles the shader that is named, below the folder that `SHADERS` names, as the driver computes and as
//! badly as Vulkan allows: 1 and a line if that fails.

use std::process::ExitCode;

use common::app::output::complain;
use common::gpu::Arithmetic;
use common::gpu::shader::compile_with;

fn main() -> ExitCode {
    let path = std::env::args().nth(1).expect("the path of a shader");
    let compiled = [Arithmetic::Driver, Arithmetic::Worst]
        .into_iter()
        .try_for_each(|arithmetic| compile_with(&path, &[], arithmetic).map(drop));
    match compiled {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&format!("error: {error:#}"));
            ExitCode::FAILURE
        }
    }
}
