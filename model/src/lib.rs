//! The Student-t microfacet model in double precision.
