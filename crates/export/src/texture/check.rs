//! Which textures can be made.

use microfacet_baker::table_spec::GAMMA_MIN;
use microfacet_tables::SIGMA_MAX;

use super::Shapes;

/// The fewest and the most texels along an axis.
pub const SIZES: [usize; 2] = [4, 4096];
/// The most texels of a texture.
pub const MOST_TEXELS: usize = 1 << 24;
/// The smallest σ_max and the largest end of a range of shapes; beyond, single precision cannot
/// tell the ends of an axis apart.
const LEAST_SIGMA_MAX: f64 = 1e-4;
const MOST_GAMMA_MIN: f64 = 1e4;

/// Checks the shapes, the largest roughness and the size of a texture.
///
/// # Errors
/// A message with the value, what is allowed, and what to do.
pub fn check(shapes: Shapes, sigma_max: f64, size: &[usize]) -> Result<(), String> {
    check_surface(shapes, sigma_max)?;
    match shapes {
        Shapes::One(_) => check_size("this texture", size, 2, "SxT, as 32x32"),
        Shapes::DownTo(_) => check_size("this volume", size, 3, "GxSxT, as 32x64x64"),
    }
}

/// Checks the shapes and the largest roughness.
pub(super) fn check_surface(shapes: Shapes, sigma_max: f64) -> Result<(), String> {
    let (Shapes::One(gamma) | Shapes::DownTo(gamma)) = shapes;
    let why = if !(gamma >= GAMMA_MIN) {
        format!(
            "gamma = {gamma} is below {GAMMA_MIN}, the smallest shape that textures cover; raise it"
        )
    } else if matches!(shapes, Shapes::DownTo(f64::INFINITY)) {
        "a range of shapes goes from infinity down: give its smallest gamma, or ask for the one \
         shape gamma = inf"
            .into()
    } else if !(sigma_max > 0.0 && sigma_max <= SIGMA_MAX) {
        format!("sigma-max = {sigma_max} must lie in (0, {SIGMA_MAX}]; 1 is what engines use")
    } else if sigma_max < LEAST_SIGMA_MAX {
        format!(
            "sigma-max = {sigma_max} is below {LEAST_SIGMA_MAX}: all of the texture would be a \
             mirror's; raise it"
        )
    } else if matches!(shapes, Shapes::DownTo(gamma) if gamma > MOST_GAMMA_MIN) {
        format!(
            "gamma-min = {gamma} is above {MOST_GAMMA_MIN}: all of the volume would be Beckmann's; \
             ask for the one shape gamma = inf"
        )
    } else {
        return Ok(());
    };
    Err(why)
}

/// Checks the size of what `whose` names, which has so many axes and is written in a form.
pub(super) fn check_size(
    whose: &str,
    size: &[usize],
    axes: usize,
    form: &str,
) -> Result<(), String> {
    let [fewest, most] = SIZES;
    let texels: usize = size.iter().product();
    let why = if size.len() != axes {
        format!("{whose} has {axes} sizes: {form}")
    } else if let Some(n) = size.iter().find(|n| !(fewest..=most).contains(*n)) {
        format!("a size of {n} must lie in [{fewest}, {most}]; give {form}")
    } else if texels > MOST_TEXELS {
        format!("{texels} texels are more than {MOST_TEXELS}; name smaller sizes")
    } else {
        return Ok(());
    };
    Err(why)
}
