//! Albedo tables and the compensation built on them, for two shapes with independent references:
//! GGX and Beckmann.

use std::sync::OnceLock;

use microfacet_baker::bake::albedo::{AlbedoLobe, bake};
use microfacet_baker::plan::RequiredAlbedo;
use microfacet_baker::progress::Stage;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{Interval, Precision, Table};
use microfacet_validate::furnace::{TOLERANCE, anisotropic, direction, furnace, survey};

use crate::sets::{self, set_of};

/// Full tables of the two shapes, at the nodes of the default quality.
fn baked() -> &'static [Table] {
    static TABLES: OnceLock<Vec<Table>> = OnceLock::new();
    TABLES.get_or_init(|| bake_at(Quality::Default))
}

fn bake_at(quality: Quality) -> Vec<Table> {
    let part = |gamma: f64| {
        let lobe = AlbedoLobe { gamma: Interval::point(gamma), ..AlbedoLobe::GENERAL };
        let need = RequiredAlbedo { lobe, ..RequiredAlbedo::general() };
        bake(&need.spec(quality, Precision::F32).unwrap()).unwrap()
    };
    [2.0, f64::INFINITY].map(part).concat()
}

fn set() -> Tables {
    set_of(baked().to_vec(), None)
}

#[test]
fn albedos_match_the_reference() {
    let set = set();
    let text = include_str!("../../crates/model/tests/data/albedo.csv");
    let mut count = 0;
    for row in text.lines().skip(1) {
        let f: Vec<&str> = row.split(',').collect();
        let n = |i: usize| f[i].parse::<f64>().unwrap();
        let masking = Masking::ALL.into_iter().find(|masking| masking.name() == f[3]).unwrap();
        let Ok(albedo) = set.albedo(n(0), n(1), masking) else { continue };
        let got = albedo.moments(direction(n(2) as f32));
        for (got, want) in [(got.scale, n(5)), (got.bias, n(6))] {
            assert!((f64::from(got) - want).abs() < 3e-4, "{row}: {got} against {want}");
        }
        count += 1;
    }
    assert!(count >= 16, "{count} rows of GGX");
}

#[test]
fn the_furnace_closes() {
    for survey in survey(&set(), &Stage::unwatched()).unwrap() {
        assert!(survey.passed() && survey.points >= 100, "{survey:?}");
    }
    for masking in Masking::ALL {
        for sigma in [0.0, 1e-8, 1e-3, 0.2, 3.0] {
            for cos in [0.0, 1e-6, 0.3, 1.0] {
                let row = furnace(&set(), masking, sigma, 2.0, cos).unwrap();
                assert!((row.kulla_conty - 1.0).abs() < TOLERANCE, "{row:?}");
                assert!(sigma > 1e-8 || 1.0 - row.single < 1e-9 || cos < 1e-5, "{row:?}");
            }
        }
    }
}

/// A lobe that is not round, with the albedo of its own table; a round one as by [`furnace`].
#[test]
fn the_furnace_of_an_anisotropic_lobe_closes() {
    let (sigma, gamma) = ([0.15, 0.6], 3.0);
    let own = sets::draft(&sets::recipe(&[["a", "[0.15, 0.6]", "3.0", "fresnel = \"mirror\""]]));
    let albedo = own.material_albedo("a").unwrap();
    for phi in [0.0, 0.7, std::f64::consts::FRAC_PI_2] {
        for cos in [1e-4, 0.1, 0.5, 1.0] {
            let row = anisotropic(&albedo, sigma, gamma, cos, phi).unwrap();
            assert!((row.kulla_conty - 1.0).abs() < TOLERANCE, "{phi}: {row:?}");
            assert!(cos < 0.1 || 1.0 - row.single > 2.0 * TOLERANCE, "{row:?}");
        }
    }
    let default = Tables::embedded();
    let masking = albedo.masking();
    // The albedo of the round lobe in its place does not close.
    let round = default.albedo(0.3, gamma, masking).unwrap();
    let row = anisotropic(&round, sigma, gamma, 0.1, 0.0).unwrap();
    assert!((row.kulla_conty - 1.0).abs() > 10.0 * TOLERANCE, "{row:?}");
    let [a, b] = [
        anisotropic(&round, [0.3; 2], gamma, 0.1, 0.7).unwrap(),
        furnace(&default, masking, 0.3, gamma, 0.1).unwrap(),
    ];
    for [a, b] in [[a.single, b.single], [a.turquin, b.turquin], [a.kulla_conty, b.kulla_conty]] {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
}

#[test]
fn cosines_of_no_view_are_those_of_the_nearest() {
    let at = |cos| furnace(&set(), Masking::HeightCorrelated, 0.3, 2.0, cos).unwrap().single;
    assert_eq!(at(1.5), at(1.0));
    assert!(at(-1.0) >= 0.0 && at(f64::NAN) >= 0.0);
}

#[test]
fn a_wrong_table_does_not_close() {
    let mut tables = baked().to_vec();
    // E − 1 three per cent too small.
    tables.iter_mut().flat_map(|table| table.values.iter_mut().step_by(3)).for_each(|e| *e *= 0.97);
    let set = set_of(tables, None);
    assert!(survey(&set, &Stage::unwatched()).unwrap().iter().all(|survey| !survey.passed()));
}

/// Compensation adds no energy beyond the error of E: tables of high quality, certified domain.
#[test]
fn compensation_makes_no_energy() {
    let set = set_of(bake_at(Quality::High), None);
    for masking in Masking::ALL {
        for gamma in [2.0, f64::INFINITY] {
            for sigma in [0.01, 0.03, 0.11, 0.37, 0.9, 1.7, 2.6] {
                for cos in [0.02, 0.05, 0.13, 0.33, 0.61, 0.87, 0.99, 1.0] {
                    let row = furnace(&set, masking, sigma, gamma, cos).unwrap();
                    assert!(row.kulla_conty <= 1.0 + 1e-4, "{row:?}");
                    assert!(row.turquin <= 1.0 + 1e-4, "{row:?}");
                }
            }
        }
    }
}

#[test]
fn the_compensated_lobe_is_reciprocal_and_never_negative() {
    let set = set();
    for masking in Masking::ALL {
        let albedo = set.albedo(0.7, 2.0, masking).unwrap();
        for (a, b) in [(0.01, 0.9), (0.2, 0.5), (1.0, 1e-5), (0.7, 0.71)] {
            let (v, l) = (sets::direction(a, 0.0), sets::direction(b, 2.0));
            let there = albedo.compensation(v, l);
            assert!(there > 0.0 && (there - albedo.compensation(l, v)).abs() <= 1e-6 * there);
            assert_eq!(albedo.compensation(v, -l), 0.0);
        }
    }
}
