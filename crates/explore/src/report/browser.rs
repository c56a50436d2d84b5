// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the page in Chromium. Without Chromium they are skipped and say so.

use foveate_output::page::browser::{ExpectedMark, chromium, probe_page};

use super::render_page;
use super::sample::sample_exploration;

/// Marks show the number and the error of their point, and link to its row and its configuration.
const TIP: ExpectedMark = ExpectedMark { figures: r"/^Point \d+: .*\n.*% flipped/", links: 2 };

#[test]
fn columns_fit_rows_are_in_sight_and_fingers_get_figures() {
    let Some(program) = chromium() else {
        eprintln!("skipped: there is no Chromium in PATH");
        return;
    };
    let spaces = [crate::BUILT_IN_SPACES[0].toml, crate::BUILT_IN_SPACES[1].toml];
    for (space, widths) in spaces.into_iter().zip([[1600, 1280, 500], [1280, 768, 500]]) {
        let page = render_page(&sample_exploration(space, true)).unwrap();
        for width in widths {
            let found = probe_page(&program, &page, width, TIP);
            assert!(found["rows"].as_u64().unwrap() > 20, "{width}: {found}");
            assert_eq!(
                (&found["hidden"], &found["wider"]),
                (&0.into(), &0.into()),
                "{width}: {found}"
            );
            assert!(found["told"] == found["plots"], "{width}: {found}");
            assert!(found["mark"].as_f64().unwrap() > 7.0, "{width}: {found}");
            // The tables of narrower windows scroll, and show that they do.
            assert_eq!(found["cut"] == 0, width >= 1280, "{width}: {found}");
        }
    }
}
