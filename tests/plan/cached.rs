//! The cache: nothing is baked twice, and nothing else is taken for it.

use microfacet_baker::cache::Cache;
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Masking;
use microfacet_tables::{
    Axis, Certificate, Interval, Precision, Provenance, Table, decode, encode,
};

use super::plan::{DRAFT, bake, bytes, plan, recipe, scene};

/// An entry that has its key right is compared with what was asked for: all but the numbers.
#[test]
fn a_cache_entry_with_other_tables_is_baked_again() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = recipe(&[["glass", "0.3", "3.0"]])
        + "[[material]]\nname = \"cloth\"\ndistribution = \"gauss\"\nm = 0.25\n"
        + "[[material]]\nname = \"coat\"\nsigma = { min = 0.2, max = 0.25 }\ngamma = 3.0\n"
        + "fresnel = { schlick = 0.04 }\n";
    let plan = plan(&Scene::from_recipe_str(&recipe).unwrap());
    let cache = Cache::new(folder.path().into());
    let bake = || {
        let settings = Settings { cache: cache.clone(), ..Settings::default() };
        bake_with(&plan, DRAFT, settings).unwrap()
    };
    let genuine = bake();
    assert_eq!(bake().baked, 0);
    let mut entries: Vec<_> =
        std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    assert_eq!(entries.len(), 3, "normals, a distribution, and albedos");
    type Forgery = fn(&mut Provenance, &mut Vec<Table>);
    let forgeries: [(&str, Forgery); 10] = [
        ("numerics", |origin, _| origin.numerics -= 1),
        ("none", |_, tables| tables.clear()),
        ("one too many", |_, tables| tables.push(tables[0].clone())),
        ("order", |_, tables| tables.reverse()),
        ("name", |_, tables| tables[0].name = "../../evil".into()),
        ("shape or lobe", |_, tables| {
            let lobe = &mut tables[0].subject.lobe;
            match &mut lobe.distribution {
                Some(label) => *label = "gtr:1.5".into(),
                None => lobe.gamma = Interval::point(5.0),
            }
        }),
        ("masking", |_, tables| tables[0].subject.masking = Some(Masking::Uncorrelated)),
        ("axis", |_, tables| {
            let axis = tables[0].axes.pop().unwrap();
            let nodes = axis.nodes.iter().copied().step_by(2).collect();
            tables[0].axes.push(Axis { nodes, ..axis });
            let count = tables[0].shape().iter().product();
            tables[0].values.truncate(count);
        }),
        ("precision", |_, tables| tables[0] = tables[0].clone().rounded(Precision::U16)),
        ("certificate", |_, tables| tables[0].certificate = Certificate::default()),
    ];
    let mut forged_entries = 0;
    for path in &entries {
        let file = std::fs::read(path).unwrap();
        for (what, forge) in forgeries {
            let (mut origin, mut tables) = decode(&file, true).unwrap();
            forge(&mut origin, &mut tables);
            let Ok(forged) = encode(&origin, &tables) else { continue };
            forged_entries += 1;
            assert!(forged != file, "{what}");
            std::fs::write(path, forged).unwrap();
            let again = bake();
            assert!(again.baked > 0, "{what}: {}", tables.first().map_or("", |table| &table.name));
            assert!(bytes(&again.set) == bytes(&genuine.set), "{what}");
            assert!(std::fs::read(path).unwrap() == file, "{what}: the entry is mended");
        }
    }
    // The others are no sets.
    assert_eq!(forged_entries, 22);
}

#[test]
fn what_is_finished_is_not_baked_again() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path().join("cache"));
    let two = [["a", "0.3", "3.0"], ["b", "0.3", "4.0"]];
    for precision in [Precision::F32, Precision::F16, Precision::U16] {
        let target = Target::Quality(Quality::Draft, precision);
        let first = bake(&plan(&scene(&two)), target, &cache).unwrap();
        let second = bake(&plan(&scene(&two)), target, &cache).unwrap();
        assert_eq!((first.baked, second.baked), (6, 0));
        assert!(
            bytes(&first.set) == bytes(&second.set),
            "{precision:?}: kept tables give another file"
        );
    }
    // Another shape is baked alone; another roughness is not even a change.
    let other =
        bake(&plan(&scene(&[["a", "0.9", "3.0"], ["b", "0.3", "4.5"]])), DRAFT, &cache).unwrap();
    assert_eq!(other.baked, 3);
    // A damaged entry is baked again, and so is one that lies about what it is.
    let entries = || {
        std::fs::read_dir(folder.path().join("cache")).unwrap().map(|entry| entry.unwrap().path())
    };
    let all: Vec<_> = entries().collect();
    assert_eq!(all.len(), 7);
    let genuine = std::fs::read(&all[0]).unwrap();
    all.iter().for_each(|path| std::fs::write(path, &genuine).unwrap());
    std::fs::write(&all[0], &genuine[..genuine.len() / 2]).unwrap();
    let again = bake(&plan(&scene(&two)), DRAFT, &cache).unwrap();
    assert_eq!(again.baked, 6);
    assert_eq!(bake(&plan(&scene(&two)), DRAFT, &cache).unwrap().baked, 0);
}
