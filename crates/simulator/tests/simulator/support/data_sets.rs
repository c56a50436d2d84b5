// SPDX-License-Identifier: MIT OR Apache-2.0
//! Helpers for the tests of data sets: a small set, runs that make a data set of it, and the
//! expected results.

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;

use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use foveate_design::DesignConfig;
use foveate_media::{ImageRelation, InputOptions, RunHooks, open};
use foveate_model::FunctionalCamera;
use foveate_pixels::{Frame, convert_depth};
use foveate_simulator::{RunOptions, RunSummary, Simulation, SimulatorError};

pub(crate) fn made<P: AsRef<Path>>(
    inputs: &[P],
    overrides: &[&str],
    input: &InputOptions,
    output: &Path,
    hooks: &dyn RunHooks,
) -> Result<RunSummary, Box<SimulatorError>> {
    let config = DesignConfig::from_toml_with("", overrides).unwrap();
    let source = open(inputs, &config.camera, input).map_err(SimulatorError::from)?;
    let options = RunOptions { rendered: None, data_set: true, ..RunOptions::default() };
    Ok(Simulation::new(&config, source)?.run(output, &options, hooks)?)
}

pub(crate) fn set() -> InputOptions {
    InputOptions { images: ImageRelation::Set, ..InputOptions::default() }
}

/// Returns seven ragged images. Each has a bright square at a position where the others have none.
pub(crate) fn pixels() -> Vec<u8> {
    let pixel = |i: u8, x: u8, y: u8| if (x / 4 + y / 4) % 7 == i { 250 - x - y } else { x };
    (0..7).flat_map(|i| (0..10).flat_map(move |y| (0..13).map(move |x| pixel(i, x, y)))).collect()
}

pub(crate) fn images() -> Vec<u8> {
    [&[0, 0, 8, 3, 0, 0, 0, 7, 0, 0, 0, 10, 0, 0, 0, 13][..], &pixels()].concat()
}

pub(crate) const LABELS: [u8; 15] = [0, 0, 8, 1, 0, 0, 0, 7, 3, 1, 4, 1, 5, 255, 0];

pub(crate) fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut zip = GzEncoder::new(Vec::new(), Compression::fast());
    zip.write_all(bytes).unwrap();
    zip.finish().unwrap()
}

/// Unpacks a file that is one gzip member with nothing after it.
pub(crate) fn unpacked(path: &Path) -> Vec<u8> {
    let bytes = fs::read(path).unwrap();
    assert_eq!(bytes[4..8], [0; 4], "no time");
    let mut zip = GzDecoder::new(&bytes[..]);
    let mut plain = Vec::new();
    zip.read_to_end(&mut plain).unwrap();
    assert!(zip.into_inner().is_empty());
    plain
}

/// Returns the rendered images, SRS and TRS of 8-bit images that are first frames.
pub(crate) fn rendered(
    config: &[&str],
    size: (u32, u32),
    images: impl Iterator<Item = Vec<u8>>,
) -> [Vec<u8>; 3] {
    let mut config = DesignConfig::from_toml_with("", config).unwrap();
    config.camera.fit_frame(size.0, size.1).unwrap();
    let design = config.validate().unwrap();
    let bits = design.pixel_bits();
    let mut result = [const { Vec::new() }; 3];
    for image in images {
        let pixels = image.iter().map(|&pixel| convert_depth(pixel.into(), 8, bits)).collect();
        let frame = Frame::new(size.0, size.1, bits, pixels).unwrap();
        let mut camera = FunctionalCamera::new(&design);
        let outcome = camera.step(&frame).unwrap();
        let shown = outcome.rendered.pixels().iter();
        result[0].extend(shown.map(|&pixel| convert_depth(pixel, bits, 8).to_le_bytes()[0]));
        result[1].extend(outcome.srs.iter().map(|&bit| u8::from(bit)));
        result[2].extend(outcome.trs.iter().map(|&bit| u8::from(bit)));
    }
    result
}

/// Unpacks a gzipped file of any origin.
pub(crate) fn unpacked_any(path: &Path) -> Vec<u8> {
    let mut plain = Vec::new();
    GzDecoder::new(fs::File::open(path).unwrap()).read_to_end(&mut plain).unwrap();
    plain
}
