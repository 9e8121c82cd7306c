//! Lobes of every γ, by buffer and by texture.

use student_t_agreement::{At, FamilyLimits, ForeignFamily, Hit, agree_with_family};

use crate::device::{Gpu, Program};
use crate::export::Export;

/// The limits that the documentation states.
const LIMITS: FamilyLimits = FamilyLimits {
    share: 1e-5,
    exact: 1e-5,
    density: [1e-4, 1e-4],
    albedo: 2.5e-4,
    moment: 1e-3,
    number: 1e-5,
    slope: 4e-6,
    of_nan: false,
};

/// Compares the functions of exports by buffer and by texture with the crate's.
pub fn agrees(gpu: &Gpu, exports: &[Export; 2], points: usize) -> bool {
    let program = |export: &Export, tables| {
        let wgsl = format!("{}{}", export.module, include_str!("lookups_family.wgsl"));
        gpu.program(&wgsl, "main", tables)
    };
    let [buffers, textures] = exports;
    let buffer = program(buffers, gpu.buffer(&buffers.tables));
    let texture = program(textures, gpu.texture(&textures.tables));
    let mut lookups = Lookups { gpu, programs: [("by buffer", buffer), ("by texture", texture)] };
    agree_with_family(&mut lookups, &LIMITS, points)
}

struct Lookups<'a> {
    gpu: &'a Gpu,
    programs: [(&'static str, Program); 2],
}

impl ForeignFamily for Lookups<'_> {
    fn answers(&mut self, hits: &[Hit]) -> Vec<(&'static str, Vec<At>)> {
        let answer = |(name, program): &(&'static str, Program)| {
            // No more groups at once than devices promise.
            let chunks = hits.chunks(1 << 20).flat_map(|hits| {
                let (size, groups) =
                    (size_of_val(hits) / size_of::<Hit>(), hits.len().div_ceil(64));
                let size = size * size_of::<At>();
                let bytes =
                    self.gpu.run(program, bytemuck::cast_slice(hits), None, size, groups as u32);
                bytemuck::pod_collect_to_vec::<u8, At>(&bytes)
            });
            let mut all: Vec<At> = chunks.collect();
            // Infinity is 1e18 here.
            all.iter_mut().filter(|at| at.gamma >= 1e18).for_each(|at| at.gamma = f32::MAX);
            (*name, all)
        };
        self.programs.iter().map(answer).collect()
    }
}
