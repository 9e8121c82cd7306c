//! The header of dielectrics of one index: the shares of light of either side, as numbers.

use std::fmt::Write;

use microfacet_core::Masking;
use microfacet_sampler::port::{InterfaceAxis, InterfaceSide, InterfaceTables, InterfaceView};

use super::super::numbers::{identifier, lines};
use super::{ExportFile, MATERIALS_NAME, float};

/// The file of an index and a form of masking. `generator` is the program that baked the tables.
pub(in super::super) fn interface(tables: &InterfaceTables, generator: &str) -> ExportFile {
    let eta = identifier(tables.eta.to_string().parse().expect("a number"));
    let suffix = match tables.masking {
        Masking::Uncorrelated => "_uncorrelated",
        _ => "",
    };
    let name = format!("student_t_eta_{eta}{suffix}");
    let guard = format!("{}_H", name.to_uppercase());
    let (masking, version) = (tables.masking.name(), env!("CARGO_PKG_VERSION"));
    let [gamma, sigma] = [tables.shapes.ends, tables.sigmas.ends].map(|ends| ends.map(single));
    let mut text = format!(
        "/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * {name}.h: dielectrics of eta = {}, inside over outside, under {masking} masking: the
 * shares of light that one bounce reflects and transmits, for gamma from {} to {} and sigma from
 * {} to {}. {MATERIALS_NAME} has the functions and says how to use them.
 *
 * Written by microfacet-bake {version} (export c --eta {})
 * from tables baked by {generator}.
 */
#ifndef {guard}
#define {guard}

#include \"{MATERIALS_NAME}\"
",
        tables.eta, gamma[0], gamma[1], sigma[0], sigma[1], tables.eta
    );
    for (side, at) in tables.sides.iter().zip(["outside", "inside"]) {
        let bands = side.bands.iter().flatten().flatten();
        let arrays: [(&str, Vec<f32>); 3] = [
            ("values", side.values.iter().flatten().copied().collect()),
            ("averages", side.averages.iter().flatten().copied().collect()),
            ("bands", bands.copied().collect()),
        ];
        for (array, values) in arrays {
            let items = values.iter().map(|&x| float(x));
            let declaration = format!("float {name}_{at}_{array}[{}]", values.len());
            writeln!(text, "\nSTUDENT_T_DATA {declaration} = {{\n{}\n}};", lines(items))
                .expect("memory");
        }
    }
    text += &definition(tables, &name);
    ExportFile::new(name + ".h", text + "\n#endif\n")
}

fn single(x: f64) -> String {
    float((x as f32).min(f32::MAX))
}

/// The first coordinate of an axis, and the last less the first; 0 and 1 of one node.
fn range<M>(axis: &InterfaceAxis<M>) -> [f64; 2] {
    match axis.nodes[..] {
        [first, .., last] => [first, last - first],
        _ => [0.0, 1.0],
    }
}

/// The definition: values in the order of the members of `student_t_interface_table`.
fn definition(tables: &InterfaceTables, name: &str) -> String {
    let masking = match tables.masking {
        Masking::Uncorrelated => "STUDENT_T_UNCORRELATED",
        _ => "STUDENT_T_HEIGHT_CORRELATED",
    };
    let inverse = tables.sides.iter().find_map(|side| match side.view {
        InterfaceView::Critical(_, inverse) => Some(inverse),
        InterfaceView::Blend(_) => None,
    });
    let (shapes, sigmas) = (&tables.shapes, &tables.sigmas);
    let scale = shapes.coordinate.map_or(1.0, |shape| shape.scale);
    let [shape_first, shape_range] = range(shapes);
    let [sigma_first, sigma_range] = range(sigmas);
    let axis = sigmas.coordinate.map_or([1.0, 1.0, 0.0, 0.0], |sigma| {
        [sigma.offset, sigma.first, sigma.slow, sigma.linear]
    });
    let row = |values: &[f64]| -> String {
        values.iter().map(|&x| single(x)).collect::<Vec<_>>().join(", ")
    };
    let [outside, inside] = [0, 1].map(|i| side(&tables.sides[i], name, ["outside", "inside"][i]));
    format!(
        "
STUDENT_T_DATA student_t_interface_table {name} = {{
    {}, /* eta */
    {masking}, /* masking */
    {}, /* smooth_transmitted */
    {:?}, /* inverse */
    {}, {}, /* shapes, sigmas */
    {}, {}, /* gamma_min, gamma_max, sigma_min, sigma_max */
    {}, /* shape_scale, shape_first, shape_range */
    {}, /* offset, first, slow, linear */
    {}, /* sigma_first, sigma_range */
    {{{{\n{outside}    }}, {{\n{inside}    }}}}
}};
",
        float(tables.eta),
        float(tables.smooth_transmitted),
        inverse.unwrap_or(1.0),
        shapes.nodes.len(),
        sigmas.nodes.len(),
        row(&shapes.ends),
        row(&sigmas.ends),
        row(&[scale, shape_first, shape_range]),
        row(&axis),
        row(&[sigma_first, sigma_range]),
    )
}

/// The members of `student_t_interface_side`.
fn side(side: &InterfaceSide, name: &str, at: &str) -> String {
    let (parts, [common, blend, critical]) = match side.view {
        InterfaceView::Blend(view) => (
            1,
            [
                vec![view.share, view.scale, view.heavy, view.floor, view.slope],
                vec![view.weight, view.normal, view.spread],
                vec![0.0; 4],
            ],
        ),
        InterfaceView::Critical(view, _) => (
            view.parts(),
            [
                vec![view.share, view.scale, view.heavy, view.floor, view.slope],
                vec![0.0; 3],
                vec![view.root, view.kink, view.sharp, view.between],
            ],
        ),
    };
    let rows = [common, blend, critical]
        .map(|values| values.into_iter().map(single).collect::<Vec<_>>().join(", "));
    let [common, blend, critical] = rows;
    format!(
        "        {name}_{at}_values,
        {name}_{at}_averages,
        {name}_{at}_bands,
        {}, {parts}, /* views, parts */
        {common}, /* share, scale, heavy, floor, slope */
        {blend}, /* weight, normal, spread */
        {critical} /* root, kink, sharp, between */
",
        side.views
    )
}

#[cfg(test)]
mod tests {
    use microfacet_sampler::port::steep_cosine;

    use super::super::MATERIALS;
    use super::*;

    /// The members of a struct of the header, in order.
    fn members(name: &str) -> Vec<String> {
        let from = MATERIALS.split(&format!("typedef struct {name} {{")).nth(1).unwrap();
        let body = from.split("\n}").next().unwrap();
        let code: String = body.split("/*").map(|part| part.rsplit("*/").next().unwrap()).collect();
        let declarations = code.split([';', ',']).filter(|names| !names.trim().is_empty());
        let last = |names: &str| names.trim().rsplit([' ', '*']).next().unwrap().to_owned();
        declarations.map(last).collect()
    }

    /// The members that comments and names of arrays in a definition state.
    fn stated(text: &str) -> Vec<String> {
        let mut names = Vec::new();
        for line in text.lines() {
            if let Some((_, comment)) = line.split_once("/* ") {
                let comment = comment.split(" */").next().unwrap();
                names.extend(comment.split(", ").map(str::to_owned));
            } else if line.trim().starts_with("it_") {
                names.push(line.trim().trim_end_matches(',').rsplit('_').next().unwrap().into());
            }
        }
        names
    }

    fn tables() -> InterfaceTables {
        let view = InterfaceView::Blend(microfacet_tables::axis::ViewBlend::BAKED);
        let side = InterfaceSide {
            view,
            views: 6,
            values: vec![[0.04, 0.9]; 6],
            averages: vec![[0.1, 0.8, -5.0, 0.9]],
            bands: vec![[[1.0; 33]; 2]],
        };
        InterfaceTables {
            eta: 1.5,
            masking: Masking::Uncorrelated,
            smooth_transmitted: 0.9,
            shapes: InterfaceAxis { coordinate: None, nodes: vec![0.0], ends: [3.0; 2] },
            sigmas: InterfaceAxis { coordinate: None, nodes: vec![0.0], ends: [0.3; 2] },
            sides: [side.clone(), side],
        }
    }

    #[test]
    fn values_stand_in_the_order_of_the_members() {
        let tables = tables();
        assert_eq!(
            stated(&side(&tables.sides[0], "it", "outside")),
            members("student_t_interface_side")
        );
        let text = definition(&tables, "it");
        let own: String = text.lines().filter(|line| line.starts_with("    ")).fold(
            String::new(),
            |mut own, line| {
                if !line.starts_with("        ") && !line.contains('}') {
                    own += line;
                    own.push('\n');
                }
                own
            },
        );
        let mut names = stated(&own);
        names.push("sides[2]".into());
        assert_eq!(names, members("student_t_interface_table"));
    }

    #[test]
    fn a_file_is_named_by_index_and_masking() {
        let file = interface(&tables(), "a test");
        assert_eq!(file.name, "student_t_eta_1p5_uncorrelated.h");
    }

    #[test]
    fn the_steep_cosine_is_that_of_the_crate() {
        // Of an index far from 1, (1 + η)/|1 − η| times the constant.
        let constant = float(steep_cosine(3.0) * 0.5);
        assert!(MATERIALS.contains(&format!("student_t_impl_min({constant} * (1.0f + eta)")));
    }
}
