// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips as rows of a table, where there are several.

use super::Rows;
use crate::Summary;
use foveate_pictures::page::Cell;

/// A row per clip.
pub(in crate::page) fn clips(summary: &Summary) -> Rows {
    let mut rows = Rows::new(vec![
        ("clip", "", "the clip or set", false),
        ("frames", "", "frames that were seen", true),
        ("counted", "", "frames that are in the means", true),
        ("active", "% of regions", "regions that were active", true),
        ("changed", "% of regions", "regions whose rendered pixels changed", true),
        ("needed", "% of MACs", "MACs whose windows hold a change", true),
        ("computed", "% of MACs", "MACs that were computed, in whole blocks", true),
        ("problem", "", "why frames are missing", false),
    ]);
    for (number, clip) in (0..).zip(&summary.clips) {
        let counted = |share: f64| {
            if clip.counted_frames > 0 { Cell::share(share) } else { Cell::none() }
        };
        let cells = vec![
            Cell::words(clip.name.clone()),
            Cell::count(clip.frames),
            Cell::count(clip.counted_frames),
            counted(clip.active_share),
            counted(clip.changed_share),
            counted(clip.macs.share(clip.macs.needed)),
            counted(clip.macs.share(clip.macs.scheduled)),
            Cell::words(clip.problem.clone().unwrap_or_default()),
        ];
        rows.push(format!("c{number}"), number, cells, String::new());
    }
    rows
}
