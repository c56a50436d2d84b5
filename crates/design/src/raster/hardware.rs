// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a raster core, and the frames and keys that it supports.

use crate::takes::Takes;
use crate::{Bus, HardwareConfig, Organization, Pipelining, Store, Thresholds};
use foveate_camera::{
    Camera, ConfigError, FeatureKind, Irrelevant, Periphery, Reference, in_range,
};

/// Valid numbers of pixels per word.
const WORDS: [u32; 3] = [1, 2, 4];
/// Smallest number of regions in a row of regions.
const MIN_COLUMNS: u32 = 4;
/// Smallest number of words in a row of the padded frame.
const MIN_ROW_WORDS: u32 = 16;
/// Largest width of a frame in pixels.
const MAX_WIDTH: u32 = 8192;

/// The properties that only a raster core has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Pixels that the core takes per clock, K: 1, 2 or 4.
    pub pixels_per_clock: u32,
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
    /// The memory of the frame store.
    pub store: Store,
    /// True if the pixels of active regions leave.
    pub forwards: bool,
    /// The interface by which the core is connected.
    pub bus: Bus,
}

impl Takes for Raster {
    fn takes_feature(kind: FeatureKind) -> bool {
        match kind {
            FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Mad | FeatureKind::Variance => {
                true
            }
        }
    }

    fn takes_reference(reference: Reference) -> bool {
        match reference {
            Reference::Previous | Reference::LastSent => true,
        }
    }

    fn takes_irrelevant(irrelevant: Irrelevant) -> bool {
        match irrelevant {
            Irrelevant::Zero | Irrelevant::Hold | Irrelevant::Mean => true,
        }
    }

    fn takes_thresholds(thresholds: Thresholds) -> bool {
        match thresholds {
            Thresholds::Runtime | Thresholds::Constant => true,
        }
    }

    fn takes_sync() -> bool {
        true
    }

    fn validate(asked: &HardwareConfig, camera: &Camera) -> Result<Self, ConfigError> {
        // The keys that are ignored here have been checked before.
        let &HardwareConfig {
            pixels_per_clock,
            pipelining,
            store,
            forward,
            interface,
            fold: _,
            feed: _,
            memory: _,
            organization: _,
            sync: _,
            thresholds: _,
        } = asked;
        let pixels = pixels_per_clock.unwrap_or(WORDS[0]);
        check_word(asked, pixels, camera.region_size())?;
        check_bus(asked)?;
        check_reference(asked, camera.temporal().reference)?;
        if let Some(periphery) = camera.periphery() {
            check_summaries(asked, pixels, periphery)?;
        }
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
        Ok(Self {
            pixels_per_clock: pixels,
            pipelining: pipelining.unwrap_or_default(),
            store: store.unwrap_or_default(),
            forwards: forward.unwrap_or(true),
            bus: interface.unwrap_or_default(),
        })
    }
}

impl Raster {
    /// Returns the table `[hardware]`. `forward` and `interface` are left out while they have their
    /// defaults, so that the fingerprint of a design is the same as before the keys existed.
    pub(crate) fn config(&self) -> HardwareConfig {
        HardwareConfig {
            organization: Organization::Raster,
            pixels_per_clock: Some(self.pixels_per_clock),
            pipelining: Some(self.pipelining),
            store: Some(self.store),
            forward: (!self.forwards).then_some(false),
            interface: self.bus.if_any(),
            ..HardwareConfig::default()
        }
    }
}

/// Refuses a number of pixels per word that does not divide the rows of a region.
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

/// Refuses the AXI interface without forwarding, because its packets carry pixels.
fn check_bus(asked: &HardwareConfig) -> Result<(), ConfigError> {
    match asked.interface.unwrap_or_default() {
        Bus::Axi if asked.forward == Some(false) => Err(ConfigError::Combination {
            key: "hardware.forward".to_owned(),
            value: false.to_string(),
            with: format!("interface = \"{}\"", Bus::Axi),
            remedy: "its packets carry the pixels of active regions; leave the key out, or use \
                     interface = \"ports\""
                .to_owned(),
        }),
        Bus::Ports | Bus::Axi => Ok(()),
    }
}

/// Refuses a frame store that cannot store the reference.
fn check_reference(asked: &HardwareConfig, reference: Reference) -> Result<(), ConfigError> {
    match reference {
        // The scored pixels are written to the store in any case. They are the reference of the
        // next frame.
        Reference::Previous => return Ok(()),
        Reference::LastSent => {}
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

/// Refuses words that span two blocks, and summaries without forwarding, because the screen shows
/// only what has left the core.
fn check_summaries(
    asked: &HardwareConfig,
    pixels: u32,
    periphery: &Periphery,
) -> Result<(), ConfigError> {
    let clash = |key: &str, value: String, with: String, remedy: String| {
        Err(ConfigError::Combination { key: key.to_owned(), value, with, remedy })
    };
    if asked.forward == Some(false) {
        let with = format!("render.irrelevant = \"{}\"", Irrelevant::Mean);
        let remedy = "what the screen shows is what has left; leave the key out, or show something \
                      else";
        return clash("hardware.forward", false.to_string(), with, remedy.to_owned());
    }
    let side = periphery.block_side;
    if side.is_multiple_of(pixels) {
        return Ok(());
    }
    let with = format!("periphery.blocks = {}", periphery.blocks);
    let remedy = format!(
        "a word must lie in one block of {side}x{side} pixels; use fewer pixels, or fewer blocks"
    );
    clash("hardware.pixels_per_clock", pixels.to_string(), with, remedy)
}

/// Returns the smallest number of regions in a row of regions, for regions of `size` x `size`
/// pixels and words of `pixels` pixels.
pub(super) fn least_columns(size: u32, pixels: u32) -> u32 {
    (MIN_ROW_WORDS * pixels).div_ceil(size).max(MIN_COLUMNS)
}
