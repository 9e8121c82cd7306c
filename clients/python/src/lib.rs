//! The extension module of the Python package `microfacet`.
//!
//! [`arrays`] takes arguments, of which [`broadcast`] runs functions on all cores; [`words`] turns
//! words and errors into those of Python. [`tables`] loads and bakes sets, [`lobe`], [`material`]
//! and [`bsdf`] are the run-time crate, [`pairs`] BSDFs of BSDFs, which are any at a [`hit`].
//! [`exact`] is the model, [`distribution`] what lobes of both have in common. [`surface`] is
//! roughness and shape of one lobe or many, [`set`] what lobes of a set share. [`shape`] has the
//! tables of a shape for lookups elsewhere, and [`farm`] what processes bake together.

use pyo3::prelude::*;

mod arrays;
mod broadcast;
mod bsdf;
mod distribution;
mod exact;
mod farm;
mod hit;
mod lobe;
mod material;
mod pairs;
mod set;
mod shape;
mod surface;
mod tables;
mod words;

/// Tables, lobes and BSDFs of the Student-t family.
#[pymodule]
mod _microfacet {
    use pyo3::prelude::*;

    use crate::exact::{ExactEllipsoid, ExactLobe, ExactStudentT};
    use crate::farm::{PyAssembly, PyLibrary, PyNeed};

    #[pymodule_export]
    use crate::bsdf::{PyBsdf, PyConductor, PyDielectric, PyPlastic, PySample};
    #[pymodule_export]
    use crate::farm::user_cache;
    #[pymodule_export]
    use crate::lobe::{PyEllipsoid, PyLobe, PyStudentT};
    #[pymodule_export]
    use crate::pairs::{PyHaze, PyRetroreflective};
    #[pymodule_export]
    use crate::shape::{PyDielectricAlbedo, PyShape};
    #[pymodule_export]
    use crate::tables::{PyTables, bake, inspect};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::broadcast::has_threads();
        // Under other names here; `microfacet.exact` gives them theirs.
        module.add("ExactLobe", module.py().get_type::<ExactLobe>())?;
        module.add("ExactStudentT", module.py().get_type::<ExactStudentT>())?;
        module.add("ExactEllipsoid", module.py().get_type::<ExactEllipsoid>())?;
        // Classes of `microfacet.farm`.
        module.add("Assembly", module.py().get_type::<PyAssembly>())?;
        module.add("Library", module.py().get_type::<PyLibrary>())?;
        module.add("Need", module.py().get_type::<PyNeed>())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
