use microfacet_model::*;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
fn weights(c: f64) -> [f64; 3] {
    let w = fresnel::schlick_weight(c);
    [1.0 - w, w, fresnel::f82_weight(c)]
}
struct Map {
    sp: f64,
    gp: f64,
    q: f64,
    w: f64,
    c: f64,
    gm: i32,
}
fn arg(n: &str, d: f64) -> f64 {
    std::env::args().find_map(|a| a.strip_prefix(&format!("{n}=")).map(|x| x.parse().unwrap())).unwrap_or(d)
}
impl Map {
    fn t_view(&self, mu: f64, sigma: f64) -> f64 {
        // compressed z
        let sin = (1.0 - mu * mu).max(0.0).sqrt();
        let rho = self.c * sigma * sin;
        let x = if self.gm & 1 != 0 { mu / (rho + mu.hypot(rho)) } else { mu / (mu + rho) };
        let f = mu / (1.0 + sin);
        (1.0 - self.w) * f.powf(self.q) + self.w * x.powf(if self.gm & 2 != 0 {self.q} else {1.0})
    }
    fn mu(&self, t: f64, sigma: f64) -> f64 {
        if sigma == 0.0 {
            // limit: fast part is a step
            return ((t - self.w) / (1.0 - self.w)).max(0.0).powf(1.0 / self.q).min(1.0);
        }
        let (mut lo, mut hi) = (0.0, 1.0);
        for _ in 0..200 {
            let m = 0.5 * (lo + hi);
            if self.t_view(m, sigma) < t { lo = m } else { hi = m }
        }
        0.5 * (lo + hi)
    }
    fn t_sigma(&self, s: f64) -> f64 { ((s + self.sp) / (0.008 + self.sp)).ln() / ((3.0 + self.sp) / (0.008 + self.sp)).ln() }
    fn sigma(&self, t: f64) -> f64 { (0.008 + self.sp) * (t * ((3.0 + self.sp) / (0.008 + self.sp)).ln()).exp() - self.sp }
    fn t_gamma(&self, s: f64) -> f64 {
        let e = |s: f64| (self.gp * s / (2.0 - s)).ln_1p();
        e(s) / e(1.0 / 0.501)
    }
    fn s(&self, t: f64) -> f64 {
        let e = |s: f64| (self.gp * s / (2.0 - s)).ln_1p();
        let x = (t * e(1.0 / 0.501)).exp_m1() / self.gp;
        2.0 * x / (1.0 + x)
    }
}
fn lagrange(t: f64, n: usize, k: usize) -> (usize, Vec<f64>) {
    let x = (t * (n - 1) as f64).clamp(0.0, (n - 1) as f64);
    let k = k.min(n);
    let start = ((x.floor() as isize) - (k as isize / 2 - 1)).clamp(0, (n - k) as isize) as usize;
    let y = x - start as f64;
    let w = (0..k)
        .map(|i| (0..k).filter(|&j| j != i).map(|j| (y - j as f64) / (i as f64 - j as f64)).product())
        .collect();
    (start, w)
}
fn main() {
    let (ns, ng, nv) = (arg("ns", 32.0) as usize, arg("ng", 16.0) as usize, arg("nv", 42.0) as usize);
    let (ks, kg, kv) = (arg("ks", 4.0) as usize, arg("kg", 4.0) as usize, arg("kv", 4.0) as usize);
    let map = Map {
        sp: arg("sp", 0.003),
        gp: arg("gp", 5.0),
        q: arg("q", 0.5),
        w: arg("w", 0.5),
        c: arg("c", 1.0),
        gm: arg("gm", 0.0) as i32,
    };
    let kind = arg("kind", 0.0) as i32;
    // probes, stratified by gamma
    let mut rng = rand::rngs::StdRng::seed_from_u64(7);
    let mut probes = vec![];
    for _ in 0..120 {
        let s: f64 = rng.random::<f64>() * (1.0 / 0.501);
        for _ in 0..30 {
            let sigma: f64 = if rng.random::<bool>() {
                0.01 * 300f64.powf(rng.random::<f64>())
            } else {
                0.01 + 2.99 * rng.random::<f64>()
            };
            let mu: f64 = if rng.random::<bool>() {
                0.02 * 50f64.powf(rng.random::<f64>())
            } else {
                0.02 + 0.98 * rng.random::<f64>()
            };
            probes.push((s, sigma, mu));
        }
    }
    let exact: Vec<[[f64; 3]; 2]> = probes
        .par_chunks(30)
        .flat_map_iter(|chunk| {
            let it = AlbedoIntegrator::new(Shape::from_s(chunk[0].0).unwrap(), 1e-6);
            chunk
                .iter()
                .map(move |p| {
                    let a = it.reflection(p.1, p.2, weights).unwrap();
                    [a.uncorrelated, a.height_correlated]
                })
                .collect::<Vec<_>>()
        })
        .collect();
    // transform
    let fwd = |e: [f64; 3], m: usize, s: f64, sigma: f64, mu: f64| -> [f64; 3] {
        trend(kind, m, s, sigma, mu, e, true)
    };
    let inv = |e: [f64; 3], m: usize, s: f64, sigma: f64, mu: f64| -> [f64; 3] {
        trend(kind, m, s, sigma, mu, e, false)
    };
    let t0 = std::time::Instant::now();
    let table: Vec<[[f64; 3]; 2]> = (0..ng)
        .into_par_iter()
        .flat_map_iter(|g| {
            let s = map.s(g as f64 / (ng - 1) as f64);
            let it = AlbedoIntegrator::new(Shape::from_s(s).unwrap(), 1e-6);
            let mut out = vec![];
            for i in 0..ns {
                for j in 0..nv {
                    let sigma = map.sigma(i as f64 / (ns - 1) as f64);
                    let mu = map.mu(j as f64 / (nv - 1) as f64, sigma).max(arg("floor", 1e-4));
                    let a = it.reflection(sigma, mu, weights).unwrap();
                    out.push([
                        fwd(a.uncorrelated, 0, s, sigma, mu),
                        fwd(a.height_correlated, 1, s, sigma, mu),
                    ]);
                }
            }
            out
        })
        .collect();
    let bake = t0.elapsed();
    for m in 0..2 {
        let mut worst = [(0.0_f64, (0.0, 0.0, 0.0)); 4];
        let mut sq = [0.0; 4];
        for (p, e) in probes.iter().zip(&exact) {
            let (g0, wg) = lagrange(map.t_gamma(p.0), ng, kg);
            let (s0, ws) = lagrange(map.t_sigma(p.1), ns, ks);
            let (v0, wv) = lagrange(map.t_view(p.2, p.1), nv, kv);
            let mut x = [0.0; 3];
            for (a, wa) in wg.iter().enumerate() {
                for (b, wb) in ws.iter().enumerate() {
                    for (c, wc) in wv.iter().enumerate() {
                        let v = table[((g0 + a) * ns + s0 + b) * nv + v0 + c][m];
                        for i in 0..3 {
                            x[i] += wa * wb * wc * v[i];
                        }
                    }
                }
            }
            let x = inv(x, m, p.0, p.1, p.2);
            let d = [x[0] - e[m][0], x[1] - e[m][1], x[2] - e[m][2], x[0] + x[1] - e[m][0] - e[m][1]];
            for i in 0..4 {
                sq[i] += d[i] * d[i];
                if d[i].abs() > worst[i].0 {
                    worst[i] = (d[i].abs(), *p);
                }
            }
        }
        let names = ["scale", "bias", "f82", "E"];
        for i in [3, 0, 1, 2] {
            let (s, sg, mu) = worst[i].1;
            println!(
                "{} {:6} max {:.1e} rms {:.1e} at s {:.3} sigma {:.4} mu {:.4}",
                ["unc", "cor"][m],
                names[i],
                worst[i].0,
                (sq[i] / probes.len() as f64).sqrt(),
                s,
                sg,
                mu
            );
        }
    }
    println!("{} nodes {} KiB bake {bake:?}", ng * ns * nv, ng * ns * nv * 12 / 1024);
}
fn trend(kind: i32, m: usize, s: f64, sigma: f64, mu: f64, e: [f64; 3], fwd: bool) -> [f64; 3] {
    let _ = (m, s, sigma, mu);
    let (w, f) = (fresnel::schlick_weight(mu), fresnel::f82_weight(mu));
    match kind {
        // difference to the mirror
        1 => {
            if fwd {
                [e[0] - (1.0 - w), e[1] - w, e[2] - f]
            } else {
                [e[0] + (1.0 - w), e[1] + w, e[2] + f]
            }
        }
        _ => e,
    }
}
