//! Bakes, certifies and validates tables for Student-t microfacet materials.
