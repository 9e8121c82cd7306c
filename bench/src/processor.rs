//! The processor that times are of.

use std::env::consts::ARCH;
use std::fs;

/// Its name, family and model as Linux states them; the architecture alone elsewhere.
pub(crate) fn name() -> String {
    of(&fs::read_to_string("/proc/cpuinfo").unwrap_or_default())
}

fn of(info: &str) -> String {
    let value = |key| {
        let pairs = info.lines().filter_map(|line| line.split_once(':'));
        pairs.map(|(name, value)| (name.trim(), value.trim())).find(|(name, _)| *name == key)
    };
    match ["model name", "cpu family", "model"].map(value) {
        [Some((_, name)), Some((_, family)), Some((_, model))] => {
            format!("{name}, family {family}, model {model}")
        }
        [Some((_, name)), ..] => name.to_owned(),
        _ => ARCH.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_processor_is_named_as_far_as_it_is_known() {
        let info = "cpu family\t: 25\nmodel\t\t: 17\nmodel name\t: AMD EPYC\n\nmodel\t\t: 18\n";
        assert_eq!(of(info), "AMD EPYC, family 25, model 17");
        assert_eq!(of("processor : 0\nmodel name : a board: fast"), "a board: fast");
        assert_eq!(of("processor : 0\nBogoMIPS : 50.00"), ARCH);
    }
}
