//! Dictionaries of Python, put together where there is no interpreter.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What can be made in any thread and becomes an object of Python.
pub trait Value: for<'py> IntoPyObject<'py> + Send + 'static {}

impl<T: for<'py> IntoPyObject<'py> + Send + 'static> Value for T {}

type Entry = Box<dyn FnOnce(Python<'_>) -> PyResult<Bound<'_, PyAny>> + Send>;

/// The entries of a dictionary, which become objects of Python together.
pub struct Dict(Vec<(&'static str, Entry)>);

impl Dict {
    pub fn new() -> Dict {
        Dict(Vec::new())
    }

    /// This dictionary with one more entry.
    pub fn with(mut self, name: &'static str, value: impl Value) -> Dict {
        self.0.push((name, Box::new(move |py| value.into_bound_py_any(py))));
        self
    }
}

impl<'py> IntoPyObject<'py> for Dict {
    type Target = PyDict;
    type Output = Bound<'py, PyDict>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, value) in self.0 {
            dict.set_item(name, value(py)?)?;
        }
        Ok(dict)
    }
}
