// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that `web/foveate.wasm` was compiled from the sources in this tree.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the folders of the engine of the page and of the crates with which it is compiled.
fn crates() -> BTreeSet<PathBuf> {
    let (mut found, mut next) = (BTreeSet::new(), vec![root().join("web/engine")]);
    while let Some(folder) = next.pop() {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let dependencies = manifest.split("\n[dependencies]\n").nth(1).unwrap_or_default();
        let dependencies = dependencies.split("\n[").next().unwrap();
        let own = dependencies.lines().filter_map(|line| line.strip_prefix("foveate-"));
        let names = own.filter_map(|line| line.split(['.', ' ']).next());
        next.extend(names.map(|name| root().join("crates").join(name)));
        found.insert(folder);
    }
    found
}

fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

fn sha256(path: &Path) -> String {
    Sha256::digest(fs::read(path).unwrap()).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[test]
fn the_engine_of_the_page_is_made_of_these_sources() {
    let mut files = vec![root().join("web/foveate.wasm")];
    for folder in crates() {
        rust_files(&folder.join("src"), &mut files);
        files.push(folder.join("Cargo.toml"));
    }
    let name = |path: &Path| path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned();
    let now: BTreeMap<String, String> =
        files.iter().map(|file| (name(file), sha256(file))).collect();
    let listed = fs::read_to_string(root().join("web/sources.sha256")).unwrap();
    let made = listed.lines().map(|line| line.split_once("  ").unwrap());
    let made: BTreeMap<String, String> =
        made.map(|(hash, name)| (name.to_owned(), hash.to_owned())).collect();
    let names: BTreeSet<&String> = now.keys().chain(made.keys()).collect();
    let other: Vec<_> =
        names.into_iter().filter(|name| now.get(*name) != made.get(*name)).collect();
    assert!(
        other.is_empty(),
        "web/foveate.wasm was made of other sources than these: {other:?}; run scripts/web.sh"
    );
}
