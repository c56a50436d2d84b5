// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the tests of this crate share: runs, images made on the spot, and a reader of NPY files.
#![allow(dead_code, reason = "each test file uses some of it")]

use std::fs;
use std::path::{Path, PathBuf};

use foveate_simulator::{
    InputOptions, RunOptions, Silent, Simulation, SimulatorError, Summary, open,
};
use foveate_spec::Config;

/// Runs `inputs` with a configuration of default values and `overrides`.
pub(crate) fn run<P: AsRef<Path>>(
    inputs: &[P],
    overrides: &[&str],
    output: &Path,
    options: &RunOptions,
) -> Result<Summary, SimulatorError> {
    let config = Config::from_toml_with("", overrides).unwrap();
    let source = open(inputs, &config, &InputOptions::default())?;
    Simulation::new(&config, source)?.run(output, options, &mut Silent)
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

/// The names in a folder, hidden ones too.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// An NPY file as its header says it is.
pub(crate) struct Npy {
    pub(crate) descr: String,
    pub(crate) shape: Vec<usize>,
    pub(crate) data: Vec<u8>,
}

impl Npy {
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
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
            descr: between("'descr': '", '\''),
            shape: shape.split(',').map(|number| number.trim().parse().unwrap()).collect(),
            data: bytes[10 + length..].to_vec(),
        }
    }
}
