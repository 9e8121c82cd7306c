//! Headers for C99, C++11, CUDA and HIP.

mod family;
mod interface;
mod turning;

use std::fmt::Write;

use microfacet_sampler::{ConductorFresnel, Metal};

use super::members::{Member, Value};
use super::numbers::{as_typed, error, identifier, lines, single};
use super::{AlbedoTable, ExportFile, Shape};

pub(super) use family::family;
pub(super) use interface::interface;

/// The functions, which do not depend on a shape.
const HEADER: &str = concat!(
    include_str!("head.h"),
    include_str!("numbers.h"),
    include_str!("lobe.h"),
    include_str!("family.h"),
    include_str!("masking.h"),
    include_str!("normals.h"),
    include_str!("prefilter.h"),
    include_str!("albedo.h"),
    include_str!("shape.h"),
    "\n#endif\n"
);

const HEADER_NAME: &str = "student_t.h";

/// Whole materials, without the metals and the end of the file.
const MATERIALS: &str = concat!(
    include_str!("material.h"),
    include_str!("conductor.h"),
    include_str!("dielectric.h"),
    include_str!("plastic.h"),
);

const MATERIALS_NAME: &str = "student_t_materials.h";

/// The materials for C++17.
const FRONT: &str = include_str!("student_t.hpp");

const FRONT_NAME: &str = "student_t.hpp";

/// `STUDENT_T_LAYOUT` of the header.
pub(super) const LAYOUT: u32 = 4;

pub(super) fn files(shapes: &[Shape]) -> Vec<ExportFile> {
    let mut files = functions();
    for shape in shapes {
        let name = format!("student_t_gamma_{}", identifier(shape.gamma));
        let text = text(shape, &name);
        files.push(ExportFile::new(name + ".h", text));
    }
    files
}

/// The files that do not depend on tables.
fn functions() -> Vec<ExportFile> {
    vec![
        ExportFile::new(HEADER_NAME, HEADER),
        ExportFile::new(MATERIALS_NAME, MATERIALS.to_owned() + &metals() + "\n#endif\n"),
        ExportFile::new(FRONT_NAME, FRONT),
        ExportFile::new("student_t_closed.h", include_str!("closed.h")),
    ]
}

/// The lines of a header that ask for the layout that it has.
fn layout_check(name: &str) -> String {
    format!(
        "#if STUDENT_T_LAYOUT != {LAYOUT}
#error \"{HEADER_NAME} is of another version than {name}.h: export both again\"
#endif
"
    )
}

/// The reflectances of metals by name.
fn metals() -> String {
    let mut text = "
/* ---- Metals ------------------------------------------------------------------------------------
 * Indices eta + ik of metals in air, for the red, green and blue of linear light: measured at 650,
 * 550 and 450 nm, from the tables of https://refractiveindex.info (CC0), rounded to three decimals.
 */

#if STUDENT_T_CHANNELS == 3
"
    .to_owned();
    for metal in Metal::ALL {
        let average = ConductorFresnel::from(metal).average();
        let [eta, k] = [metal.eta(), metal.k()].map(|all| all.map(|x| x as f32));
        let [eta, k, average] = [eta, k, average].map(|all| all.map(float).join(", "));
        let source = metal.source();
        write!(
            text,
            "
/* {source} */
STUDENT_T_DATA student_t_reflectance student_t_{metal} = {{
    STUDENT_T_ETA_K,
    {{{eta}}},
    {{{k}}},
    {{{average}}},
}};
"
        )
        .expect("memory");
    }
    text + "#endif\n"
}

fn text(shape: &Shape, name: &str) -> String {
    let guard = format!("{}_H", name.to_uppercase());
    let mut text = comment(shape, name);
    write!(
        text,
        "#ifndef {guard}
#define {guard}

#include \"{HEADER_NAME}\"

{}",
        layout_check(name)
    )
    .expect("memory");
    for part in shape.parts() {
        let (items, count) = (part.values.iter().map(|&x| float(x)), part.values.len());
        let array = format!("float {name}_{}[{count}]", part.name);
        writeln!(text, "\nSTUDENT_T_DATA {array} = {{\n{}\n}};", lines(items)).expect("memory");
    }
    text + &turning::tables(&shape.turning, name) + &definition(shape, name) + "\n#endif\n"
}

/// The comment at the head of a shape's file.
fn comment(shape: &Shape, name: &str) -> String {
    let (gamma, version) = (as_typed(shape.gamma), env!("CARGO_PKG_VERSION"));
    let worst = |of: fn(&AlbedoTable) -> Option<f64>| error(shape.worst_albedo(of));
    let lobe = if shape.tables.is_some() {
        let [along, across] = shape.errors.cdf.map(error);
        format!(
            " *   D: a closed form
 *   G1, from which lambda, G2 and weights follow: {}
 *   visible normals: {along} of the cumulative distribution in the plane of incidence, and
 *     {across} of that across it
 *   densities: analytic, with G1 from the table\n",
            error(shape.errors.g1)
        )
    } else {
        " *   D, G1, lambda, G2, weights, visible normals, densities: closed forms\n".into()
    };
    let from_default = if shape.from_default.is_empty() {
        String::new()
    } else {
        let forms: Vec<_> = shape.from_default.iter().map(|masking| masking.name()).collect();
        format!(" * Albedos of {} masking are those of the default set.\n", forms.join(" and "))
    };
    let [low, high] = shape.albedos[0].sigma.map(|sigma| single(sigma as f32));
    format!(
        "/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * {name}.h: the Student-t lobe of gamma = {gamma} for any roughness.
 * {HEADER_NAME} has the functions and says how to use them.
 *
 * Written by microfacet-bake {version} (export c --gamma {gamma})
 * from tables baked by {}, numerics {}.
 *
 * Largest errors over all gamma that these tables serve, measured against the model in double
 * precision:
{lobe} *   albedo and its parts: {} for sigma >= 0.01 and cos theta >= 0.02, {} elsewhere
 *   averages: those of the albedo, and for this gamma {} by interpolation
 * Albedos have tables for sigma from {low} to {high}.
{from_default}{} */
",
        shape.generator,
        shape.numerics,
        worst(|table| table.errors[0]),
        worst(|table| table.errors[1]),
        worst(|table| Some(table.average_error)),
        turning::comment(&shape.turning),
    )
}

/// The members of a lobe by the struct of the header that holds them: `student_t_law`,
/// `student_t_constants`, and the tables in `student_t_shape` itself. GGX's flag is apart.
fn grouped(lobe: Vec<Member>) -> [Vec<Member>; 3] {
    const LAW: [&str; 6] = ["s", "d_s", "d_power", "kappa", "heavy_exponent", "heavy_root_s"];
    let of = |member: &Member| match member.value {
        Value::Table(_) => 2,
        _ => usize::from(!LAW.contains(&member.name)),
    };
    let mut groups = [vec![], vec![], vec![]];
    let rest = lobe.into_iter().filter(|member| member.name != "is_ggx");
    rest.for_each(|member| groups[of(&member)].push(member));
    groups
}

/// The definition of the shape: values in the order of the members of `student_t_shape`.
fn definition(shape: &Shape, name: &str) -> String {
    let [lobe, uncorrelated, correlated] = shape.lists();
    let lines = |members: Vec<Member>, indent: &str| -> String {
        let one = |Member { name: member, value }: Member| {
            format!("{indent}{}, /* {member} */\n", literal(value, name))
        };
        members.into_iter().map(one).collect()
    };
    let inner = "        ";
    let gamma = float((shape.gamma as f32).min(f32::MAX));
    let is_ggx = u8::from(shape.tables.is_none());
    let [law, constants, tables] = grouped(lobe);
    let (law, constants, tables) =
        (lines(law, inner), lines(constants, inner), lines(tables, "    "));
    let [a, b] = [uncorrelated, correlated].map(|members| lines(members, inner));
    format!(
        "
STUDENT_T_DATA student_t_shape {name} = {{
    {gamma}, /* gamma */
    {is_ggx}, /* is_ggx */
    {{\n{law}    }},
    {{\n{constants}    }},
{tables}    {{{{\n{a}    }}, {{\n{b}    }}}},
    {}, /* turning */
    {} /* turning_count */
}};

/* The lobe of this shape and a roughness along x and y. */
STUDENT_T_FUNCTION student_t_lobe {name}_lobe(float sigma_x, float sigma_y)
{{
    return student_t_lobe_of(&{name}, sigma_x, sigma_y);
}}
",
        turning::pointer(&shape.turning, name),
        shape.turning.len()
    )
}

/// A member as C source; `name` is that of the shape.
fn literal(value: Value, name: &str) -> String {
    match value {
        Value::Flag(flag) => u8::from(flag).to_string(),
        Value::Count(count) => count.to_string(),
        Value::Number(number) => float(number),
        Value::Table(part) => {
            part.map_or("STUDENT_T_IMPL_NULL".into(), |part| format!("{name}_{part}"))
        }
    }
}

fn float(x: f32) -> String {
    single(x) + "f"
}

#[cfg(test)]
mod tests {
    use microfacet_core::schlick::{F82_AVERAGE, F82_SCALE, SCHLICK_AVERAGE};
    use microfacet_sampler::StudentT;
    use microfacet_sampler::port::VolumeTables;

    use super::*;
    use crate::family::Block;

    #[test]
    fn files_of_shapes_ask_for_the_layout_of_the_functions() {
        assert!(HEADER.contains(&format!("\n#define STUDENT_T_LAYOUT {LAYOUT}\n")));
        assert!(MATERIALS.contains(&format!("\n#if STUDENT_T_LAYOUT != {LAYOUT}\n")));
    }

    #[test]
    fn constants_are_those_of_the_crate() {
        let [low, high] = StudentT::SIGMAS.map(|sigma| single(sigma as f32));
        let shares = VolumeTables::VIEW_SHARES.map(float);
        let constants = [
            format!("student_t_impl_max(sigma, {low}f), {high}f)"),
            format!("*f82 = {} * mu", float(F82_SCALE as f32)),
            format!("F82_AVERAGE {} /*", float(F82_AVERAGE as f32)),
            format!("SCHLICK_AVERAGE (1.0f / {}f)", single((1.0 / SCHLICK_AVERAGE) as f32)),
            format!("STUDENT_T_VOLUME_SHAPES {}\n", VolumeTables::SIZES[0]),
            format!("STUDENT_T_VOLUME_VIEWS {}\n", VolumeTables::SIZES[1]),
            format!("at = {} * sqrtf(sqrtf(x)) + {} * sqrtf", shares[0], shares[1]),
            format!("STUDENT_T_IMPL_ROWS {}\n", Block::ROWS),
            format!("STUDENT_T_FAMILY_MAGIC {:#x}u", Block::MAGIC),
        ];
        for constant in constants {
            assert!(HEADER.contains(&constant), "{constant}");
        }
    }

    #[test]
    fn metals_are_those_of_the_crate() {
        let text = metals();
        assert!(text.contains("student_t_gold = {\n    STUDENT_T_ETA_K,\n    {0.156f, 0.424f, "));
        assert_eq!(text.matches("STUDENT_T_DATA").count(), Metal::ALL.len());
    }

    #[test]
    fn values_stand_in_the_order_of_the_members() {
        // Members of a struct of the header, in order.
        let members = |name: &str| -> Vec<String> {
            let from = HEADER.split(&format!("typedef struct {name} {{")).nth(1).unwrap();
            let body = from.split("\n}").next().unwrap();
            let code: String =
                body.split("/*").map(|part| part.rsplit("*/").next().unwrap()).collect();
            let declarations = code.split(';').filter(|declaration| !declaration.trim().is_empty());
            let names = declarations.flat_map(|declaration| {
                let names = declaration.split(',').map(|name| name.trim());
                names.map(|name| name.rsplit([' ', '*']).next().unwrap().to_owned())
            });
            names.collect()
        };
        let shape = Shape::bind(&microfacet_sampler::Tables::embedded(), 1.7).unwrap();
        let [lobe, uncorrelated, _] = shape.lists();
        let names = |list: &[Member]| list.iter().map(|member| member.name).collect::<Vec<_>>();
        let [law, constants, tables] = grouped(lobe);
        assert_eq!(members("student_t_law"), names(&law));
        assert_eq!(members("student_t_constants"), names(&constants));
        let first = ["gamma", "is_ggx", "law", "constants"];
        let last = ["albedo[2]", "turning", "turning_count"];
        let all = [&first[..], &names(&tables), &last].concat();
        assert_eq!(members("student_t_shape"), all);
        let albedo = names(&uncorrelated);
        assert_eq!(members("student_t_albedo_table"), albedo);
    }
}
