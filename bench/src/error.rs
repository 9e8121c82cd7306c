//! The error of a rival, and the noise of an estimator that uses it.

use glam::{DVec3, Vec3};
use microfacet_model::{
    AlbedoIntegrator, Masking, MicrofacetDistribution, SignedSlope, StudentT, VisibleSlope,
    across_cdf,
};

use crate::inputs::Inputs;
use crate::rival::{Evaluate, Rival};
use crate::sampler::{Check, Density, Sampler};
use crate::settings::SIGMA;

/// Largest and root-mean-square error over the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Error {
    pub(crate) max: f64,
    pub(crate) rms: f64,
}

impl Error {
    pub(crate) fn of(errors: impl IntoIterator<Item = f64>) -> Self {
        let (mut max, mut sum, mut count) = (0.0, 0.0, 0.0_f64);
        for error in errors {
            // NaN counts as the largest error.
            if !(error <= max) {
                max = error;
            }
            sum += error * error;
            count += 1.0;
        }
        Self { max, rms: (sum / count.max(1.0)).sqrt() }
    }
}

/// The material of a shape.
pub(crate) fn truth(gamma: f64) -> StudentT {
    material(SIGMA, gamma)
}

/// The material of a roughness and a shape.
pub(crate) fn material(sigma: f64, gamma: f64) -> StudentT {
    StudentT::new(sigma, gamma).expect("both are constants, or of a texture within the family")
}

/// The error of a sampler: how far the CDFs along and across the plane of incidence are from their
/// exact values, the larger of the two. `None` where the random numbers do not correspond to CDFs.
pub(crate) fn sampler_error(rival: &Rival<Sampler>, inputs: &Inputs) -> Option<Error> {
    let sampler = &rival.run;
    if matches!(sampler.check, Check::Distribution) {
        return None;
    }
    let truth = truth(rival.gamma);
    let mut normals = vec![Vec3::ZERO; inputs.views.len()];
    (sampler.draw)(&inputs.views, &inputs.numbers, &mut normals);
    let one =
        |((v, u), m): ((&Vec3, &[f32; 2]), &Vec3)| cdf_error(&truth, sampler.check, *v, *u, *m);
    Some(Error::of(inputs.views.iter().zip(&inputs.numbers).zip(&normals).map(one)))
}

/// The error of one normal of a sampler whose random numbers correspond to CDFs.
pub(crate) fn cdf_error(truth: &StudentT, check: Check, v: Vec3, u: [f32; 2], m: Vec3) -> f64 {
    let (v, u, m) = (v.as_dvec3(), u.map(f64::from), m.as_dvec3());
    let want = match check {
        Check::Falling => [1.0 - u[0], u[1]],
        Check::Formula(exactly) => cdfs(truth, v, exactly(truth.sigma_x(), v, u)),
        _ => u,
    };
    let got = cdfs(truth, v, m);
    (got[0] - want[0]).abs().max((got[1] - want[1]).abs())
}

/// The CDFs along and across the plane of incidence at a normal of a round lobe.
fn cdfs(truth: &StudentT, v: DVec3, m: DVec3) -> [f64; 2] {
    let (view, [cos, sin]) = truth.unit_view(v);
    let shape = truth.shape();
    let (a, b) = (m.x / truth.sigma_x(), m.y / truth.sigma_y());
    let (x, y) = (a * cos + b * sin, b * cos - a * sin);
    let t = y / (m.z * m.z + shape.s() * x * x).sqrt();
    let signed = |x: f64| SignedSlope {
        w: shape.asinh_slope(x.abs()),
        sign: if x < 0.0 { -1.0 } else { 1.0 },
    };
    [VisibleSlope::new(shape, view).cdf(signed(x / m.z)), across_cdf(shape, signed(t))]
}

/// The absolute error of G1.
pub(crate) fn masking_error(rival: &Rival<Evaluate>, inputs: &Inputs) -> Error {
    let truth = truth(rival.gamma);
    let error = |(w, g1): (&Vec3, f32)| g1_error(&truth, *w, g1);
    Error::of(inputs.views.iter().zip(evaluated(rival, inputs)).map(error))
}

/// The absolute error of one G1.
pub(crate) fn g1_error(truth: &StudentT, w: Vec3, g1: f32) -> f64 {
    (f64::from(g1) - truth.g1(w.as_dvec3())).abs()
}

/// The relative error of D.
pub(crate) fn density_error(rival: &Rival<Evaluate>, normals: &Inputs) -> Error {
    let truth = truth(rival.gamma);
    let error = |(m, d): (&Vec3, f32)| d_error(&truth, *m, d);
    Error::of(normals.views.iter().zip(evaluated(rival, normals)).filter_map(error))
}

/// The relative error of one D; `None` where it is subnormal in single precision.
pub(crate) fn d_error(truth: &StudentT, m: Vec3, d: f32) -> Option<f64> {
    let exact = truth.d(m.as_dvec3());
    (exact > 1e-37).then(|| (f64::from(d) / exact - 1.0).abs())
}

/// The absolute error of one E, height-correlated.
pub(crate) fn e_error(truth: &StudentT, v: Vec3, e: f32) -> f64 {
    let cos = f64::from(v.z).clamp(0.0, 1.0);
    let exact =
        AlbedoIntegrator::new(*truth.shape(), 1e-6).reflection(truth.sigma_x(), cos, |_| [1.0]);
    let [exact] = exact.expect("a cosine and a roughness").of(Masking::HeightCorrelated);
    (f64::from(e) - exact).abs()
}

fn evaluated(rival: &Rival<Evaluate>, inputs: &Inputs) -> Vec<f32> {
    let mut values = vec![0.0; inputs.views.len()];
    (rival.run)(&inputs.views, &mut values);
    values
}

/// The mean over views of the variance of a white-furnace estimator: the weight f cos/pdf of one
/// reflected light, with G2 height-correlated and no Fresnel term, 0 for a light below the horizon.
///
/// Weights are the model's in double precision, so that samplers differ by their normals alone.
/// `views` of the inputs take part, with `draws` of the numbers each.
pub(crate) fn furnace_variance(
    rival: &Rival<Sampler>,
    inputs: &Inputs,
    views: usize,
    draws: usize,
) -> f64 {
    let (sampler, truth) = (&rival.run, truth(rival.gamma));
    let mut normals = vec![Vec3::ZERO; draws];
    let n = draws as f64;
    let mut total = 0.0;
    let views = &inputs.views[..views.min(inputs.views.len())];
    for (i, v) in views.iter().enumerate() {
        // Other numbers for every view; the last few views may reuse the first numbers.
        let first = i * draws % inputs.numbers.len();
        let numbers: Vec<[f32; 2]> =
            inputs.numbers.iter().copied().cycle().skip(first).take(draws).collect();
        (sampler.draw)(&vec![*v; draws], &numbers, &mut normals);
        let v = v.as_dvec3();
        let g1 = truth.g1(v);
        let share = match &sampler.density {
            Density::Bounded(bounded) => f64::from(bounded.at(v.as_vec3()).share()),
            _ => 1.0,
        };
        let weight = |m: &Vec3| {
            let m = m.as_dvec3();
            let facing = v.dot(m);
            let l = 2.0 * facing * m - v;
            if !(l.z > 0.0 && facing > 0.0) {
                return 0.0;
            }
            let g2 = truth.g2(v, l, Masking::HeightCorrelated);
            match sampler.density {
                Density::Ndf => g2 * facing / (v.z * m.z),
                Density::Visible | Density::Bounded(_) => share * g2 / g1,
            }
        };
        let (mut sum, mut squares) = (0.0, 0.0);
        for weight in normals.iter().map(weight) {
            (sum, squares) = (sum + weight, squares + weight * weight);
        }
        total += (squares - sum * sum / n) / (n - 1.0).max(1.0);
    }
    total / views.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use microfacet_model::statistics::{sidak, test_visible_normals};

    use super::*;
    use crate::sampler::{OTHERS, samplers};
    use crate::tables::Slices;
    use crate::values::maskings;

    const SAMPLES: usize = 20_000;
    /// For samplers that take their numbers from a stream, which must not repeat.
    const STREAMED: usize = 4000;

    #[test]
    fn rivals_draw_visible_normals_and_others_do_not() {
        let slices = Slices::bake();
        let views = [0.05_f64, 0.9, 1.5].map(|theta| DVec3::new(theta.sin(), 0.0, theta.cos()));
        let all = samplers(&slices, 3);
        let level = sidak(1e-3, all.len() * views.len());
        for sampler in &all {
            let p = views.map(|v| {
                let draw = |u| {
                    let mut m = [Vec3::ZERO];
                    (sampler.run.draw)(&[v.as_vec3()], &[u], &mut m);
                    m[0]
                };
                let streamed = matches!(sampler.run.check, Check::Distribution);
                let samples = if streamed { STREAMED } else { SAMPLES };
                test_visible_normals(&truth(sampler.gamma), v, samples, 7, draw).p()
            });
            if OTHERS.contains(&sampler.name) {
                // The difference shows where the view is oblique but does not graze.
                assert!(p[1] < level, "{}: {p:?}", sampler.name);
            } else {
                assert!(p.iter().all(|&p| p > level), "{}: {p:?}", sampler.name);
            }
        }
    }

    #[test]
    fn errors_are_those_of_the_forms() {
        let (slices, inputs) = (Slices::bake(), Inputs::new(1, 2000));
        for sampler in samplers(&slices, 1) {
            let Some(error) = sampler_error(&sampler, &inputs) else { continue };
            let most = match sampler.name {
                name if name.starts_with("bilinear") => 5e-3,
                "table, default, f16" => 2e-3,
                "table, draft" => 3e-4,
                // Its iteration ends at 1e-5, and its error function has 1.5e-7.
                "Beckmann, numerical inversion" => 1e-4,
                _ => 5e-5,
            };
            assert!(error.max < most && error.rms <= error.max, "{}: {error:?}", sampler.name);
        }
        for masking in maskings(&slices) {
            let error = masking_error(&masking, &inputs);
            let most = match masking.name {
                "Beckmann, rational fit" | "rational approximation (eq. 22-23)" => 1e-2,
                "table, default, f16" => 1e-3,
                _ => 4e-6,
            };
            assert!(error.max < most, "{}: {error:?}", masking.name);
        }
    }

    #[test]
    fn a_white_furnace_of_visible_normals_has_less_variance() {
        let (slices, inputs) = (Slices::bake(), Inputs::new(1, 4096));
        let all = samplers(&slices, 1);
        let variance = |name: &str| {
            let sampler = all.iter().find(|sampler| sampler.name == name);
            furnace_variance(sampler.expect("a name of the list"), &inputs, 16, 256)
        };
        let (table, inversion) =
            (variance("table, default"), variance("inversion of the CDF, any gamma"));
        assert!((table / inversion - 1.0).abs() < 1e-2, "{table} against {inversion}");
        assert!(variance("all normals (NDF)") > 3.0 * table);
        assert!(variance("table, default, bounded to reflections") < 0.9 * table);
    }
}
