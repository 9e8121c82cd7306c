//! The work that a farm shares out, and the assembly of a library's sets, for `microfacet.farm`.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

use microfacet_baker::cache::Cache;
use microfacet_baker::library::{Library, PER_SET};
use microfacet_baker::store::{OutputFolder, SetWriter};
use microfacet_baker::table_set::{Need, Settings, Target, bake_with};

use crate::tables::{interruptible, options_of, scene_of, target_of, warn_of};
use crate::words::{refused, unread};

/// One thing that a library needs, which any process on any machine can bake; it can be pickled.
#[pyclass(name = "Need", module = "microfacet.farm", frozen)]
pub(crate) struct PyNeed {
    need: Need,
    id: String,
}

impl PyNeed {
    fn of((id, need): (String, Need)) -> Self {
        Self { need, id }
    }
}

#[pymethods]
impl PyNeed {
    /// The need of its text, which str gives; one of another version is refused.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let need = Need::from_text(text).map_err(refused)?;
        Ok(Self { id: need.id(), need })
    }

    fn __getnewargs__(&self) -> (String,) {
        (self.need.to_text(),)
    }

    fn __str__(&self) -> String {
        self.need.to_text()
    }

    fn __repr__(&self) -> String {
        format!("Need({}, about {:.2} s)", self.need.name(), self.need.seconds())
    }

    /// Its content address: needs with the same tables have the same.
    #[getter]
    fn id(&self) -> &str {
        &self.id
    }

    /// Words for it.
    #[getter]
    fn name(&self) -> String {
        self.need.name()
    }

    /// The planner's estimate for one thread.
    #[getter]
    fn seconds(&self) -> f64 {
        self.need.seconds()
    }

    /// Whether a folder of finished tables has it.
    fn is_kept(&self, cache: PathBuf) -> bool {
        self.need.is_kept(&Cache::new(cache))
    }

    /// Bakes what the folder lacks of it, on so many threads, and keeps it there; whether anything
    /// had to be baked.
    #[pyo3(signature = (cache, threads=1, max_memory=4 << 30))]
    fn bake(
        &self,
        py: Python<'_>,
        cache: PathBuf,
        threads: usize,
        max_memory: u64,
    ) -> PyResult<bool> {
        let settings = Settings { cache: Cache::new(cache), max_memory, ..Settings::default() };
        let baked = py.detach(|| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.max(1)).build();
            pool.map(|pool| pool.install(|| self.need.bake(settings)))
        });
        let baked = baked.map_err(|why| PyRuntimeError::new_err(why.to_string()))?;
        baked.map_err(|why| PyRuntimeError::new_err(format!("{}: {why}", self.need.name())))
    }
}

/// A scene divided into sets, and what they need.
#[pyclass(name = "Library", module = "microfacet.farm", frozen)]
pub(crate) struct PyLibrary {
    library: Arc<Library>,
    target: Target,
}

#[pymethods]
impl PyLibrary {
    /// Reads and plans a recipe or scene; the arguments are those of microfacet.bake.
    #[new]
    #[pyo3(signature = (scene, *, quality="default", precision="f32", max_error=None, albedo=None,
                        tabulate_ggx=false, per_set=PER_SET))]
    #[expect(clippy::too_many_arguments, reason = "by keyword, as options of the command")]
    fn new(
        py: Python<'_>,
        scene: &Bound<'_, PyAny>,
        quality: &str,
        precision: &str,
        max_error: Option<f64>,
        albedo: Option<bool>,
        tabulate_ggx: bool,
        per_set: usize,
    ) -> PyResult<Self> {
        let target = target_of(quality, precision, max_error, None)?;
        if !(1..=PER_SET).contains(&per_set) {
            return Err(refused(format!("per_set is {per_set}: it must be in [1, {PER_SET}]")));
        }
        let scene = scene_of(scene)?;
        let options = options_of(albedo, tabulate_ggx, target);
        let library = py.detach(|| Library::new(scene, per_set, options)).map_err(refused)?;
        for (scene, plan) in library.plans() {
            warn_of(py, scene, plan)?;
        }
        Ok(Self { library: Arc::new(library), target })
    }

    /// The names of the materials of each set.
    #[getter]
    fn sets(&self) -> Vec<Vec<String>> {
        let names = |entries: &[microfacet_tables::MaterialEntry]| {
            entries.iter().map(|entry| entry.name.clone()).collect()
        };
        self.library.parts.iter().map(|part| names(&part.plan.materials)).collect()
    }

    /// What its sets need, each thing once.
    fn needs(&self, py: Python<'_>) -> PyResult<Vec<PyNeed>> {
        let needs = py.detach(|| self.library.needs(self.target)).map_err(refused)?;
        Ok(needs.into_iter().map(PyNeed::of).collect())
    }
}

/// The folder in which a library's sets are put together; nothing in it changes before the end.
#[pyclass(name = "Assembly", module = "microfacet.farm", frozen)]
pub(crate) struct PyAssembly {
    writer: Arc<Mutex<Option<SetWriter>>>,
}

fn over() -> PyErr {
    PyRuntimeError::new_err("the sets are written, or have failed: begin again")
}

#[pymethods]
impl PyAssembly {
    /// Opens the folder, which is made if it is not there.
    #[new]
    fn new(out: PathBuf) -> PyResult<Self> {
        let folder = OutputFolder::open_for_set(&out).map_err(unread)?;
        Ok(Self { writer: Arc::new(Mutex::new(Some(folder.sets()))) })
    }

    /// Adds the sets of a library from a folder of finished tables, and bakes what that lacks;
    /// returns the number of tables, and of those that had to be baked. After an interrupt, which
    /// returns at once, the folder is given up.
    fn add(
        &self,
        py: Python<'_>,
        library: &PyLibrary,
        cache: PathBuf,
        max_memory: u64,
    ) -> PyResult<(usize, usize)> {
        let (library, target) = (Arc::clone(&library.library), library.target);
        let writer = Arc::clone(&self.writer);
        interruptible(py, move || {
            let mut held = writer.lock().unwrap_or_else(PoisonError::into_inner);
            // Taken out, so that a failure leaves nothing to go on with.
            let mut writer = held.take().ok_or_else(over)?;
            let (mut tables, mut fresh) = (0, 0);
            for part in &library.parts {
                let cache = Cache::new(cache.clone());
                let settings = Settings { cache, max_memory, ..Settings::default() };
                let baked = bake_with(&part.plan, target, settings).map_err(refused)?;
                if let Some(why) = baked.cache_error {
                    return Err(PyOSError::new_err(why.to_string()));
                }
                tables += baked.set.tables().len();
                fresh += baked.baked;
                writer.add(baked.set).map_err(unread)?;
            }
            *held = Some(writer);
            Ok((tables, fresh))
        })?
    }

    /// Gives the folder up as it was, unless finish has been called.
    fn close(&self) {
        // After an interrupt a thread may still hold it, and gives it up itself.
        if let Ok(mut held) = self.writer.try_lock() {
            held.take();
        }
    }

    /// Puts the sets in their place, and returns the paths of the files.
    fn finish(&self, py: Python<'_>) -> PyResult<Vec<PathBuf>> {
        py.detach(|| {
            let mut held = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
            let written = held.take().ok_or_else(over)?.finish().map_err(unread)?;
            Ok(written.into_iter().map(|file| file.path).collect())
        })
    }
}

/// The folder where finished tables are kept unless another is named; none without a home.
#[pyfunction]
pub(crate) fn user_cache() -> Option<PathBuf> {
    Cache::user().folder().map(PathBuf::from)
}
