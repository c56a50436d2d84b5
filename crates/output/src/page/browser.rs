// SPDX-License-Identifier: MIT OR Apache-2.0
//! Opens a page in Chromium, for tests, if Chromium is installed.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Returns the path of Chromium.
#[must_use]
pub fn chromium() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let candidates =
        NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    candidates.into_iter().find(|candidate| candidate.is_file())
}

/// The properties that a test expects of the marks of a page.
#[derive(Clone, Copy, Debug)]
pub struct ExpectedMark {
    /// A JavaScript expression of the figures of a plot's last mark.
    pub figures: &'static str,
    /// The number of links of these figures.
    pub links: usize,
}

/// Returns the findings of `probe.js` on a page in a window of this width. The width must be at
/// least 500.
///
/// # Panics
/// Panics if Chromium does not run or prints nothing.
#[must_use]
pub fn probe_page(program: &Path, page: &str, width: u32, tip: ExpectedMark) -> Value {
    let folder = tempfile::tempdir().expect("a folder for the page");
    let file = folder.path().join("page.html");
    let script = include_str!("probe.js")
        .replace("TOLD", tip.figures)
        .replace("LINKS", &tip.links.to_string());
    let script = format!("<script>{script}</script></body>");
    std::fs::write(&file, page.replace("</body>", &script)).expect("the page is written");
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
        .expect("Chromium runs");
    let text = String::from_utf8_lossy(&run.stdout);
    let found =
        text.split_once("<pre id=\"probe\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (found, _) = found.unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&run.stderr)));
    serde_json::from_str(found).expect("the script writes JSON")
}
