// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page on which a camera runs in the browser: the files of `web/` in one file, with the engine
//! inside.
//!
//! The page loads nothing. Its policy allows its own script and style by their hashes, and requests
//! only to its own server, for the frames of `foveate live`.

use super::base85;
use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::GzEncoder;
use foveate_output::{
    page::colour_variables,
    palette::{DARK, LIGHT},
};
use sha2::{Digest as _, Sha256};

macro_rules! web_files {
    ($($name:literal),* $(,)?) => { [$(include_str!(concat!("../../web/", $name))),*] };
}

/// The modules of the page. Each comes after the modules that it imports.
const MODULES: [&str; 26] = web_files![
    "engine.js",
    "engine_text.js",
    "elements.js",
    "toml.js",
    "means.js",
    "zones.js",
    "link.js",
    "depth.js",
    "organization.js",
    "pixel_camera.js",
    "sources.js",
    "screens.js",
    "controls.js",
    "figures.js",
    "pinned.js",
    "capture.js",
    "reasons.js",
    "recording.js",
    "hardware.js",
    "class_names.js",
    "boxes.js",
    "network_thread.js",
    "network_controls.js",
    "network_figures.js",
    "network.js",
    "main.js",
];

/// The modules of the thread in which a network runs, in the same order.
const WORKER_MODULES: [&str; 2] = web_files!["engine.js", "network_worker.js"];

/// Returns the page as one file. With `frames` it begins with the frames that the server has at
/// that address, relative to the page's own.
#[must_use]
pub fn camera_page(frames: Option<&str>) -> String {
    let script = joined_modules(&MODULES);
    let style = include_str!("../../web/style.css")
        .replace("/*LIGHT*/", &colour_variables(&LIGHT))
        .replace("/*DARK*/", &colour_variables(&DARK));
    let frames = frames.map_or(String::new(), |path| format!(" data-frames=\"{path}\""));
    include_str!("../../web/index.html")
        .replace("<html lang=\"en\">", &format!("<html lang=\"en\"{frames}>"))
        .replace("POLICY", &policy(&script, &style))
        .replace("/*STYLE*/", &style)
        .replace("/*HARDWARE*/", include_str!("../../web/hardware.json"))
        .replace("/*SCRIPT*/", &script)
        .replace("/*WORKER*/", &joined_modules(&WORKER_MODULES))
        .replace("/*WASM*/", &compressed(include_bytes!("../../web/foveate.wasm")))
}

/// Joins modules into one script.
fn joined_modules(modules: &[&str]) -> String {
    modules.iter().map(|module| module_part(module)).collect()
}

/// Turns a module into a part of one script. The part imports nothing, because the modules that it
/// needs come before it.
fn module_part(module: &str) -> String {
    let lines = module.lines().filter(|line| !line.starts_with("import "));
    lines.map(|line| format!("{}\n", line.strip_prefix("export ").unwrap_or(line))).collect()
}

/// Compresses bytes and encodes them as text.
fn compressed(bytes: &[u8]) -> String {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::best());
    let written = gzip.write_all(bytes).and_then(|()| gzip.finish());
    base85::encode(&written.expect("memory takes everything"))
}

fn policy(script: &str, style: &str) -> String {
    let hash = |text: &str| format!("'sha256-{}'", BASE64.encode(Sha256::digest(text)));
    format!(
        "default-src 'none'; script-src {} 'wasm-unsafe-eval'; style-src {}; img-src data: blob:; \
         media-src blob:; worker-src blob:; connect-src 'self'; base-uri 'none'; form-action 'none'",
        hash(script),
        hash(style)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_one_small_file_that_loads_nothing() {
        let page = camera_page(None);
        assert!(page.len() < 1_000_000, "{} bytes", page.len());
        for gone in [
            "POLICY",
            "/*LIGHT*/",
            "/*STYLE*/",
            "/*WASM*/",
            "/*SCRIPT*/",
            "/*WORKER*/",
            "/*HARDWARE*/",
            "\nimport ",
            "\nexport ",
        ] {
            assert!(!page.contains(gone), "{gone}");
        }
        for loaded in [" src=", "<link rel=\"stylesheet", "url(", "@import"] {
            assert!(!page.contains(loaded), "{loaded}");
        }
        // Another end tag would end the script or the style early.
        assert_eq!(page.matches("</script").count(), 4);
        assert_eq!(page.matches("</style").count(), 1);
    }

    #[test]
    fn every_module_of_the_folder_is_in_the_page() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/web");
        let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let modules: Vec<_> = files
            .filter(|path| path.extension().is_some_and(|extension| extension == "js"))
            .collect();
        // Both scripts have the engine.
        assert_eq!(modules.len(), MODULES.len() + WORKER_MODULES.len() - 1, "{modules:?}");
        for path in modules {
            let text = std::fs::read_to_string(&path).unwrap();
            let is_part = [&MODULES[..], &WORKER_MODULES].concat().contains(&text.as_str());
            assert!(is_part, "{}", path.display());
        }
    }

    #[test]
    fn a_module_comes_after_the_modules_that_it_imports() {
        for modules in [&MODULES[..], &WORKER_MODULES] {
            assert_imports_precede(modules);
        }
    }

    /// The modules become parts of one script, so a name is declared in only one of them.
    #[test]
    fn no_two_modules_of_a_script_declare_the_same_name() {
        for modules in [&MODULES[..], &WORKER_MODULES] {
            let mut names: Vec<&str> = modules
                .iter()
                .flat_map(|module| module.lines())
                .filter_map(declared_name)
                .collect();
            names.sort_unstable();
            let twice: Vec<_> =
                names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
            assert!(names.len() > 5 && twice.is_empty(), "{twice:?} of {}", names.len());
        }
    }

    /// Returns the name that a line declares for its whole module.
    fn declared_name(line: &str) -> Option<&str> {
        let line = line.strip_prefix("export ").unwrap_or(line);
        let line = line.strip_prefix("async ").unwrap_or(line);
        let kinds = ["const ", "let ", "function ", "class "];
        let rest = kinds.iter().find_map(|kind| line.strip_prefix(kind))?;
        let end = rest.find(|letter: char| !letter.is_alphanumeric() && letter != '_')?;
        Some(&rest[..end]).filter(|name| !name.is_empty())
    }

    fn assert_imports_precede(modules: &[&str]) {
        let mut known = String::new();
        for module in modules {
            for import in module.lines().filter(|line| line.starts_with("import ")) {
                let names = import.split(['{', '}']).nth(1).unwrap().split(',');
                for name in names.map(str::trim) {
                    let defined = ["class", "const", "function", "async function"]
                        .map(|kind| format!("\nexport {kind} {name}"));
                    assert!(defined.iter().any(|text| known.contains(text.as_str())), "{import}");
                }
            }
            known.push('\n');
            known.push_str(module);
        }
    }

    #[test]
    fn frames_of_a_server_are_named_in_the_page() {
        assert!(camera_page(Some("frames")).contains("<html lang=\"en\" data-frames=\"frames\">"));
        assert!(camera_page(None).contains("<html lang=\"en\">"));
    }
}
