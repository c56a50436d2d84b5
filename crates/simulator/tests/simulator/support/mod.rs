// SPDX-License-Identifier: MIT OR Apache-2.0
//! Helpers that the tests of this crate share: runs, generated images, and a reader of NPY files.

#[path = "../../../../media/tests/footage/clips.rs"]
pub(crate) mod clips;
pub(crate) mod data_sets;

use std::fs;
use std::path::{Path, PathBuf};

use foveate_design::{Design, DesignConfig};
use foveate_media::{InputOptions, SilentHooks, open};
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::{Frame, Scene, SceneParameters};
use foveate_simulator::{RunOptions, RunSummary, Simulation, SimulatorError};

/// Runs `inputs` with a configuration of default values and `overrides`.
pub(crate) fn run<P: AsRef<Path>>(
    inputs: &[P],
    overrides: &[&str],
    output: &Path,
    options: &RunOptions,
) -> Result<RunSummary, SimulatorError> {
    let config = DesignConfig::from_toml_with("", overrides).unwrap();
    let source = open(inputs, &config.camera, &InputOptions::default())?;
    Simulation::new(&config, source)?.run(output, options, &SilentHooks)
}

/// The configuration of a ragged street with two features.
pub(crate) const STREET: [&str; 4] = [
    "frame.width=45",
    "frame.height=38",
    "region.size=8",
    r#"spatial=[{feature="edge"},{feature="mad",min_score=4}]"#,
];

/// Runs five frames of the street.
pub(crate) fn street(output: &Path, overrides: &[&str], options: &RunOptions) -> RunSummary {
    let config = DesignConfig::from_toml_with("", overrides).unwrap();
    let limit = InputOptions { frames: Some(5), ..InputOptions::default() };
    let source = open(&["scene:street"], &config.camera, &limit).unwrap();
    Simulation::new(&config, source).unwrap().run(output, options, &SilentHooks).unwrap()
}

/// Returns the five frames of the street.
pub(crate) fn frames(design: &Design) -> impl Iterator<Item = Frame> + use<> {
    Scene::Street.frames(SceneParameters {
        width: design.width(),
        height: design.height(),
        bits: design.pixel_bits(),
        region_size: design.region_size(),
        frames: 5,
    })
}

pub(crate) fn design(overrides: &[&str]) -> Design {
    DesignConfig::from_toml_with("", overrides).unwrap().validate().unwrap()
}

/// Returns the outcomes of the model for the five frames.
pub(crate) fn outcomes(overrides: &[&str]) -> Vec<FunctionalOutcome> {
    let design = design(overrides);
    let mut camera = FunctionalCamera::new(&design);
    frames(&design).map(|frame| camera.step(&frame).unwrap().clone()).collect()
}

/// Writes an 8-bit grey image whose format follows from its extension.
pub(crate) fn grey(
    path: &Path,
    width: u32,
    height: u32,
    pixel: impl Fn(u32, u32) -> u8,
) -> PathBuf {
    image::GrayImage::from_fn(width, height, |x, y| image::Luma([pixel(x, y)])).save(path).unwrap();
    path.to_owned()
}

/// Returns the names in a folder, hidden ones included.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// An NPY file, parsed by its header.
pub(crate) struct NpyArray {
    pub(crate) descr: String,
    pub(crate) shape: Vec<usize>,
    pub(crate) data: Vec<u8>,
}

impl NpyArray {
    pub(crate) fn read(path: &Path) -> Self {
        Self::parse(&fs::read(path).unwrap())
    }

    pub(crate) fn parse(bytes: &[u8]) -> Self {
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!((10 + length) % 64, 0, "NumPy asks for aligned data");
        let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
        assert!(header.ends_with('\n') && header.contains("'fortran_order': False"));
        let between = |start: &str, end: char| {
            let from = header.find(start).unwrap() + start.len();
            header[from..].split(end).next().unwrap().to_owned()
        };
        let shape = between("'shape': (", ')');
        Self {
            descr: match between("'descr': ", 'f').trim_end_matches([' ', ',', '\'']) {
                list if list.starts_with('[') => list.to_owned(),
                name => name.trim_matches('\'').to_owned(),
            },
            shape: shape
                .split(',')
                .filter(|number| !number.trim().is_empty())
                .map(|number| number.trim().parse().unwrap())
                .collect(),
            data: bytes[10 + length..].to_vec(),
        }
    }
}
