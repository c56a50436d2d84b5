// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the map of the crates is true. It lists every crate with the imports of its manifest,
//! and imports go only upwards.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

type Imports = BTreeMap<String, BTreeSet<String>>;

fn crates() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Returns the crates that every manifest names below `[dependencies]`.
fn manifests() -> Imports {
    let folders = fs::read_dir(crates()).unwrap().map(|entry| entry.unwrap().path());
    let imports = folders.filter(|folder| folder.join("Cargo.toml").is_file()).map(|folder| {
        let text = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        let table = manifest.get("dependencies").and_then(toml::Value::as_table);
        let keys = table.into_iter().flat_map(toml::Table::keys);
        let own = keys.filter_map(|key| key.strip_prefix("foveate-")).map(str::to_owned);
        (folder.file_name().unwrap().to_str().unwrap().to_owned(), own.collect())
    });
    imports.collect()
}

/// Returns the words between backticks.
fn quoted(text: &str) -> BTreeSet<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Returns the rows of the table.
fn table(map: &str) -> Imports {
    let rows = map.lines().filter(|line| line.starts_with("| `"));
    let mut table = Imports::new();
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        table.insert(cells[1].trim_matches('`').to_owned(), quoted(cells[2]));
    }
    let all: BTreeSet<String> = table.keys().cloned().collect();
    let command = table.get_mut("cli").unwrap();
    *command =
        all.iter().filter(|name| !command.contains(*name) && *name != "cli").cloned().collect();
    table
}

/// Returns the height of every crate in the drawing, 0 at the top.
fn heights(map: &str) -> BTreeMap<String, usize> {
    let drawing = map.split("```").nth(1).unwrap();
    let rows = drawing.lines().filter(|line| line.contains(char::is_alphabetic));
    let below = rows.enumerate().flat_map(|(height, row)| {
        let names: Vec<&str> = row.get(20..).unwrap_or_default().split_whitespace().collect();
        names.into_iter().map(move |name| (name.to_owned(), height)).collect::<Vec<_>>()
    });
    below.collect()
}

#[test]
fn the_map_is_what_the_manifests_say() {
    let map = fs::read_to_string(crates().join("README.md")).unwrap();
    let imports = manifests();
    assert_eq!(table(&map), imports);

    let heights = heights(&map);
    assert_eq!(heights.keys().collect::<Vec<_>>(), imports.keys().collect::<Vec<_>>());
    for (name, imported) in &imports {
        for above in imported {
            assert!(heights[above] < heights[name], "{name} imports {above} from its row or below");
        }
    }
}

/// A crate that computes a camera, or that gives it frames, cannot import hardware.
#[test]
fn the_crates_of_the_camera_cannot_see_hardware() {
    let imports = manifests();
    let mut reached =
        BTreeSet::from(["camera", "engine", "ideal", "media", "network"].map(String::from));
    loop {
        let more: BTreeSet<String> =
            reached.iter().flat_map(|name| &imports[name]).cloned().collect();
        if more.is_subset(&reached) {
            break;
        }
        reached.extend(more);
    }
    assert!(!reached.contains("design"), "{reached:?}");
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] });
    files.collect()
}

/// Frames are taken from a source in one place, the playback of `media`, so that every command reads ahead,
/// gives memory back, resets cameras and stops in the same way.
#[test]
fn only_the_playback_takes_frames_from_a_source() {
    let python = crates().join("../python");
    let folders = manifests().into_keys().map(|name| crates().join(name)).chain([python]);
    let own = crates().join("media/src");
    let files = folders.map(|folder| folder.join("src")).filter(|folder| *folder != own);
    for file in files.flat_map(|folder| sources(&folder)) {
        let text = fs::read_to_string(&file).unwrap_or_default();
        assert!(!text.contains(".next_frame()"), "{} takes frames itself", file.display());
    }
}
