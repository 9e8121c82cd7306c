//! All shapes in one header, or in one file of bytes.

use std::fmt::Write;

use microfacet_sampler::port::WindowCell;

use super::{HEADER_NAME, LAYOUT, float, layout_check};
use crate::family::{Block, Family, Item};
use crate::numbers::wide_lines;
use crate::{ExportFile, numbers};

/// The width of lines of data, of which a hundredth would be ends of lines otherwise.
const DATA: usize = 4000;

const NAME: &str = "student_t_family";

/// The header with the family as text, or the file with its bytes.
pub(in super::super) fn family(family: &Family, binary: bool) -> ExportFile {
    let block = Block::new(family, LAYOUT);
    if binary {
        return ExportFile::new(format!("{NAME}.bin"), block.bytes());
    }
    ExportFile::new(format!("{NAME}.h"), text(family, &block))
}

fn text(family: &Family, block: &Block) -> String {
    let mut text = comment(family);
    let [windows, numbers, codes] = [block.windows.len(), block.numbers.len(), block.codes.len()];
    write!(
        text,
        "#ifndef STUDENT_T_FAMILY_H
#define STUDENT_T_FAMILY_H

#include \"{HEADER_NAME}\"

{}
struct {NAME}_tables {{
    student_t_family family;
    student_t_impl_between windows[{windows}];
    float numbers[{numbers}];
    unsigned short codes[{codes}];
}};

/* Files of bytes have these sizes. */
typedef char {NAME}_head[sizeof(student_t_family) == {} ? 1 : -1];
typedef char {NAME}_window[sizeof(student_t_impl_between) == {} ? 1 : -1];

STUDENT_T_DATA struct {NAME}_tables {NAME}_data = {{
",
        layout_check(NAME),
        Block::HEAD,
        Block::WINDOW
    )
    .expect("memory");
    text.push_str(&wide_lines([head(&block.head)], DATA));
    text.push_str("\n{\n");
    text.push_str(&wide_lines(block.windows.iter().flat_map(window), DATA));
    text.push_str("\n},\n{\n");
    text.push_str(&wide_lines(block.numbers.iter().map(|&x| short(x)), DATA));
    text.push_str("\n},\n{\n");
    text.push_str(&wide_lines(block.codes.iter().map(u16::to_string), DATA));
    text.push_str(
        "
}
};

/* The family of all gamma that this file has. In device code it is another copy than on the host. */
STUDENT_T_FUNCTION const student_t_family *student_t_family_here(void)
{
    return &student_t_family_data.family;
}

/* The lobe of a gamma in [1.501, infinity] and a roughness along x and along y. gamma and sigma are
 * taken at the nearer end of their ranges, NaN at the smallest. */
STUDENT_T_FUNCTION student_t_lobe student_t_lobe_at(float gamma, float sigma_x, float sigma_y)
{
    return student_t_family_lobe(student_t_family_here(), gamma, sigma_x, sigma_y);
}

/* The same, in place: compilers of C copy a lobe by value, in the time of a sample. */
STUDENT_T_FUNCTION void
student_t_set_lobe(float gamma, float sigma_x, float sigma_y, student_t_lobe *lobe)
{
    student_t_family_set_lobe(student_t_family_here(), gamma, sigma_x, sigma_y, lobe);
}

#endif
",
    );
    text
}

fn comment(family: &Family) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let albedos = if family.albedos.is_some() { "" } else { " --no-albedo" };
    format!(
        "/* SPDX-License-Identifier: CC0-1.0 OR MIT
 *
 * {NAME}.h: the Student-t lobes of every gamma from 1.501 to infinity, for any roughness.
 * {HEADER_NAME} has the functions and says how to use them:
 *
 *     student_t_lobe lobe = student_t_lobe_at(gamma, sigma_x, sigma_y); // at a hit
 *     student_t_lobe_sample_visible_normal(&lobe, v, u, m);
 *
 * Written by microfacet-bake {version} (export c --family{albedos})
 * from tables baked by {}, numerics {}.
 */
",
        family.generator, family.numerics
    )
}

/// A member of the head as C source, in braces where it has some.
fn head(item: &Item) -> String {
    match item {
        Item::Whole(whole) => whole.to_string(),
        Item::Number(number) => float(*number),
        Item::Group(items) => {
            let items: Vec<String> = items.iter().map(head).collect();
            format!("{{{}}}", items.join(","))
        }
    }
}

fn window(cell: &WindowCell) -> Vec<String> {
    let list = |numbers: &[f32]| numbers.iter().map(|&x| short(x)).collect::<Vec<_>>().join(",");
    let starts = cell.starts.map(|start| start.to_string()).join(",");
    let tables = cell.weights.map(|table| {
        let powers = table.map(|power| format!("{{{}}}", list(&power)));
        format!("{{{}}}", powers.join(","))
    });
    let [a, b, c] = tables;
    vec![
        format!("{{{},{{{starts}}}", list(&[cell.from, cell.inverse])),
        format!("{{{a}"),
        b,
        format!("{c}}}}}"),
    ]
}

/// A number without a zero before the point.
fn short(x: f32) -> String {
    let text = numbers::single(x);
    let text = match text.strip_prefix("0.") {
        Some(rest) if !rest.is_empty() => format!(".{rest}"),
        _ => match text.strip_prefix("-0.") {
            Some(rest) if !rest.is_empty() => format!("-.{rest}"),
            _ => text,
        },
    };
    text + "f"
}
