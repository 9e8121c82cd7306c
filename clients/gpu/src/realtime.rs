//! The kit for real time, by the device's own filter, against the crate.

use std::f32::consts::PI;
use std::fs;
use std::path::Path;

use bytemuck::{Pod, Zeroable};
use microfacet_sampler::albedo::{FamilyAlbedo, f82_tint_average};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Family, Masking, MicrofacetDistribution, Tables};
use serde_json::Value;
use wgpu::TextureFormat::{R16Float, Rgba16Float};

use crate::device::{Filtered, Gpu};

/// A hit with a view and a light, as the shader has it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Query {
    v: [f32; 3],
    gamma: f32,
    l: [f32; 3],
    sigma: [f32; 2],
    rest: [f32; 3],
}

/// What it answers.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Answer {
    texel: [f32; 4],
    areas: [f32; 2],
    f_cos: f32,
    pdf: f32,
    d: f32,
    schlick: f32,
    tinted: f32,
    further: f32,
    scaled: f32,
    rest: [f32; 3],
}

/// A reflectance at normal incidence and a tint, those of the shader.
const METAL: [f32; 2] = [0.8, 0.6];

/// What is compared, and its largest error: in single precision, and, where it is any good, in
/// half, of hits with cosines of at least 0.05 and σ of at least 0.1.
const LIMITS: [(&str, f64, Option<f64>); 10] = [
    ("G1, relative", 4e-4, Some(6e-3)),
    ("f cos, relative, gamma < 20", 5e-4, None),
    ("density, relative, gamma < 20", 5e-4, None),
    ("D over its peak", 1.2e-3, None),
    ("E", 1.5e-3, Some(4e-3)),
    ("E, sigma < 0.01 or cos theta < 0.02", 8e-3, None),
    ("E_avg", 1.2e-3, Some(3e-3)),
    ("albedo of F0 = 0.04", 2.5e-3, Some(4e-3)),
    ("albedo of F0 = 0.8, tint 0.6", 3e-3, Some(6e-3)),
    ("further bounces, sigma > 0.1", 5e-3, Some(8e-3)),
];

/// Names of numbers in the functions, and what stands for them.
const SINGLE: &str = "alias real = f32; alias real2 = vec2f; alias real3 = vec3f; \
                      alias real4 = vec4f;\n";
const HALF: &str = "alias real = f16; alias real2 = vec2h; alias real3 = vec3h; \
                    alias real4 = vec4h;\n";

/// Compares the functions of a folder with the crate at random points and corners.
pub fn agrees(gpu: &Gpu, folder: &Path, points: usize) -> bool {
    let module = text(folder, ".wgsl");
    let textures = textures(folder);
    // The program that comes with it is valid, at least.
    gpu.module(&format!("{module}{}", text(folder, "_sample.wgsl")));
    let compare = |text: String, queries: &[Query]| -> [(f64, Query); LIMITS.len()] {
        let text = format!("{text}{}", include_str!("lookups_realtime.wgsl"));
        let program = gpu.program(&text, "main", gpu.filtered(&textures));
        let size = size_of::<Answer>() * queries.len();
        let groups = queries.len().div_ceil(64) as u32;
        let bytes = gpu.run(&program, bytemuck::cast_slice(queries), None, size, groups);
        worst(queries, &bytemuck::pod_collect_to_vec(&bytes))
    };
    let queries = queries(points);
    let single = compare(format!("{module}{SINGLE}"), &queries);
    let half = gpu.has_halves().then(|| {
        let rough = |query: &Query| {
            let Query { v, l, sigma, .. } = query;
            v[2].min(l[2]) >= 0.05 && sigma[0].min(sigma[1]) >= 0.1
        };
        let queries: Vec<Query> = queries.iter().copied().filter(rough).collect();
        compare(format!("enable f16;\n{}{HALF}", in_half(&module)), &queries)
    });
    println!("Functions for real time, {} points:", queries.len());
    let mut good = true;
    for (i, (name, limit, of_half)) in LIMITS.iter().enumerate() {
        let (error, Query { v, gamma, l, sigma, .. }) = single[i];
        println!("  {name:36} {error:.1e} of {limit:.1e}  gamma {gamma} {sigma:?} {v:?} {l:?}");
        good &= error <= *limit;
        if let (Some(limit), Some(half)) = (of_half, &half) {
            let (error, Query { v, gamma, l, sigma, .. }) = half[i];
            println!(
                "    in half {error:33.1e} of {limit:.1e}  gamma {gamma} {sigma:?} {v:?} {l:?}"
            );
            good &= error <= *limit;
        }
    }
    if half.is_none() {
        println!("  (the device has no arithmetic in half precision)");
    }
    good
}

/// The functions in half precision, with limits that it has.
fn in_half(module: &str) -> String {
    let replaced = [
        ("vec2f", "vec2h"),
        ("vec3f", "vec3h"),
        ("vec4f", "vec4h"),
        ("f32", "f16"),
        ("1e6)", "6e4)"),
        ("1e-24", "6e-8"),
        ("1e-12", "6e-8"),
        ("1e-20", "6e-8"),
    ];
    replaced.iter().fold(module.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// The largest error of each of [`LIMITS`].
fn worst(queries: &[Query], answers: &[Answer]) -> [(f64, Query); LIMITS.len()] {
    let tables = Tables::embedded();
    let family = tables.family().expect("a family");
    let albedo = tables.family_albedo(Masking::HeightCorrelated).expect("albedos");
    let mut worst = [(0.0, Query::zeroed()); LIMITS.len()];
    for (query, answer) in queries.iter().zip(answers) {
        for (worst, error) in worst.iter_mut().zip(errors(query, answer, &family, &albedo)) {
            // What is no number exceeds all.
            let error = if error.is_nan() { f64::INFINITY } else { error };
            if error > worst.0 {
                *worst = (error, *query);
            }
        }
    }
    worst
}

fn text(folder: &Path, end: &str) -> String {
    fs::read_to_string(folder.join(format!("student_t_realtime{end}"))).expect(end)
}

/// Both textures, as their description says.
fn textures(folder: &Path) -> [Filtered; 2] {
    let told: Value = serde_json::from_str(&text(folder, ".json")).expect("a description");
    [("masking", R16Float), ("albedo", Rgba16Float)].map(|(name, format)| {
        let one = &told["textures"][name];
        let number = |value: &Value| value.as_u64().expect("a number") as usize;
        let size: Vec<usize> = one["size"].as_array().expect("a size").iter().map(number).collect();
        let bytes = fs::read(folder.join(one["file"].as_str().expect("a file"))).expect(name);
        let start = number(&one["offset"]);
        let texels = bytes[start..start + number(&one["bytes"])].to_vec();
        let along = |axis: usize| size.get(axis).map_or(0, |n| *n as u32);
        Filtered { size: [along(0), along(1), along(2)], format, texels }
    })
}

/// Random hits, and corners of the domain.
fn queries(points: usize) -> Vec<Query> {
    let mut queries = Vec::new();
    let number = |i: usize, step: f64| (0.5 + i as f64 * step).fract();
    for i in 0..points {
        let share = |step| number(i, step);
        let gamma = 1.5 + 0.1 / share(0.819_172_5).max(1e-6);
        let sigma = [0.671_043_6, 0.549_700_5].map(|step| 2f64.powf(-13.2 * share(step)) as f32);
        // Every second is round; directions crowd at the horizon.
        let sigma = if i % 2 == 0 { [sigma[0]; 2] } else { sigma };
        let direction = |a, b| direction(share(a).powi(3), share(b));
        let v = direction(0.450_283_2, 0.368_858_1);
        let l = direction(0.302_150_4, 0.247_507_3);
        queries.push(Query { v, gamma: gamma as f32, l, sigma, rest: [0.0; 3] });
    }
    for gamma in [1.6, 2.0, 3.0, 40.0, 1e6, f32::MAX] {
        for sigma in [1e-4, 0.01, 0.3, 1.0] {
            for cos_v in [1e-6, 1e-3, 0.02, 0.5, 1.0] {
                for cos_l in [1e-6, 0.02, 0.5, 1.0] {
                    for turn in [0.0, 0.3, 0.5] {
                        let [v, l] = [direction(cos_v, 0.1), direction(cos_l, 0.1 + turn)];
                        let rest = [0.0; 3];
                        queries.push(Query { v, gamma, l, sigma: [sigma, sigma], rest });
                    }
                }
            }
        }
    }
    queries
}

/// A direction of a cosine and a turn.
fn direction(cos: f64, turn: f64) -> [f32; 3] {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let (y, x) = (std::f64::consts::TAU * turn).sin_cos();
    [(sin * x) as f32, (sin * y) as f32, cos as f32]
}

/// The error of each of [`LIMITS`]; 0 of those that do not count here.
fn errors(query: &Query, answer: &Answer, family: &Family, albedo: &FamilyAlbedo) -> [f64; 10] {
    let Query { v, gamma, l, sigma, .. } = *query;
    let lobe = family.at(sigma, gamma);
    let f64 = |x: f32| f64::from(x);
    let relative = |got: f32, want: f32| {
        // Smaller numbers have few digits.
        if want > 1e-30 { (f64(got) / f64(want) - 1.0).abs() } else { f64(got - want).abs() }
    };
    let sum: [f32; 3] = std::array::from_fn(|i| v[i] + l[i]);
    let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
    let m = sum.map(|x| x / length);
    let g1 = [(v, answer.areas[0]), (l, answer.areas[1])]
        .map(|(w, area)| relative(w[2] / area, lobe.g1(w)))
        .into_iter()
        .fold(0.0, f64::max);
    let (f, pdf) = lobe.eval_pdf(v, l, Masking::HeightCorrelated);
    let is_heavy = gamma < 20.0;
    let peak = 1.0 / (PI * sigma[0] * sigma[1]);
    let at = albedo.at((sigma[0] * sigma[1]).sqrt(), gamma);
    let e = f64(answer.texel[0].powi(2) - at.lost(v)).abs();
    let rough = sigma[0] * sigma[1] >= 1e-2;
    let smooth = sigma[0] * sigma[1] < 1e-4 || v[2] < 0.02;
    let [moments, averages] = [at.moments(v), at.average_moments()];
    let average = f82_tint_average(METAL[0], METAL[1]);
    let (lost, lost_avg) = (at.lost_average(), averages.total());
    let further =
        average * average * lost_avg / (1.0 - average * lost) * (at.lost(v) * at.lost(l) / lost);
    let d_error = f64(answer.d - lobe.d(m)).abs() / f64(peak.max(lobe.d(m)));
    [
        g1,
        if is_heavy { relative(answer.f_cos, f * l[2]) } else { 0.0 },
        if is_heavy { relative(answer.pdf, pdf) } else { 0.0 },
        d_error,
        if smooth { 0.0 } else { e },
        if smooth { e } else { 0.0 },
        f64(answer.texel[3].powi(2) - lost).abs(),
        if smooth { 0.0 } else { f64(answer.schlick - moments.schlick(0.04, 1.0)).abs() },
        if smooth { 0.0 } else { f64(answer.tinted - moments.f82_tint(METAL[0], METAL[1])).abs() },
        if rough { f64(answer.further * PI - further).abs() * f64(l[2]) } else { 0.0 },
    ]
}
