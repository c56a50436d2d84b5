// SPDX-License-Identifier: MIT OR Apache-2.0
//! The count of the boxes of a file that are no objects.

use std::collections::BTreeMap;
use std::path::Path;

/// Boxes that are left out, counted by reason.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoxExclusions {
    /// The number of all boxes of the file.
    boxes: u64,
    by_reason: BTreeMap<&'static str, u64>,
}

impl BoxExclusions {
    /// Counts a box, which is left out if there is a reason.
    pub(crate) fn count(&mut self, reason: Option<&'static str>) {
        self.boxes += 1;
        if let Some(reason) = reason {
            *self.by_reason.entry(reason).or_default() += 1;
        }
    }

    /// Returns a sentence about the boxes of a file that are left out, if there are any.
    pub(crate) fn in_words(&self, path: &Path) -> Option<String> {
        let left_out: u64 = self.by_reason.values().sum();
        let reasons = self.by_reason.iter().map(|(reason, count)| format!("{count} {reason}"));
        (left_out > 0).then(|| {
            format!(
                "{left_out} of {} boxes of `{}` are left out: {}",
                self.boxes,
                path.display(),
                reasons.collect::<Vec<_>>().join(", ")
            )
        })
    }
}
