//! The tables as the last argument of the functions that read them, in place of a binding of the
//! module: for programs that bind by themselves. Metal's translation has them so already.

/// The name of the tables.
const TABLES: &str = "student_t_tables";

/// A module that reads a texture, and a program that uses it, as text; what declares the texture
/// moves from the one to the other.
pub(super) fn as_argument(module: &str, program: &str) -> [String; 2] {
    let is_declared = |line: &&str| line.contains(TABLES) && line.trim_end().ends_with(';');
    let at_start = |line: &&str| !line.starts_with([' ', '/']);
    let declared = module.lines().filter(at_start).find(is_declared).expect("a declaration");
    let parameter = parameter(declared);
    let readers = readers(module, declared);
    let module = module.replacen(&format!("{declared}\n"), "", 1);
    let module = with_tables(&module, &readers, parameter);
    let program = with_tables(program, &readers, parameter);
    // After what makes the module part of the program.
    let start = program
        .rfind("#include")
        .map_or(0, |at| at + program[at..].find('\n').map_or(program.len() - at, |end| end + 1));
    let (before, after) = program.split_at(start);
    [module, format!("{before}\n{declared}\n{after}").trim_start().to_owned()]
}

/// A parameter of the same type as a declaration: without a binding before it.
fn parameter(declared: &str) -> &str {
    let found = ["var ", "uniform "].iter().find_map(|word| declared.split_once(word));
    found.expect("a texture").1.trim_end_matches(';')
}

/// The names of the functions that read the tables, or call one that does.
fn readers<'a>(module: &'a str, declared: &str) -> Vec<&'a str> {
    // Functions end at a brace in the first column, and begin with the last line there before it.
    let functions = module.split("\n}").filter_map(|text| {
        let head = text.lines().rfind(|line| {
            !line.starts_with(['/', '#', ' ']) && line.contains('(') && line != &declared
        })?;
        let (before, _) = head.split_once('(')?;
        let name = before.rsplit(' ').next()?;
        let body = &text[text.rfind(head)?..];
        name.starts_with("student_t_").then_some((name, body))
    });
    let functions: Vec<(&str, &str)> = functions.collect();
    let mut readers: Vec<&str> = Vec::new();
    loop {
        let more: Vec<&str> = functions
            .iter()
            .filter(|(name, _)| !readers.contains(name))
            .filter(|(_, body)| {
                body.contains(TABLES)
                    || readers.iter().any(|name| calls(body, name).next().is_some())
            })
            .map(|(name, _)| *name)
            .collect();
        if more.is_empty() {
            return readers;
        }
        readers.extend(more);
    }
}

/// Where a name stands before a parenthesis.
fn calls<'a>(text: &'a str, name: &'a str) -> impl Iterator<Item = usize> + 'a {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.match_indices(name).map(|(at, _)| at).filter(move |&at| {
        text[at + name.len()..].starts_with('(') && !text[..at].ends_with(is_part)
    })
}

/// Text in which these functions have, and get, one argument more.
fn with_tables(text: &str, readers: &[&str], parameter: &str) -> String {
    let mut ends: Vec<(usize, bool)> = Vec::new();
    for name in readers {
        for at in calls(text, name) {
            let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
            let before = &text[line..at];
            if before.contains("//") {
                continue;
            }
            let is_definition =
                before.starts_with(char::is_alphabetic) && !before.contains(['{', '(']);
            ends.push((closing(text, at + name.len()), is_definition));
        }
    }
    ends.sort_unstable();
    let (mut whole, mut from) = (String::new(), 0);
    for (end, is_definition) in ends {
        let before = text[from..end].trim_end();
        whole.push_str(before);
        whole.push_str(if before.ends_with(',') { " " } else { ", " });
        whole.push_str(if is_definition { parameter } else { TABLES });
        from = end;
    }
    whole + &text[from..]
}

/// The parenthesis that closes the one at a place.
fn closing(text: &str, open: usize) -> usize {
    let mut depth = 0;
    for (i, c) in text[open..].char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => (),
        }
        if depth == 0 {
            return open + i;
        }
    }
    panic!("a parenthesis is open at {open}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_reads_the_tables_takes_them_and_nothing_else_does() {
        let module = "uniform highp sampler2D student_t_tables;\n\nvec2 student_t_impl_pair(uint at) {\n    \
                      return texelFetch(student_t_tables, ivec2(at), 0).xy;\n}\n\nfloat student_t_d(float \
                      x) {\n    return x;\n}\n\nfloat student_t_e(uint at) {\n    at += 1u;\n\n    return \
                      student_t_d(student_t_impl_pair(max(at, 1u)).x);\n}\n";
        let program = "#include \"a\"\nvoid main() { student_t_d(student_t_e(2u)); }\n";
        let [module, program] = as_argument(module, program);
        for line in [
            "vec2 student_t_impl_pair(uint at, highp sampler2D student_t_tables) {",
            "float student_t_d(float x) {",
            "float student_t_e(uint at, highp sampler2D student_t_tables) {",
            "    return student_t_d(student_t_impl_pair(max(at, 1u), student_t_tables).x);",
        ] {
            assert!(module.lines().any(|found| found == line), "{line} in {module}");
        }
        assert!(!module.contains("uniform"), "{module}");
        let expected = "#include \"a\"\n\nuniform highp sampler2D student_t_tables;\nvoid main() { \
                        student_t_d(student_t_e(2u, student_t_tables)); }\n";
        assert_eq!(program, expected);
    }
}
