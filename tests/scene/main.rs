//! What scene descriptions ask for, format by format.

mod gltf;
mod hostile;
mod images;
mod materialx;
mod mitsuba;
mod pbrt;
mod places;
mod recipe;
#[path = "../common/transcript.rs"]
mod transcript;

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use microfacet_baker::scene::{Material, Roughness, Scene, SceneError, SceneErrorKind};
use microfacet_tables::Interval;

use transcript::{marked, replay};

/// A folder with a scene in it.
struct Folder(TempDir);

impl Folder {
    /// A folder with these files: names and contents.
    fn new<C: AsRef<[u8]>>(files: &[(&str, C)]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, content) in files {
            folder.write(name, content);
        }
        folder
    }

    /// Writes a file; in a text for pbrt and in JSON, ' stands for ".
    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let mut content = content.as_ref().to_vec();
        if name.ends_with(".pbrt") || name.ends_with(".gltf") {
            content.iter_mut().filter(|byte| **byte == b'\'').for_each(|byte| *byte = b'"');
        }
        fs::write(self.path(name), content).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, name: &str) -> Result<Scene, SceneError> {
        microfacet_scene::load(&self.path(name))
    }
}

/// The scene in one file.
fn load(name: &str, text: &str) -> Scene {
    Folder::new(&[(name, text)]).load(name).unwrap()
}

/// Checks that the message holds all of `parts`, in which ' stands for ".
#[track_caller]
fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(&part.replace('\'', "\"")), "no {part:?} in {message}");
    }
}

/// Checks that the file is refused at "line:column" with a message that holds all of `parts`.
#[track_caller]
fn assert_refused(name: &str, text: &str, place: &str, parts: &[&str]) {
    let error = Folder::new(&[(name, text)]).load(name).unwrap_err();
    let message = error.to_string();
    let (_, after) = message.split_once(name).unwrap();
    assert!(after.starts_with(&format!("{place}: ")), "{message}");
    assert_says(&message, parts);
}

fn named<'a>(scene: &'a Scene, name: &str) -> &'a Material {
    let found = scene.materials.iter().find(|material| material.name == name);
    found.unwrap_or_else(|| panic!("no {name} among {:?}", names(scene)))
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.materials.iter().map(|material| &material.name[..]).collect()
}

/// Checks that a material is listed as not understood at "line:column", for a reason with all of
/// `parts`.
#[track_caller]
fn assert_not_understood(scene: &Scene, name: &str, place: &str, parts: &[&str]) {
    let mut entries = scene.ignored.iter().filter(|ignored| ignored.name == name);
    let (Some(entry), None) = (entries.next(), entries.next()) else {
        panic!("not one entry of {name} among {:?}", scene.ignored)
    };
    let message = entry.to_string();
    assert!(
        !entry.understood && message.contains(&format!("{place}: not understood")),
        "{message}"
    );
    assert_says(&message, parts);
}

/// Checks that the scene has this one warning, at "line:column", and that it holds all of `parts`.
#[track_caller]
fn assert_warned(scene: &Scene, place: &str, parts: &[&str]) {
    let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
    assert!(warning.contains(&format!("{place}: ")), "{warning}");
    assert_says(warning, parts);
}

fn isotropic(sigma: f64) -> Roughness {
    Roughness::Isotropic(Interval::point(sigma))
}

fn anisotropic(x: f64, y: f64) -> Roughness {
    Roughness::Anisotropic { x: Interval::point(x), y: Interval::point(y) }
}

/// Checks a roughness against numbers worked out by hand.
#[track_caller]
fn assert_close(roughness: Roughness, x: [f64; 2], y: [f64; 2]) {
    for (interval, expected) in [(roughness.x(), x), (roughness.y(), y)] {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
        assert!(
            close(interval.min, expected[0]) && close(interval.max, expected[1]),
            "{interval:?} is not {expected:?}"
        );
    }
}

/// A PNG whose red is 51 and 102, green 102 and 204, blue 255 and 0.
fn png() -> Vec<u8> {
    png_of(png::ColorType::Rgb, 4, &[[51, 102, 255].repeat(15), vec![102, 204, 0]].concat())
}

/// A PNG of these samples of eight bits, so many pixels wide.
fn png_of(color: png::ColorType, width: usize, samples: &[u8]) -> Vec<u8> {
    let lines = samples.len() / (width * color.samples());
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, lines as u32);
    encoder.set_color(color);
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    file
}

#[test]
fn an_unknown_extension_lists_the_formats() {
    let error = Folder::new(&[("scene.blend", "")]).load("scene.blend").unwrap_err();
    assert!(matches!(&error.kind, SceneErrorKind::UnknownExtension(e) if e.as_os_str() == "blend"));
    let message = error.to_string();
    for extension in ["blend", ".toml", ".pbrt", ".xml", ".gltf", ".glb", ".mtlx"] {
        assert!(message.contains(extension), "{message}");
    }
    let usd = Folder::new(&[("scene.usda", "#usda 1.0")]).load("scene.usda").unwrap_err();
    assert!(usd.to_string().contains("export a USD scene as glTF"), "{usd}");
}

#[test]
fn a_missing_scene_is_an_error_of_input_and_output() {
    for name in ["a.toml", "a.pbrt", "a.xml", "a.gltf", "a.glb", "a.mtlx"] {
        let error = Folder::new::<&str>(&[]).load(name).unwrap_err();
        assert!(matches!(error.kind, SceneErrorKind::Io(_)), "{error}");
        assert!(error.to_string().contains(name), "{error}");
    }
}

/// What a scene gives, line by line: materials, what has no lobe, files that it includes, and
/// warnings; or why it is refused.
fn answer(folder: &Path, line: &str) -> String {
    let folder = folder.canonicalize().unwrap();
    let name = line.strip_prefix("load ").unwrap();
    let said = match microfacet_scene::load(&folder.join(name)) {
        Err(why) => marked('!', &format!("{why}\n")),
        Ok(scene) => {
            let unknown = scene.ignored.iter().filter(|ignored| !ignored.understood).count();
            assert_eq!(scene.doubts().count(), scene.warnings.len() + unknown);
            let materials = scene.materials.iter().map(|material| {
                let used = if material.used { "" } else { "not used: " };
                let lobe = material.origin.lobe.map_or(String::new(), |lobe| format!("{lobe}: "));
                let entry = material.entry();
                // JSON has null for any number that is not finite: it is γ = ∞.
                let values = format!("{entry:?}");
                assert!(!values.contains("NaN") && !values.contains("-inf"), "{values}");
                let entry = serde_json::to_string(&entry).unwrap();
                format!("{}: {used}{lobe}{entry}\n", material.origin.place)
            });
            let ignored = scene.ignored.iter().map(|ignored| format!("{ignored}\n"));
            let included = scene.included.iter().map(|it| format!("includes {}\n", it.display()));
            let warnings: String = scene.warnings.iter().map(|it| format!("{it}\n")).collect();
            let found: String = materials.chain(ignored).chain(included).collect();
            marked('>', &found) + &marked('!', &warnings)
        }
    };
    said.replace(&format!("{}/", folder.display()), "")
}

/// Small scenes that are refused, or not understood as a whole.
#[test]
fn scenes_are_read_as_their_transcripts_say() {
    for format in ["recipe", "pbrt", "mitsuba", "gltf", "materialx"] {
        replay(&format!("scene/{format}"), answer);
    }
}
