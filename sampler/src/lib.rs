//! Run-time sampling and evaluation of Student-t microfacet materials from baked tables.
#![cfg_attr(not(feature = "std"), no_std)]
