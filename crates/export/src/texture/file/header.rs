//! A texture as a C header, with the function that reads it: for renderers without a filter.

use std::fmt::Write;

use super::Made;
use crate::numbers::{as_typed, lines, single};
use crate::texture::shader::Dialect;
use crate::texture::{Along, Channel, shader_lines};

/// The header: `NAME_texels`, the values, and `NAME_read`, which interpolates them. Their suffixes
/// keep names from being keywords, or names of `<math.h>` or of local variables.
pub(super) fn encode(made: &Made) -> String {
    let (texture, spec) = (&made.texture, &made.texture.spec);
    let name = &spec.name;
    let channels = spec.channels.len();
    let mut text = String::from("/* SPDX-License-Identifier: CC0-1.0 OR MIT\n");
    let of = if spec.gamma.is_nan() {
        "several gamma".into()
    } else {
        format!("gamma {}", as_typed(spec.gamma))
    };
    let what = if spec.is_directional() { "Directional albedo" } else { "Average albedo" };
    let _ =
        writeln!(text, "   {what} of the Student-t distribution, {of}, {} masking.", spec.masking);
    for error in &made.errors {
        let _ = writeln!(text, "   Largest error of {}: {:.1e}.", error.quantity, error.stated());
    }
    for axis in &spec.axes {
        let _ = match axis.along {
            Along::Roughness { largest } => writeln!(text, "   sigma in [0, {largest}]."),
            Along::Index { ends: [low, high], inside: false } => {
                writeln!(text, "   eta in [{low}, {high}].")
            }
            Along::Index { ends: [low, high], inside: true } => {
                writeln!(text, "   eta in [1/{high}, 1/{low}].")
            }
            Along::Shape { smallest } => writeln!(text, "   gamma in [{smallest}, inf]."),
            _ => Ok(()),
        };
    }
    let names: Vec<&str> = spec.channels.iter().map(|channel| channel.name()).collect();
    let _ = writeln!(
        text,
        "   Channels: {}. A shader reads the same values as a texture with",
        names.join(", ")
    );
    let _ = writeln!(text, "   {} */", shader_lines(spec).glsl);
    let guard = name.to_uppercase();
    let _ = write!(
        text,
        "#ifndef {guard}_H\n#define {guard}_H\n\n#include <math.h>\n\n\
         /* From C++17 on a program has one copy, which inline functions may use. */\n\
         #if (defined(__cplusplus) && __cplusplus >= 201703L) || \\\n    \
         (defined(_MSVC_LANG) && _MSVC_LANG >= 201703L)\n\
         #define {guard}_DATA inline const\n#define {guard}_FUNCTION inline\n#else\n\
         #define {guard}_DATA static const\n#define {guard}_FUNCTION static inline\n#endif\n\n"
    );
    let _ = writeln!(text, "{guard}_DATA float {name}_texels[{}] = {{", texture.values.len());
    text += &lines(texture.values.iter().map(|&x| single(x) + "f"));
    text += "\n};\n\n";
    text += &function(made, channels, &guard);
    let _ = writeln!(text, "\n#endif");
    text
}

fn function(made: &Made, channels: usize, guard: &str) -> String {
    let spec = &made.texture.spec;
    let name = &spec.name;
    let number = |x| Dialect::C.number(x);
    let (mut arguments, mut clamps) = (Vec::new(), String::new());
    let (mut coordinates, mut counts) = (Vec::new(), Vec::new());
    for axis in &spec.axes {
        let argument = axis.along.argument();
        let (least, most) = match axis.along {
            Along::Shape { smallest } => (smallest, "INFINITY".into()),
            Along::Index { ends: [low, high], inside: false } => (low, number(high)),
            Along::Index { ends: [low, high], inside: true } => (1.0 / high, number(1.0 / low)),
            Along::LinearIndex { inside: true, .. } | Along::Contrast { inside: true, .. } => {
                (0.0, number(1.0))
            }
            Along::LinearIndex { .. } | Along::Contrast { .. } => (1.0, "INFINITY".into()),
            Along::Roughness { largest } => (0.0, number(largest)),
            Along::LinearRoughness => (0.0, number(1.0)),
            Along::View(_)
            | Along::Critical { .. }
            | Along::Cosine { .. }
            | Along::Angle
            | Along::RootVersine { .. } => (spec.least_cos, number(1.0)),
        };
        let least = number(least);
        clamps += &format!("    {argument} = fminf(fmaxf({argument}, {least}), {most});\n");
        arguments.push(format!("float {argument}"));
        coordinates.push(Dialect::C.coordinate(axis.along, spec.gamma));
        counts.push(axis.len().to_string());
    }
    let axes = counts.len();
    let (kind, parameter, local, result) = if channels > 1 {
        ("void", format!(", float *out /* {channels} */"), "", "")
    } else {
        ("float", String::new(), "    float out[1];\n", "    return out[0];\n")
    };
    let interface = spec.side().is_some();
    let sums = interface && spec.is_directional();
    let mut locals = String::new();
    if let (Some(eta), true) = (spec.eta, sums) {
        locals += &format!("    const float eta = {};\n", number(eta));
    }
    if sums {
        for line in Dialect::C.interface("const float").split_inclusive("; ") {
            locals += &format!("    {}\n", line.trim_end());
        }
    }
    let first = if sums { "    out[0] += f;\n    out[1] += 1.0f - f;\n" } else { "" };
    let meaning = match (&spec.channels[..], spec.is_directional()) {
        _ if interface => "out[0] is the share that is reflected, out[1] that transmitted,",
        ([Channel::Lost], _) => "1 - E",
        ([_], _) => "E",
        (_, true) => "out[0] is E; bias is out[1] + out[0] (1 - mu)^5, and scale E - bias,",
        (_, false) => "out[0] is E; bias is out[1] + out[0] / 21, and scale E - bias,",
    };
    format!(
        "/* {meaning} between\n   the texels; arguments beyond the ends, and NaN, are taken there. C99. */\n\
         {guard}_FUNCTION {kind} {name}_read({}{parameter}) {{\n{clamps}{locals}\
         \x20   const float c[{axes}] = {{\n        {}\n    }};\n\
         \x20   const int n[{axes}] = {{ {} }};\n\
         \x20   int first = 0, stride[{axes}], corner, axis, channel;\n\
         \x20   float share[{axes}];\n{local}\
         \x20   for (axis = 0; axis < {axes}; axis++) {{\n\
         \x20       const float x = fminf(fmaxf(c[axis], 0.0f), 1.0f) * (float)(n[axis] - 1);\n\
         \x20       int i = (int)x < n[axis] - 2 ? (int)x : n[axis] - 2;\n\
         \x20       first = first * n[axis] + i;\n\
         \x20       share[axis] = x - (float)i;\n\
         \x20   }}\n\
         \x20   stride[{last}] = 1;\n\
         \x20   for (axis = {last}; axis > 0; axis--) stride[axis - 1] = stride[axis] * n[axis];\n\
         \x20   for (channel = 0; channel < {channels}; channel++) out[channel] = 0.0f;\n\
         \x20   for (corner = 0; corner < {corners}; corner++) {{\n\
         \x20       int texel = first;\n\
         \x20       float weight = 1.0f;\n\
         \x20       for (axis = 0; axis < {axes}; axis++) {{\n\
         \x20           const int next = corner >> axis & 1;\n\
         \x20           texel += next * stride[axis];\n\
         \x20           weight *= next ? share[axis] : 1.0f - share[axis];\n\
         \x20       }}\n\
         \x20       for (channel = 0; channel < {channels}; channel++)\n\
         \x20           out[channel] += weight * {name}_texels[texel * {channels} + channel];\n\
         \x20   }}\n{first}{result}}}\n",
        arguments.join(", "),
        coordinates.join(",\n        "),
        counts.join(", "),
        last = axes - 1,
        corners = 1 << axes,
    )
}
