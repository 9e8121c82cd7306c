//! Command lines that reproduce what a validation found.

use microfacet_validate::configuration::Configuration;
use microfacet_validate::stress::Point;

/// The options of `validate` and `sample` that reproduce a configuration.
pub fn options(configuration: &Configuration) -> String {
    let Configuration { sigma_x, sigma_y, gamma, theta, phi, seed } = configuration;
    format!("--sigma {sigma_x},{sigma_y} --gamma {gamma} --theta {theta} --phi {phi} --seed {seed}")
}

/// The command that shows a point of a stress test.
pub fn query(point: &Point) -> String {
    let Point { sigma: [x, y], gamma, theta, phi, u: [u1, u2] } = point;
    format!(
        "microfacet-bake query normal --sigma {x:?},{y:?} --gamma {gamma:?} --theta {theta:?} \
         --phi {phi:?} --u {u1:?},{u2:?}"
    )
}
