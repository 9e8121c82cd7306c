//! The line with which a shader reads a texture.

use std::f64::consts::FRAC_2_PI;

use microfacet_tables::axis::LogShape;

use super::axis::{Along, TexelAxis};
use super::interface::{KNEE, POWER, WIDTH, index_coordinate};
use super::{Channel, TextureSpec};
use crate::numbers::single;

/// What keeps 0/0 from views of a smooth interface at the critical angle.
const TINY: f64 = 1e-20;

/// The same line in three languages, where `lut_texture` is the texture `lut`, read with a linear
/// filter that clamps. Variables are `sigma`, `mu`, the cosine of the view, in [1e-4, 1], and
/// `gamma`; of functions, which read interfaces, `eta`, the index beyond over that on the side of
/// the view.
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
    if spec.side().is_some() {
        return functions(spec);
    }
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

/// Functions that read both shares of an interface, each in one line: what they declare cannot be
/// declared twice where a shader reads both sides.
fn functions(spec: &TextureSpec) -> Lines {
    let name = &spec.name;
    let arguments: Vec<&str> = spec.axes.iter().map(|axis| axis.along.argument()).collect();
    let line = |head: String, local: &str, pair: &str, read: String| {
        let mut body = String::new();
        let read = if spec.is_directional() {
            if let Some(eta) = spec.eta {
                body += &format!("{local} eta = {}; ", Dialect::Shader.number(eta));
            }
            body += &Dialect::Shader.interface(local);
            format!("{pair}(f, 1.0 - f) + {read}")
        } else {
            read
        };
        format!("{head} {{ {body}return {read}.rg; }}")
    };
    let texture = format!("{name}_texture");
    let at = |vector, suffix| coordinates(&spec.axes, spec.gamma, [vector, suffix]);
    let typed = |word: &str| {
        arguments.iter().map(|name| format!("{word} {name}")).collect::<Vec<_>>().join(", ")
    };
    let after: Vec<String> = arguments.iter().map(|name| format!("{name}: f32")).collect();
    Lines {
        glsl: line(
            format!("vec2 {name}({})", typed("float")),
            "float",
            "vec2",
            format!("texture({texture}, {})", at("vec", "")),
        ),
        hlsl: line(
            format!("float2 {name}({})", typed("float")),
            "float",
            "float2",
            format!("{texture}.SampleLevel(linear_clamp, {}, 0)", at("float", "")),
        ),
        wgsl: line(
            format!("fn {name}({}) -> vec2f", after.join(", ")),
            "let",
            "vec2f",
            format!("textureSampleLevel({texture}, linear_clamp, {}, 0.0)", at("vec", "f")),
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
            Self::C if ["max", "abs"].contains(&name) => format!("f{name}f"),
            Self::C => format!("{name}f"),
        }
    }

    /// A number in single precision, with a decimal point.
    pub(super) fn number(self, x: f64) -> String {
        let suffix = if matches!(self, Self::C) { "f" } else { "" };
        single(x as f32) + suffix
    }

    /// Declarations of `rim` and `past`, by which views of an interface differ from those of a
    /// mirror, and of `f`, the softened reflectance of a smooth one.
    pub(super) fn interface(self, local: &str) -> String {
        let [sqrt, max, abs] = ["sqrt", "max", "abs"].map(|name| self.function(name));
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|x| self.number(x));
        let tiny = self.number(TINY);
        let declared = [
            ("rim", format!("sigma * mu * {sqrt}({max}({zero}, {one} - mu * mu))")),
            ("past", format!("(eta - {one}) * (eta + {one}) + mu * mu")),
            (
                "g",
                format!(
                    "{sqrt}({max}({zero}, past) + {half} * rim * rim / ({abs}(past) + rim + {tiny}))"
                ),
            ),
            ("a", "(mu - g) / (mu + g)".into()),
            ("b", format!("(mu * (mu + g) - {one}) / (mu * (g - mu) + {one})")),
            ("f", format!("{half} * a * a * ({one} + b * b)")),
        ];
        declared.map(|(name, value)| format!("{local} {name} = {value}; ")).concat()
    }

    /// A coordinate as an expression of `gamma`, `sigma` and `mu`.
    pub(super) fn coordinate(self, along: Along, gamma: f64) -> String {
        let number = |x| self.number(x);
        let [sqrt, pow, log, max, abs] =
            ["sqrt", "pow", "log", "max", "abs"].map(|name| self.function(name));
        let [zero, one, two, three, quarter] = [0.0, 1.0, 2.0, 3.0, 0.25].map(number);
        match along {
            Along::Shape { smallest } => {
                let [scale, last] =
                    [LogShape::BAKED.scale, LogShape::BAKED.coordinate(smallest)].map(number);
                format!("{log}({one} + {scale} / ({two} * gamma - {three})) / {last}")
            }
            Along::Index { ends, .. } => {
                let [first, last] = ends.map(index_coordinate);
                let v = format!("{sqrt}({abs}(eta - {one}) / (eta + {one}))");
                let scale = number(1.0 / (last - first));
                match first {
                    0.0 => format!("{v} * {scale}"),
                    _ => format!("({v} - {}) * {scale}", number(first)),
                }
            }
            Along::Critical { near } => {
                let [step, near, power, width, tiny] =
                    [0.5 * (1.0 - near), near, POWER, WIDTH, TINY].map(number);
                let knee = number(KNEE[0] + KNEE[1] / (2.0 * gamma - 3.0));
                let sin = format!("{sqrt}({max}({zero}, {one} - mu * mu))");
                format!(
                    "{near} * {pow}(mu / (mu + {knee} * sigma * {sin}), {power}) + \
                     {step} * ({one} + past / ({abs}(past) + {width} * rim + {tiny}))"
                )
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
            Along::LinearIndex { first, last, inside } => {
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
