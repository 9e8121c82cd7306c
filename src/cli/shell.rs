//! `completions` and `man`: what a shell and its reader know about this command.

use std::path::{Path, PathBuf};

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use microfacet_bake::store::replace;

use super::{Cli, Done, Failure, Outcome, summarize, write};

/// The name under which a shell finds this command.
const NAME: &str = "microfacet-bake";

/// Print the completions of a shell.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    microfacet-bake completions bash > ~/.local/share/bash-completion/completions/microfacet-bake\n  \
    microfacet-bake completions fish > ~/.config/fish/completions/microfacet-bake.fish")]
pub(super) struct Completions {
    /// The shell.
    shell: Shell,
}

/// Print the manual page, or write one for each subcommand.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    microfacet-bake man | man -l -\n  \
    microfacet-bake man --out ~/.local/share/man/man1")]
pub(super) struct ManPages {
    /// Existing folder to write all pages into, as microfacet-bake.1, microfacet-bake-plan.1 and
    /// so on.
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn completions(args: Completions) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), NAME, &mut script);
    write(&script)?;
    Ok(Done::Ok)
}

pub(super) fn man(args: ManPages) -> Outcome {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    match args.out {
        None => write(&page(command)?)?,
        Some(folder) => {
            let count = pages(command, &folder)?;
            summarize(&format!("{count} pages in {}\n", folder.display()))?;
        }
    }
    Ok(Done::Ok)
}

/// Writes the page of a command and those of its subcommands; returns their number.
fn pages(command: Command, folder: &Path) -> Result<usize, Failure> {
    let mut count = 1;
    for subcommand in command.get_subcommands() {
        count += pages(subcommand.clone(), folder)?;
    }
    let name = command.get_bin_name().unwrap_or(NAME).replace(' ', "-");
    let path = folder.join(name).with_extension("1");
    replace(&path, &page(command)?).map_err(|why| format!("{}: {why}", path.display()))?;
    Ok(count)
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    // A page is found by its name, in which hyphens take the place of spaces.
    let name = command.get_bin_name().unwrap_or(NAME).replace(' ', "-");
    let mut text = Vec::new();
    Man::new(command).title(name.to_uppercase()).render(&mut text)?;
    Ok(text)
}
