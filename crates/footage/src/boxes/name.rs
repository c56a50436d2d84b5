// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names of images as files of boxes give them and as inputs have them.

use std::path::{Component, Path};

/// A name in a file as it is compared: folders and name with `/` between them. `None` if there is no name.
pub(crate) fn key(name: &str) -> Option<String> {
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

/// The path of an image, then what is left without its first folders, down to the name.
pub(super) fn endings(path: &Path) -> Vec<String> {
    let parts = parts(path);
    (0..parts.len()).map(|first| parts[first..].join("/")).collect()
}
