//! Shader modules: functions written once, in WGSL, and translated into files, which are here too.

mod data;
mod host;
mod language;
mod slang;

use std::fmt::Write;

use microfacet_tables::crc32;

use super::members::{Member, Value};
use super::{ExportFile, Shape};
pub use data::texture_rows;
pub use data::{WIDTH, append_some};
pub use host::{Group, Host};
use language::head;
pub use language::{Language, Storage};

/// Names of files before their extension.
const NAME: &str = "student_t";

/// The functions, after the tables and the members of shapes.
const FUNCTIONS: &str = concat!(
    include_str!("numbers.wgsl"),
    "\n",
    include_str!("masking.wgsl"),
    "\n",
    include_str!("normals.wgsl"),
    "\n",
    include_str!("albedo.wgsl"),
);

/// The module, a program that uses it, and the data.
pub(super) fn files(
    language: Language,
    storage: Storage,
    host: &Host,
    shapes: &[Shape],
) -> Vec<ExportFile> {
    let storage = language.storage(storage);
    let module = module(&shapes.first().expect("shapes").lists(), storage);
    let sample = language.sample(storage);
    let [of_module, of_sample] = language.extensions();
    let name = format!("{NAME}.{of_module}");
    let text = if language == Language::Slang { slang::module(storage) } else { module };
    let translation = language.translation(storage).unwrap_or(text.as_bytes());
    let contents = match language {
        Language::SpirV => host.place_words(translation),
        _ => {
            let text = str::from_utf8(translation).expect("text but of SPIR-V");
            host.place(&format!("{}\n{text}", head(&name, language, storage)), language).into()
        }
    };
    let sample = host.place_bindings(&sample, language);
    let sample = ExportFile::new(format!("{NAME}_sample.{of_sample}"), sample);
    let mut files = vec![ExportFile::new(name, contents), sample];
    data::append_files(shapes, &mut files);
    files
}

/// The functions for WebGL 2, without the comment at the head of the file.
pub fn for_webgl() -> &'static str {
    include_str!("translated/texture_es.glsl")
}

/// The CRC-32 of the WGSL that is translated, without its comments, which `translated/wgsl.crc32`
/// states: so a test finds old translations without a translator.
#[doc(hidden)]
pub fn wgsl_crc32(shape: &Shape) -> String {
    let texts = [Storage::Buffer, Storage::Texture].map(|storage| {
        format!("{}\n{}", module(&shape.lists(), storage), Language::SpirV.sample(storage))
    });
    let lines = texts.iter().flat_map(|text| text.lines());
    let code: Vec<&str> = lines.filter(|line| !line.trim_start().starts_with("//")).collect();
    crc32(code.join("\n").as_bytes())
}

/// All text in WGSL, the same for all shapes, so that it can be translated before they are known.
fn module([lobe, uncorrelated, correlated]: &[Vec<Member>; 3], storage: Storage) -> String {
    let tables = match storage {
        Storage::Buffer => include_str!("buffer.wgsl"),
        Storage::Texture => include_str!("texture.wgsl"),
    };
    let first = lobe.len().div_ceil(2);
    let second = first + uncorrelated.len().div_ceil(2);
    let which = format!("select({second}u, {first}u, masking == STUDENT_T_UNCORRELATED)");
    let shape = loader("StudentTShape", lobe, "student_t_impl_shape(shape: u32)", "shape");
    let albedo = loader(
        "StudentTAlbedoTable",
        correlated,
        "student_t_impl_albedo_table(shape: u32, masking: u32)",
        &format!("shape + {which}"),
    );
    format!("{tables}\n{shape}\n{albedo}\n{FUNCTIONS}")
}

/// A struct of members, and a function that reads it; a table is the index of its first pair.
fn loader(name: &str, members: &[Member], signature: &str, at: &str) -> String {
    let mut fields = String::new();
    let mut pairs = String::new();
    let mut values = String::new();
    for (i, pair) in members.chunks(2).enumerate() {
        let first = pair[0].name;
        writeln!(pairs, "    let {first} = student_t_impl_pair(at + {i}u);").expect("memory");
        for (member, channel) in pair.iter().zip(["x", "y"]) {
            let (kind, value) = match member.value {
                Value::Table(_) => ("u32", format!("shape + u32({first}.{channel})")),
                _ => ("f32", format!("{first}.{channel}")),
            };
            writeln!(fields, "    {}: {kind},", member.name).expect("memory");
            writeln!(values, "        {value},").expect("memory");
        }
    }
    format!(
        "struct {name} {{\n{fields}}}\n\nfn {signature} -> {name} {{\n    let at = {at};\n{pairs}    \
         return {name}(\n{values}    );\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    use microfacet_core::schlick::{F82_AVERAGE, F82_SCALE, SCHLICK_AVERAGE};
    use microfacet_sampler::{StudentT, Tables};

    use super::super::numbers::single;
    use super::*;

    #[test]
    fn constants_are_those_of_the_crate() {
        let [low, high] = StudentT::SIGMAS.map(|sigma| single(sigma as f32));
        let constants = [
            format!("student_t_impl_max(sigma, {low}), {high})"),
            format!("fourth * k, {} * mu", single(F82_SCALE as f32)),
            format!(
                "1.0 / {}, {})",
                single((1.0 / SCHLICK_AVERAGE) as f32),
                single(F82_AVERAGE as f32)
            ),
        ];
        for constant in constants {
            assert!(FUNCTIONS.contains(&constant), "{constant}");
        }
        let width = data::WIDTH;
        let (mask, shift) = (width - 1, width.ilog2());
        let texel = format!("at & {mask}u), i32(at >> {shift}u)");
        assert!(width.is_power_of_two() && include_str!("texture.wgsl").contains(&texel));
    }

    #[test]
    fn translations_are_those_of_the_wgsl() {
        let shape = Shape::bind(&Tables::embedded(), 2.0).unwrap();
        let stated = include_str!("translated/wgsl.crc32").trim();
        assert_eq!(stated, wgsl_crc32(&shape), "translated/README.md says how to translate anew");
    }

    #[test]
    fn members_are_read_by_pairs_in_their_order() {
        let shape = Shape::bind(&Tables::embedded(), 1.7).unwrap();
        let [_, _, albedo] = shape.lists();
        let text = loader("T", &albedo, "t(shape: u32)", "shape");
        let fields = text.lines().take_while(|line| *line != "}").skip(1);
        let declared: Vec<&str> =
            fields.map(|line| line.trim().split_once(": ").unwrap().0).collect();
        assert!(declared.iter().copied().eq(albedo.iter().map(|member| member.name)));
        // The second pair begins with the third member.
        assert!(text.contains("let sigmas = student_t_impl_pair(at + 1u);"), "{text}");
        let values = ["shape + u32(values.x),", "shape + u32(values.y),", "sigmas.x,", "sigmas.y,"];
        assert!(text.contains(&values.join("\n        ")), "{text}");
    }

    #[test]
    fn text_is_narrow_and_that_of_all_shapes() {
        let tables = Tables::embedded();
        let [lists, heavy, closed] =
            [3.0, 1.7, 2.0].map(|gamma| Shape::bind(&tables, gamma).unwrap().lists());
        for storage in [Storage::Buffer, Storage::Texture] {
            let text = module(&lists, storage);
            assert!(text == module(&heavy, storage) && text == module(&closed, storage));
            for language in [Language::Wgsl, Language::GlslEs, Language::Msl, Language::Slang] {
                let head = head("student_t.metal", language, storage);
                for line in head.lines().chain(text.lines()) {
                    assert!(line.len() <= 100, "{line}");
                }
            }
        }
    }
}
