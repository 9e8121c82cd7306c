//! The parser of the command line: what the subcommands declare, options that are refused with what
//! to use instead, and negative numbers.

use std::any::TypeId;
use std::path::PathBuf;

use clap::builder::UnknownArgumentValueParser;
use clap::{Arg, Command, CommandFactory};

use microfacet_baker::scene::did_you_mean_key;

use super::{Cli, values};

/// Options that describe a material.
const MATERIAL: [&str; 6] = ["sigma", "gamma", "alpha", "roughness", "theta", "fresnel"];
/// Other names of σ.
const NAMES: [&str; 3] = ["alpha", "roughness", "m"];

pub(super) fn command() -> Command {
    hyphens(Cli::command().mut_subcommands(|command| match command.get_name() {
        "validate" | "sample" | "furnace" => command.args(NAMES.map(other_name)),
        "query" => command.mut_subcommands(|quantity| quantity.args(NAMES.map(other_name))),
        "fit" => command.arg(bare_file()),
        "bake" | "plan" => command.args(MATERIAL.map(|name| {
            let hint = "materials are described in a file: `microfacet-bake recipe` prints one to \
                        start from";
            refused(name, hint)
        })),
        "export" => command.mut_subcommands(|target| match target.get_name() {
            "lut" => target.arg(largest_gamma()),
            _ => target.args(["sigma", "alpha", "roughness"].map(|name| {
                let hint = "an export serves every roughness: its functions take sigma as an \
                            argument";
                refused(name, hint)
            })),
        }),
        _ => command,
    }))
}

fn other_name(name: &'static str) -> Arg {
    let hint = did_you_mean_key(name, &["--sigma"]).replace('`', "");
    let refused = refused(name, hint.trim_start_matches("; "));
    // The error shows the short form, however many dashes were typed.
    if name == "m" { refused.long(None).short('m').alias("m") } else { refused }
}

/// An option of which no value is accepted.
fn refused(name: &'static str, hint: &str) -> Arg {
    let parser = UnknownArgumentValueParser::suggest(hint.to_owned());
    Arg::new(name).long(name).hide(true).value_name("X").value_parser(parser)
}

/// A file without the option that says what it is.
fn bare_file() -> Arg {
    let which = |file: &str| -> Result<String, String> {
        let option = if file.ends_with(".binary") { "--merl" } else { "--input" };
        Err(format!(
            "write {option} before it: --input reads a CSV of angles and D, --merl files of the \
             MERL database"
        ))
    };
    Arg::new("file").value_name("FILE").hide(true).value_parser(which)
}

/// The end of a range of shapes, which is always infinity.
fn largest_gamma() -> Arg {
    let infinite = |text: &str| match values::gamma(text) {
        Ok(f64::INFINITY) => Ok(f64::INFINITY),
        _ => Err("a range of shapes goes from --gamma-min to infinity: leave out --gamma-max"),
    };
    let arg = Arg::new("gamma_max").long("gamma-max").hide(true).value_name("G");
    arg.requires("gamma_min").value_parser(infinite)
}

/// Lets values of options begin with a minus; paths like a number only, since a forgotten path must
/// not take the option after it.
fn hyphens(command: Command) -> Command {
    let of = |arg: Arg| match arg.get_value_parser().type_id() == TypeId::of::<PathBuf>() {
        _ if arg.get_long().is_none() || !arg.get_action().takes_values() => arg,
        true => arg.allow_negative_numbers(true),
        false => arg.allow_hyphen_values(true),
    };
    command.mut_args(of).mut_subcommands(hyphens)
}
