// SPDX-License-Identifier: MIT OR Apache-2.0
//! The names of images in box files, and their comparison with the paths of inputs.

use std::path::{Component, Path};

/// Returns a name from a file in the form in which it is compared, with `/` between folders and
/// name. Returns `None` if there is no name.
pub(crate) fn comparison_name(name: &str) -> Option<String> {
    let parts = parts(Path::new(&name.replace('\\', "/")));
    (!parts.is_empty()).then(|| parts.join("/"))
}

fn parts(path: &Path) -> Vec<String> {
    let part = |part| match part {
        Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
        _ => None,
    };
    path.components().filter_map(part).collect()
}

/// Returns the path of an image, and every shorter path that remains when its first folders are
/// removed, down to the name.
pub(super) fn path_endings(path: &Path) -> Vec<String> {
    let parts = parts(path);
    (0..parts.len()).map(|first| parts[first..].join("/")).collect()
}
