//! Finds the table of a set that holds an albedo.

use microfacet_core::Masking;
use microfacet_core::shape::s_of_gamma;
use microfacet_tables::{
    Kind, LobeForm, LobeSpec, Mapping, MaterialEntry, Reflectance, Side, Subject, Table,
};

use super::curve::{DielectricAlbedo, FresnelAlbedo, MaterialPoint, MaterialWeights, ViewCurve};
use super::directional::Albedo;
use super::family::FamilyAlbedo;
use super::interface::InterfaceAlbedos;
use super::moments::Moments;
use super::shape::ShapeAlbedo;
use crate::bind_error::BindError;
use crate::error::{Covered, MaterialError};
use crate::tables::Tables;

impl Tables {
    /// The directional albedo of the round Student-t lobe with σ and γ, for one form of masking.
    ///
    /// σ is 0, a mirror with E = 1, or lies in [1e-8, 3] (the default set, and every set whose
    /// recipe does not narrow it). Between the two nothing is tabulated: at γ = 1.501 and σ = 1e-9
    /// a view of cos θ = 1e-7 loses two thirds of its light. The averages are those of the lookups
    /// of this material, so that a white furnace closes: 1 − E_avg differs by no more than 5e-5 of
    /// itself from the integral of 1 − E in default quality, and by 5e-4 in draft. The call takes
    /// some twenty microseconds; keep the result.
    ///
    /// # Errors
    /// [`MaterialError`] for a γ outside the family, or a σ, γ or form of masking that the set's
    /// albedo tables do not cover.
    pub fn albedo(
        &self,
        sigma: f64,
        gamma: f64,
        masking: Masking,
    ) -> Result<Albedo, MaterialError> {
        self.moments_of(Kind::Albedo, sigma, gamma, masking, Albedo::new)
    }

    /// Cosine-weighted averages 2∫₀¹ · μ dμ of the moments, from the table of averages alone; where
    /// a set has no such table, as for single materials, those of [`albedo`](Self::albedo).
    ///
    /// Off the table's nodes they differ from those of [`albedo`](Self::albedo) by the errors of its
    /// certificate.
    ///
    /// # Errors
    /// As [`albedo`](Self::albedo).
    pub fn average_moments(
        &self,
        sigma: f64,
        gamma: f64,
        masking: Masking,
    ) -> Result<Moments, MaterialError> {
        let tabulated = self.moments_of(Kind::AlbedoAverage, sigma, gamma, masking, |table, at| {
            let at = MaterialWeights::new(table, at)?;
            let rest = table.collapsed::<f64>(&at.weights);
            let rest =
                if at.is_mirror { [0.0; 3] } else { core::array::from_fn(|i| rest[i] as f32) };
            Some(Moments::mirror_average().plus(rest))
        });
        tabulated.or_else(|_| Ok(self.albedo(sigma, gamma, masking)?.average_moments()))
    }

    /// The directional albedo of the shape γ at every roughness, for one form of masking.
    ///
    /// The call takes some microseconds, and the result 15 kB beside the set, from which it
    /// borrows.
    ///
    /// # Errors
    /// As [`albedo`](Self::albedo), but for the roughness.
    pub fn shape_albedo(
        &self,
        gamma: f64,
        masking: Masking,
    ) -> Result<ShapeAlbedo<'_>, MaterialError> {
        if !(gamma > 1.5) {
            return Err(MaterialError::Gamma(gamma));
        }
        let tables = |masking| self.moments(Kind::Albedo, masking);
        let mut of_shape = tables(masking).filter(|table| table.subject.lobe.contains_shape(gamma));
        of_shape.find_map(|table| ShapeAlbedo::of(table, gamma)).ok_or_else(|| {
            match no_range(tables, masking) {
                MaterialError::NoAlbedoRange => MaterialError::NotCovered {
                    gamma,
                    nearest: nearest_shapes(tables(masking), gamma),
                },
                why => why,
            }
        })
    }

    /// The directional albedo at every σ and γ, for one form of masking.
    ///
    /// It is made from the set's own table of moments, the one over most shapes, and holds for
    /// what that covers. The call takes some ten milliseconds, and the result half a MiB in the
    /// default set; keep it.
    ///
    /// # Errors
    /// [`MaterialError`] if the set has no such table for the form of masking.
    pub fn family_albedo(&self, masking: Masking) -> Result<FamilyAlbedo, MaterialError> {
        let tables = |masking| self.moments(Kind::Albedo, masking);
        let of_roughness = |table: &&Table| smallest_sigma(table).is_some();
        // The first among equals.
        let widest = tables(masking)
            .filter(of_roughness)
            .reduce(|a, b| if width(b) > width(a) { b } else { a });
        widest.and_then(FamilyAlbedo::of).ok_or_else(|| no_range(tables, masking))
    }

    /// The albedo with F = 1 of a named material, and its moments, for the form of masking of its
    /// recipe (height-correlated if it names none).
    ///
    /// An anisotropic Student-t whose σx, σy and γ are single numbers, an ellipsoid and a
    /// distribution outside the family have tables of their own; averaging one takes about a
    /// millisecond, so keep the result. A range is taken at its middle; an anisotropic material
    /// with a range has the albedo of the round lobe of √(σx σy).
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], [`BindError::NoAlbedoOf`] for a material that was baked
    /// without albedos, or what [`albedo`](Self::albedo) reports.
    pub fn material_albedo(&self, name: &str) -> Result<Albedo, BindError> {
        let entry = self.entry(name)?;
        if entry.lobe.tabulated().is_family() {
            let (sigma, gamma) = (entry.lobe.round_sigma(), entry.lobe.gamma());
            return Ok(self.albedo(sigma, gamma, entry.masking())?);
        }
        self.own(entry, Albedo::new, |reflectance| *reflectance == Reflectance::Mirror)
    }

    /// The albedo of a named conductor or dielectric under its exact reflectance.
    ///
    /// Ranges are taken as by [`material_albedo`](Self::material_albedo), that of an index of
    /// refraction at the middle of its coordinate
    /// [`ReflectanceRoot`](microfacet_tables::axis::ReflectanceRoot). A dielectric of an anisotropic
    /// lobe has the albedo of the round lobe of √(σx σy), unless the set has tables of its own. For
    /// σ = 0 its albedo is that of 1e-8.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], [`BindError::NoAlbedoOf`] for a material that states no
    /// such reflectance or was baked without albedos.
    pub fn material_fresnel_albedo(&self, name: &str) -> Result<FresnelAlbedo, BindError> {
        let entry = self.entry(name)?;
        if let Some(eta) = entry.fresnel.and_then(|fresnel| fresnel.middle_index()) {
            return Ok(FresnelAlbedo::Dielectric(self.material_dielectric_albedo(name, eta)?));
        }
        let wanted = entry.fresnel.as_ref().map(Reflectance::tabulated).unwrap_or_default();
        let conductor = |reflectance: &Reflectance| {
            matches!(reflectance, Reflectance::Conductor { .. }) && wanted.contains(reflectance)
        };
        self.own(entry, ViewCurve::new, conductor).map(FresnelAlbedo::Conductor)
    }

    /// The albedo of a named material at an index of refraction η in the range that its recipe
    /// states.
    ///
    /// # Errors
    /// [`BindError::NoSuchMaterial`], [`BindError::OtherDistribution`] for a lobe that has
    /// none, or as [`dielectric_albedo`](Self::dielectric_albedo).
    pub fn material_dielectric_albedo(
        &self,
        name: &str,
        eta: f64,
    ) -> Result<DielectricAlbedo, BindError> {
        let entry = self.entry(name)?;
        if !matches!(entry.lobe.form(), LobeForm::Family | LobeForm::StudentT) {
            let distribution = entry.lobe.distribution.clone();
            let distribution = distribution.unwrap_or_else(|| "ellipsoid".into());
            return Err(BindError::OtherDistribution { name: name.into(), distribution });
        }
        let lobe = entry.lobe.tabulated();
        if let Some(own) = self.own_dielectric_albedo(|of| of.contains(&lobe), eta, entry.masking())
        {
            return Ok(own);
        }
        let (sigma, gamma) = (entry.lobe.round_sigma(), entry.lobe.gamma());
        Ok(self.dielectric_albedo(sigma, gamma, eta, entry.masking())?)
    }

    /// The albedo of a rough dielectric of index η ∈ [0, ∞], inside over outside, with σ and γ, for
    /// one form of masking.
    ///
    /// The call takes some microseconds; keep the result.
    ///
    /// # Errors
    /// [`MaterialError::DielectricNotCovered`] if no table of the set covers it.
    pub fn dielectric_albedo(
        &self,
        sigma: f64,
        gamma: f64,
        eta: f64,
        masking: Masking,
    ) -> Result<DielectricAlbedo, MaterialError> {
        let side = |eta| self.interface_albedo(sigma, gamma, eta, masking);
        Ok(DielectricAlbedo { masking, outside: side(eta)?, inside: side(1.0 / eta)? })
    }

    /// The albedo of a rough dielectric seen from one side: [reflection, transmission], where
    /// η ∈ [0, ∞] is the index of refraction beyond the interface over that on the viewer's side.
    ///
    /// # Errors
    /// [`MaterialError::DielectricNotCovered`] if no table of that side covers it.
    pub fn interface_albedo(
        &self,
        sigma: f64,
        gamma: f64,
        eta: f64,
        masking: Masking,
    ) -> Result<ViewCurve<2>, MaterialError> {
        let (side, dense) = seen_from(eta);
        let point = MaterialPoint { sigma, gamma, eta: dense };
        let mut tables = self.of_family(Kind::Albedo, masking);
        let found = tables.find_map(|table| {
            let same = table.subject.reflectance?.side()? == side;
            same.then(|| ViewCurve::new(table, &point)).flatten()
        });
        found.ok_or_else(|| {
            let dielectrics = self.searched().iter().filter(|table| indices(table).is_some());
            let nearest = nearest(dielectrics, [sigma, gamma, dense], masking);
            MaterialError::DielectricNotCovered { eta, sigma, gamma, masking, nearest }
        })
    }

    /// The albedo of a rough dielectric of index η, inside over outside, whose lobe differs by
    /// azimuth, from its own tables; `None` if the set has none.
    pub(crate) fn own_dielectric_albedo(
        &self,
        is: impl Fn(&LobeSpec) -> bool,
        eta: f64,
        masking: Masking,
    ) -> Option<DielectricAlbedo> {
        let of_side = |eta: f64| {
            let (side, dense) = seen_from(eta);
            let point = MaterialPoint { sigma: f64::NAN, gamma: f64::NAN, eta: dense };
            self.albedos(Kind::Albedo, masking).find_map(|table| {
                let Subject { lobe, reflectance, .. } = &table.subject;
                let here = reflectance.as_ref().and_then(Reflectance::side) == Some(side);
                (here && !lobe.is_family() && is(lobe))
                    .then(|| ViewCurve::new(table, &point))
                    .flatten()
            })
        };
        Some(DielectricAlbedo { masking, outside: of_side(eta)?, inside: of_side(1.0 / eta)? })
    }

    /// The albedos of dielectrics of index η ∈ (0, ∞) at every σ and γ. `each` is called with those
    /// of each node.
    pub(crate) fn interface_albedos(
        &self,
        eta: f64,
        masking: Masking,
        mut each: impl FnMut(&DielectricAlbedo),
    ) -> Result<InterfaceAlbedos, MaterialError> {
        let dense = eta.max(1.0 / eta);
        let pair_of = |all| {
            let tables = |side: Side| {
                of_family(all, Kind::Albedo, masking).filter(move |table| {
                    let reflectance = table.subject.reflectance.as_ref();
                    let here = reflectance.and_then(Reflectance::side) == Some(side);
                    let near = f64::from(f32::EPSILON) * dense;
                    let has = |[low, high]: [f64; 2]| low - near <= dense && dense <= high + near;
                    here && smallest_sigma(table).is_some() && indices(table).is_some_and(has)
                })
            };
            // The first among equals.
            let thin = tables(Side::Thin).reduce(|a, b| if width(b) > width(a) { b } else { a })?;
            let same = |table: &&Table| table.subject.lobe == thin.subject.lobe;
            Some([thin, tables(Side::Dense).find(same)?])
        };
        // What a fallback holds may be wider, but coarser.
        let pair = pair_of(self.tables()).or_else(|| pair_of(self.searched()));
        pair.and_then(|pair| InterfaceAlbedos::new(pair, eta, &mut each)).ok_or_else(|| {
            let dielectrics = self.searched().iter().filter(|table| indices(table).is_some());
            let nearest = nearest(dielectrics, [0.3, 2.0, dense], masking);
            MaterialError::NoDielectricRange { eta, masking, nearest }
        })
    }

    fn own<T>(
        &self,
        entry: &MaterialEntry,
        read: impl Fn(&Table, &MaterialPoint) -> Option<T>,
        serves: impl Fn(&Reflectance) -> bool,
    ) -> Result<T, BindError> {
        let point = MaterialPoint {
            sigma: entry.lobe.round_sigma(),
            gamma: entry.lobe.gamma(),
            eta: f64::NAN,
        };
        let lobe = entry.lobe.tabulated();
        let mut tables = self.albedos(Kind::Albedo, entry.masking());
        let found = tables.find_map(|table| {
            let serves = table.subject.lobe.contains(&lobe)
                && table.subject.reflectance.as_ref().is_some_and(&serves);
            serves.then(|| read(table, &point)).flatten()
        });
        found.ok_or_else(|| BindError::NoAlbedoOf(entry.name.clone()))
    }

    fn albedos(&self, kind: Kind, masking: Masking) -> impl Iterator<Item = &Table> {
        albedos(self.searched(), kind, masking)
    }

    fn of_family(&self, kind: Kind, masking: Masking) -> impl Iterator<Item = &Table> {
        of_family(self.searched(), kind, masking)
    }

    /// The tables of moments of the family, of a kind and masking.
    pub(super) fn moments(&self, kind: Kind, masking: Masking) -> impl Iterator<Item = &Table> {
        let of_moments = |table: &&Table| table.subject.reflectance == Some(Reflectance::Mirror);
        self.of_family(kind, masking).filter(of_moments)
    }

    /// `read` of the first table of moments of a kind and masking that covers (σ, γ).
    fn moments_of<T>(
        &self,
        kind: Kind,
        sigma: f64,
        gamma: f64,
        masking: Masking,
        read: impl Fn(&Table, &MaterialPoint) -> Option<T>,
    ) -> Result<T, MaterialError> {
        if !(gamma > 1.5) {
            return Err(MaterialError::Gamma(gamma));
        }
        let tables = |masking| self.moments(kind, masking);
        let point = MaterialPoint { sigma, gamma, eta: f64::NAN };
        tables(masking)
            .find_map(|table| read(table, &point))
            .ok_or_else(|| not_covered(tables, masking, [sigma, gamma]))
    }
}

fn albedos(all: &[Table], kind: Kind, masking: Masking) -> impl Iterator<Item = &Table> {
    let of = move |table: &&Table| table.kind == kind && table.subject.masking == Some(masking);
    all.iter().filter(of)
}

fn of_family(all: &[Table], kind: Kind, masking: Masking) -> impl Iterator<Item = &Table> {
    albedos(all, kind, masking).filter(|table| table.subject.lobe.is_family())
}

/// The side that an interface is seen from, by the index beyond it over that on the viewer's side,
/// and the index of its dense side over that of the thin one.
fn seen_from(eta: f64) -> (Side, f64) {
    if eta < 1.0 { (Side::Dense, 1.0 / eta) } else { (Side::Thin, eta) }
}

/// How wide a range of shapes a table covers.
fn width(table: &Table) -> f64 {
    let [least, most]: [f64; 2] = table.subject.lobe.gamma.into();
    s_of_gamma(least) - s_of_gamma(most)
}

/// The error where no table of moments is over roughnesses.
fn no_range<'a, I: Iterator<Item = &'a Table>>(
    tables: impl Fn(Masking) -> I,
    masking: Masking,
) -> MaterialError {
    let has = |masking: &Masking| tables(*masking).next().is_some();
    if has(&masking) {
        return MaterialError::NoAlbedoRange;
    }
    let other = Masking::ALL.into_iter().find(has);
    MaterialError::MaskingNotCovered { masking, other }
}

/// The nearest γ below and above of tables over roughnesses.
fn nearest_shapes<'a>(tables: impl Iterator<Item = &'a Table>, gamma: f64) -> [Option<f64>; 2] {
    let ends = tables.filter(|table| smallest_sigma(table).is_some()).flat_map(|table| {
        let ends: [f64; 2] = table.subject.lobe.gamma.into();
        ends
    });
    ends.fold([None, None], |[below, above], end| {
        if end < gamma {
            [Some(below.map_or(end, |below: f64| below.max(end))), above]
        } else {
            [below, Some(above.map_or(end, |above: f64| above.min(end)))]
        }
    })
}

/// The error where no table of moments covers (σ, γ); it says what the tables cover.
fn not_covered<'a, I: Iterator<Item = &'a Table>>(
    tables: impl Fn(Masking) -> I,
    masking: Masking,
    [sigma, gamma]: [f64; 2],
) -> MaterialError {
    let has = |masking: &Masking| tables(*masking).next().is_some();
    if !has(&masking) {
        let other = Masking::ALL.into_iter().find(has);
        return MaterialError::MaskingNotCovered { masking, other };
    }
    let of_shape = tables(masking).filter(|table| table.subject.lobe.contains_shape(gamma));
    // Sets of single materials are listed with their shapes.
    let whole = of_shape.filter_map(|table| {
        let sigma = table.subject.lobe.roughness.x();
        Some([smallest_sigma(table)?, sigma.max]).filter(|_| sigma.min == 0.0)
    });
    match whole.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) {
        Some(range) => MaterialError::SigmaNotCovered { sigma, range },
        None => {
            let nearest = nearest(tables(masking), [sigma, gamma, f64::NAN], masking);
            MaterialError::AlbedoNotCovered { sigma, gamma, nearest }
        }
    }
}

/// The roughness of the first node: the smallest that a table holds, apart from 0.
fn smallest_sigma(table: &Table) -> Option<f64> {
    let mut axes = table.axes.iter();
    let axis = axes.find(|axis| matches!(axis.mapping, Mapping::LogRoughness(_)))?;
    axis.quantity(axis.nodes[0])
}

/// What the table covers whose material comes nearest to one of σ, γ and η.
fn nearest<'a>(
    tables: impl Iterator<Item = &'a Table>,
    [sigma, gamma, eta]: [f64; 3],
    masking: Masking,
) -> Option<Covered> {
    // In ratios; those of s for shapes. A missing index counts as none.
    let beyond = |x: f64, [low, high]: [f64; 2]| {
        let excess = (low.max(f64::MIN_POSITIVE) / x).max(x / high);
        if excess > 1.0 { libm::log(excess) } else { 0.0 }
    };
    let distance = |covered: &Covered| {
        let [low, high] = covered.gamma.map(s_of_gamma);
        beyond(s_of_gamma(gamma) + 1.0, [high + 1.0, low + 1.0])
            + if sigma == 0.0 && covered.mirror { 0.0 } else { beyond(sigma, covered.sigma) }
            + covered.eta.map_or(0.0, |range| beyond(eta, range))
            + if covered.masking == masking { 0.0 } else { 1.0 }
    };
    let all = tables.filter_map(|table| {
        let [least, largest]: [f64; 2] = table.subject.lobe.roughness.x().into();
        let first = smallest_sigma(table).filter(|_| least == 0.0);
        let (mirror, sigma) = (first.is_some(), [first.unwrap_or(least), largest]);
        let gamma = table.subject.lobe.gamma.into();
        Some(Covered { gamma, sigma, mirror, eta: indices(table), masking: table.subject.masking? })
    });
    all.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The indices of refraction of a table of dielectrics.
fn indices(table: &Table) -> Option<[f64; 2]> {
    Some(table.subject.reflectance?.indices()?.into())
}
