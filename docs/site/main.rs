//! Makes a website of the book; see the library.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

/// Makes a website of the book, to be read from a file or from any folder of a server
#[derive(Debug, Parser)]
#[command(name = "site", disable_version_flag = true)]
struct Arguments {
    /// Folder for it, which this command made before, or which is empty or new [default: book]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,

    /// The project's root
    #[arg(long, value_name = "DIR", default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../.."), hide_default_value = true)]
    root: PathBuf,
}

fn main() -> ExitCode {
    let Arguments { out, root } = Arguments::parse();
    let out = out.unwrap_or_else(|| root.join("book"));
    signals::watch(|_| {
        site::output::abandon();
        eprintln!("error: stopped by a signal");
        std::process::exit(1)
    });
    match site::output::replace(&out, |made| site::build(&root, made)) {
        Ok(site::Counts { pages, code, pictures, formulas, sliders, figures }) => {
            println!(
                "{}: {pages} pages, {code} of code; {pictures} pictures, {formulas} formulas, {sliders} sliders, \
                 {figures} figures",
                out.join("index.html").display()
            );
            ExitCode::SUCCESS
        }
        Err(error) => {
            for line in format!("{error:#}").lines() {
                eprintln!("error: {line}");
            }
            ExitCode::FAILURE
        }
    }
}
