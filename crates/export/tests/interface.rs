//! Textures of interfaces, read as a shader reads them: from the file, in single precision, by
//! formulas that are written independently here.

use microfacet_baker::progress::Stage;
use microfacet_core::Masking;
use microfacet_export::texture::{
    Format, Indices, Made, TextureSpec, check_interface, files, shader_lines,
};
use microfacet_model::fresnel::Dielectric;
use microfacet_model::{AlbedoIntegrator, Shape};
use serde_json::Value;

const CORRELATED: Masking = Masking::HeightCorrelated;
const ENDS: [f64; 2] = [1.05, 2.5];
const SIZE: [usize; 3] = [4, 6, 12];

/// Textures of both sides and their averages, each as the description with the values.
fn described(indices: Indices, size: &[usize]) -> Vec<Value> {
    let specs = TextureSpec::of_interface("lut", 2.0, indices, 1.0, size, CORRELATED);
    let made = specs.map(|spec| {
        let (texture, checks) = spec.make_checked([&Stage::unwatched(); 2]).unwrap();
        let (errors, edges) = (checks.of(&texture, |_| true), checks.along_edges(&texture));
        Made { texture, errors, edges, before_rounding: None }
    });
    let files = files(&[Format::Json], &made).unwrap();
    files.iter().map(|file| serde_json::from_slice(&file.contents).unwrap()).collect()
}

/// What a linear filter reads of both channels at coordinates in [0, 1], slowest first.
fn filtered(told: &Value, at: &[f32]) -> [f32; 2] {
    let mut values: Vec<f32> = serde_json::from_value(told["data"].clone()).unwrap();
    for (axis, &c) in told["axes_slowest_first"].as_array().unwrap().iter().zip(at) {
        let n = axis["texels"].as_u64().unwrap() as usize;
        let place = c.clamp(0.0, 1.0) * (n - 1) as f32;
        let i = (place as usize).min(n - 2);
        let (stride, share) = (values.len() / n, place - i as f32);
        let [a, b] = [i, i + 1].map(|i| &values[i * stride..(i + 1) * stride]);
        values = a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect();
    }
    [values[0], values[1]]
}

fn index_coordinate(eta: f32) -> f32 {
    let of = |eta: f32| ((eta - 1.0).abs() / (eta + 1.0)).sqrt();
    let [first, last] = ENDS.map(|end| of(end as f32));
    (of(eta) - first) / (last - first)
}

/// Both shares, of a relative index below 1 from inside.
fn shares(told: &Value, eta: f32, sigma: f32, mu: f32) -> [f32; 2] {
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    let (rim, past) = (sigma * mu * sin, (eta - 1.0) * (eta + 1.0) + mu * mu);
    let g = (past.max(0.0) + 0.5 * rim * rim / (past.abs() + rim + 1e-20)).sqrt();
    let (a, b) = ((mu - g) / (mu + g), (mu * (mu + g) - 1.0) / (mu * (g - mu) + 1.0));
    let f = 0.5 * a * a * (1.0 + b * b);
    let axes = told["axes_slowest_first"].as_array().unwrap();
    let t = if told["side"] == "inside" {
        let near = axes.last().unwrap()["near"].as_f64().unwrap() as f32;
        near * (mu / (mu + 7.0 * sigma * sin)).powf(0.3)
            + 0.5 * (1.0 - near) * (1.0 + past / (past.abs() + 3.2 * rim + 1e-20))
    } else {
        (mu / (mu + 3.5 * sigma * sin)).powf(0.25)
    };
    let at = [index_coordinate(eta), sigma.sqrt(), t];
    let [r, t] = filtered(told, &at[3 - axes.len()..]);
    [f + r, 1.0 - f + t]
}

/// The relative indices of a side, at both ends and between.
fn etas(side: usize) -> [f64; 3] {
    [1.05, 1.6, 2.5].map(|eta| if side == 1 { 1.0 / eta } else { eta })
}

#[test]
fn both_shares_are_what_the_files_promise_at_edges_by_name() {
    let told = described(Indices::Between(ENDS), &SIZE);
    let integrator = AlbedoIntegrator::new(Shape::new(2.0).unwrap(), 1e-5);
    for (side, told) in told[..2].iter().enumerate() {
        let most = |quantity: &str| told["errors"][quantity]["largest"].as_f64().unwrap();
        let most = ["reflected", "transmitted"].map(most);
        for eta in etas(side) {
            let critical = (1.0 - eta * eta).max(0.0).sqrt().max(1e-4);
            let beside = [0.999 * critical, (1.001 * critical).min(1.0)];
            let views = [1e-4, 1e-3, 0.3, critical, beside[0], beside[1], eta.min(1.0), 1.0];
            for (sigma, cos) in [0.0, 1e-8, 1e-3, 0.1, 0.47, 1.0]
                .into_iter()
                .flat_map(|sigma| views.map(|cos| (sigma, cos.max(1e-4))))
            {
                let pane = Dielectric::new(eta).unwrap();
                let want = integrator.interface(sigma, cos, pane).unwrap().of(CORRELATED);
                let found = shares(told, eta as f32, sigma as f32, cos as f32);
                for i in 0..2 {
                    let off = (f64::from(found[i]) - want[i]).abs();
                    // Single precision moves a step of a smooth surface.
                    let more = if sigma < 1e-4 { 6e-3 } else { 5e-4 };
                    let at = format!("eta {eta}, sigma {sigma}, cos {cos}, share {i}");
                    assert!(off < 1.05 * most[i] + more, "{at}: {off} of {}", most[i]);
                }
            }
        }
    }
    // Averages are functions of η and σ alone.
    for (side, told) in told[2..].iter().enumerate() {
        let most = told["errors"]["reflected"]["largest"].as_f64().unwrap();
        for (eta, sigma) in etas(side).into_iter().flat_map(|eta| [0.0, 0.2, 1.0].map(|s| (eta, s)))
        {
            let pane = Dielectric::new(eta).unwrap();
            let want = integrator.interface_average(sigma, pane).unwrap().of(CORRELATED);
            let at = [index_coordinate(eta as f32), (sigma as f32).sqrt()];
            let off = (f64::from(filtered(told, &at)[0]) - want[0]).abs();
            assert!(off < 1.1 * most + 1e-4, "eta {eta}, sigma {sigma}: {off} of {most}");
        }
    }
}

/// `docs/textures.md` states these errors of η = 1.5 in 32 × 32 texels, of which what few texels
/// hold next to the horizon takes more points of a fit there than elsewhere.
#[test]
fn the_view_from_inside_errs_by_what_the_documentation_says() {
    let specs =
        TextureSpec::of_interface("lut", 2.0, Indices::One(1.5), 1.0, &[32, 32], CORRELATED);
    let (texture, checks) = specs[1].make_checked([&Stage::unwatched(); 2]).unwrap();
    let errors = checks.of(&texture, |_| true);
    for (quantity, most) in [("reflected", 2.95e-3), ("transmitted", 2.45e-3), ("e", 2.95e-3)] {
        let found = errors.iter().find(|error| error.quantity == quantity).unwrap();
        assert!(found.largest < most, "{found:?}");
    }
}

/// A smooth interface errs far less than a rough one: its texels are nearly 0.
#[test]
fn edges_are_named_and_smooth_interfaces_nearly_exact() {
    let told = described(Indices::One(1.5), &[6, 12]);
    let names = ["least_cos_theta", "normal", "sigma_0", "sigma_max"];
    let inside = [&names[..], &["critical_angle", "upright_facets"]].concat();
    for (told, names) in told.iter().zip([&names[..], &inside]) {
        let found = told["largest_errors_along_edges"].as_object().unwrap();
        let mut found: Vec<&str> = found.keys().map(String::as_str).collect();
        let mut names = names.to_vec();
        found.sort_unstable();
        names.sort_unstable();
        assert_eq!(found, names);
    }
    let least = told[0]["largest_errors_along_edges"]["sigma_0"]["reflected"].as_f64().unwrap();
    assert!(least < 0.3 * told[0]["errors"]["reflected"]["largest"].as_f64().unwrap());
    for cos in [1e-3, 0.1, 0.5, 1.0] {
        let want = Dielectric::new(1.5).unwrap().reflectance(cos);
        let off = (f64::from(shares(&told[0], 1.5, 0.0, cos as f32)[0]) - want).abs();
        assert!(off < least + 1e-5, "{cos}: {off} of {least}");
    }
}

#[test]
fn functions_read_what_their_sides_need() {
    let of = |indices, size: &[usize]| {
        let specs = TextureSpec::of_interface("glass", 2.0, indices, 1.0, size, CORRELATED);
        specs.map(|spec| shader_lines(&spec))
    };
    let [outside, inside, _, average] = of(Indices::Between(ENDS), &SIZE);
    assert!(outside.glsl.starts_with("vec2 glass_outside(float eta, float sigma, float mu) {"));
    assert!(inside.hlsl.starts_with("float2 glass_inside(float eta, float sigma, float mu) {"));
    assert!(inside.wgsl.starts_with("fn glass_inside(eta: f32, sigma: f32, mu: f32) -> vec2f {"));
    assert!(average.wgsl.starts_with("fn glass_inside_average(eta: f32, sigma: f32) -> vec2f {"));
    let [_, one, _, _] = of(Indices::One(2.0), &SIZE[1..]);
    assert!(one.glsl.contains("(float sigma, float mu) { float eta = 0.5; "), "{}", one.glsl);
}

#[test]
fn what_cannot_be_made_is_refused() {
    for (gamma, indices, size, says) in [
        (2.0, Indices::One(1.0), &[8, 8][..], "eta = 1 must lie in [1.05, 3]"),
        (2.0, Indices::Between([1.05, 3.5]), &[8, 8, 8], "eta = 3.5 must lie in [1.05, 3]"),
        (2.0, Indices::Between([1.5, 1.5]), &[8, 8, 8], "a smaller to a larger index"),
        (2.0, Indices::One(f64::NAN), &[8, 8], "must lie in [1.05, 3]"),
        (2.0, Indices::One(1.5), &[8, 8, 8], "2 sizes"),
        (1.4, Indices::One(1.5), &[8, 8], "below 1.501"),
    ] {
        let message = check_interface(gamma, indices, 1.0, size).unwrap_err();
        assert!(message.contains(says), "{message}");
    }
    assert_eq!(check_interface(2.0, Indices::Between([1.05, 3.0]), 1.0, &[8, 8, 8]), Ok(()));
}
