//! What holds for every subcommand and option, read from their declarations.

use std::any::TypeId;
use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Arg;
use clap::error::ErrorKind;

use super::*;

/// Every subcommand that has none itself, after the words that lead to it.
fn leaves(command: &clap::Command, path: &[String]) -> Vec<(Vec<String>, clap::Command)> {
    let path = [path, &[command.get_name().to_owned()]].concat();
    let children = command.get_subcommands().filter(|child| child.get_name() != "help");
    let below: Vec<_> = children.flat_map(|child| leaves(child, &path)).collect();
    if below.is_empty() { vec![(path, command.clone())] } else { below }
}

fn built() -> clap::Command {
    let mut command = parser::command();
    command.build();
    command
}

/// Options with a value, each after its subcommand.
fn options() -> Vec<(Vec<String>, Arg)> {
    let takes_value = |arg: &&Arg| {
        arg.get_long().is_some() && arg.get_action().takes_values() && !arg.is_hide_set()
    };
    let of = |(path, leaf): (Vec<String>, clap::Command)| -> Vec<_> {
        let args = leaf.get_arguments().filter(takes_value);
        args.map(|arg| (path.clone(), arg.clone())).collect()
    };
    leaves(&built(), &[]).into_iter().flat_map(of).collect()
}

fn is<T: 'static>(arg: &Arg) -> bool {
    arg.get_value_parser().type_id() == TypeId::of::<T>()
}

fn is_number(arg: &Arg) -> bool {
    is::<f64>(arg) || is::<[f64; 2]>(arg) || is::<u64>(arg) || is::<usize>(arg)
}

fn refusal(path: &[String], option: &str, value: &str) -> Option<clap::Error> {
    let words = path.iter().map(String::as_str).chain([option, value]);
    parser::command().try_get_matches_from(words).err()
}

#[test]
fn declarations_are_consistent() {
    parser::command().debug_assert();
}

#[test]
fn what_begins_like_a_negative_number_is_the_value_of_any_option() {
    let (mut tried, mut numbers) = (0, 0);
    for (path, arg) in options() {
        let option = format!("--{}", arg.get_long().unwrap());
        // A path may only be like a whole number: else it would take the next option.
        let values = ["-1", "-1e-3", "-.5", "-inf", "-0.3,0.5", "-nan"];
        for value in &values[..if is::<PathBuf>(&arg) { 1 } else { 6 }] {
            // Where nothing is wrong with the value, other options may be missing.
            let Some(error) = refusal(&path, &option, value) else { continue };
            let text = error.to_string();
            assert_ne!(error.kind(), ErrorKind::UnknownArgument, "{path:?}: {text}");
            assert!(!text.contains("a value is required"), "{path:?}: {text}");
            tried += 1;
            if is_number(&arg) && error.kind() == ErrorKind::ValueValidation {
                // A list names the one of its values that is wrong.
                let first = value.split(',').next().unwrap();
                let named = text.contains(&option) && text.contains(&format!("'{first}"));
                assert!(named && text.contains(" must "), "{path:?}: {text}");
                numbers += 1;
            }
        }
    }
    assert!(tried > 200 && numbers > 100, "{tried} {numbers}");
}

/// The messages of Rust's parsers name neither the range nor the fix.
#[test]
fn no_option_of_a_number_answers_with_the_message_of_a_parser() {
    let numbers: Vec<_> = options().into_iter().filter(|(_, arg)| is_number(arg)).collect();
    assert!(numbers.len() > 25, "{}", numbers.len());
    for (path, arg) in numbers {
        let option = format!("--{}", arg.get_long().unwrap());
        for value in ["many", "", "1e999999x", "nan"] {
            let error = refusal(&path, &option, value).expect("no number");
            let text = error.to_string();
            assert_eq!(error.kind(), ErrorKind::ValueValidation, "{path:?}: {text}");
            assert!(
                text.contains(" must ")
                    && !text.contains("invalid digit")
                    && !text.contains("literal"),
                "{path:?}: {text}"
            );
        }
    }
}

/// One name of the value for the same option, wherever it is, and `-o` for every `--out`.
#[test]
fn the_same_option_has_the_same_value_everywhere() {
    // Lists, and options that name different things.
    const DIFFER: [&str; 7] = ["sigma", "gamma", "eta", "method", "out", "tables", "cache"];
    let mut seen: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, arg) in options() {
        let Some(long) = arg.get_long().filter(|long| !DIFFER.contains(long)) else { continue };
        let names = arg.get_value_names().unwrap_or_default();
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        let first = seen.entry(long.to_owned()).or_insert_with(|| names.clone());
        assert_eq!(*first, names, "{path:?} --{long}");
    }
    assert!(seen.len() > 20);
    let of = |long: &'static str| {
        options().into_iter().filter(move |(_, arg)| arg.get_long() == Some(long))
    };
    assert!(of("out").map(|(_, arg)| assert_eq!(arg.get_short(), Some('o'))).count() >= 4);
    assert_eq!(of("output").count(), 0);
    for (path, arg) in of("tables") {
        assert_eq!(arg.get_value_names().unwrap(), ["TABLES"], "{path:?}");
    }
    for subcommand in ["inspect", "validate", "furnace"] {
        let command = built();
        let command = command.find_subcommand(subcommand).unwrap();
        let first = command.get_positionals().next().unwrap();
        assert_eq!(first.get_value_names().unwrap(), ["TABLES"], "{subcommand}");
    }
}

#[test]
fn every_subcommand_has_examples_that_parse() {
    for child in built().get_subcommands().filter(|child| child.get_name() != "help") {
        let name = child.get_name();
        let help = child.get_after_help().unwrap_or_default().to_string();
        let examples: Vec<&str> =
            help.lines().filter_map(|line| line.split("microfacet-bake ").nth(1)).collect();
        assert!(!examples.is_empty(), "{name}");
        for example in examples {
            // Words after a pipe or a redirection belong to the shell.
            let ours = example.split_whitespace().take_while(|word| !["|", ">"].contains(word));
            let words = ["microfacet-bake"].into_iter().chain(ours);
            let error = parser::command().try_get_matches_from(words).err();
            assert!(error.is_none(), "{example}: {}", error.unwrap());
        }
    }
}
