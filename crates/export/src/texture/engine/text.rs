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
    let mut text =
        format!("/* {} Replaces the arrays of these names. */\n\n", provenance(&textures[0]));
    for texture in textures {
        let row = texture.size().last().copied().unwrap_or(1);
        let name = &texture.spec.name;
        let _ = writeln!(text, "static const float table_{name}[{}] = {{", texture.values.len());
        for row in texture.values.chunks(row) {
            let row: String = row.iter().map(|x| format!("{x:.6}f, ")).collect();
            let _ = writeln!(text, "  {}", row.trim_end());
        }
        text += "};\n\n";
    }
    Ok(vec![ExportFile::new("shader.tables", text)])
}

/// OpenPBR: bodies of arrays of sixteen-bit integers.
pub(super) fn openpbr(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let body = |texture: &Texture| {
        let integer = |x: &f32| ((65535.0 * x).round() as u16).to_string();
        let numbers: Vec<String> = texture.values.iter().map(integer).collect();
        let text = format!(
            "// {}\n// clang-format off\n{}\n// clang-format on\n",
            provenance(texture),
            numbers.join(", ")
        );
        ExportFile::new(format!("openpbr_{}_energy_complement_data.h", texture.spec.name), text)
    };
    Ok(textures.iter().map(body).collect())
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
