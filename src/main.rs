//! The `microfacet-bake` command: parses, dispatches, and turns the result into an exit code.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
