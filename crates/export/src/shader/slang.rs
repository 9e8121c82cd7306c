//! Slang: the translation into HLSL, which its compilers take as it is, with derivatives.
//!
//! Derivatives are lost without a word in a structure that is not of `IDifferentiable`, and in a
//! function without its attribute that returns one. So all structures are, and all functions of
//! numbers have it, whatever the translation holds. `clients/slang` takes both away from each
//! structure, to see that it is missed.

use super::{Kind, Language, Storage};

/// The functions in Slang.
pub(super) fn module(storage: Storage, kind: Kind) -> String {
    let hlsl = Language::Hlsl.translation(storage, kind).expect("HLSL is a translation");
    let text = from_hlsl(str::from_utf8(hlsl).expect("HLSL is text"));
    match kind {
        // A program may import it beside one of the others, which have a root of the same name.
        Kind::Realtime => text.replace("student_t_impl_sqrt", "student_t_impl_surface_sqrt"),
        Kind::Shapes | Kind::Family => format!("{text}\n{}", include_str!("d_of_gamma.slang")),
    }
}

fn from_hlsl(hlsl: &str) -> String {
    let mut is_differentiable = false;
    let code = hlsl.lines().filter(|line| !line.starts_with('#'));
    let code: String = code.map(|line| of_line(line, &mut is_differentiable)).collect();
    format!("{}\n\n{}", code.trim(), include_str!("root.slang"))
}

/// A line of HLSL; attributes stand on the line before. `is_differentiable` is of the function that
/// it is in.
fn of_line(line: &str, is_differentiable: &mut bool) -> String {
    let line = line.replace(" : register(STUDENT_T_REGISTER)", "");
    let line = with_call(&line, "sqrt", "student_t_impl_sqrt");
    // What is differentiated backwards keeps each pass of a loop, and asks for the most of them.
    let line = line.replace("while(true) {", "[MaxIters(4)] while(true) {");
    if let Some(name) = line.strip_prefix("struct ").and_then(|rest| rest.strip_suffix(" {")) {
        return format!("struct {name} : IDifferentiable {{\n");
    }
    let is_function = line.starts_with(char::is_alphabetic) && line.contains('(');
    if is_function && !line.ends_with(';') {
        *is_differentiable = line.starts_with("float") || line.starts_with("StudentT");
        let attribute = if *is_differentiable { "[Differentiable]\n" } else { "" };
        return format!("{attribute}{line}\n");
    }
    let constants = if *is_differentiable { &CONSTANTS[..] } else { &[] };
    let constant = |line: String, call: &&str| with_call(&line, call, &format!("no_diff {call}"));
    constants.iter().fold(line, constant) + "\n"
}

/// Calls that return what does not change with a number: what tables hold, and the cell that a
/// number is in.
const CONSTANTS: [&str; 3] = ["asfloat", "student_t_tables.Load", "floor"];

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
        let all = [Storage::Buffer, Storage::Texture]
            .map(|storage| [Kind::Shapes, Kind::Family].map(|kind| (storage, kind)));
        let realtime = (Storage::Texture, Kind::Realtime);
        for (storage, kind) in all.into_iter().flatten().chain([realtime]) {
            let text = module(storage, kind);
            let (text, _) = text.split_once("\n// The root.").expect("what is added");
            let lines: Vec<&str> = text.lines().collect();
            let mut functions = 0;
            for pair in lines.windows(2) {
                let [before, line] = pair else { unreachable!() };
                assert!(!line.starts_with("struct ") || line.contains(" : IDifferentiable {"));
                if line.starts_with("float") || line.starts_with("StudentT") {
                    assert_eq!(*before, "[Differentiable]", "{line}");
                    functions += 1;
                }
            }
            let has_tables = kind != Kind::Realtime;
            assert!(functions > if has_tables { 40 } else { 15 }, "{functions}");
            let count = |part: &str| text.matches(part).count();
            // All floats of the tables are constants; nothing is left of the preprocessor and of
            // registers.
            let reads = count("asfloat(") + count(" student_t_tables.Load(");
            assert_eq!(reads > 0, has_tables, "{kind:?}");
            assert_eq!(count("asfloat("), count("no_diff asfloat("));
            assert_eq!(count("floor("), count("no_diff floor("));
            let roots = ["student_t_impl_sqrt(", "student_t_impl_surface_sqrt("].map(count);
            assert_eq!(count("sqrt("), roots[0] + roots[1]);
            assert_eq!(roots[0] > 0, has_tables, "{kind:?}");
            assert!(!text.contains('#') && !text.contains("register("));
        }
    }

    #[test]
    fn constants_of_gamma_are_those_of_the_crate() {
        let text = include_str!("d_of_gamma.slang");
        let least = 2f32.powi(-40);
        for (number, after) in [(least, "1.0 / (gamma - 1.0), "), (1.0 / least, "gamma - 1.0, ")] {
            let (_, rest) = text.split_once(&format!("({after}")).expect(after);
            let (written, _) = rest.split_once(')').unwrap();
            assert_eq!(written.parse::<f32>().unwrap(), number);
        }
    }
}
