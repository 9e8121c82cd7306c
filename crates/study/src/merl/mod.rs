//! Makes files in the format of the MERL database, whose own files may not be redistributed:
//! materials of known lobes, and of lobes outside the Student-t family, with noise and gaps.
//!
//! ```sh
//! cargo run --release -p microfacet-study -- merl merl
//! cargo run --release -- fit --merl merl/*.binary
//! ```
//!
//! With `--start` before the folder a value is that of the start of its cell instead of its middle:
//! fits then show the error of taking one for the other. The folder is made, and must not hold
//! files of these names yet.

pub mod made;

use std::path::Path;

use made::Material;

use microfacet_baker::store;
use microfacet_fit::merl::MIDDLE;

use crate::Outcome;

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let (place, folder) = match arguments {
        [folder] if !folder.starts_with('-') => (MIDDLE, folder),
        [option, folder] if option == "--start" => (0.0, folder),
        _ => return Err("name a folder to make the files in, after --start if need be".into()),
    };
    std::fs::create_dir_all(folder)?;
    let path = |name: &str| Path::new(folder).join(format!("{name}.binary"));
    let all = materials();
    if let Some(there) =
        all.iter().map(|(name, _)| path(name)).find(|path| path.symlink_metadata().is_ok())
    {
        return Err(format!("{}: exists already; name a new folder", there.display()).into());
    }
    for (name, material) in all {
        let path = path(name);
        store::replace(&path, &material.file(place)?)?;
        println!("{}: {}", path.display(), text(&material));
    }
    Ok(())
}

/// Members of the family, and three materials outside it.
fn materials() -> Vec<(&'static str, Material)> {
    let material = |name, lobes: &[(f64, &'static str)], f0, lambert| {
        (name, Material { lobes: lobes.to_vec(), f0, lambert, noise: 0.1 })
    };
    let [gold, silver, plastic] = [[0.95, 0.72, 0.35], [0.9, 0.89, 0.86], [0.04; 3]];
    let [none, red, grey] = [[0.0; 3], [0.4, 0.08, 0.05], [0.3; 3]];
    vec![
        material("student-t-1.7", &[(1.0, "student-t:0.15,1.7")], gold, [0.02; 3]),
        material("student-t-3", &[(1.0, "student-t:0.2,3")], plastic, red),
        material("ggx", &[(1.0, "ggx:0.1")], silver, none),
        material("beckmann", &[(1.0, "beckmann:0.3")], plastic, grey),
        material("gtr-1.5", &[(1.0, "gtr:0.1,1.5")], gold, none),
        material("two-beckmann", &[(0.6, "beckmann:0.08"), (0.4, "beckmann:0.3")], silver, none),
        material("two-ggx", &[(0.3, "ggx:0.03"), (0.7, "ggx:0.35")], plastic, red),
        material("matte", &[(1.0, "student-t:0.6,2.5")], plastic, grey),
    ]
}

fn text(material: &Material) -> String {
    let Material { lobes, f0, lambert, noise } = material;
    let lobe = |(share, lobe): &(f64, &str)| {
        if *share == 1.0 { (*lobe).to_owned() } else { format!("{share} {lobe}") }
    };
    let lobes: Vec<String> = lobes.iter().map(lobe).collect();
    let lobes = lobes.join(" + ");
    format!("{lobes}, F0 {f0:?}, Lambert {lambert:?}, noise of up to {} %", 100.0 * noise)
}
