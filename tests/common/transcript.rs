//! Transcripts: command lines, the files that they are given, and what they answer, word for word.
//!
//! A transcript is a text file beside the tests. Of its lines,
//!
//! - `# WORDS` is a heading: what follows begins in a new, empty folder;
//! - `-- NAME --` begins a file of that folder, up to the next such line or command, but for the
//!   end of its last line; `-- NAME/ --` is a folder;
//! - `$ LINE` is a command line, without quotes;
//! - `> `, `! ` and `? ` begin what it answered: standard output, standard error, and the exit
//!   status if that is not 0.
//!
//! A heading follows a command, since it would be a line of a file that it followed.
//! What was answered is compared, all else is input. A difference is printed as a diff;
//! `SNAPSHOTS=overwrite cargo test` writes the new words in place of the old ones, to be read in
//! `git diff`.

use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use snapbox::{Assert, Data};
use tempfile::tempdir;

/// Lines of an answer, each after a mark; the last line of an output ends as well.
pub(crate) fn marked(mark: char, text: &str) -> String {
    assert!(text.is_empty() || text.ends_with('\n'), "the last line has no end: {text}");
    let line = |line: &str| format!("{mark} {line}").trim_end().to_owned() + "\n";
    text.lines().map(line).collect()
}

fn is_answer(line: &str) -> bool {
    [">", "!", "?"].contains(&line.split(' ').next().unwrap_or_default())
}

/// The transcript with the answers of today.
fn replayed(text: &str, answer: impl Fn(&Path, &str) -> String) -> String {
    let mut folder = tempdir().unwrap();
    let (mut told, mut commands) = (String::new(), 0);
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if is_answer(line) {
            continue;
        }
        told += &format!("{line}\n");
        if let Some(name) = line.strip_prefix("-- ").and_then(|rest| rest.strip_suffix(" --")) {
            let mut content = Vec::new();
            let inside = |line: &&str| !line.starts_with("-- ") && !line.starts_with("$ ");
            while let Some(line) = lines.next_if(inside) {
                content.push(line);
            }
            let path = folder.path().join(name);
            fs::create_dir_all(if name.ends_with('/') { &path } else { path.parent().unwrap() })
                .unwrap();
            if !name.ends_with('/') {
                fs::write(path, content.join("\n")).unwrap();
            }
            content.iter().for_each(|line| told += &format!("{line}\n"));
        } else if let Some(command) = line.strip_prefix("$ ") {
            commands += 1;
            told += &answer(folder.path(), command);
        } else if line.starts_with("# ") {
            folder = tempdir().unwrap();
        } else {
            assert!(!line.starts_with(['$', '-']), "neither a command nor a file: {line}");
        }
    }
    assert!(commands > 0, "no command");
    told
}

/// Replays the transcripts in a folder of `tests`.
pub(crate) fn replay(folder: &str, answer: impl Fn(&Path, &str) -> String + Sync) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let transcripts: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|end| end == "txt")).collect();
    assert!(!transcripts.is_empty());
    transcripts.par_iter().for_each(|path| {
        let told = replayed(&fs::read_to_string(path).unwrap(), &answer);
        Assert::new().action_env("SNAPSHOTS").eq(told, Data::read_from(path, None).raw());
    });
}
