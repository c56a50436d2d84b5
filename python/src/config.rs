// SPDX-License-Identifier: MIT OR Apache-2.0
//! A configuration from Python's values: a preset, a file or a mapping, and keys by name.

use std::path::{Path, PathBuf};

use foveate_design::{DesignConfig, PRESETS, Preset};
use foveate_media::read_class_map;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};
use toml::{Table, Value};

use crate::camera::Camera;
use crate::design::Design;
use crate::error::{os_error, raise};
use crate::inputs::option_names;

/// Returns the configuration of `source` with changes by `sections`, such as `{"region": {"size": 16}}`.
pub(crate) fn read(
    source: Option<&Bound<'_, PyAny>>,
    sections: Option<&Bound<'_, PyDict>>,
) -> PyResult<DesignConfig> {
    let text = source.map_or(Ok(String::new()), toml_of)?;
    let overrides = sections.map_or(Ok(Vec::new()), overrides)?;
    let mut config = DesignConfig::from_toml_with(&text, &overrides).map_err(raise)?;
    if has_empty_zones(sections)? {
        // A dict without keys is a table, too, and makes a camera with zones.
        config.camera.zones.get_or_insert_default();
    }
    let file: Option<PathBuf> = source.and_then(|source| source.extract().ok());
    read_class_map(&mut config.camera, file.as_deref(), &overrides).map_err(raise)?;
    Ok(config)
}

/// Returns true if `zones` is a dict without keys.
fn has_empty_zones(sections: Option<&Bound<'_, PyDict>>) -> PyResult<bool> {
    let Some(sections) = sections else { return Ok(false) };
    let zones = sections.get_item("zones")?;
    Ok(zones.is_some_and(|zones| zones.cast::<PyDict>().is_ok_and(|keys| keys.is_empty())))
}

/// Returns the TOML text of a preset, a TOML file, a mapping, a design or a camera.
fn toml_of(source: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(design) = source.cast::<Design>() {
        return Ok(design.get().config().to_toml());
    }
    if let Ok(camera) = source.cast::<Camera>() {
        return Ok(camera.get().config().to_toml());
    }
    if source.is_instance_of::<PyDict>() {
        return Ok(table(source, "the configuration")?.to_string());
    }
    if let Ok(name) = source.cast::<PyString>() {
        let name: String = name.extract()?;
        let name = name.as_str();
        // A name without a folder or an extension is not a file.
        if Path::new(name).extension().is_none() && Path::new(name).components().count() == 1 {
            return Ok(Preset::find(name).map_err(raise)?.toml.to_owned());
        }
    }
    let Ok(path) = source.extract::<PathBuf>() else {
        let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        return Err(PyTypeError::new_err(format!(
            "a configuration is the name of a preset ({}), the path of a TOML file, a dict, a Design or a Camera, not {}",
            names.join(", "),
            source.get_type().name()?,
        )));
    };
    foveate_tools::read_settings(&path).map_err(|error| {
        let message = format!("cannot read the configuration `{}`: {error}", path.display());
        os_error(&error, message)
    })
}

/// Returns the changed keys by their names in the command line's `--set`.
fn overrides(sections: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
    let mut found = Vec::new();
    let known = option_names(sections.py(), "Sections")?;
    for (name, value) in sections.iter() {
        let name: String = name.extract()?;
        if value.is_none() && known.contains(&name) {
            continue;
        }
        if name == "spatial" {
            found.push(format!("spatial={}", features(&value)?));
            continue;
        }
        let Ok(keys) = value.cast::<PyDict>() else {
            return Err(PyTypeError::new_err(format!(
                "{name} takes a dict of its keys, for example region={{\"size\": 16}}, not {}",
                value.get_type().name()?
            )));
        };
        if keys.is_empty() && !known.contains(&name) {
            // An unknown table is refused by its name, even if it has no keys.
            found.push(format!("{name}={{}}"));
        }
        for (key, value) in keys.iter() {
            let key: String = key.extract()?;
            found.push(format!("{name}.{key}={}", literal(&value, &format!("{name}.{key}"))?));
        }
    }
    Ok(found)
}

/// Returns features from a name, a dict, or a list of these.
fn features(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let one = |value: &Bound<'_, PyAny>| -> PyResult<Value> {
        if let Ok(name) = value.extract::<String>() {
            return Ok(Value::Table(Table::from_iter([(
                "feature".to_owned(),
                Value::String(name),
            )])));
        }
        Ok(Value::Table(table(value, "spatial")?))
    };
    if value.is_instance_of::<PyString>() || value.is_instance_of::<PyDict>() {
        return Ok(Value::Array(vec![one(value)?]));
    }
    let all: PyResult<Vec<Value>> = value.try_iter()?.map(|item| one(&item?)).collect();
    Ok(Value::Array(all?))
}

fn table(value: &Bound<'_, PyAny>, key: &str) -> PyResult<Table> {
    match literal(value, key)? {
        Value::Table(table) => Ok(table),
        other => Err(PyTypeError::new_err(format!("{key} takes a dict, not {other}"))),
    }
}

/// Converts a Python value to one of TOML. Scalars of NumPy count as numbers.
fn literal(value: &Bound<'_, PyAny>, key: &str) -> PyResult<Value> {
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if let Ok(text) = value.extract::<String>() {
        return Ok(Value::String(text));
    }
    if let Ok(entries) = value.cast::<PyDict>() {
        let entry = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let name: String = name.extract()?;
            Ok((name.clone(), literal(&value, &format!("{key}.{name}"))?))
        };
        return Ok(Value::Table(entries.iter().map(entry).collect::<PyResult<Table>>()?));
    }
    if value.is_instance_of::<PyInt>() || value.hasattr("__index__")? {
        let number = value.extract::<i64>().map_err(|_| {
            PyValueError::new_err(format!("{key} = {value} is beyond the range of every key"))
        })?;
        return Ok(Value::Integer(number));
    }
    if value.is_instance_of::<PyFloat>() || value.hasattr("__float__")? {
        return Ok(Value::Float(value.extract()?));
    }
    if let Ok(items) = value.try_iter() {
        let items: PyResult<Vec<Value>> = items.map(|item| literal(&item?, key)).collect();
        return Ok(Value::Array(items?));
    }
    Err(PyTypeError::new_err(format!(
        "{key} takes a number, a string, a bool, a list or a dict, not {}",
        value.get_type().name()?
    )))
}
