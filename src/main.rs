//! The `microfacet-bake` command.

fn main() {}
