//! Albedos of lobes that are not round, as parts of a shape's header.

use std::fmt::Write;

use super::{float, literal};
use crate::TurningAlbedo;
use crate::members::{Member, turning};
use crate::numbers::{error, lines};

/// What the comment at the head of a file says of them.
pub(super) fn comment(all: &[TurningAlbedo]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut text = " * Albedos of their own have lobes of sigma_x and sigma_y\n".to_owned();
    for TurningAlbedo { sigma: [x, y], masking, error: worst, .. } in all {
        let bound = error(*worst);
        writeln!(text, " *   {x} and {y}, {masking}: {bound} for cos theta >= 0.02")
            .expect("memory");
    }
    text
}

/// The tables, and the list of them.
pub(super) fn tables(all: &[TurningAlbedo], name: &str) -> String {
    let mut text = String::new();
    let mut list = String::new();
    for (i, table) in all.iter().enumerate() {
        let parts = [format!("turning_{i}"), format!("turning_{i}_average")];
        let values = [table.values.as_flattened(), &table.averages];
        for (part, values) in parts.iter().zip(values) {
            let numbers = lines(values.iter().map(|&x| float(x)));
            let array = format!("float {name}_{part}[{}]", values.len());
            writeln!(text, "\nSTUDENT_T_DATA {array} = {{\n{numbers}\n}};").expect("memory");
        }
        let [x, y] = table.sigma.map(|sigma| float(sigma as f32));
        let masking = table.masking.name().replace('-', "_").to_uppercase();
        let member = |Member { name: member, value }| {
            format!("        {}, /* {member} */\n", literal(value, name))
        };
        let members: String = turning(table, parts).into_iter().map(member).collect();
        write!(list, "    {{{x}, {y}, STUDENT_T_{masking}, {{\n{members}    }}}},\n")
            .expect("memory");
    }
    if !all.is_empty() {
        let array = format!("student_t_turning_albedo {name}_turning[{}]", all.len());
        write!(text, "\nSTUDENT_T_DATA {array} = {{\n{list}}};\n").expect("memory");
    }
    text
}

/// The list as a member of the shape.
pub(super) fn pointer(all: &[TurningAlbedo], name: &str) -> String {
    if all.is_empty() { "STUDENT_T_IMPL_NULL".into() } else { format!("{name}_turning") }
}
