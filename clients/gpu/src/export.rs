//! What `microfacet-bake export` wrote.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// A module and its tables.
pub struct Export {
    /// The functions.
    pub module: String,
    /// The program that came with them.
    pub sample: String,
    pub tables: Tables,
    description: Value,
}

/// Texels in rows.
pub struct Tables {
    pub bytes: Vec<u8>,
    pub width: u32,
    pub height: u32,
    pub format: wgpu::TextureFormat,
}

impl Export {
    /// Reads the files of an export, whose names begin with `student_t` or `student_t_family`.
    pub fn read(folder: &Path, name: &str) -> Self {
        let file = |end: &str| folder.join(format!("{name}{end}"));
        let text = |end: &str| fs::read_to_string(file(end)).expect(end);
        let description: Value = serde_json::from_str(&text(".json")).expect("a description");
        let number = |name: &str| description[name].as_u64().expect(name) as u32;
        let tables = Tables {
            bytes: fs::read(file(".bin")).expect("tables"),
            width: number("width"),
            height: number("height"),
            format: match description["format"].as_str() {
                Some("rg32f") => wgpu::TextureFormat::Rg32Float,
                Some("r32uint") => wgpu::TextureFormat::R32Uint,
                other => panic!("{other:?} is no format of exports"),
            },
        };
        let (module, sample) = (text(".wgsl"), text("_sample.wgsl"));
        Self { module, sample, tables, description }
    }

    /// The exported shapes: γ, and the offset by which functions identify each.
    fn shapes(&self) -> impl Iterator<Item = (f64, u32)> {
        let shapes = self.description["shapes"].as_object().expect("shapes");
        shapes.iter().map(|(gamma, shape)| {
            let offset = shape["offset"].as_u64().expect("an offset") as u32;
            (gamma.parse().expect("a number"), offset)
        })
    }

    /// The exported γ, ascending.
    pub fn gammas(&self) -> Vec<f64> {
        let mut gammas: Vec<f64> = self.shapes().map(|(gamma, _)| gamma).collect();
        gammas.sort_by(f64::total_cmp);
        gammas
    }

    /// The offset by which functions identify a shape.
    pub fn offset(&self, gamma: f64) -> u32 {
        let found = self.shapes().find(|(other, _)| *other == gamma);
        found.unwrap_or_else(|| panic!("gamma {gamma} was not exported")).1
    }
}
