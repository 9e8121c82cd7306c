//! Compares lookups of a family with the crate's, at a γ and σ of its own for each point.

mod compare;
mod points;

use bytemuck::{Pod, Zeroable};

use compare::Seen;

/// A point of a surface, a view and a light.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Hit {
    pub gamma: f32,
    pub sigma: [f32; 2],
    pub v: [f32; 3],
    pub l: [f32; 3],
    pub m: [f32; 3],
    pub u: [f32; 2],
}

/// What lookups have there, as numbers in the order of C; pairs are by form of masking.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct At {
    pub gamma: f32,
    pub d: f32,
    pub g1: f32,
    pub lambda: f32,
    pub pdf: f32,
    pub reflection_pdf: f32,
    pub normal: [f32; 3],
    pub g2: [f32; 2],
    pub weight: [f32; 2],
    pub f: [f32; 2],
    pub f_pdf: [f32; 2],
    pub albedo: [f32; 2],
    pub average: [f32; 2],
    pub parts: [[f32; 3]; 2],
    pub average_parts: [[f32; 3]; 2],
    pub compensation: [f32; 2],
    /// 1 or 0.
    pub is_smooth: f32,
}

/// Exported functions of a family in one or several languages.
pub trait ForeignFamily {
    /// The answers of each language.
    fn answers(&mut self, hits: &[Hit]) -> Vec<(&'static str, Vec<At>)>;
}

/// Limits of the differences.
pub struct FamilyLimits {
    /// G1 and what follows from it, from the crate's family.
    pub share: f64,
    /// The same from the model.
    pub exact: f64,
    /// Relative differences of densities: a constant, and one for each unit of |ln(D σx σy)|.
    pub density: [f64; 2],
    /// E and its average.
    pub albedo: f64,
    /// Other moments, and their averages.
    pub moment: f64,
    /// By how much random numbers may be off whose normals are those of the lookups.
    pub number: f32,
    /// Of slopes of normals, over one and their length, in units of the anisotropy.
    pub slope: f64,
    /// Whether NaN arguments must give numbers; otherwise points with NaN are left out.
    pub of_nan: bool,
}

/// Compares at `count` random points and at corners; prints the largest differences, and returns
/// whether all are allowed.
pub fn agree(foreign: &mut impl ForeignFamily, limits: &FamilyLimits, count: usize) -> bool {
    let mut good = true;
    for (title, mut hits) in
        [("random points", points::random(count)), ("corners", points::corners())]
    {
        hits.retain(|hit| limits.of_nan || !points::has_nan(hit));
        let mut seen = Seen::new(limits);
        let mut languages = Vec::new();
        for (language, answers) in foreign.answers(&hits) {
            seen.compare(&hits, &answers);
            languages.push(language);
        }
        let languages = languages.join(" and ");
        println!("largest differences of a family at {} {title}, {languages}", hits.len());
        good &= seen.print();
    }
    good
}
