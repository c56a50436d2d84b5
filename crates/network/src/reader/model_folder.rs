// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder of a model, whose files hold constants, and the memory that constants may still take.

use super::OpenFile;
use super::constant_values::ConstantValues;
use crate::onnx::TensorProto;
use crate::tensor::checked_element_count;
use std::cell::Cell;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Component, Path, PathBuf};

/// The folder of a model, in which data outside of the model file must lie.
pub(super) struct ModelFolder {
    path: PathBuf,
    open: OpenFile,
    /// The bytes of constants that may still be read.
    readable_bytes: Cell<u64>,
    /// The bytes of constants that may still be computed.
    computable_bytes: Cell<u64>,
}

/// The largest number of bytes of all constants in separate files of a model.
const MAX_EXTERNAL_BYTES: u64 = 1 << 32;
/// The largest number of bytes of all constants that are computed when a model is read. It is
/// limited because a few bytes of a file can ask for a very large constant.
const MAX_COMPUTED_BYTES: u64 = 1 << 30;

impl ModelFolder {
    pub(super) fn of_model(model: &Path, open: OpenFile) -> Self {
        let path = model.parent().unwrap_or_else(|| Path::new("")).to_owned();
        Self {
            path,
            open,
            readable_bytes: Cell::new(MAX_EXTERNAL_BYTES),
            computable_bytes: Cell::new(MAX_COMPUTED_BYTES),
        }
    }

    /// Counts bytes that are to be read, and fails if they exceed the limit.
    pub(super) fn count_read_bytes(&self, bytes: u64) -> Result<(), String> {
        let left = self.readable_bytes.get().checked_sub(bytes);
        self.readable_bytes.set(left.ok_or("all constants together have more than 4 GiB")?);
        Ok(())
    }

    /// Returns the number of values of a shape, and fails if there is no room for them as a
    /// computed constant of this type.
    pub(super) fn check_room(
        &self,
        shape: &[usize],
        like: &ConstantValues,
    ) -> Result<usize, String> {
        let count = checked_element_count(shape);
        let bytes = count.and_then(|count| (count as u64).checked_mul(like.bytes_per_value()));
        match (count, bytes.and_then(|bytes| self.computable_bytes.get().checked_sub(bytes))) {
            (Some(count), Some(_)) => Ok(count),
            _ => Err(format!(
                "it makes a constant of shape {shape:?}, and all computed constants together have at most 1 GiB, of which {} MiB are left",
                self.computable_bytes.get() >> 20
            )),
        }
    }

    /// Counts a computed constant that is kept, and fails if there is no room for it.
    pub(super) fn count_computed(
        &self,
        shape: &[usize],
        values: &ConstantValues,
    ) -> Result<(), String> {
        let count = self.check_room(shape, values)? as u64;
        self.computable_bytes.set(self.computable_bytes.get() - count * values.bytes_per_value());
        Ok(())
    }
}

/// Reads the bytes of a tensor from a separate file, which must lie in the folder of the model.
pub(super) fn read_external_data(
    tensor: &TensorProto,
    folder: &ModelFolder,
) -> Result<Vec<u8>, String> {
    let entry = |key: &str| {
        tensor
            .external_data
            .iter()
            .find(|entry| entry.key.as_deref() == Some(key))
            .and_then(|entry| entry.value.as_deref())
    };
    let number = |key: &str| {
        entry(key)
            .map(|text| {
                text.parse::<u64>().map_err(|_| format!("its {key} is not a number: {text}"))
            })
            .transpose()
    };
    let location = Path::new(entry("location").ok_or("its data have no location")?);
    if !location.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(format!(
            "its data `{}` are outside of the folder of the model",
            location.display()
        ));
    }
    let path = folder.path.join(location);
    let fails =
        |error: std::io::Error| format!("cannot read its data `{}`: {error}", path.display());
    let outside =
        |_| format!("its data `{}` are outside of the folder of the model", location.display());
    if !path.metadata().map_err(fails)?.is_file() {
        return Err(format!("its data `{}` is not a file", location.display()));
    }
    let (real, root) = (
        path.canonicalize().map_err(fails)?,
        if folder.path.as_os_str().is_empty() { Path::new(".") } else { &folder.path }
            .canonicalize()
            .map_err(fails)?,
    );
    real.strip_prefix(root).map_err(outside)?;
    let mut file = (folder.open)(&real).map_err(fails)?;
    let all = file.metadata().map_err(fails)?.len();
    let offset = number("offset")?.unwrap_or(0);
    let length = number("length")?.unwrap_or(all.saturating_sub(offset));
    if offset.checked_add(length).is_none_or(|end| end > all) {
        return Err(format!(
            "its data is {length} bytes from {offset} on, but `{}` has {all}",
            location.display()
        ));
    }
    folder.count_read_bytes(length)?;
    file.seek(SeekFrom::Start(offset)).map_err(fails)?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).map_err(fails)?;
    Ok(bytes)
}
