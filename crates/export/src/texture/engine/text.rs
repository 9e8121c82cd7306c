//! Textures as the source text that engines compile.

use std::fmt::Write;

use half::f16;

use super::Texture;
use crate::ExportFile;
use crate::numbers::{as_typed, lines};

/// One line on the content of a texture.
fn provenance(texture: &Texture) -> String {
    let spec = &texture.spec;
    let size: Vec<String> = texture.size().iter().map(usize::to_string).collect();
    let values = if spec.fitted { "fitted to the filter" } else { "exact at the texels" };
    format!(
        "Albedo of gamma {}, {} masking, {}, {values}; microfacet-bake {}.",
        as_typed(spec.gamma),
        spec.masking,
        size.join("x"),
        env!("CARGO_PKG_VERSION")
    )
}

/// Cycles: arrays of decimal numbers, to replace those in `src/scene/shader.tables`.
pub(super) fn cycles(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    Ok(vec![ExportFile::new("shader.tables", arrays(textures))])
}

/// As [`cycles`]. The first slice, of equal indices, is 1: the engine lets light straight through
/// such a surface, and divides by the table.
pub(super) fn cycles_glass(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let mut textures = textures.to_vec();
    for texture in &mut textures {
        let slice = texture.values.len() / texture.size()[0];
        texture.values[..slice].fill(1.0);
    }
    Ok(vec![ExportFile::new("shader_glass.tables", arrays(&textures))])
}

/// Arrays of decimal numbers, a blank line between the slices of a volume.
fn arrays(textures: &[Texture]) -> String {
    let mut text =
        format!("/* {} Replaces the arrays of these names. */\n", provenance(&textures[0]));
    for texture in textures {
        let size = texture.size();
        let name = &texture.spec.name;
        let row = size.last().copied().unwrap_or(1);
        let rows = if size.len() == 3 { size[1] } else { usize::MAX };
        let _ = write!(text, "\nstatic const float table_{name}[{}] = {{", texture.values.len());
        for (i, row) in texture.values.chunks(row).enumerate() {
            let gap = if i > 0 && i % rows == 0 { "\n" } else { "" };
            let row: String = row.iter().map(|x| format!("{x:.6}f, ")).collect();
            let _ = write!(text, "{gap}\n  {}", row.trim_end());
        }
        text += "\n};\n";
    }
    text
}

/// The body of an array of sixteen-bit integers, from channels of textures one after another.
fn integers(name: &str, parts: &[(&Texture, usize)]) -> ExportFile {
    let values = parts.iter().flat_map(|(texture, channel)| texture.plane(*channel));
    let numbers: Vec<String> = values.map(|x| ((65535.0 * x).round() as u16).to_string()).collect();
    let text = format!(
        "// {}\n// clang-format off\n{}\n// clang-format on\n",
        provenance(parts[0].0),
        numbers.join(", ")
    );
    ExportFile::new(format!("openpbr_{name}_data.h"), text)
}

/// OpenPBR: bodies of arrays of sixteen-bit integers.
pub(super) fn openpbr(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let body = |texture: &Texture| {
        integers(&format!("{}_energy_complement", texture.spec.name), &[(texture, 0)])
    };
    Ok(textures.iter().map(body).collect())
}

/// As [`openpbr`], of tables from inside and from outside.
pub(super) fn openpbr_dielectric(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let body = |name: &str, first: usize, channel: usize| {
        integers(name, &[(&textures[first], channel), (&textures[first + 2], channel)])
    };
    Ok(vec![
        body("ideal_dielectric_energy_complement", 0, 0),
        body("opaque_dielectric_energy_complement", 0, 1),
        body("ideal_dielectric_avg_energy_complement", 1, 0),
        body("opaque_dielectric_avg_energy_complement", 1, 1),
    ])
}

/// EEVEE: an array of texels, to replace that in `eevee_lut.cc`.
pub(super) fn eevee(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let texture = &textures[0];
    let size = texture.size();
    let mut text = format!(
        "/* {} Replaces the array of this name. */\nconst float {}[{}][{}][3] = {{\n",
        provenance(texture),
        texture.spec.name,
        size[0],
        size[1]
    );
    for row in texture.values.chunks(3 * size[1]) {
        let texel = |x: &[f32]| format!("{{{:.6}f, {:.6}f, {:.6}f}}", x[0], x[1], x[2]);
        let texels: Vec<String> = row.chunks(3).map(texel).collect();
        let _ = writeln!(text, "    {{{}}},", texels.join(", "));
    }
    text += "};\n";
    Ok(vec![ExportFile::new("eevee_lut.cc", text)])
}

/// OSL: a header with a definition of `get_energy`.
pub(super) fn osl(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let texture = &textures[0];
    let lobe = &texture.spec.name;
    let mut text = format!(
        "// {}\n#pragma once\n\nBSDL_ENTER_NAMESPACE\n\nnamespace spi {{\n\n\
         BSDL_INLINE_METHOD {lobe}::Energy& {lobe}::get_energy()\n{{\n    static Energy energy = {{{{\n",
        provenance(texture)
    );
    for row in texture.values.chunks(texture.size()[1]) {
        let row: String = row.iter().map(|x| format!(" {x:?}f,")).collect();
        let _ = writeln!(text, "       {row}");
    }
    text += "    }};\n    return energy;\n}\n\n}  // namespace spi\n\nBSDL_LEAVE_NAMESPACE\n";
    Ok(vec![ExportFile::new("microfacet_tools_luts.h", text)])
}

/// The bits of sixteen-bit floats.
fn bits(texture: &Texture) -> impl Iterator<Item = String> + '_ {
    texture.values.iter().map(|&x| format!("0x{:04x}", f16::from_f32(x).to_bits()))
}

/// Filament: a list of numbers that is included.
pub(super) fn filament(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let texture = &textures[0];
    let mut text =
        format!("// {}\n// Three halves a texel: bias, E, and 0 for cloth\n", provenance(texture));
    let all: Vec<String> = bits(texture).collect();
    for line in all.chunks(12) {
        let _ = writeln!(text, "{},", line.join(", "));
    }
    Ok(vec![ExportFile::new("dfg.inc", text)])
}

/// three.js: an array, to replace that in both files.
pub(super) fn three(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let (provenance, numbers) = (provenance(&textures[0]), lines(bits(&textures[0])));
    let text = format!("// {provenance}\nconst DATA = new Uint16Array( [\n{numbers}\n] );\n");
    Ok(vec![ExportFile::new("DFGLUTData.js", text)])
}
