//! Runs a study by name, or lists them.

use std::process::ExitCode;

use microfacet_study::STUDIES;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next();
    let Some(study) = STUDIES.iter().find(|study| Some(study.name) == name.as_deref()) else {
        match &name {
            Some(name) => eprintln!("no study `{name}`; there are"),
            None => eprintln!("name a study:"),
        }
        STUDIES.iter().for_each(|study| eprintln!("  {:19} {}", study.name, study.what));
        return ExitCode::from(2);
    };
    match (study.run)(&arguments.collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}
