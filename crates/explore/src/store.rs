// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is finished, in the folder of the exploration: a file for every clip and design, under a name
//! that says all that the figures depend on. A rerun does only what is missing.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use foveate_simulator::{InputOptions, Subject};
use foveate_spec::{Config, HardwareConfig};
use foveate_staging::write_file;
use sha2::{Digest, Sha256};

use crate::ExploreError;
use crate::measure::Measured;

/// Grows when figures change their meaning, so that older ones are not taken for new ones.
const VERSION: u32 = 2;
const FOLDER: &str = "measured";

/// Finished measurements.
pub(crate) struct Store {
    folder: PathBuf,
}

impl Store {
    /// The store of an exploration, made if it is not there.
    pub(crate) fn open(exploration: &Path) -> Result<Self, ExploreError> {
        let folder = exploration.join(FOLDER);
        fs::create_dir_all(&folder).map_err(ExploreError::io("make the folder", &folder))?;
        Ok(Self { folder })
    }

    /// A finished measurement; none that cannot be read.
    pub(crate) fn get(&self, key: &str) -> Option<Measured> {
        serde_json::from_slice(&fs::read(self.place(key)).ok()?).ok()
    }

    pub(crate) fn put(&self, key: &str, measured: &Measured) -> Result<(), ExploreError> {
        let path = self.place(key);
        let text = serde_json::to_string(measured);
        let text = text.map_err(|error| ExploreError::io("write", &path)(error.into()))?;
        Ok(write_file(&path, text.as_bytes())?)
    }

    fn place(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.json"))
    }
}

/// The part of a configuration that figures depend on: not how the array is built.
pub(crate) fn functional(config: &Config) -> Config {
    Config { hardware: HardwareConfig::default(), ..config.clone() }
}

/// The name of a measurement.
pub(crate) fn key(clip: &str, ideal: &Config, functional: &Config) -> String {
    let text = format!("{VERSION}\n{clip}\n{}\n{}", ideal.to_toml(), functional.to_toml());
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().take(12).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// What tells a clip, as it is read, from others: names, sizes and times of its files.
pub(crate) fn identity(subject: &Subject, input: &InputOptions) -> String {
    let mut text = format!("{input:?}");
    for path in &subject.inputs {
        let _ = write!(text, "\n{}", path.display());
        if path.is_dir() {
            let mut files: Vec<PathBuf> = fs::read_dir(path)
                .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
                .unwrap_or_default();
            files.sort();
            files.iter().for_each(|file| stamp(&mut text, file));
        } else {
            stamp(&mut text, path);
        }
    }
    text
}

fn stamp(text: &mut String, file: &Path) {
    let Ok(about) = fs::metadata(file) else { return };
    let changed = about.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    let _ = write!(text, "\n{} {} {:?}", file.display(), about.len(), changed);
}
