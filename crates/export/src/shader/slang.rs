//! Slang: the translation into HLSL, of which Slang is a superset, as a module with derivatives.
//!
//! Derivatives are lost without a word in a structure that is not of `IDifferentiable`, and in a
//! function without its attribute that returns one. So all structures are, and all functions of
//! numbers have it, whatever the translation holds. `clients/slang` takes both away from each
//! structure, to see that it is missed.

use super::{Language, Storage};

/// The functions in Slang.
pub(super) fn module(storage: Storage) -> String {
    let hlsl = Language::Hlsl.translation(storage).expect("HLSL is a translation");
    from_hlsl(str::from_utf8(hlsl).expect("HLSL is text"))
}

fn from_hlsl(hlsl: &str) -> String {
    let code = hlsl.lines().filter(|line| !line.starts_with('#')).map(of_line).collect::<String>();
    format!("module student_t;\n\n{}\n\n{}", code.trim(), include_str!("additions.slang"))
}

/// A line of HLSL; attributes stand on the line before.
fn of_line(line: &str) -> String {
    let first = line.split(' ').next().unwrap_or_default();
    let is_function = !first.is_empty() && line.contains('(') && !line.ends_with(';');
    let of_numbers = first.starts_with("float") || first.starts_with("StudentT");
    let line = line.replace(" : register(STUDENT_T_REGISTER)", "");
    let line = match line.strip_prefix("struct ").and_then(|rest| rest.strip_suffix(" {")) {
        Some(name) => format!("struct {name} : IDifferentiable {{"),
        None => line,
    };
    let line = CALLS.iter().fold(line, |line, [from, to]| with_call(&line, from, to));
    let is_public = line.starts_with("static const")
        || is_function && line.contains(" student_t_") && !line.contains(" student_t_impl_");
    let attribute = if is_function && of_numbers { "[Differentiable]\n" } else { "" };
    format!("{attribute}{}{line}\n", if is_public { "public " } else { "" })
}

/// What is called otherwise: what tables hold, and which cell a number is in, are constants; and
/// the root has another derivative (`additions.slang`).
const CALLS: [[&str; 2]; 4] = [
    ["asfloat", "no_diff asfloat"],
    ["student_t_tables.Load", "no_diff student_t_tables.Load"],
    ["floor", "no_diff floor"],
    ["sqrt", "student_t_impl_sqrt"],
];

/// The line with calls of a function by another name.
fn with_call(line: &str, from: &str, to: &str) -> String {
    let is_in_name = |text: &str| text.ends_with(|c: char| c.is_alphanumeric() || c == '_');
    let call = format!("{from}(");
    let mut parts = line.split(&call);
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let name = if is_in_name(&text) { from } else { to };
        text += &format!("{name}({part}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_are_those_of_whole_names() {
        let line = "a = (sqrt(my_sqrt(sqrt(x)))) + sqrt_(y);";
        let expected = "a = (root(my_sqrt(root(x)))) + sqrt_(y);";
        assert_eq!(with_call(line, "sqrt", "root"), expected);
    }

    #[test]
    fn all_that_numbers_pass_is_differentiable() {
        for storage in [Storage::Buffer, Storage::Texture] {
            let text = module(storage);
            let (text, _) = text.split_once("\n// The root.").expect("additions");
            let lines: Vec<&str> = text.lines().collect();
            let mut functions = 0;
            for pair in lines.windows(2) {
                let [before, line] = pair else { unreachable!() };
                assert!(!line.starts_with("struct ") || line.contains(" : IDifferentiable {"));
                let declares = line.trim_start_matches("public ");
                if declares.starts_with("float") || declares.starts_with("StudentT") {
                    assert_eq!(*before, "[Differentiable]", "{line}");
                    functions += 1;
                }
            }
            assert!(functions > 40, "{functions}");
            let count = |part: &str| text.matches(part).count();
            // One read of the tables; nothing is left of the preprocessor and of registers.
            assert_eq!(count("no_diff asfloat(") + count("no_diff student_t_tables.Load("), 1);
            assert_eq!(count("floor("), count("no_diff floor("));
            assert_eq!(count("sqrt("), count("student_t_impl_sqrt("));
            assert!(!text.contains('#') && !text.contains("register("));
        }
    }

    #[test]
    fn what_users_call_is_public() {
        let text = module(Storage::Buffer);
        let public = text.lines().filter(|line| line.starts_with("public "));
        let (constants, functions): (Vec<&str>, Vec<&str>) =
            public.partition(|line| line.contains(" static const "));
        assert_eq!((constants.len(), functions.len()), (2, 15), "{functions:?}");
        assert!(functions.iter().all(|line| !line.contains("_impl_")));
    }

    #[test]
    fn constants_of_gamma_are_those_of_the_crate() {
        let text = include_str!("additions.slang");
        let least = 2f32.powi(-40);
        for (number, after) in [(least, "1.0 / (gamma - 1.0), "), (1.0 / least, "gamma - 1.0, ")] {
            let (_, rest) = text.split_once(&format!("({after}")).expect(after);
            let (written, _) = rest.split_once(')').unwrap();
            assert_eq!(written.parse::<f32>().unwrap(), number);
        }
    }
}
