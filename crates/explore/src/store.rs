// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finished measurements in the folder of an exploration ([`MeasurementStore`]), so that a rerun
//! measures only what is missing: there is a file for every clip and camera, and for every clip and
//! design in front of a link, and its name is a hash of everything that the figures depend on.

use crate::ExploreError;
use crate::link::ArrayLink;
use foveate_camera::CameraConfig;
use foveate_cosim::ENERGY_FORMAT_VERSION;
use foveate_design::{Design, DesignConfig};
use foveate_estimate::SiliconReport;
use foveate_media::{ComparedInput, ImageRelation, InputOptions, matched_images};
use foveate_tools::{sha256_hex, write_file};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// The version of the figures. It grows if figures change their meaning, so that older figures are
/// not used.
const FIGURES_VERSION: u32 = 5;

/// The version of the loads on a link, which grows in the same way.
const LOAD_VERSION: u32 = 1;

/// The version of the energies in the cells of a process, which grows in the same way.
const ENERGY_VERSION: u32 = 1;

/// The number of hexadecimal digits of a name: 96 bits.
const KEY_DIGITS: usize = 24;

const STORE_FOLDER: &str = "measured";

/// The largest measurement that is read, in bytes; a usual one has a few KiB.
const MAX_MEASUREMENT_BYTES: u64 = 1 << 26;

/// The store of finished measurements.
pub(crate) struct MeasurementStore {
    folder: PathBuf,
}

impl MeasurementStore {
    /// Opens the store of an exploration, and creates it if it does not exist.
    pub(crate) fn open(exploration: &Path) -> Result<Self, ExploreError> {
        let folder = exploration.join(STORE_FOLDER);
        fs::create_dir_all(&folder).map_err(ExploreError::io("make the folder", &folder))?;
        Ok(Self { folder })
    }

    /// Returns a finished measurement; `None` if it does not exist or cannot be read.
    pub(crate) fn get<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        serde_json::from_slice(
            &foveate_tools::read_bytes(&self.measurement_path(key), MAX_MEASUREMENT_BYTES).ok()?,
        )
        .ok()
    }

    pub(crate) fn put(&self, key: &str, measured: &impl Serialize) -> Result<(), ExploreError> {
        let path = self.measurement_path(key);
        let text = serde_json::to_string(measured);
        let text = text.map_err(|error| ExploreError::io("write", &path)(error.into()))?;
        Ok(write_file(&path, text.as_bytes())?)
    }

    /// Returns a finished measurement, or else measures and keeps it.
    pub(crate) fn get_or_measure<T: Serialize + DeserializeOwned>(
        &self,
        key: &str,
        measure: impl FnOnce() -> Result<T, ExploreError>,
    ) -> Result<T, ExploreError> {
        if let Some(known) = self.get(key) {
            return Ok(known);
        }
        let measured = measure()?;
        self.put(key, &measured)?;
        Ok(measured)
    }

    fn measurement_path(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.json"))
    }
}

/// Returns the name of a result that depends on all of a text: the first digits of its hash.
pub(crate) fn key_of(text: &str) -> String {
    sha256_hex(text)[..KEY_DIGITS].to_owned()
}

/// The store of the measured energies of designs.
pub(crate) struct EnergyStore<'a> {
    pub(crate) measurements: &'a MeasurementStore,
    /// A text for every clip that identifies its frames.
    pub(crate) clips: Vec<String>,
}

impl EnergyStore<'_> {
    /// Returns the name of the energy of a design on a clip, which is given by its number, for
    /// `frame_rate` frames per second. `report` tells the RTL, the library and the tools.
    pub(crate) fn key(
        &self,
        clip: usize,
        frame_rate: f64,
        design: &Design,
        report: &SiliconReport,
    ) -> String {
        // The report is plain data with text keys, so this cannot fail.
        let report = serde_json::to_string(report).expect("it has no map with other keys");
        let (clip, design) = (&self.clips[clip], design.config().to_toml());
        let text = format!(
            "energy {ENERGY_VERSION} {ENERGY_FORMAT_VERSION}\n{clip}\n{frame_rate}\n{design}\n{report}"
        );
        key_of(&text)
    }
}

/// Returns the name of a measurement; `ideal` is the TOML of the ideal camera.
pub(crate) fn measurement_key(clip: &str, ideal: &str, camera: &CameraConfig) -> String {
    let text = format!("{FIGURES_VERSION}\n{clip}\n{ideal}\n{}", camera.to_toml());
    key_of(&text)
}

/// Returns the name of the load of a design on a link; `ideal` is the TOML of the ideal camera, by
/// which the frames are read.
pub(crate) fn load_key(clip: &str, ideal: &str, link: ArrayLink, design: &DesignConfig) -> String {
    let text = format!("load {LOAD_VERSION}\n{clip}\n{ideal}\n{link:?}\n{}", design.to_toml());
    key_of(&text)
}

/// Returns a text that identifies a clip as it is read: its options, and the names, sizes and times
/// of its files.
pub(crate) fn clip_identity(subject: &ComparedInput, input: &InputOptions) -> String {
    let mut text = format!("{input:?}");
    for path in &subject.inputs {
        let _ = write!(text, "\n{}", path.display());
        // An input that does not exist under its name may be a pattern, or a scene, which has no
        // files.
        match path.exists() {
            true => stamp_files(&mut text, path),
            false => matched_images(path, ImageRelation::Clip)
                .iter()
                .for_each(|file| stamp_file(&mut text, file)),
        }
    }
    let further = [input.labels.as_deref(), input.timestamps.as_ref().map(|file| &*file.path)];
    further.into_iter().flatten().for_each(|file| stamp_file(&mut text, file));
    text
}

/// Adds the name, size and time of a file, or of all files below a folder.
fn stamp_files(text: &mut String, path: &Path) {
    let Ok(entries) = fs::read_dir(path) else { return stamp_file(text, path) };
    let mut inside: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    inside.sort();
    inside.iter().for_each(|path| stamp_files(text, path));
}

fn stamp_file(text: &mut String, file: &Path) {
    let Ok(about) = fs::metadata(file) else { return };
    let changed = about.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    let _ = write!(text, "\n{} {} {:?}", file.display(), about.len(), changed);
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_media::{TimestampUnit, TimestampsFile};

    #[test]
    fn a_clip_is_another_when_one_of_its_files_is() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("class");
        fs::create_dir(&below).unwrap();
        fs::write(below.join("a.png"), "a").unwrap();
        let of = |input: PathBuf| {
            let subject = ComparedInput { name: String::new(), inputs: vec![input] };
            clip_identity(&subject, &InputOptions::default())
        };
        let numbered = || of(folder.path().join("f%d.png"));
        let without = numbered();
        fs::write(folder.path().join("f1.png"), "a").unwrap();
        assert_ne!(numbered(), without);
        let both = || (of(folder.path().to_owned()), of(below.join("*.png")));
        let before = both();
        assert_eq!(before, both());
        fs::write(below.join("a.png"), "other").unwrap();
        let changed = both();
        assert!(before.0 != changed.0 && before.1 != changed.1);
        fs::write(below.join("b.png"), "b").unwrap();
        let more = both();
        assert!(more.0 != changed.0 && more.1 != changed.1);
    }

    #[test]
    fn a_clip_is_another_when_its_times_are() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("times.txt");
        let subject = ComparedInput { name: String::new(), inputs: vec!["f.png".into()] };
        let file = TimestampsFile { path: path.clone(), unit: TimestampUnit::Seconds };
        let options = InputOptions { timestamps: Some(file), ..InputOptions::default() };
        fs::write(&path, "0\n1\n").unwrap();
        let before = clip_identity(&subject, &options);
        fs::write(&path, "0\n1.5\n").unwrap();
        assert_ne!(clip_identity(&subject, &options), before);
    }
}
