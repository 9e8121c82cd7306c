//! `fit --merl`: files in the format of the MERL database, made of lobes of this program.

use std::fs;
use std::path::Path;

use crate::common::{ok, refused};

use microfacet_baker::progress::Meter;
use microfacet_fit::merl::{
    BYTES, Comparison, Fitted, Fitter, MIDDLE, Measured, MerlError, encode,
};
use microfacet_study::merl::made::Material;

fn fit(material: &Material) -> Comparison {
    let measured = Measured::decode(&material.file(MIDDLE).unwrap()).unwrap();
    Fitter::default().fit(&measured, &Meter::default()).unwrap()
}

fn single(lobe: &'static str, f0: [f64; 3], lambert: [f64; 3], noise: f64) -> Material {
    Material { lobes: vec![(1.0, lobe)], f0, lambert, noise }
}

#[track_caller]
fn assert_near(fitted: &Fitted, sigma_gamma: [f64; 2], of: &Material, tolerance: f64) {
    let [sigma, gamma] = fitted.sigma_gamma();
    let off = |found: f64, made: f64| (found / made - 1.0).abs();
    assert!(off(sigma, sigma_gamma[0]) < tolerance, "{fitted:?}");
    // Compared as s = 1/(γ−1), which is 0 for Beckmann.
    let s = [gamma, sigma_gamma[1]].map(|gamma| 1.0 / (gamma - 1.0));
    assert!((s[0] - s[1]).abs() < tolerance, "{fitted:?}");
    for (found, made) in [(fitted.f0, of.f0), (fitted.lambert, of.lambert)] {
        for (found, made) in found.into_iter().zip(made) {
            assert!((found - made).abs() < tolerance, "{fitted:?}");
        }
    }
}

#[test]
fn what_was_made_is_found_again_and_no_other_fit_is_better() {
    let [gold, plastic] = [[0.95, 0.72, 0.35], [0.04; 3]];
    let cases = [
        (single("student-t:0.15,1.7", gold, [0.02; 3], 0.0), [0.15, 1.7], 1e-4),
        (single("student-t:0.2,3", plastic, [0.4, 0.08, 0.05], 0.1), [0.2, 3.0], 2e-2),
        // GGX and Beckmann, F0 = 0 and 1, and no Lambert term.
        (single("ggx:0.02", [1.0, 0.5, 0.0], [0.0; 3], 0.1), [0.02, 2.0], 5e-3),
        (single("beckmann:0.5", [1.0, 0.5, 0.0], [0.3; 3], 0.1), [0.5, f64::INFINITY], 5e-3),
    ];
    for (material, sigma_gamma, tolerance) in cases {
        let fits = fit(&material);
        assert_near(&fits.student_t, sigma_gamma, &material, tolerance);
        assert!(fits.student_t.error <= fits.ggx.error);
        assert!(fits.student_t.error <= fits.beckmann.error);
        assert!(fits.haze.error <= fits.ggx.error);
        let others = [&fits.haze, &fits.abc];
        assert!(others.iter().all(|other| other.error > 0.999 * fits.student_t.error), "{fits:?}");
        // On average half of the largest noise is left, less what it takes from the sums.
        let left = fits.student_t.error / (0.5 * material.noise).max(1e-4);
        assert!(left < 1.01, "{left}");
        match sigma_gamma[1] {
            2.0 => assert_near(&fits.ggx, sigma_gamma, &material, tolerance),
            f64::INFINITY => assert_near(&fits.beckmann, sigma_gamma, &material, tolerance),
            _ => assert!(fits.ggx.error > 1.05 * fits.student_t.error),
        }
        let simple = matches!(sigma_gamma[1], 2.0 | f64::INFINITY);
        assert_eq!(fits.best() == &fits.student_t, !simple, "{fits:?}");
    }
}

/// One surface with the normals of two GGX is told from a Student-t, and its parameters are found.
#[test]
fn a_haze_is_found_again() {
    let made = single("haze:0.05,0.4,0.3", [0.95, 0.72, 0.35], [0.02; 3], 0.02);
    let fits = fit(&made);
    assert_eq!(fits.best(), &fits.haze, "{fits:?}");
    assert!(fits.student_t.error > 2.0 * fits.haze.error, "{fits:?}");
    for (found, made) in fits.haze.lobe.values.iter().zip([0.05, 0.4, 0.3]) {
        assert!((found / made - 1.0).abs() < 0.02, "{fits:?}");
    }
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let check = |reflectance: [f64; 3]| {
        let bytes = encode(MIDDLE, |_, _| reflectance);
        Fitter::default().check(&Measured::decode(&bytes).unwrap())
    };
    assert!(matches!(check([0.1, -1.0, 0.1]), Err(MerlError::Missing(1))));
    assert!(matches!(check([0.0; 3]), Err(MerlError::Black)));
    // One channel may be black, and a reflectance without any highlight is one.
    check([0.0, 0.1, 0.0]).unwrap();
}

fn write(folder: &Path, name: &str, bytes: &[u8]) {
    fs::write(folder.join(name), bytes).unwrap();
}

#[test]
fn the_command_compares_and_writes_a_recipe() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let gold = single("student-t:0.15,1.7", [0.95, 0.72, 0.35], [0.02; 3], 0.1);
    let ggx = single("ggx:0.3", [0.04; 3], [0.1, 0.0, 0.3], 0.1);
    write(at, "gold.binary", &gold.file(MIDDLE).unwrap());
    fs::create_dir(at.join("more")).unwrap();
    write(&at.join("more"), "gold.binary", &ggx.file(MIDDLE).unwrap());
    let files = ["fit", "--merl", "gold.binary", "more/gold.binary"];
    let text = ok(at, &[&files[..], &["--recipe", "fitted.toml"]].concat());
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("material  Beckmann"), "{text}");
    assert!(lines[1].starts_with("gold ") && lines[1].ends_with("Student-t"), "{text}");
    assert!(lines[2].contains("F0 0.95") && lines[2].contains("Lambert 0.0"), "{text}");
    assert!(text.contains("best for 2 materials: Student-t 1, GGX 1, Beckmann 0"), "{text}");
    assert!(text.ends_with("fitted.toml\n"), "{text}");
    // `plan` reads the recipe, with a name for each material and the masking of the fit.
    let found = microfacet_scene::load(&at.join("fitted.toml")).unwrap();
    let names: Vec<&str> = found.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["gold", "gold (2)"]);
    assert!(ok(at, &["plan", "fitted.toml"]).contains("uncorrelated"));
    // The recipe is not replaced, and the error comes before anything is fitted.
    let message = refused(at, &["fit", "--merl", "none.binary", "--recipe", "fitted.toml"]);
    assert!(message.contains("fitted.toml: this exists already"), "{message}");
}

#[test]
fn files_and_options_that_do_not_belong_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "d.csv", b"theta,D\n0,10\n5,8.7\n10,5.6\n");
    let made = encode(MIDDLE, |_, _| [0.1; 3]);
    write(at, "good.binary", &made);
    write(at, "short.binary", &made[..BYTES - 8]);
    let not_a_number = [&made[..BYTES - 8], &f64::NAN.to_le_bytes()].concat();
    write(at, "nan.binary", &not_a_number);
    write(at, "missing.binary", &encode(MIDDLE, |_, _| [-1.0; 3]));
    let cases: [(&[&str], &str); 8] = [
        (&["--merl", "none.binary"], "none.binary: "),
        (&["--merl", "."], ".: is a folder"),
        (&["--merl", "d.csv"], "d.csv: is no full-size MERL file"),
        // A good file before the bad one is not fitted first.
        (&["--merl", "good.binary", "short.binary"], "short.binary: has 34992004 bytes"),
        (&["--merl", "nan.binary"], "blue at theta_h 89, theta_d 89, phi_d 179"),
        (&["--merl", "missing.binary"], "missing.binary: red has no value"),
        (&["--recipe", "x.toml", "--input", "d.csv"], "cannot be used with"),
        (&[], "--input"),
    ];
    for (args, part) in cases {
        let message = refused(at, &[&["fit"], args].concat());
        assert!(message.contains(part), "{args:?}: {message}");
    }
    for option in [&["--input", "d.csv"][..], &["--degrees"], &["--on", "density"]] {
        let message = refused(at, &[&["fit", "--merl", "good.binary"], option].concat());
        assert!(message.contains("cannot be used with"), "{option:?}: {message}");
    }
}
