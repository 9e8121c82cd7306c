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

/// Pairs of numbers in rows.
pub struct Tables {
    pub bytes: Vec<u8>,
    pub width: u32,
    pub height: u32,
}

impl Export {
    pub fn read(folder: &Path) -> Self {
        let file = |name: &str| folder.join(name);
        let text = |name| fs::read_to_string(file(name)).expect(name);
        let description: Value =
            serde_json::from_str(&text("student_t.json")).expect("a description");
        let number = |name: &str| description[name].as_u64().expect(name) as u32;
        let tables = Tables {
            bytes: fs::read(file("student_t.bin")).expect("tables"),
            width: number("width"),
            height: number("height"),
        };
        let (module, sample) = (text("student_t.wgsl"), text("student_t_sample.wgsl"));
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
