/// Loads a set after repairing its checksum, whatever the bytes are, and uses its contents.
#[allow(dead_code)]
fn load(bytes: &[u8]) {
    use microfacet_sampler::MicrofacetDistribution;
    use microfacet_sampler::lobe::Tabulated;

    let mut bytes = bytes.to_vec();
    microfacet_tables::seal(&mut bytes);
    let Ok(set) = microfacet_sampler::Tables::from_bytes(&bytes) else { return };
    for gamma in [1.501, 1.8, 2.0, 3.0, f64::INFINITY] {
        let Ok(material) = set.student_t(0.3_f32, gamma) else { continue };
        let v = [0.6, 0.0, 0.8];
        for u in [[0.0, 0.0], [0.3, 0.7], [1.0, 1.0]] {
            let (m, _) = material.sample_with_table_pdf(v, u);
            let _ = (material.table_pdf(v, m), material.visible_normal_pdf(v, m), material.g1(m));
        }
    }
    for material in &set.provenance().materials {
        let v = [0.6, 0.0, 0.8];
        if let Ok(lobe) = set.material(&material.name) {
            let m = lobe.sample_visible_normal(v, [0.3, 0.7]);
            let _ = (lobe.visible_normal_pdf(v, m), lobe.g1(m), lobe.d(m));
        }
    }
    albedos(&set);
}

/// Checks that albedos are in [0, 1], whatever the tables hold.
fn albedos(set: &microfacet_sampler::Tables) {
    use microfacet_sampler::albedo::FresnelAlbedo;
    use microfacet_sampler::Masking;
    let share = |x: f32| assert!((0.0..=1.0).contains(&x), "an albedo of {x}");
    let view = |cos: f32| [0.0, (1.0_f32 - cos * cos).sqrt(), cos];
    for (sigma, gamma) in [(0.0, 2.0), (1e-9, 1.501), (0.3, 2.0), (3.0, f64::INFINITY), (f64::NAN, 2.0)] {
        for masking in Masking::ALL {
            if let Ok(albedo) = set.albedo(sigma, gamma, masking) {
                share(albedo.albedo(view(0.3)));
                share(albedo.albedo_average());
            }
            for eta in [1.5, 0.6] {
                if let Ok(side) = set.interface_albedo(sigma, gamma, eta, masking) {
                    side.eval(view(0.3)).into_iter().for_each(share);
                    side.average().into_iter().for_each(share);
                }
            }
        }
    }
    for material in &set.provenance().materials {
        for v in [0.0, 1e-7, 0.4, 0.75, 1.0].map(view) {
            if let Ok(albedo) = set.material_albedo(&material.name) {
                share(albedo.albedo(v));
                share(albedo.albedo_average());
            }
            match set.material_fresnel_albedo(&material.name) {
                Ok(FresnelAlbedo::Conductor(metal)) => metal.eval(v).into_iter().for_each(share),
                Ok(FresnelAlbedo::Dielectric(sides)) => {
                    sides.outside.eval(v).into_iter().chain(sides.inside.eval(v)).for_each(share);
                }
                _ => {}
            }
        }
    }
}

/// Reads an index, and looks at bytes through it as at the files that it lists.
#[allow(dead_code)]
fn index(bytes: &[u8]) {
    use microfacet_tables::{Index, Provenance};

    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(index) = Index::from_json(text) else { return };
    assert_eq!(Index::from_json(&index.to_json()), Ok(index.clone()));
    let all: Vec<&str> = index.sets.iter().flat_map(|set| &set.materials).map(|name| &**name).collect();
    assert!(all.len() == index.materials() && index.files_of(&all).len() <= index.sets.len());
    for set in &index.sets {
        assert!(set.file.starts_with("tables-") && !set.file.contains(['/', '\\']));
        let _ = (set.check(bytes), set.check_materials(&Provenance::default()));
    }
    let _ = index.bytes();
}

/// The single shape whose entry is asked for.
#[allow(dead_code)]
const ENTRY: &str = "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\n";

/// Replaces a cache's only entry by bytes, with a correct checksum, and returns whether the cache
/// accepts them; accepted bytes must serve the request.
#[allow(dead_code)]
fn entry(bytes: &[u8]) -> bool {
    use microfacet_baker::cache::Cache;
    use microfacet_baker::plan::Plan;
    use microfacet_baker::scene::Scene;
    use microfacet_baker::table_set::{Need, Settings, Target, bake_with};
    use microfacet_baker::table_spec::Quality;

    struct Kept {
        folder: tempfile::TempDir,
        plan: Plan,
        entry: std::path::PathBuf,
    }
    const TARGET: Target = Target::Quality(Quality::Draft, microfacet_tables::Precision::F16);
    thread_local! {
        static KEPT: Kept = {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let scene = Scene::from_recipe_str(ENTRY).expect("a recipe");
            let plan = Plan::new(&scene, Default::default()).expect("a plan");
            let cache = Cache::new(folder.path().into());
            bake_with(&plan, TARGET, Settings { cache, ..Settings::default() }).expect("tables");
            let mut files = std::fs::read_dir(folder.path()).expect("a folder");
            let entry = files.next().expect("an entry").expect("a name").path();
            assert!(files.next().is_none(), "one entry");
            Kept { folder, plan, entry }
        };
    }
    KEPT.with(|Kept { folder, plan, entry }| {
        let mut bytes = bytes.to_vec();
        microfacet_tables::seal(&mut bytes);
        std::fs::write(entry, &bytes).expect("a temporary file");
        let cache = Cache::new(folder.path().into());
        let needs = Need::of(plan, TARGET).expect("needs");
        let believed = needs[0].is_kept(&cache);
        if believed {
            let settings = Settings { cache, ..Settings::default() };
            let set = bake_with(plan, TARGET, settings).expect("a set").set;
            set.student_t(0.3_f32, 3.0).expect("the shape that was asked for");
        }
        believed
    })
}

/// Loads a scene from a file of that name in a folder of its own, and writes its recipe.
#[allow(dead_code)]
fn scene(name: &str, bytes: &[u8]) {
    thread_local! {
        static FOLDER: tempfile::TempDir = tempfile::tempdir().expect("a temporary folder");
    }
    FOLDER.with(|folder| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("a temporary file");
        if let Ok(scene) = microfacet_scene::load(&path) {
            let _ = scene.to_recipe();
        }
    });
}
