//! The pages say what the code does.

use microfacet_sampler::{Kind, Mapping};

/// `text` with every run of white space as one space, so that a page may break its lines anywhere.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_page_of_the_format_has_every_mapping_and_its_formula() {
    let page = flat(include_str!("../docs/format.md"));
    for mapping in Mapping::EVERY {
        assert!(
            page.contains(&format!("`{}`", mapping.name())),
            "docs/format.md: no `{}`",
            mapping.name()
        );
        assert!(
            page.contains(&flat(mapping.formula())),
            "docs/format.md: the formula of `{}` is {}",
            mapping.name(),
            mapping.formula()
        );
    }
}

#[test]
fn the_page_of_the_format_is_of_this_version() {
    let page = include_str!("../docs/format.md");
    assert!(
        page.starts_with(&format!("# The table format, version {}\n", microfacet_sampler::VERSION))
    );
    for kind in Kind::ALL {
        assert!(
            page.contains(&format!("`{}`", kind.name())),
            "docs/format.md: no `{}`",
            kind.name()
        );
    }
}
