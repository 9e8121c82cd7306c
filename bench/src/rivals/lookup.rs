//! The directional albedo E of GGX as engines keep it: 32 × 32 texels over α and cos θ,
//! interpolated linearly. It knows no γ.

use microfacet_sampler::{Masking, Tables};

use crate::inputs::direction;

const EDGE: usize = 32;

/// Texels by α, then by cos θ, both from 0 to 1 with a texel at either end.
pub(crate) struct Lookup(Box<[[f32; EDGE]; EDGE]>);

impl Lookup {
    /// From a set that covers γ = 2.
    pub(crate) fn new(set: &Tables) -> Self {
        let place = |i: usize| i as f32 / (EDGE - 1) as f32;
        let row = |i: usize| {
            if i == 0 {
                // A mirror.
                return [1.0; EDGE];
            }
            let albedo = set.albedo(f64::from(place(i)), 2.0, Masking::HeightCorrelated);
            let albedo = albedo.expect("the general set has every sigma up to 1");
            std::array::from_fn(|j| albedo.albedo(direction(place(j), 0.0)))
        };
        Self(Box::new(std::array::from_fn(row)))
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }

    #[inline(always)]
    pub(crate) fn at(&self, alpha: f32, cos: f32) -> f32 {
        let ((i, s), (j, t)) = (locate(alpha), locate(cos));
        let [low, high] = [&self.0[i], &self.0[i + 1]].map(|row| mix(row[j], row[j + 1], t));
        mix(low, high, s)
    }
}

/// The cell of a coordinate and the place inside it; beyond an end, at that end.
#[inline(always)]
fn locate(x: f32) -> (usize, f32) {
    let x = x.clamp(0.0, 1.0) * (EDGE - 1) as f32;
    let cell = (x as i32).clamp(0, EDGE as i32 - 2);
    (cell as usize, x - cell as f32)
}

#[inline(always)]
fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_albedo_of_ggx_about() {
        let set = Tables::embedded();
        let lookup = Lookup::new(&set);
        for alpha in [0.1_f32, 0.37, 0.8, 1.0] {
            let exact = set.albedo(f64::from(alpha), 2.0, Masking::HeightCorrelated).unwrap();
            for cos in [0.1_f32, 0.43, 0.9, 1.0] {
                let (got, want) = (lookup.at(alpha, cos), exact.albedo(direction(cos, 0.0)));
                assert!((got - want).abs() < 3e-3, "{alpha} {cos}: {got} for {want}");
            }
        }
        assert_eq!(lookup.at(-1.0, 0.5), 1.0);
        assert_eq!(lookup.at(2.0, 2.0), lookup.at(1.0, 1.0));
    }
}
