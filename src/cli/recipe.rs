//! `recipe`: a recipe to start from.

use std::path::{Path, PathBuf};

use microfacet_baker::store;

use super::{Result, ensure, is_stream, print, summarize, unwritable, write_file};

/// Print a commented recipe to start from.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microfacet-bake recipe --out mine.toml\n  microfacet-bake bake mine.toml --out tables",
    after_long_help = KEYS
)]
pub(super) struct Args {
    /// File to write instead, which must not exist yet.
    #[arg(long, short, value_name = "FILE")]
    out: Option<PathBuf>,
}

const STARTER: &str = include_str!("../../tables/recipes/starter.toml");

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
Instead of a number, sigma and gamma take a range: { min = A, max = B }.

Example:
  microfacet-bake recipe --out mine.toml\n  microfacet-bake bake mine.toml --out tables";

pub(super) fn run(args: Args) -> Result<()> {
    let Some(path) = args.out.filter(|path| !is_stream(path)) else { return print(STARTER) };
    check_new(&path)?;
    write_file(&path, STARTER.as_bytes())?;
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
