// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files, and filled templates.

use askama::Template;
use foveate_emit::SourceFile;

/// Returns a file of a project.
pub(crate) fn source_file(path: &str, contents: String) -> SourceFile {
    SourceFile { path: path.to_owned(), contents }
}

/// Returns a filled template, with the newline at its end that askama drops.
pub(crate) fn rendered(view: &impl Template) -> String {
    let text = view.render();
    text.map_or_else(|e| unreachable!("a template only fails when writing does: {e}"), |t| t + "\n")
}
