// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip that goes through a core on AXI to a receiver's screen, compared with the results of
//! `simulate`, which uses no hardware.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use foveate_design::DesignConfig;
use foveate_media::{ClipPlayer, InputOptions};
use foveate_simulator::{PacketRecording, RunOptions, Simulation};
use foveate_tools::{FolderKind, StagedFolder};
use serde::Serialize;

use crate::args::CosimArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::progress::RunTerminal;

/// The names in the folder: the packets, the receiver's results, and the model's results.
const PACKETS: &str = "packets.bin";
const RECEIVED: &str = "received";
const SIMULATED: &str = "simulated";
/// The kind of the folder. An earlier folder is replaced if nothing else is in it.
const END_TO_END: FolderKind = FolderKind {
    description: "a clip through the hardware (its packets.bin)",
    matches: |folder| folder.join(PACKETS).is_file(),
};

/// The folder while it is being written.
pub(super) struct EndToEndFolder(StagedFolder);

impl EndToEndFolder {
    /// Fails if the folder holds anything else.
    pub(super) fn check(folder: &Path) -> Result<(), CliError> {
        Ok(StagedFolder::check(folder, END_TO_END, true)?)
    }

    pub(super) fn create(folder: &Path) -> Result<Self, CliError> {
        Ok(Self(StagedFolder::new(folder, END_TO_END, true)?))
    }

    pub(super) fn packets(&self) -> PathBuf {
        self.0.folder().join(PACKETS)
    }

    /// Returns the error with the final path of the folder in place of the temporary one.
    pub(super) fn with_final_path(&self, error: CliError) -> CliError {
        match error {
            CliError::Cosim(error) => CliError::Cosim(error.with_final_paths(&self.0)),
            other => other,
        }
    }

    /// Moves the folder with its contents to its final path. Does nothing if there are no packets.
    pub(super) fn commit(self) -> Result<(), CliError> {
        if self.packets().is_file() { Ok(self.0.commit()?) } else { Ok(()) }
    }
}

/// The comparison of the receiver's screen with the results of `simulate`.
#[derive(Debug, Serialize)]
pub(super) struct EndToEndReport {
    frames: u64,
    /// The number of arrays and pictures that were compared.
    files: usize,
    /// The files that differ, or that are not in both folders.
    differences: Vec<String>,
    received: PathBuf,
    simulated: PathBuf,
}

impl EndToEndReport {
    pub(super) fn agrees(&self) -> bool {
        self.differences.is_empty()
    }

    /// Returns the result as a line of text.
    pub(super) fn text(&self) -> String {
        let Self { frames, files, differences, received, simulated } = self;
        let (received, simulated) = (received.display(), simulated.display());
        if differences.is_empty() {
            return format!(
                "end to end: {frames} frames, {files} files with decisions and rendered frames in {received}, as in {simulated}"
            );
        }
        let names = differences.join(", ");
        format!("end to end: in {received} these files are not as in {simulated}: {names}")
    }
}

/// Decodes the packets that the core has sent, simulates the same frames, and compares the results.
pub(super) fn compare(args: &CosimArgs, trip: &EndToEndFolder) -> Result<EndToEndReport, CliError> {
    let EndToEndFolder(staged) = trip;
    let told = |folder: &Path| staged.shown_path(folder);
    let folder = staged.folder();
    let config = args.design.config()?;
    let hooks = RunTerminal::new(true)?;
    let options = RunOptions::default();
    let (received, simulated) = (folder.join(RECEIVED), folder.join(SIMULATED));
    let simulation = simulation(args, &config)?;
    // The clip gives the size of its frames; packets do not.
    let config = simulation.design().config().clone();

    let packets = folder.join(PACKETS);
    let mut stream = File::open(&packets).map_err(CliError::io("read the packets", &packets))?;
    let name = told(&packets).display().to_string();
    let recording = PacketRecording { config: &config, stream: &mut stream, name: &name };
    let decoded = recording.decode(&received, &options, &hooks);
    let decoded = decoded.map_err(|error| error.with_shown_paths(staged))?;
    hooks.check_complete(&told(&received), decoded.summary.problem)?;
    let summary = simulation.run(&simulated, &options, &hooks);
    let summary = summary.map_err(|error| error.with_shown_paths(staged))?;
    hooks.check_complete(&told(&simulated), summary.problem)?;
    let (files, differences) = differences(&received, &simulated)?;
    let (received, simulated) = (told(&received), told(&simulated));
    Ok(EndToEndReport { frames: summary.frames, files, differences, received, simulated })
}

fn simulation(args: &CosimArgs, config: &DesignConfig) -> Result<Simulation, CliError> {
    let (frames, interrupt) = (Some(args.frames), interrupt::stop_request());
    let input = InputOptions { frames, interrupt, ..InputOptions::default() };
    Ok(Simulation::new(config, ClipPlayer::open(&args.inputs, &config.camera, &input)?)?)
}

/// Returns the number of compared arrays and pictures, and the names of those that differ from the
/// model's. A picture that only one of the two has counts and differs, too. Only the receiver's
/// arrays are compared: the model also has scores, which packets do not carry.
fn differences(received: &Path, simulated: &Path) -> Result<(usize, Vec<String>), CliError> {
    let arrays = file_names(received)?.into_iter().filter(|name| name.ends_with(".npy"));
    let pictures = [received, simulated].map(|folder| file_names(&folder.join("rendered")));
    let pictures = pictures.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten();
    let all: BTreeSet<String> =
        arrays.chain(pictures.map(|name| format!("rendered/{name}"))).collect();
    let read = |folder: &Path, name: &str| fs::read(folder.join(name)).ok();
    let differs = |name: &&String| {
        let found = read(received, name);
        found.is_none() || found != read(simulated, name)
    };
    Ok((all.len(), all.iter().filter(differs).cloned().collect()))
}

fn file_names(folder: &Path) -> Result<Vec<String>, CliError> {
    let entries = fs::read_dir(folder).map_err(CliError::io("read the folder", folder))?;
    let name = |entry: std::io::Result<fs::DirEntry>| {
        let entry = entry.map_err(CliError::io("read the folder", folder))?;
        Ok(entry.file_name().to_string_lossy().into_owned())
    };
    entries.map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writes a folder as `simulate` does, and returns its path.
    fn folder(root: &Path, name: &str, pictures: &[&str]) -> PathBuf {
        let folder = root.join(name);
        fs::create_dir_all(folder.join("rendered")).unwrap();
        fs::write(folder.join("active.npy"), "decisions").unwrap();
        fs::write(folder.join("frames.csv"), name).unwrap();
        for picture in pictures {
            fs::write(folder.join("rendered").join(picture), picture).unwrap();
        }
        folder
    }

    #[test]
    fn a_picture_that_differs_or_is_missing_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let received = folder(dir.path(), RECEIVED, &["0.png", "1.png"]);
        let simulated = folder(dir.path(), SIMULATED, &["0.png", "1.png"]);
        fs::write(simulated.join("score_edge.npy"), "scores").unwrap();
        let said = |received, simulated| differences(received, simulated).unwrap();
        assert_eq!(said(&received, &simulated), (3, vec![]));

        fs::write(received.join("rendered/1.png"), "another").unwrap();
        assert_eq!(said(&received, &simulated), (3, vec!["rendered/1.png".to_owned()]));
        fs::remove_file(received.join("rendered/1.png")).unwrap();
        assert_eq!(said(&received, &simulated), (3, vec!["rendered/1.png".to_owned()]));
        fs::write(received.join("active.npy"), "others").unwrap();
        assert_eq!(said(&received, &simulated).1.len(), 2);
    }
}
