//! `completions` and `man`: completions for shells, and manual pages.

use std::path::{Path, PathBuf};

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use super::{Cli, Result, summarize, write, write_file};

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

pub(super) fn completions(args: &Completions) -> Result<()> {
    // Clap's script for bash splits labels at two underscores, which it also writes for a hyphen,
    // and then finds none of its labels: it is made for a name without a hyphen.
    let plain = NAME.replace('-', "");
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), &plain, &mut script);
    write(String::from_utf8(script)?.replace(&plain, NAME).as_bytes())
}

pub(super) fn man(args: &ManPages) -> Result<()> {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let Some(folder) = &args.out else { return write(&page(command)?) };
    let count = pages(command, folder)?;
    summarize(&format!("{count} pages in {}\n", folder.display()))
}

/// Writes the page of a command and those of its subcommands; returns their number.
fn pages(command: Command, folder: &Path) -> Result<usize> {
    let mut count = 1;
    for subcommand in command.get_subcommands() {
        count += pages(subcommand.clone(), folder)?;
    }
    let path = folder.join(page_name(&command)).with_extension("1");
    write_file(&path, &page(command)?)?;
    Ok(count)
}

fn page(command: Command) -> Result<Vec<u8>> {
    let title = page_name(&command).to_uppercase();
    let mut text = Vec::new();
    Man::new(command).title(title).render(&mut text)?;
    Ok(text)
}

/// The name of a manual page, with hyphens for spaces.
fn page_name(command: &Command) -> String {
    command.get_bin_name().unwrap_or(NAME).replace(' ', "-")
}
