//! Headers for C99, C++11, CUDA and HIP.

use std::fmt::Write;

use microfacet_common::shape::s_of_gamma;
use microfacet_sampler::internals::ShapeTables;

use super::numbers::{as_typed, error, identifier, lines, single};
use super::{AlbedoTable, ExportFile, Shape};

/// The functions, which do not depend on a shape.
const HEADER: &str = concat!(
    include_str!("head.h"),
    include_str!("masking.h"),
    include_str!("normals.h"),
    include_str!("albedo.h"),
    "\n#endif\n"
);

/// The name of the file with the functions.
const HEADER_NAME: &str = "student_t.h";

/// `STUDENT_T_LAYOUT` of the header.
const LAYOUT: u32 = 1;

pub(super) fn files(shapes: &[Shape]) -> Vec<ExportFile> {
    let header = ExportFile { name: HEADER_NAME.into(), text: HEADER.into() };
    let shape = |shape: &Shape| {
        let name = format!("student_t_gamma_{}", identifier(shape.gamma));
        ExportFile { text: text(shape, &name), name: name + ".h" }
    };
    std::iter::once(header).chain(shapes.iter().map(shape)).collect()
}

/// The file of a shape.
fn text(shape: &Shape, name: &str) -> String {
    let guard = format!("{}_H", name.to_uppercase());
    let mut text = comment(shape, name);
    write!(
        text,
        "#ifndef {guard}
#define {guard}

#include \"{HEADER_NAME}\"

#if STUDENT_T_LAYOUT != {LAYOUT}
#error \"{HEADER_NAME} is of another version than {name}.h: export both again\"
#endif
"
    )
    .expect("memory");
    if let Some(tables) = &shape.tables {
        array(&mut text, name, "masking", &tables.masking);
        array(&mut text, name, "slopes", &tables.slopes);
        array(&mut text, name, "across", &tables.across);
        if let Some(heavy) = &tables.heavy {
            array(&mut text, name, "heavy", &heavy.shares);
        }
    }
    for table in &shape.albedos {
        let masking = masking(table);
        array(&mut text, name, &format!("albedo_{masking}"), &table.values);
        array(&mut text, name, &format!("averages_{masking}"), &table.averages);
    }
    definition(&mut text, shape, name);
    text + "\n#endif\n"
}

/// What a shape's file says of it.
fn comment(shape: &Shape, name: &str) -> String {
    let (gamma, version) = (as_typed(shape.gamma), env!("CARGO_PKG_VERSION"));
    let worst = |of: fn(&AlbedoTable) -> Option<f64>| {
        error(shape.albedos.iter().filter_map(of).reduce(f64::max))
    };
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
        "/* SPDX-License-Identifier: CC0-1.0
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
{from_default} */
",
        shape.generator,
        shape.numerics,
        worst(|table| table.errors[0]),
        worst(|table| table.errors[1]),
        worst(|table| Some(table.average_error)),
    )
}

fn masking(table: &AlbedoTable) -> String {
    table.masking.name().replace('-', "_")
}

/// An array of the tables.
fn array<const N: usize>(text: &mut String, name: &str, part: &str, values: &[[f32; N]]) {
    let items = values.as_flattened().iter().map(|&x| float(x));
    let count = values.len() * N;
    writeln!(text, "\nSTUDENT_T_DATA float {name}_{part}[{count}] = {{\n{}\n}};", lines(items))
        .expect("memory");
}

/// The definition of the shape: values in the order of the members of `student_t_shape`.
fn definition(text: &mut String, shape: &Shape, name: &str) {
    writeln!(text, "\nSTUDENT_T_DATA student_t_shape {name} = {{").expect("memory");
    for (member, value) in lobe(shape, name) {
        writeln!(text, "    {value}, /* {member} */").expect("memory");
    }
    for (i, table) in shape.albedos.iter().enumerate() {
        text.push_str(if i == 0 { "    {{\n" } else { "    }, {\n" });
        for (member, value) in albedo(table, name) {
            writeln!(text, "        {value}, /* {member} */").expect("memory");
        }
    }
    text.push_str("    }}\n};\n");
}

/// Names of members with their values.
type Members = Vec<(&'static str, String)>;

/// The lobe; what GGX does not need is 0.
fn lobe(shape: &Shape, name: &str) -> Members {
    let tables = shape.tables.as_ref();
    let heavy = tables.and_then(|tables| tables.heavy.as_ref());
    let number = |of: fn(&ShapeTables) -> f32| float(tables.map_or(0.0, of));
    let flag = |flag: bool| u8::from(flag).to_string();
    let array = |has: bool, part| if has { format!("{name}_{part}") } else { "0".into() };
    let [d_s, d_power] = tables.map_or([1.0, 0.0], |tables| tables.normals);
    vec![
        ("is_ggx", flag(tables.is_none())),
        ("s", float(s_of_gamma(shape.gamma) as f32)),
        ("d_s", float(d_s)),
        ("d_power", float(d_power)),
        ("kappa", number(|tables| tables.kappa)),
        ("masking_crowded", flag(tables.is_some_and(|tables| tables.masking_crowded))),
        ("masking_cells", number(|tables| tables.masking_cells)),
        ("masking", array(tables.is_some(), "masking")),
        ("slopes_crowded", flag(tables.is_some_and(|tables| tables.slopes_crowded))),
        ("rows", number(|tables| tables.rows[0])),
        ("inverse_rows", number(|tables| tables.rows[1])),
        ("numbers", tables.map_or(0, |tables| tables.numbers).to_string()),
        ("along_scale", number(|tables| tables.scales[0])),
        ("slopes", array(tables.is_some(), "slopes")),
        ("across_scale", number(|tables| tables.scales[1])),
        ("across", array(tables.is_some(), "across")),
        ("heavy_per_row", float(heavy.map_or(0.0, |heavy| heavy.cells_per_row))),
        ("heavy", array(heavy.is_some(), "heavy")),
        ("heavy_exponent", float(heavy.map_or(0.0, |heavy| heavy.exponent))),
        ("heavy_root_s", float(heavy.map_or(0.0, |heavy| heavy.root_s))),
    ]
}

fn albedo(table: &AlbedoTable, name: &str) -> Members {
    let masking = masking(table);
    let [first, last] = table.ends;
    let (sigma, view) = (table.roughness, table.view);
    vec![
        ("values", format!("{name}_albedo_{masking}")),
        ("averages", format!("{name}_averages_{masking}")),
        ("sigmas", table.sigmas.to_string()),
        ("average_sigmas", table.averages.len().to_string()),
        ("views", table.views.to_string()),
        ("offset", float(sigma.offset as f32)),
        ("first", float(sigma.first as f32)),
        ("slow", float(sigma.slow as f32)),
        ("linear", float(sigma.linear as f32)),
        ("start", float(first as f32)),
        ("range", float((last - first) as f32)),
        ("sigma_min", float(table.sigma[0] as f32)),
        ("sigma_max", float(table.sigma[1] as f32)),
        ("weight", float(view.weight as f32)),
        ("normal", float(view.normal as f32)),
        ("share", float(view.share as f32)),
        ("kappa", float(view.scale as f32)),
        ("spread", float(view.spread as f32)),
        ("floor", float(view.floor as f32)),
        ("slope", float(view.slope as f32)),
    ]
}

fn float(x: f32) -> String {
    single(x) + "f"
}

#[cfg(test)]
mod tests {
    use microfacet_common::schlick::{F82_AVERAGE, F82_SCALE, SCHLICK_AVERAGE};
    use microfacet_sampler::StudentT;

    use super::*;

    #[test]
    fn files_of_shapes_ask_for_the_layout_of_the_functions() {
        assert!(HEADER.contains(&format!("\n#define STUDENT_T_LAYOUT {LAYOUT}\n")));
    }

    #[test]
    fn constants_are_those_of_the_crate() {
        let [low, high] = StudentT::SIGMAS.map(|sigma| single(sigma as f32));
        let constants = [
            format!("student_t_impl_max(sigma, {low}f), {high}f)"),
            format!("*f82 = {} * mu", float(F82_SCALE as f32)),
            format!("averages[2] = {};", float(F82_AVERAGE as f32)),
            format!("averages[1] = 1.0f / {}f;", single((1.0 / SCHLICK_AVERAGE) as f32)),
        ];
        for constant in constants {
            assert!(HEADER.contains(&constant), "{constant}");
        }
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
        let written = |members: Members| members.into_iter().map(|(name, _)| name.to_owned());
        let mut expected: Vec<_> = written(lobe(&shape, "x")).collect();
        expected.push("albedo[2]".into());
        assert_eq!(members("student_t_shape"), expected);
        let albedo: Vec<_> = written(albedo(&shape.albedos[0], "x")).collect();
        assert_eq!(members("student_t_albedo_table"), albedo);
    }
}
