//! The line with which a shader reads a texture.

use std::f64::consts::FRAC_2_PI;

use microfacet_tables::axis::LogShape;

use super::axis::{Along, TexelAxis};
use super::{Channel, TextureSpec};
use crate::numbers::single;

/// The same line in three languages, where `lut_texture` is the texture `lut`, read with a linear
/// filter that clamps. Variables are `sigma`, `mu`, the cosine of the view, in [1e-4, 1], and
/// `gamma`.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Lines {
    /// GLSL, for any version with `texture`.
    pub glsl: String,
    /// HLSL.
    pub hlsl: String,
    /// WGSL.
    pub wgsl: String,
}

/// The expression of `gamma`, `sigma` and `mu` at which a texture is read whose texels reach the
/// ends of its coordinates; `vector` and `suffix` are the name of a vector type before and after
/// its number of components.
pub fn coordinates(axes: &[TexelAxis], gamma: f64, [vector, suffix]: [&str; 2]) -> String {
    // The fastest axis is the first coordinate.
    let axes: Vec<&TexelAxis> = axes.iter().rev().collect();
    let of = |part: &dyn Fn(&TexelAxis) -> String| -> Vec<String> {
        axes.iter().map(|axis| part(axis)).collect()
    };
    let n = |axis: &TexelAxis| axis.len() as f64;
    let offset = of(&|axis| Dialect::Shader.number(0.5 / n(axis)));
    let factor = of(&|axis| Dialect::Shader.number((n(axis) - 1.0) / n(axis)));
    let coordinate = of(&|axis| Dialect::Shader.coordinate(axis.along, gamma)).join(", ");
    // An average of one shape is a texture of one row.
    let vector = format!("{vector}{}{suffix}", axes.len().max(2));
    // One number serves for equal ones.
    let all = |numbers: &[String]| match numbers {
        [first, rest @ ..] if rest.iter().all(|other| other == first) => first.clone(),
        _ => format!("{vector}({})", numbers.join(", ")),
    };
    let at = format!("{} + {} * ", all(&offset), all(&factor));
    match axes.len() {
        1 => format!("{vector}({at}{coordinate}, 0.5)"),
        _ => format!("{at}{vector}({coordinate})"),
    }
}

/// The lines for a texture whose texels reach the ends of its coordinates.
pub fn shader_lines(spec: &TextureSpec) -> Lines {
    let read = |vector: &str, suffix: &str| coordinates(&spec.axes, spec.gamma, [vector, suffix]);
    // The suffix keeps the name from being a keyword or a variable of the line.
    let texture = format!("{}_texture", spec.name);
    let (mirror, of) = if spec.is_directional() {
        ("pow(max(0.0, 1.0 - mu), 5.0)", "")
    } else {
        ("1.0 / 21.0", "_average")
    };
    let line = |one: &str, two: &str, read: String| match spec.channels[..] {
        [Channel::E, Channel::Excess] => {
            format!(
                "{two} e_excess{of} = {read}.rg; \
                 {one} bias{of} = e_excess{of}.y + e_excess{of}.x * {mirror};"
            )
        }
        [Channel::Lost] => format!("{one} lost{of} = {read}.r;"),
        _ => format!("{one} e{of} = {read}.r;"),
    };
    Lines {
        glsl: line("float", "vec2", format!("texture({texture}, {})", read("vec", ""))),
        hlsl: line(
            "float",
            "float2",
            format!("{texture}.SampleLevel(linear_clamp, {}, 0)", read("float", "")),
        ),
        wgsl: line(
            "let",
            "let",
            format!("textureSampleLevel({texture}, linear_clamp, {}, 0.0)", read("vec", "f")),
        ),
    }
}

/// How a language writes functions and numbers.
#[derive(Clone, Copy)]
pub(super) enum Dialect {
    /// GLSL, HLSL and WGSL agree.
    Shader,
    /// C in single precision.
    C,
}

impl Dialect {
    fn function(self, name: &str) -> String {
        match self {
            Self::Shader => name.into(),
            Self::C if name == "max" => "fmaxf".into(),
            Self::C => format!("{name}f"),
        }
    }

    /// A number in single precision, with a decimal point.
    pub(super) fn number(self, x: f64) -> String {
        let suffix = if matches!(self, Self::C) { "f" } else { "" };
        single(x as f32) + suffix
    }

    /// A coordinate as an expression of `gamma`, `sigma` and `mu`.
    pub(super) fn coordinate(self, along: Along, gamma: f64) -> String {
        let number = |x| self.number(x);
        let [sqrt, pow, log, max] = ["sqrt", "pow", "log", "max"].map(|name| self.function(name));
        let [zero, one, two, three, quarter] = [0.0, 1.0, 2.0, 3.0, 0.25].map(number);
        match along {
            Along::Shape { smallest } => {
                let [scale, last] =
                    [LogShape::BAKED.scale, LogShape::BAKED.coordinate(smallest)].map(number);
                format!("{log}({one} + {scale} / ({two} * gamma - {three})) / {last}")
            }
            Along::Roughness { largest: 1.0 } => format!("{sqrt}(sigma)"),
            Along::Roughness { largest } => format!("{sqrt}(sigma / {})", number(largest)),
            Along::View(view) => {
                let kappa = if gamma.is_nan() {
                    let [scale, heavy] = [view.scale, view.heavy].map(number);
                    format!("({scale} + {heavy} / ({two} * gamma - {three}))")
                } else {
                    number(view.of_shape(gamma).scale)
                };
                let sin = format!("{sqrt}({max}({zero}, {one} - mu * mu))");
                format!("{pow}(mu / (mu + {kappa} * sigma * {sin}), {quarter})")
            }
            Along::LinearRoughness => "sigma".into(),
            Along::Cosine { .. } => "mu".into(),
            Along::Angle => {
                format!("{}(mu) * {}", self.function("acos"), number(FRAC_2_PI))
            }
            Along::RootVersine { .. } => format!("{sqrt}({max}({zero}, {one} - mu))"),
            Along::Index { first, last, inside } => {
                let n = if inside { format!("{one} / eta") } else { "eta".into() };
                format!("({n} - {}) / {}", number(first), number(last - first))
            }
            Along::Contrast { inside, .. } => {
                let (a, b) = if inside { (&*one, "eta") } else { ("eta", &*one) };
                format!("{sqrt}({max}({zero}, {a} - {b}) / ({a} + {b}))")
            }
        }
    }
}
