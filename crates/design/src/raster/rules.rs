// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a raster design answers, and which frames its core takes; see [`crate::organization`].

use super::{RasterTiming, ports::ports};
use crate::rules::{Rules, Unit};
use crate::{Design, Feed, HardwareConfig, MemoryKind, Port, Store, Timing};
use foveate_camera::{Camera, ConfigError, Reference, Written, in_range};

/// Pixels that a word may have.
const WORDS: [u32; 3] = [1, 2, 4];
/// Fewest regions side by side.
const MIN_COLUMNS: u32 = 4;
/// Fewest words of a row of the padded frame.
const MIN_ROW_WORDS: u32 = 16;
/// Widest frame in pixels.
const MAX_WIDTH: u32 = 8192;
/// Regions one below the other of the lone core.
const LONE_ROWS: u32 = 3;

/// The organization as the answers to [`Rules`].
pub(crate) struct Raster;

impl Rules for Raster {
    fn unit(&self, design: &Design) -> Unit {
        Unit {
            name: self.unit_name(),
            module: "raster_core",
            count: 1,
            regions: design.regions(),
            rpu_in_rcm: false,
            // The core by itself has the numbers of no design.
            split: "rcm",
        }
    }

    fn unit_name(&self) -> &'static str {
        "core"
    }

    fn feeds(&self) -> &'static [Feed] {
        &[]
    }

    fn memories(&self) -> &'static [MemoryKind] {
        &[]
    }

    fn folds(&self) -> bool {
        false
    }

    fn hardware(
        &self,
        asked: &HardwareConfig,
        camera: &Camera,
    ) -> Result<HardwareConfig, ConfigError> {
        refuse_lanes(asked)?;
        let pixels = asked.pixels_per_clock.unwrap_or(WORDS[0]);
        check_word(asked, pixels, camera.region_size())?;
        check_reference(asked, camera.temporal().reference)?;
        let why = " for organization = \"raster\"; use a narrower frame, or \"serial\"";
        in_range("frame.width", camera.width(), 1..=MAX_WIDTH, why)?;
        let size = camera.region_size();
        let columns = least_columns(size, pixels);
        if camera.columns() < columns {
            let remedy = format!(
                "a row must have at least {MIN_COLUMNS} regions and {MIN_ROW_WORDS} words of \
                 {pixels} pixels; use frames of at least {} pixels, or smaller regions",
                (columns - 1) * size + 1
            );
            return Err(asked.clash("frame.width", camera.width().to_string(), &remedy));
        }
        Ok(HardwareConfig {
            pixels_per_clock: Some(pixels),
            pipelining: Some(asked.pipelining.unwrap_or_default()),
            store: Some(asked.store.unwrap_or_default()),
            // The default is left out, so that designs have the fingerprints from before there was this key.
            forward: asked.forward.filter(|forward| !forward),
            ..asked.clone()
        })
    }

    /// The core for the smallest frame that it takes.
    fn lone_unit(&self, design: &Design) -> Design {
        let size = design.region_size();
        let columns = least_columns(size, design.pixels_per_clock());
        let mut config = design.config();
        config.camera.frame.width = Some(columns * size);
        config.camera.frame.height = Some(LONE_ROWS * size);
        config.validate().expect("a raster design stays one with the smallest frame")
    }

    fn timing(&self, design: &Design) -> Timing {
        RasterTiming::of(design).answers()
    }

    fn rpu_ports(&self, design: &Design) -> Vec<Port> {
        ports(&self.lone_unit(design))
    }

    fn rcm_ports(&self, design: &Design) -> Vec<Port> {
        ports(design)
    }
}

/// Refuses what only lanes have.
fn refuse_lanes(asked: &HardwareConfig) -> Result<(), ConfigError> {
    if asked.fold != 1 {
        let remedy = "only the serial organization shares lanes; use 1";
        return Err(asked.clash("hardware.fold", asked.fold.to_string(), remedy));
    }
    if let Some(feed) = asked.feed {
        let remedy = "this organization always takes the frame row by row; leave the key out";
        return Err(asked.clash("hardware.feed", format!("\"{feed}\""), remedy));
    }
    if let Some(memory) = asked.memory {
        let remedy = "only the lanes of the serial organization have such a memory; leave the key \
                      out, or use `hardware.store`";
        return Err(asked.clash("hardware.memory", format!("\"{memory}\""), remedy));
    }
    Ok(())
}

/// Refuses words that do not fill the rows of a region.
fn check_word(asked: &HardwareConfig, pixels: u32, size: u32) -> Result<(), ConfigError> {
    let key = "hardware.pixels_per_clock";
    if !WORDS.contains(&pixels) {
        return Err(ConfigError::Range {
            key: key.to_owned(),
            value: pixels.to_string(),
            valid: "1, 2 or 4".to_owned(),
        });
    }
    if size.is_multiple_of(pixels) {
        return Ok(());
    }
    let remedy = format!("it must divide region.size = {}; use fewer pixels", size);
    Err(asked.clash(key, pixels.to_string(), &remedy))
}

/// Refuses what cannot keep references that are written when regions are sent.
fn check_reference(asked: &HardwareConfig, reference: Reference) -> Result<(), ConfigError> {
    match reference.written() {
        Written::WithEveryFrame => return Ok(()),
        Written::WhenSent => {}
    }
    let clash = |key: &str, value: String, remedy: &str| {
        Err(ConfigError::Combination {
            key: key.to_owned(),
            value,
            with: format!("temporal.reference = \"{reference}\""),
            remedy: remedy.to_owned(),
        })
    };
    if asked.forward == Some(false) {
        let remedy = "its references are the pixels that leave; leave the key out, or use \
                      reference = \"previous\"";
        return clash("hardware.forward", false.to_string(), remedy);
    }
    match asked.store.unwrap_or_default() {
        Store::Block | Store::Ultra => Ok(()),
        store @ (Store::SinglePort | Store::External) => {
            let remedy = "it also writes regions that leave while others come, for which such a \
                          store has no port; use \"block\" or \"ultra\", or reference = \"previous\"";
            clash("hardware.store", format!("\"{store}\""), remedy)
        }
    }
}

/// The fewest regions side by side, for regions and words of so many pixels.
fn least_columns(size: u32, pixels: u32) -> u32 {
    (MIN_ROW_WORDS * pixels).div_ceil(size).max(MIN_COLUMNS)
}
