//! The program `afu`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
