//! What a plan decides on a material, in words.

use std::borrow::Cow;

use microfacet_baker::plan::{AlbedoVerdict, Verdict};

/// Why a material gets no tables of its own, in short and in full.
pub fn reason(verdict: &Verdict) -> [Cow<'static, str>; 2] {
    let [short, long] = match verdict {
        Verdict::Bake(_) => ["baked", "tables are baked for it"],
        Verdict::Same { .. } => ["same", "another material needs the same tables"],
        Verdict::Within { .. } => {
            ["within", "its gamma lies in a range that is baked for another material"]
        }
        Verdict::ClosedForm => {
            ["closed form", "GGX: D, G1 and visible normals have closed forms; no tables"]
        }
        Verdict::Own => ["own tables", "not a Student-t lobe: tables of its own"],
        Verdict::Embedded => ["embedded", "covered by the default set compiled into the sampler"],
        Verdict::NotRough => ["not rough", "no microfacets"],
        Verdict::NotUsed => ["not used", "no geometry uses it"],
        Verdict::NotCovered(why) => return ["not covered".into(), why.reason().into()],
    };
    [short.into(), long.into()]
}

/// Why a material gets no albedo tables, in short and in full.
pub fn albedo_reason(verdict: &AlbedoVerdict) -> [Cow<'static, str>; 2] {
    let [short, long] = match verdict {
        AlbedoVerdict::Bake(_) => ["baked", "albedo tables cover it"],
        AlbedoVerdict::NotAsked => {
            ["no fresnel", "the recipe states no `fresnel`; --albedo bakes albedos for all"]
        }
        AlbedoVerdict::Imported => {
            ["not asked", "they take long for this scene, and only --albedo bakes them"]
        }
        AlbedoVerdict::Declined => ["declined", "--no-albedo"],
        AlbedoVerdict::Embedded => {
            ["embedded", "the default set compiled into the sampler has its albedo"]
        }
        AlbedoVerdict::NotNeeded => ["not needed", "it gets no tables at all"],
        AlbedoVerdict::NotCovered(why) => return ["not covered".into(), why.reason().into()],
    };
    [short.into(), long.into()]
}
