//! What bounded visible normals gain for an estimator of reflection:
//! `cargo run --release -p microfacet-sampler --example bounded`.
//!
//! Prints the variance of a white furnace's weight, f cos θ_l/pdf without Fresnel and 0 for a light
//! below the horizon, as the mean over views of even cosines: of all visible normals, of those of
//! `StudentT::bounded`, of `FamilyLobe::bounded`, and of GGX's visible normals, weighted by the
//! ratio of densities, at the σ that serves best, with that σ and the largest weight.

use glam::Vec3;
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Ggx, Masking, MicrofacetDistribution, StudentT, Tables};

const VIEWS: u32 = 16;
const SAMPLES: u32 = 1 << 15;

/// The mean over views of the variance of a weight, and the largest weight, of normals drawn by
/// `draw` with a factor on their weight.
fn furnace(lobe: &StudentT, draw: impl Fn(Vec3, [f32; 2]) -> (Vec3, f32)) -> [f64; 2] {
    let (mut variance, mut largest) = (0.0, 0.0_f64);
    for i in 0..VIEWS {
        let z = (i as f32 + 0.5) / VIEWS as f32;
        let v = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
        let (mut sum, mut squares) = (0.0, 0.0);
        for j in 0..SAMPLES {
            // A lattice by the golden ratio.
            let u = (f64::from(j) + 0.5) / f64::from(SAMPLES);
            let (m, factor) = draw(v, [u as f32, (f64::from(j) * 0.618_033_988_75).fract() as f32]);
            let l = 2.0 * v.dot(m) / m.dot(m) * m - v;
            let weight = lobe.reflection_weight(v, l, Masking::HeightCorrelated) * factor;
            let weight = if v.dot(m) > 0.0 { f64::from(weight) } else { 0.0 };
            (sum, squares, largest) =
                (sum + weight, squares + weight * weight, largest.max(weight));
        }
        let mean = sum / f64::from(SAMPLES);
        variance += (squares / f64::from(SAMPLES) - mean * mean) / f64::from(VIEWS);
    }
    [variance, largest]
}

fn reflecting(lobe: &StudentT, drawn: &impl Reflecting) -> f64 {
    furnace(lobe, |v, u| {
        let (m, share) = drawn.sample_reflecting_normal(v, u);
        (m.into(), share)
    })[0]
}

fn main() {
    let tables = Tables::embedded();
    let family = tables.family().expect("ranges of shapes in the default set");
    println!("| γ | σ | visible | bounded | bounded per hit | GGX, weighted | its σ | largest |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for gamma in [1.51, 1.55, 1.6, 1.7, 1.79, 1.9, 2.5, 4.0, f64::INFINITY] {
        for sigma in [0.1_f32, 0.3, 0.5] {
            let lobe = tables.student_t(sigma, gamma).expect("covered by the default set");
            let visible = reflecting(&lobe, &lobe);
            let bounded = reflecting(&lobe, &lobe.clone().bounded());
            let per_hit = reflecting(&lobe, &family.at(sigma, gamma as f32).bounded());
            let ggx = (0..9).map(|i| {
                let alpha = sigma * 1.1_f32.powi(i - 2);
                let ggx = Ggx::new(alpha).expect("a roughness");
                let weighted = furnace(&lobe, |v, u| {
                    let m = ggx.sample_visible_normal(v, u);
                    (m.into(), lobe.visible_normal_pdf(v, m) / ggx.visible_normal_pdf(v, m))
                });
                (alpha, weighted)
            });
            let best = ggx.min_by(|(_, [a, _]), (_, [b, _])| a.total_cmp(b));
            let (alpha, [weighted, largest]) = best.expect("some roughness");
            println!(
                "| {gamma} | {sigma} | {visible:.4} | {bounded:.4} | {per_hit:.4} | {weighted:.4} | \
                 {alpha:.2} | {largest:.1} |"
            );
        }
    }
}
