// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page in Chromium, where there is one; otherwise the tests say that they are skipped.

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use super::page;
use super::sample::exploration;

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

fn chromium() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let places = NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    places.into_iter().find(|place| place.is_file())
}

/// What `probe.js` found on a page in a window of that width.
fn probe(program: &PathBuf, page: &str, width: u32) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("page.html");
    let script = concat!("<script>", include_str!("probe.js"), "</script></body>");
    std::fs::write(&file, page.replace("</body>", script)).unwrap();
    let run = Command::new(program)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--hide-scrollbars",
        ])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .arg(format!("--window-size={width},800"))
        .arg("--dump-dom")
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&run.stdout);
    let found =
        text.split_once("<pre id=\"probe\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (found, _) = found.unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&run.stderr)));
    serde_json::from_str(found).unwrap()
}

#[test]
fn columns_fit_rows_are_in_sight_and_fingers_get_figures() {
    let Some(program) = chromium() else {
        eprintln!("skipped: there is no Chromium in PATH");
        return;
    };
    let spaces = [crate::BUILT_IN[0].toml, crate::BUILT_IN[1].toml];
    for (space, widths) in spaces.into_iter().zip([[1600, 1280, 500], [1280, 768, 500]]) {
        let page = page(&exploration(space, true)).unwrap();
        for width in widths {
            let found = probe(&program, &page, width);
            assert!(found["rows"].as_u64().unwrap() > 20, "{width}: {found}");
            assert_eq!(
                (&found["hidden"], &found["wider"]),
                (&0.into(), &0.into()),
                "{width}: {found}"
            );
            assert!(found["told"] == found["plots"], "{width}: {found}");
            assert!(found["mark"].as_f64().unwrap() > 7.0, "{width}: {found}");
            // Narrower windows scroll, and say so.
            assert_eq!(found["cut"] == 0, width >= 1280, "{width}: {found}");
        }
    }
}
