//! Finds imports that go in circles: `circles FOLDER…` reads the sources of a crate in each folder.
//!
//! Fails on a circle among the modules of one folder that goes through a folder, with the imports
//! that close it. Of files alone it prints those in circles. Needs nothing but rustc, so that the
//! gate can run it first. Tests are left out, and names that a module passes on are followed to
//! where they are defined.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{env, fs, process};

/// The path of a module from the root of its crate.
type Module = Vec<String>;

/// A file, without its tests.
#[derive(Default)]
struct Source {
    file: PathBuf,
    /// Paths with their lines, those of imports with the name that each has here.
    uses: Vec<(Module, Option<String>, usize)>,
}

/// An import from one file of another.
struct Arrow {
    from: Module,
    to: Module,
    line: usize,
}

fn main() {
    let mut failed = false;
    for root in env::args().skip(1) {
        let sources = read(Path::new(&root));
        let arrows = arrows(&sources);
        let is_folder = |module: &Module| {
            sources.keys().any(|other| other.len() > module.len() && other.starts_with(module))
        };
        let mut folders: BTreeMap<Module, BTreeSet<(Module, Module)>> = BTreeMap::new();
        let mut files = BTreeSet::new();
        for arrow in &arrows {
            if let Some((folder, from, to)) = siblings(arrow) {
                folders.entry(folder).or_default().insert((from, to));
                files.insert((arrow.from.clone(), arrow.to.clone()));
            }
        }
        let show = |circle: &BTreeSet<Module>| {
            let closing = |arrow: &&Arrow| {
                let ends = siblings(arrow).map(|(_, from, to)| [from, to]);
                let files = [arrow.from.clone(), arrow.to.clone()];
                [Some(files), ends]
                    .iter()
                    .flatten()
                    .any(|ends| ends.iter().all(|end| circle.contains(end)))
            };
            let line = |Arrow { from, to, line }: &Arrow| {
                format!("    {}:{line}: {}", sources[from].file.display(), to.join("::"))
            };
            for line in arrows.iter().filter(closing).map(line).collect::<BTreeSet<_>>() {
                println!("{line}");
            }
        };
        let of_files = circles(&files);
        let count: usize = of_files.iter().map(BTreeSet::len).sum();
        println!("{root}: {} files, {count} in circles", sources.len());
        of_files.iter().for_each(show);
        for circle in folders.values().flat_map(circles).filter(|all| all.iter().any(is_folder)) {
            failed = true;
            let names: Vec<String> = circle.iter().map(|module| module.join("::")).collect();
            println!("{root}: modules in a circle, {}, closed by", names.join(", "));
            show(&circle);
        }
    }
    process::exit(failed.into());
}

/// The folder in which the modules of two files part, and those modules; `None` if one holds the
/// other, which need not be one-way.
fn siblings(arrow: &Arrow) -> Option<(Module, Module, Module)> {
    let Arrow { from, to, .. } = arrow;
    let same = from.iter().zip(to).take_while(|(a, b)| a == b).count();
    let part = |module: &Module| module.get(..=same).map(<[String]>::to_vec);
    Some((from[..same].to_vec(), part(from)?, part(to)?))
}

fn read(root: &Path) -> BTreeMap<Module, Source> {
    let (mut sources, mut folders) = (BTreeMap::new(), vec![root.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of sources").flatten() {
            let file = entry.path();
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if name == "tests" {
                continue;
            } else if file.is_dir() {
                folders.push(file);
            } else if file.extension().is_some_and(|end| end == "rs") {
                let parents = folder.strip_prefix(root).expect("below the root");
                let parents = parents.iter().map(|part| part.to_string_lossy().into_owned());
                let own = Some(name).filter(|name| !matches!(&name[..], "lib" | "main" | "mod"));
                let module: Module = parents.chain(own).collect();
                let text = fs::read_to_string(&file).expect("a file of text");
                let source: &mut Source = sources.entry(module).or_default();
                source.file = file;
                source.add(&text);
            }
        }
    }
    sources
}

impl Source {
    fn add(&mut self, text: &str) {
        let tokens = tokens(without_tests(text));
        let mut i = 0;
        while i < tokens.len() {
            let (token, line) = &tokens[i];
            if token == "use" {
                i = self.tree(&tokens, i + 1, &[]);
            } else if is_name(token) && tokens.get(i + 1).is_some_and(|next| next.0 == "::") {
                let mut path = vec![token.clone()];
                while let [(colons, _), (name, _), ..] = &tokens[i + 1..]
                    && colons == "::"
                    && is_name(name)
                {
                    path.push(name.clone());
                    i += 2;
                }
                self.uses.push((path, None, *line));
            }
            i += 1;
        }
    }

    /// One tree of an import from token i on; the place of the token that ends it.
    fn tree(&mut self, tokens: &[(String, usize)], mut i: usize, before: &[String]) -> usize {
        let mut path = before.to_vec();
        let line = tokens[i].1;
        loop {
            match &tokens[i].0[..] {
                "{" => {
                    while tokens[i].0 != "}" {
                        i = self.tree(tokens, i + 1, &path);
                    }
                    return i + 1;
                }
                "::" => i += 1,
                "as" => {
                    self.uses.push((path, Some(tokens[i + 1].0.clone()), line));
                    return i + 2;
                }
                name if is_name(name) || name == "*" => {
                    if name != "self" || path.is_empty() {
                        path.push(name.into());
                    }
                    i += 1;
                }
                _ => {
                    let name = path.last().cloned();
                    self.uses.push((path, name, line));
                    return i;
                }
            }
        }
    }
}

/// What stands before the module of tests, if it is in this file: that is the last item.
fn without_tests(text: &str) -> &str {
    let starts = text.match_indices("#[cfg(test)]\nmod ");
    let mut inline = starts.filter(|(at, _)| {
        text[*at..].find(['{', ';']).is_some_and(|end| text[at + end..].starts_with('{'))
    });
    inline.next().map_or(text, |(at, _)| &text[..at])
}

/// The length of a literal of a character at the start of a text; of a lifetime's mark, 1.
fn character(text: &str) -> usize {
    let mut inner = text[1..].chars();
    match (inner.next(), inner.next()) {
        (Some('\\'), _) => text[3..].find('\'').map_or(1, |end| end + 4),
        (Some(c), Some('\'')) => c.len_utf8() + 2,
        _ => 1,
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names and punctuation with their lines, without comments and literals.
fn tokens(text: &str) -> Vec<(String, usize)> {
    let (mut tokens, mut line, mut rest) = (Vec::new(), 1, text);
    while let Some(c) = rest.chars().next() {
        let name = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let length = match c {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '"' => {
                let mut escaped = false;
                let end = rest[1..].find(|c| {
                    let ends = c == '"' && !escaped;
                    escaped = c == '\\' && !escaped;
                    ends
                });
                end.map_or(rest.len(), |end| end + 2)
            }
            'r' if rest.starts_with("r#\"") => rest.find("\"#").map_or(rest.len(), |end| end + 2),
            '\'' => character(rest),
            ':' if rest.starts_with("::") => 2,
            _ if name > 0 => name,
            _ => c.len_utf8(),
        };
        let token = &rest[..length];
        let is_literal = matches!(c, '"' | '\'') || token.starts_with("r#");
        if !c.is_whitespace() && !is_literal && !token.starts_with("//") {
            tokens.push((token.to_owned(), line));
        }
        line += token.matches('\n').count();
        rest = &rest[length..];
    }
    tokens
}

/// All imports, each to the file that defines the name.
fn arrows(sources: &BTreeMap<Module, Source>) -> Vec<Arrow> {
    let mut arrows = Vec::new();
    for (from, source) in sources {
        for (path, _, line) in &source.uses {
            if let Some(to) = defined(sources, from, path, 0)
                && to != *from
            {
                arrows.push(Arrow { from: from.clone(), to, line: *line });
            }
        }
    }
    arrows
}

/// The module whose file defines what a path in a module names; `None` if that is another crate.
fn defined(
    sources: &BTreeMap<Module, Source>,
    from: &Module,
    path: &[String],
    depth: usize,
) -> Option<Module> {
    let (mut module, mut rest) = (from.clone(), path);
    match &path.first()?[..] {
        "crate" => (module, rest) = (Module::new(), &path[1..]),
        "self" => rest = &path[1..],
        "super" => {
            while let Some(("super", after)) = rest.split_first().map(|(a, b)| (&a[..], b)) {
                module.pop();
                rest = after;
            }
        }
        name => {
            let child = [&from[..], &[name.to_owned()]].concat();
            sources.get(&child)?;
        }
    }
    while let Some((name, after)) = rest.split_first() {
        let child = [&module[..], std::slice::from_ref(name)].concat();
        if !sources.contains_key(&child) {
            break;
        }
        (module, rest) = (child, after);
    }
    let passed = |name: &String| {
        let source = sources.get(&module)?;
        let (path, ..) = source.uses.iter().find(|(_, known, _)| known.as_ref() == Some(name))?;
        defined(sources, &module, path, depth + 1)
    };
    match rest.first() {
        Some(name) if depth < 8 => passed(name).or(Some(module)),
        _ => Some(module),
    }
}

/// The sets of two or more that lead to each other.
fn circles(arrows: &BTreeSet<(Module, Module)>) -> Vec<BTreeSet<Module>> {
    let reached = |from: &Module| {
        let (mut seen, mut ahead) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(at) = ahead.pop() {
            for (_, to) in arrows.iter().filter(|(from, _)| *from == at) {
                if seen.insert(to.clone()) {
                    ahead.push(to.clone());
                }
            }
        }
        seen
    };
    let all: BTreeMap<Module, BTreeSet<Module>> =
        arrows.iter().map(|(from, _)| (from.clone(), reached(from))).collect();
    let mut circles: Vec<BTreeSet<Module>> = Vec::new();
    for (module, reach) in &all {
        let back = |other: &&Module| all.get(*other).is_some_and(|others| others.contains(module));
        let circle: BTreeSet<Module> = reach.iter().filter(back).cloned().collect();
        if circle.len() > 1 && !circles.contains(&circle) {
            circles.push(circle);
        }
    }
    circles
}
