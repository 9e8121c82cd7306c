//! The family that C reads, from its header and from a file.

use std::ffi::c_void;

use student_t_agreement::{At, FamilyLimits, ForeignFamily, Hit, agree_with_family};

unsafe extern "C" {
    fn c_family(bytes: *const c_void, size: u32, count: usize, hits: *const Hit, all: *mut At);
    fn cpp_family(bytes: *const c_void, size: u32, count: usize, hits: *const Hit, all: *mut At);
}

/// The limits that the documentation of exports states.
const LIMITS: FamilyLimits = FamilyLimits {
    share: 5e-6,
    exact: 1e-5,
    density: [3e-5, 4e-6],
    albedo: 2.5e-4,
    moment: 1e-3,
    number: 1e-5,
    slope: 2e-6,
    of_nan: true,
};

/// The file of the family, which lookups read in place of the header's tables; whole words, since
/// its address is a multiple of 4.
struct File(Vec<u32>);

impl File {
    fn read(path: &str) -> Self {
        let bytes = std::fs::read(path).expect("the file of a family");
        Self(bytes.chunks_exact(4).map(|w| u32::from_ne_bytes(w.try_into().unwrap())).collect())
    }

    fn answers(&self, hits: &[Hit]) -> Vec<At> {
        let mut all = vec![At::default(); hits.len()];
        let size = 4 * self.0.len() as u32;
        // SAFETY: all are of the lengths passed, and of the layout of `families.c`.
        unsafe {
            c_family(self.0.as_ptr().cast(), size, hits.len(), hits.as_ptr(), all.as_mut_ptr());
        }
        all
    }
}

impl ForeignFamily for File {
    fn answers(&mut self, hits: &[Hit]) -> Vec<(&'static str, Vec<At>)> {
        let [c, cpp] =
            [c_family, cpp_family].map(|function: unsafe extern "C" fn(_, _, _, _, _)| {
                let mut all = vec![At::default(); hits.len()];
                // SAFETY: both are of the length passed, and of the layout of `families.c`.
                unsafe {
                    function(std::ptr::null(), 0, hits.len(), hits.as_ptr(), all.as_mut_ptr())
                };
                all
            });
        let bits = |all: &[At]| all.iter().map(|at| format!("{at:?}")).collect::<Vec<_>>();
        assert_eq!(bits(&Self::answers(self, hits)), bits(&c), "the file is not the header");
        vec![("C", c), ("C++", cpp)]
    }
}

/// Compares at `count` random points and at corners, by C, by C++, and by the file at `path`;
/// returns whether all differences are allowed.
pub fn agree(count: usize, path: &str) -> bool {
    agree_with_family(&mut File::read(path), &LIMITS, count)
}
