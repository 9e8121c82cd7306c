//! The exported functions, compiled as C and as C++.

use student_t_agreement::{Answer, Foreign, Point};

unsafe extern "C" {
    fn c_answer(shape: usize, count: usize, points: *const Point, answers: *mut Answer);
    fn cpp_answer(shape: usize, count: usize, points: *const Point, answers: *mut Answer);
    fn c_sample(
        shape: usize,
        sigma: *const f32,
        count: usize,
        v: *const [f32; 3],
        u: *const [f32; 2],
        m: *mut [f32; 3],
    );
    fn c_compensation(
        shape: usize,
        sigma: *const f32,
        count: usize,
        v: *const [f32; 3],
        l: *const [f32; 3],
        lobe: *mut f32,
    );
    fn c_dielectric(
        shape: usize,
        table: i32,
        compensation: i32,
        count: usize,
        queries: *const Query,
        all: *mut Found,
    );
    fn cpp_dielectric(
        shape: usize,
        table: i32,
        compensation: i32,
        count: usize,
        queries: *const Query,
        all: *mut Found,
    );
    fn c_plastic(
        shape: usize,
        table: i32,
        compensation: i32,
        base: *const f32,
        count: usize,
        queries: *const Query,
        all: *mut Found,
    );
    fn cpp_plastic(
        shape: usize,
        table: i32,
        compensation: i32,
        base: *const f32,
        count: usize,
        queries: *const Query,
        all: *mut Found,
    );
    fn c_g1(shape: usize, sigma: *const f32, count: usize, v: *const [f32; 3], g1: *mut f32);
}

/// The shapes that were exported, in the order of the foreign functions.
pub fn gammas() -> Vec<f64> {
    let text = include_str!(concat!(env!("OUT_DIR"), "/gammas.txt"));
    text.lines().map(|gamma| gamma.parse().expect("a number")).collect()
}

/// The shapes as compiled.
pub struct Compiled;

impl Foreign for Compiled {
    fn answers(&mut self, shape: usize, points: &[Point]) -> Vec<(&'static str, Vec<Answer>)> {
        let by = |language, function: unsafe extern "C" fn(_, _, _, _)| {
            let mut answers = vec![Answer::default(); points.len()];
            // SAFETY: both are of the length passed, and of the layout of `lookups.c`.
            unsafe { function(shape, points.len(), points.as_ptr(), answers.as_mut_ptr()) };
            (language, answers)
        };
        vec![by("C", c_answer), by("C++", cpp_answer)]
    }
}

/// Normals by C; all slices are of one length.
pub fn sample(shape: usize, sigma: [f32; 2], v: &[[f32; 3]], u: &[[f32; 2]], m: &mut [[f32; 3]]) {
    assert!(v.len() == u.len() && u.len() == m.len());
    // SAFETY: all are of the length passed.
    unsafe { c_sample(shape, sigma.as_ptr(), v.len(), v.as_ptr(), u.as_ptr(), m.as_mut_ptr()) }
}

/// G1 by C; both slices are of one length.
pub fn g1(shape: usize, sigma: [f32; 2], v: &[[f32; 3]], g1: &mut [f32]) {
    assert_eq!(v.len(), g1.len());
    // SAFETY: both are of the length passed.
    unsafe { c_g1(shape, sigma.as_ptr(), v.len(), v.as_ptr(), g1.as_mut_ptr()) }
}

/// The compensating lobe of height-correlated masking by C; all slices are of one length.
pub fn compensation(
    shape: usize,
    sigma: [f32; 2],
    v: &[[f32; 3]],
    l: &[[f32; 3]],
    lobe: &mut [f32],
) {
    assert!(v.len() == l.len() && l.len() == lobe.len());
    let (count, sigma) = (v.len(), sigma.as_ptr());
    // SAFETY: all are of the length passed.
    unsafe { c_compensation(shape, sigma, count, v.as_ptr(), l.as_ptr(), lobe.as_mut_ptr()) }
}

/// A dielectric, a view of either side and a light.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Query {
    pub sigma: [f32; 2],
    pub eta: f32,
    pub v: [f32; 3],
    pub l: [f32; 3],
    pub choice: f32,
    pub u: [f32; 2],
    pub masking: i32,
    pub transport: i32,
}

/// What C has for a query: a sample, and f and densities towards the light, back from it, and
/// towards the sampled light.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Found {
    pub event: i32,
    pub is_delta: i32,
    pub l: [f32; 3],
    pub m: [f32; 3],
    pub weight: [f32; 3],
    pub pdf: f32,
    pub eta: f32,
    pub f: [[f32; 3]; 3],
    pub density: [f32; 3],
}

/// The indices of the tables that were exported, in the order of the foreign functions.
pub fn indices() -> Vec<f64> {
    let text = include_str!(concat!(env!("OUT_DIR"), "/indices.txt"));
    text.lines().map(|eta| eta.parse().expect("a number")).collect()
}

/// Dielectrics by C and by C++: of one bounce, or by the table and the form of compensation given.
pub fn dielectric(shape: usize, by: Option<(usize, usize)>, queries: &[Query]) -> [Vec<Found>; 2] {
    let (table, form) = by.map_or((-1, 0), |(table, form)| (table as i32, form as i32));
    let count = queries.len();
    [c_dielectric, cpp_dielectric].map(|function: unsafe extern "C" fn(_, _, _, _, _, _)| {
        let mut all = vec![Found::default(); count];
        // SAFETY: both are of the length passed, and of the layout of `interfaces.c`.
        unsafe { function(shape, table, form, count, queries.as_ptr(), all.as_mut_ptr()) };
        all
    })
}

/// Plastics by C and by C++, by a table and a form of compensation.
pub fn plastic(
    shape: usize,
    (table, form): (usize, usize),
    base: [f32; 3],
    queries: &[Query],
) -> [Vec<Found>; 2] {
    let (table, form, count) = (table as i32, form as i32, queries.len());
    [c_plastic, cpp_plastic].map(|function: unsafe extern "C" fn(_, _, _, _, _, _, _)| {
        let mut all = vec![Found::default(); count];
        let base = base.as_ptr();
        // SAFETY: both are of the length passed, and of the layout of `interfaces.c`.
        unsafe { function(shape, table, form, base, count, queries.as_ptr(), all.as_mut_ptr()) };
        all
    })
}
