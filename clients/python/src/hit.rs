//! Any BSDF at one hit, so that materials can be made of materials.

use std::ops::Range;

use microfacet_sampler::albedo::AlbedoAt;
use microfacet_sampler::lobe::FamilyLobe;
use microfacet_sampler::{
    AnyBsdf, Bsdf, BsdfSample, Conductor, Dielectric, DielectricAt, Haze, Plastic, Retroreflective,
    Transport,
};

use crate::broadcast::Chunks;

/// A BSDF that is made for one item: of one lobe, of a lobe of arrays, or of other BSDFs, in boxes
/// since they may be such as this.
pub(crate) enum Hit<'a> {
    One(&'a AnyBsdf),
    Conductor(Conductor<FamilyLobe<'a>, 3, AlbedoAt<'a>>),
    /// A dielectric of one bounce.
    Single(Dielectric<FamilyLobe<'a>>),
    Dielectric(Dielectric<FamilyLobe<'a>, 3, DielectricAt<'a>>),
    Plastic(Plastic<FamilyLobe<'a>, 3, DielectricAt<'a>>),
    Haze(Box<Haze<Hit<'a>>>),
    Retroreflective(Box<Retroreflective<Hit<'a>>>),
}

macro_rules! from {
    ($($one:ident: $of:ty => $kept:expr),* $(,)?) => {$(
        impl<'a> From<$of> for Hit<'a> {
            fn from(bsdf: $of) -> Self {
                Self::$one($kept(bsdf))
            }
        }
    )*};
}

from! {
    One: &'a AnyBsdf => |bsdf| bsdf,
    Conductor: Conductor<FamilyLobe<'a>, 3, AlbedoAt<'a>> => |bsdf| bsdf,
    Single: Dielectric<FamilyLobe<'a>> => |bsdf| bsdf,
    Dielectric: Dielectric<FamilyLobe<'a>, 3, DielectricAt<'a>> => |bsdf| bsdf,
    Plastic: Plastic<FamilyLobe<'a>, 3, DielectricAt<'a>> => |bsdf| bsdf,
    Haze: Haze<Hit<'a>> => Box::new,
    Retroreflective: Retroreflective<Hit<'a>> => Box::new,
}

macro_rules! each {
    ($hit:ident, $one:ident => $call:expr) => {
        match $hit {
            Hit::One($one) => {
                let $one = *$one;
                $call
            }
            Hit::Conductor($one) => $call,
            Hit::Single($one) => $call,
            Hit::Dielectric($one) => $call,
            Hit::Plastic($one) => $call,
            Hit::Haze($one) => {
                let $one = &**$one;
                $call
            }
            Hit::Retroreflective($one) => {
                let $one = &**$one;
                $call
            }
        }
    };
}

impl Bsdf for Hit<'_> {
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample, f32)> {
        let v: [f32; 3] = v.into();
        each!(self, bsdf => bsdf.sample_with_pdf(v, choice, u, transport))
    }

    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> ([f32; 3], f32) {
        let (v, l): ([f32; 3], [f32; 3]) = (v.into(), l.into());
        each!(self, bsdf => bsdf.eval_pdf(v, l, transport))
    }

    fn is_delta(&self) -> bool {
        each!(self, bsdf => Bsdf::<3>::is_delta(bsdf))
    }

    fn transmits(&self) -> bool {
        each!(self, bsdf => Bsdf::<3>::transmits(bsdf))
    }

    fn is_symmetric(&self) -> bool {
        each!(self, bsdf => Bsdf::<3>::is_symmetric(bsdf))
    }
}

/// Items of a material, as BSDFs of one type.
pub(crate) struct HitChunks<'a>(Box<dyn AnyChunks<'a> + 'a>);

impl<'a> HitChunks<'a> {
    pub(crate) fn of<C: Chunks + 'a>(chunks: C) -> Self
    where
        C::Item: Into<Hit<'a>>,
    {
        Self(Box::new(chunks))
    }
}

impl<'a> Chunks for HitChunks<'a> {
    type Item = Hit<'a>;

    fn chunk(&self, range: Range<usize>) -> impl Fn(usize) -> Hit<'a> {
        self.0.hits(range)
    }
}

/// [`Chunks`] whose items are BSDFs of any type.
trait AnyChunks<'a>: Sync {
    fn hits<'s>(&'s self, range: Range<usize>) -> Box<dyn Fn(usize) -> Hit<'a> + 's>;
}

impl<'a, C: Chunks> AnyChunks<'a> for C
where
    C::Item: Into<Hit<'a>>,
{
    fn hits<'s>(&'s self, range: Range<usize>) -> Box<dyn Fn(usize) -> Hit<'a> + 's> {
        let item = self.chunk(range);
        Box::new(move |i| item(i).into())
    }
}
