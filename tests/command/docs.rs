//! The pages say what the code does.

use std::fs;
use std::path::{Path, PathBuf};

use microfacet_report::plot::FIGURES;
use microfacet_study::STUDIES;
use microfacet_tables::{Kind, Mapping};

use crate::common::{flat, has};

#[test]
fn the_page_of_the_format_has_every_mapping_and_its_formula() {
    let page = flat(include_str!("../../docs/format.md"));
    for mapping in Mapping::EVERY {
        has(&page, &[&format!("`{}`", mapping.name()), &flat(mapping.formula())]);
    }
}

#[test]
fn the_page_of_the_format_is_of_this_version() {
    let page = include_str!("../../docs/format.md");
    let title = format!("# The table format, version {}\n", microfacet_tables::VERSION);
    assert!(page.starts_with(&title));
    for kind in Kind::ALL {
        has(page, &[&format!("`{}`", kind.name())]);
    }
}

/// Files below a folder whose name ends so.
fn files(folder: &Path, end: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, end, found);
        } else if path.to_str().is_some_and(|path| path.ends_with(end)) {
            found.push(path);
        }
    }
}

/// An example works where it is copied to: its vectors are those of the crate that it shows.
#[test]
fn no_example_asks_for_a_crate_of_vectors() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = ["README.md", "crates/sampler/README.md", "crates/model/README.md"]
        .map(|at| root.join(at))
        .into();
    files(&root.join("docs"), ".md", &mut all);
    files(&root.join("crates/tables/src"), ".rs", &mut all);
    files(&root.join("crates/sampler/src"), ".rs", &mut all);
    files(&root.join("crates/model/src"), ".rs", &mut all);
    assert!(all.len() > 100, "{}", all.len());
    for path in all {
        let is_page = path.extension().is_some_and(|end| end == "md");
        for line in fs::read_to_string(&path).unwrap().lines() {
            let comment = line.trim_start().strip_prefix("//").unwrap_or("");
            let shown = if is_page { line } else { comment.trim_start_matches(['/', '!']) };
            let code = shown.trim_start_matches(['#', ' ']);
            assert!(!code.starts_with("use glam::"), "{}: {line}", path.display());
        }
    }
}

/// The word after another in a command.
fn after<'a>(command: &'a str, word: &str) -> Option<&'a str> {
    let mut words = command.split_whitespace().skip_while(|each| *each != word);
    words.nth(1)
}

#[test]
fn the_page_of_what_was_reproduced_has_whole_rows_and_commands_that_there_are() {
    let page = include_str!("../../docs/reproduced.md");
    assert!(!page.contains('@'), "docs/reproduced.md: something is to be filled in");
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with('|') && !line.starts_with("| --"))
        .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect())
        .collect();
    assert!(rows.iter().filter(|row| row[0] == "claim").count() == 3 && rows.len() > 40);
    let mut figures = Vec::new();
    for row in rows {
        let whole = row.len() == 4 && row.iter().all(|cell| !cell.is_empty());
        assert!(whole, "docs/reproduced.md: {row:?}");
        // Between backticks are commands.
        for command in row[1].split('`').skip(1).step_by(2) {
            if command.contains("microfacet-study") {
                let name = after(command, "--").unwrap_or_default();
                let found = STUDIES.iter().any(|study| study.name == name);
                assert!(found, "docs/reproduced.md: no study {name}");
            }
            figures.extend(after(command, "plot"));
        }
    }
    for listed in FIGURES {
        assert!(figures.contains(&listed.name), "docs/reproduced.md: no {}", listed.name);
    }
    let known = FIGURES.map(|listed| listed.name);
    assert!(figures.iter().all(|figure| known.contains(figure)), "{figures:?}");
}

/// Commands that stand in a line of text have options that there are; `.ci/commands` runs those of
/// fences.
#[test]
fn commands_in_the_text_of_pages_have_options_that_there_are() {
    let help: Vec<(&str, &str)> = include_str!("help.txt")
        .split("\n$ ")
        .filter_map(|page| page.split_once(" --help\n"))
        .collect();
    let mut wrong = Vec::new();
    let mut pages = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")];
    files(&pages[0].with_file_name("docs"), ".md", &mut pages);
    let mut count = 0;
    for path in pages {
        let text = flat(&fs::read_to_string(&path).unwrap());
        for span in text.split('`').skip(1).step_by(2) {
            let starts = ["microfacet-bake ", "cargo run --release -- "];
            let Some(command) = starts.iter().find_map(|start| span.strip_prefix(start)) else {
                continue;
            };
            let words: Vec<&str> = command.split_whitespace().collect();
            // The longest name of a subcommand.
            let named = |count: usize| {
                let name = words.get(..count)?.join(" ");
                help.iter().find(|(of, _)| *of == name).map(|(_, page)| page)
            };
            let page = named(2).or_else(|| named(1));
            let options = words.iter().filter(|word| word.starts_with("--") && word.len() > 2);
            for option in options {
                let is_known = page
                    .is_some_and(|page| page.split([' ', '\n', ',']).any(|word| word == *option));
                if !is_known && *option != "--help" {
                    wrong.push(format!("{}: {command}: {option}", path.display()));
                }
                count += 1;
            }
        }
    }
    assert!(wrong.is_empty() && count > 20, "{count}: {wrong:#?}");
}
