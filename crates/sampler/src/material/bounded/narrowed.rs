//! The intervals of many views, in lanes.

use microfacet_lanes::{Lanes, Work};

use super::{BoundedRef, Kept};
use crate::material::lanes::many::components;

/// Views and numbers whose intervals are not yet taken.
pub(super) struct Narrowed<'a, V> {
    pub(super) lobe: BoundedRef<'a>,
    pub(super) v: &'a [V],
    pub(super) u: &'a [[f32; 2]],
    pub(super) numbers: &'a mut [[f32; 2]],
    pub(super) share: &'a mut [f32],
}

impl<V: Copy + Into<[f32; 3]>> Narrowed<'_, V> {
    /// Takes those of all views but those too few to fill lanes, which are left.
    #[inline(always)]
    pub(super) fn groups<L: Lanes>(self) -> Self {
        let Self { lobe, v, u, numbers, share } = self;
        let whole = v.len() - v.len() % L::WIDTH;
        let (v, v_rest) = v.split_at(whole);
        let (u, u_rest) = u.split_at(whole);
        let (n, n_rest) = numbers.split_at_mut(whole);
        let (s, s_rest) = share.split_at_mut(whole);
        let inputs = v.chunks_exact(L::WIDTH).zip(u.chunks_exact(L::WIDTH));
        let outputs = n.chunks_exact_mut(L::WIDTH).zip(s.chunks_exact_mut(L::WIDTH));
        for ((v, u), (n, s)) in inputs.zip(outputs) {
            let kept = lobe.kept_of(components::<L, V>(v));
            s.copy_from_slice(kept.share.to_array().as_ref());
            let (from, end, gap) = (kept.from.to_array(), kept.end.to_array(), kept.gap.to_array());
            for i in 0..L::WIDTH {
                let kept = Kept { from: from[i], share: s[i], end: end[i], gap: gap[i] };
                n[i] = [kept.number(u[i][0]), u[i][1]];
            }
        }
        Self { lobe, v: v_rest, u: u_rest, numbers: n_rest, share: s_rest }
    }
}

impl<V: Copy + Into<[f32; 3]>> Work for Narrowed<'_, V> {
    type Output = Self;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self {
        self.groups::<L>()
    }
}
