// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of the leaves that a core ships.

use crate::verilog_text::module_file;
use crate::{LEAVES, SourceFile};

/// Returns the leaves of these names and all that they instantiate in any branch, in compile order.
/// Each has the text of `rtl/`.
pub(crate) fn leaf_files(mut names: Vec<&'static str>) -> impl Iterator<Item = SourceFile> {
    // Every leaf comes after those that it instantiates, so one pass from the end finds them all.
    for leaf in LEAVES.iter().rev() {
        if names.contains(&leaf.name) {
            names.extend(leaf.uses);
        }
    }
    let named = LEAVES.iter().filter(move |leaf| names.contains(&leaf.name));
    named.map(|leaf| module_file(leaf.name, leaf.contents.to_owned()))
}
