//! Sets of tables: loaded, baked and described.

use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{AlbedoWish, Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::store::{self, Format};
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::{Precision, describe};
use pyo3::exceptions::{PyFileNotFoundError, PyRuntimeError, PyTypeError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::arrays::Any;
use crate::broadcast::has_threads;
use crate::bsdf::PyBsdf;
use crate::lobe::{Made, PyEllipsoid, PyLobe, PyStudentT};
use crate::set::Set;
use crate::shape::{PyDielectricAlbedo, PyShape};
use crate::surface::Surface;
use crate::words::{self, one_of, refused, unbound, unread, unscened};

/// Time between two checks for an interrupt while a bake runs.
const PATIENCE: Duration = Duration::from_millis(20);

/// A set of tables: those built in, or of a file or folder that `microfacet-bake bake` wrote.
///
/// materials names those that are needed of a large library, or of any set: the others are left
/// out, with the tables of lobes that they alone have.
///
/// >>> import microfacet
/// >>> tables = microfacet.Tables()  # Tables("folder") opens a set that was baked
/// >>> tables.covers(2.5)
/// True
/// >>> tables.student_t(0.3, 2.5)
/// StudentT(sigma=0.3, gamma=2.5)
#[pyclass(name = "Tables", module = "microfacet", frozen)]
pub(crate) struct PyTables {
    pub(crate) set: Arc<Set>,
    origin: String,
}

#[pymethods]
impl PyTables {
    #[new]
    #[pyo3(signature = (path=None, materials=None))]
    fn new(path: Option<PathBuf>, materials: Option<Vec<String>>) -> PyResult<Self> {
        let Some(path) = path else {
            return match materials {
                None => Ok(Self { set: Set::embedded(), origin: "built in".into() }),
                Some(_) => Err(refused("materials are those of a path; the set built in has none")),
            };
        };
        let origin = path.display().to_string();
        if !path.try_exists().unwrap_or(true) {
            return Err(PyFileNotFoundError::new_err(format!(
                "{origin}: no such file or folder; name what `microfacet-bake bake` wrote"
            )));
        }
        let set = match materials {
            None => store::read(&path),
            Some(names) => {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                store::read_materials(&path, &names)
            }
        };
        Ok(Self { set: Set::new(set.map_err(unread)?), origin })
    }

    /// Student-t lobes of these tables, which must cover their shapes; arguments are those of
    /// microfacet.StudentT. For arrays the tables must be over a range of shapes, as those built
    /// in are.
    #[pyo3(signature = (sigma=None, gamma=None, *, sigma_x=None, sigma_y=None, **others),
           text_signature = "($self, sigma=None, gamma=None, *, sigma_x=None, sigma_y=None)")]
    fn student_t(
        &self,
        py: Python<'_>,
        sigma: Option<&Any>,
        gamma: Option<&Any>,
        sigma_x: Option<&Any>,
        sigma_y: Option<&Any>,
        others: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Py<PyStudentT>> {
        let surface = Surface::new(sigma, gamma, sigma_x, sigma_y, others)?;
        Py::new(py, PyStudentT::of(py, &self.set, surface)?)
    }

    /// A Student-t lobe tilted and turned by the angles theta = (x, y, z) in radians.
    fn ellipsoid(
        &self,
        py: Python<'_>,
        sigma: &Any,
        theta: &Any,
        gamma: f64,
    ) -> PyResult<Py<PyEllipsoid>> {
        Py::new(py, PyEllipsoid::of(&self.set, sigma, theta, gamma)?)
    }

    /// The lobe of a material by its name in the recipe that the set was baked from: the core, if
    /// it has a haze.
    fn material(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyLobe>> {
        let lobe = self.set.material(name).map_err(refused)?;
        let made = Made::Material(name.into());
        Py::new(py, PyLobe::new(lobe, &self.set, made, format!("Lobe({name:?})")))
    }

    /// The BSDF of a material by name: its lobe, reflectance and form of masking, its haze, and the
    /// share of its light that goes back. Ranges of shares are taken at their middle.
    ///
    /// compensation is "none", "turquin" or "kulla-conty".
    #[pyo3(signature = (name, compensation="none", *, stand_in=false))]
    fn bsdf(&self, name: &str, compensation: &str, stand_in: bool) -> PyResult<PyBsdf> {
        let form = words::compensation(compensation)?;
        let bsdf = self.set.bsdf(name, form, words::stand_in(stand_in)).map_err(unbound)?;
        Ok(PyBsdf::new(bsdf, format!("Bsdf({name:?})")))
    }

    /// The names of the materials of the recipe; none for a set of ranges.
    #[getter]
    fn materials(&self) -> Vec<String> {
        self.set.provenance().materials.iter().map(|entry| entry.name.clone()).collect()
    }

    /// Whether student_t serves the shape gamma.
    fn covers(&self, gamma: f64) -> bool {
        self.set.tabulates(gamma)
    }

    /// What one bounce off and through a dielectric of the round lobe returns, of index eta, inside
    /// over outside; a set has it where its recipe has such a material.
    #[pyo3(signature = (sigma, gamma, eta, masking="height-correlated"))]
    fn dielectric_albedo(
        &self,
        sigma: f64,
        gamma: f64,
        eta: f64,
        masking: &str,
    ) -> PyResult<PyDielectricAlbedo> {
        let form = words::masking(masking)?;
        self.set.dielectric_albedo(sigma, gamma, eta, form).map(PyDielectricAlbedo).map_err(refused)
    }

    /// The tables of one shape, for lookups in another language: gamma must be covered, or 2.
    fn shape(&self, py: Python<'_>, gamma: f64) -> PyResult<PyShape> {
        PyShape::bind(py, &self.set, gamma)
    }

    /// The description of the set, as `microfacet-bake inspect --json` prints it.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Any<'py>> {
        let text = describe(self.set.provenance(), self.set.tables()).map_err(refused)?;
        let all = PyModule::import(py, "json")?.call_method1("loads", (text,))?;
        // The checksum is of the bytes of a file, and there may be no file.
        all.call_method1("pop", ("checksum", py.None()))?;
        Ok(all)
    }

    /// Writes the set into a folder, which is created: tables.safetensors. What a bake has written
    /// there before is replaced, numbered sets too.
    fn write(&self, folder: PathBuf) -> PyResult<()> {
        store::write(&folder, &self.set, Format::Safetensors).map_err(unread)?;
        Ok(())
    }

    /// Those built in are found again, others go along.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Any<'py>, Bound<'py, PyTuple>)> {
        let class = py.get_type::<Self>();
        if Arc::ptr_eq(&self.set, &Set::embedded()) {
            return Ok((class.into_any(), PyTuple::empty(py)));
        }
        let all = (PyBytes::new(py, &self.set.bytes()?), &self.origin).into_pyobject(py)?;
        Ok((class.getattr("_of_bytes")?, all))
    }

    /// A set from the bytes of its file.
    #[staticmethod]
    fn _of_bytes(bytes: &[u8], origin: String) -> PyResult<Self> {
        Ok(Self { set: Set::new(Tables::from_bytes(bytes).map_err(refused)?), origin })
    }

    fn __repr__(&self) -> String {
        format!("Tables({}, {} tables)", self.origin, self.set.tables().len())
    }
}

/// Bakes the tables of a recipe or scene, or without one those of every sigma and gamma.
///
/// recipe is a path (.toml, .pbrt, .xml, .gltf, .glb, .mtlx), or the text of a recipe, which has
/// more than one line (docs/recipe.md). With `out` the set is written into that folder, too; an
/// older set in it is replaced. quality is "draft", "default" or "high", precision "f32", "f16" or
/// "u16"; max_error or max_bytes take the place of both. albedo=True bakes directional albedos for
/// every rough material, False for none; by default those of a recipe that state `fresnel` get
/// them, and those of another scene if all take less than 2 s of one thread. max_memory is in
/// bytes. What is assumed or not understood of a scene is a warning. Finished tables are kept
/// in the user's cache unless cache=False, or in the folder that cache names. An interrupt returns
/// at once and writes nothing; what was begun goes on in the background until it is done.
#[pyfunction]
#[pyo3(signature = (recipe=None, out=None, *, quality="default", precision="f32", max_error=None,
                    max_bytes=None, albedo=None, tabulate_ggx=false, cache=None,
                    max_memory=4 << 30))]
#[expect(clippy::too_many_arguments, reason = "by keyword, as options of the command")]
pub(crate) fn bake(
    py: Python<'_>,
    recipe: Option<&Any>,
    out: Option<PathBuf>,
    quality: &str,
    precision: &str,
    max_error: Option<f64>,
    max_bytes: Option<usize>,
    albedo: Option<bool>,
    tabulate_ggx: bool,
    cache: Option<&Any>,
    max_memory: u64,
) -> PyResult<PyTables> {
    if !has_threads() {
        return Err(PyRuntimeError::new_err(
            "a process that was forked has no threads to bake with: start it with \
             multiprocessing's \"spawn\", or bake before",
        ));
    }
    let target = target_of(quality, precision, max_error, max_bytes)?;
    let plan = match recipe {
        None => general(albedo),
        Some(recipe) => {
            let scene = scene_of(recipe)?;
            let options = options_of(albedo, tabulate_ggx, target);
            let plan = Plan::new(&scene, options).map_err(refused)?;
            warn_of(py, &scene, &plan)?;
            plan
        }
    };
    let cache = match cache {
        None => Cache::user(),
        Some(cache) => match cache.extract::<bool>() {
            Ok(true) => Cache::user(),
            Ok(false) => Cache::none(),
            Err(_) => Cache::new(path("cache", "True, False", cache)?),
        },
    };
    let settings = Settings { cache, max_memory, ..Settings::default() };
    let work = move || bake_with(&plan, target, settings).map(|baked| baked.set);
    let set = interruptible(py, work)?.map_err(refused)?;
    let tables = PyTables { set: Set::new(set), origin: "baked".into() };
    if let Some(out) = out {
        tables.write(out)?;
    }
    Ok(tables)
}

/// The description of a set of tables, as `microfacet-bake inspect --json` prints it: of a file or
/// folder, or of the set built in.
#[pyfunction]
#[pyo3(signature = (path=None))]
pub(crate) fn inspect(py: Python<'_>, path: Option<PathBuf>) -> PyResult<Any<'_>> {
    PyTables::new(path, None)?.describe(py)
}

/// Does long work in a thread of its own, so that an interrupt is answered meanwhile; what was
/// begun then goes on until it is done.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let work = thread::spawn(work);
    while !work.is_finished() {
        py.detach(|| thread::sleep(PATIENCE));
        py.check_signals()?;
    }
    work.join().map_err(|_| PyRuntimeError::new_err("the bake has failed"))
}

/// The target of a bake, from the arguments of Python.
pub(crate) fn target_of(
    quality: &str,
    precision: &str,
    max_error: Option<f64>,
    max_bytes: Option<usize>,
) -> PyResult<Target> {
    let qualities =
        [("draft", Quality::Draft), ("default", Quality::Default), ("high", Quality::High)];
    let quality = one_of("quality", quality, &qualities)?;
    let precisions = [("f32", Precision::F32), ("f16", Precision::F16), ("u16", Precision::U16)];
    let precision = one_of("precision", precision, &precisions)?;
    match (max_error, max_bytes) {
        (None, None) => Ok(Target::Quality(quality, precision)),
        (Some(error), None) => Ok(Target::MaxError(error)),
        (None, Some(bytes)) => Ok(Target::MaxBytes(bytes)),
        _ => Err(refused("give either max_error or max_bytes")),
    }
}

/// Issues warnings of Python for doubts on a scene, and for what no table covers.
pub(crate) fn warn_of(py: Python<'_>, scene: &Scene, plan: &Plan) -> PyResult<()> {
    for warning in scene.doubts().chain(plan.not_covered().map(ToString::to_string)) {
        let warning = std::ffi::CString::new(warning.replace('\0', " "))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &warning, 1)?;
    }
    Ok(())
}

/// The options of a plan, from the arguments of `bake`.
pub(crate) fn options_of(albedo: Option<bool>, tabulate_ggx: bool, target: Target) -> Options {
    let albedo = match albedo {
        None => AlbedoWish::Auto,
        Some(true) => AlbedoWish::All,
        Some(false) => AlbedoWish::None,
    };
    Options { tabulate_ggx, albedo, quality: target.quality(), ..Options::default() }
}

fn general(albedo: Option<bool>) -> Plan {
    let mut plan = Plan::general();
    if albedo == Some(false) {
        plan.albedos.clear();
    }
    plan
}

/// Reads a recipe's text, which has more than one line, or what a path names.
pub(crate) fn scene_of(recipe: &Any) -> PyResult<Scene> {
    let scene = match recipe.extract::<String>() {
        Ok(text) if text.contains('\n') => Scene::from_recipe_str(&text),
        _ => microfacet_scene::load(&path("recipe", "the text of a recipe", recipe)?),
    };
    scene.map_err(unscened)
}

/// An argument as a path; `or` names what else it may be, for the error.
fn path(name: &str, or: &str, value: &Any) -> PyResult<PathBuf> {
    let of = value.get_type().name()?.to_string();
    let why = |_| PyTypeError::new_err(format!("{name} must be {or} or a path, and is a {of}"));
    value.extract().map_err(why)
}
