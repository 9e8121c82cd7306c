//! `recipe`: a recipe to start from, or that of a scene.

mod scene;

use std::path::{Path, PathBuf};

use microfacet_baker::store;

use super::{Result, ensure, is_stream, print, summarize, unwritable, write_file};

/// Print a commented recipe to start from, or the recipe of a scene.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microfacet-bake recipe --out mine.toml\n  microfacet-bake bake mine.toml --out tables\n  microfacet-bake recipe scene.pbrt --out scene.toml",
    after_long_help = KEYS
)]
pub(super) struct Args {
    /// A scene (.pbrt, .xml, .gltf, .glb, .mtlx) or recipe (.toml) whose materials to write;
    /// without one, a recipe to start from.
    scene: Option<PathBuf>,
    /// File to write instead, which must not exist yet.
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

const STARTER: &str = include_str!("../../../tables/recipes/starter.toml");

/// The keys of a material in `--help`.
const KEYS: &str = "\
Keys of a material (docs/recipe.md has all their forms):
  name          text of your choice, different for each material
  sigma         roughness, the alpha of GGX and Beckmann: X, or [X, Y] for an
                anisotropic material; 0 is smooth
  gamma         shape in (1.5, inf]: 2 is GGX, \"inf\" is Beckmann
  theta         [X, Y, Z]: tilts and turns the lobe, in radians; in degrees with
                degrees = true
  distribution  takes the place of sigma and gamma: a name such as \"gtr\", with its
                parameters, or { measured = \"file.csv\" }
  fresnel       \"mirror\", { schlick = F0 }, { schlick = [R, G, B] },
                { metal = \"gold\" },
                { conductor = { eta = [R, G, B], k = [R, G, B] } } or
                { dielectric = eta }; asks for albedos
  masking       \"height-correlated\" (the default) or \"uncorrelated\"
  haze          { weight = W, sigma = S, gamma = G }: a second lobe, W in [0, 1] of all;
                without gamma it has that of the first
  retroreflection  share in [0, 1] of the reflected light that goes back
Instead of a number, sigma, gamma, W, S, G and the share take a range:
{ min = A, max = B }.

Examples:
  microfacet-bake recipe --out mine.toml\n  microfacet-bake bake mine.toml --out tables
  microfacet-bake recipe scene.pbrt --out scene.toml";

pub(super) fn run(args: Args) -> Result<()> {
    let out = args.out.filter(|path| !is_stream(path));
    out.as_deref().map_or(Ok(()), check_new)?;
    let text = args.scene.map_or(Ok(STARTER.into()), |path| scene::recipe(&path))?;
    let Some(path) = out else { return print(&text) };
    write_file(&path, text.as_bytes())?;
    summarize(&format!("{}\n", path.display()))
}

/// Refuses a file that exists already, since its contents may exist nowhere else, and one that
/// cannot be written.
pub(super) fn check_new(path: &Path) -> Result<()> {
    ensure!(
        path.symlink_metadata().is_err(),
        "{}: this exists already and is kept; name a new file, or remove it before",
        path.display()
    );
    store::check_file(path).map_err(|why| unwritable(path, why))
}
