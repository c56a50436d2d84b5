// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clips and sets of a comparison. Every input is a clip or set with a name, and a folder of
//! clips is several.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::address::input_without_secrets;
use crate::{ClipPlan, FootageError, ImageRelation, InputOptions, plan};

/// A clip or set with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComparedInput {
    /// The unique name in tables and charts.
    pub name: String,
    /// The inputs for [`open`](crate::open).
    pub inputs: Vec<PathBuf>,
}

/// Makes the clips and sets of a comparison. Image files together are one clip, unless they are
/// sheets of many images. Every other input is a clip or set of its own.
///
/// # Errors
/// The errors are those of [`plan`](fn@crate::plan).
pub fn subjects(
    inputs: &[PathBuf],
    options: &InputOptions,
) -> Result<Vec<ComparedInput>, FootageError> {
    let mut found = Vec::new();
    let sheets = options.images == ImageRelation::CifarSheet;
    if inputs.len() > 1 && !sheets && matches!(plan(inputs, options), Ok(ClipPlan::One)) {
        return Ok(vec![ComparedInput { name: name_of(&inputs[0]), inputs: inputs.to_vec() }]);
    }
    for input in inputs {
        match plan(&[input], options)? {
            ClipPlan::One => {
                found.push(ComparedInput { name: name_of(input), inputs: vec![input.clone()] });
            }
            ClipPlan::Batch(clips) => found.extend(clips.into_iter().map(|clip| {
                // Every clip has an input.
                ComparedInput { name: name_of(&clip.inputs[0]), inputs: clip.inputs }
            })),
        }
    }
    make_names_unique(&mut found);
    Ok(found)
}

/// Returns the name of a file without folder and extension, or the name of a scene.
fn name_of(path: &Path) -> String {
    // The name of an address is the part of it that may be shown.
    let address = path.to_string_lossy().contains("://").then(|| input_without_secrets(path));
    let path = address.as_ref().map_or(path, Path::new);
    let text = path.to_string_lossy();
    if let Some(scene) = text.strip_prefix("scene:") {
        return scene.to_owned();
    }
    let name = if path.is_dir() { path.file_name() } else { path.file_name().map(name_stem) };
    name.map_or_else(|| "clip".to_owned(), |name| name.to_string_lossy().into_owned())
}

fn name_stem(name: &std::ffi::OsStr) -> &std::ffi::OsStr {
    let once = Path::new(name).file_stem().unwrap_or(name);
    // `train-images-idx3-ubyte.gz` and `clip.y4m.gz` lose two extensions.
    Path::new(once).file_stem().unwrap_or(once)
}

/// Makes names unique: names that occur twice get their folder in front, and a number if that is
/// not enough.
fn make_names_unique(subjects: &mut [ComparedInput]) {
    let mut times: HashMap<String, u32> = HashMap::new();
    for subject in subjects.iter() {
        *times.entry(subject.name.clone()).or_insert(0) += 1;
    }
    let mut seen: HashMap<String, u32> = HashMap::new();
    for subject in subjects {
        let folder = subject.inputs.first().and_then(|path| path.parent()?.file_name());
        if let (Some(2..), Some(folder)) = (times.get(&subject.name), folder) {
            subject.name = format!("{}/{}", folder.to_string_lossy(), subject.name);
        }
        let number = seen.entry(subject.name.clone()).or_insert(0);
        *number += 1;
        if *number > 1 {
            subject.name = format!("{} ({number})", subject.name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(inputs: &[&str]) -> Vec<String> {
        let inputs: Vec<PathBuf> = inputs.iter().map(PathBuf::from).collect();
        let found = subjects(&inputs, &InputOptions::default()).unwrap();
        found.into_iter().map(|subject| subject.name).collect()
    }

    #[test]
    fn every_input_has_a_name_of_its_own() {
        assert_eq!(names(&["scene:street", "scene:fade"]), ["street", "fade"]);
        assert_eq!(names(&["scene:zero", "scene:zero"]), ["zero", "zero (2)"]);
        assert_eq!(names(&["a.png", "b.png"]), ["a"]);
        assert_eq!(names(&["-", "x/a.png", "y/a.png"]), ["-", "x/a", "y/a"]);
    }
}
