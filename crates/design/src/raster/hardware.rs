// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a raster core, and the frames and keys that it supports.

use crate::{FrameStoreKind, InterfaceKind, Organization, Pipelining, RasterConfig};
use foveate_camera::{
    Camera, ConfigError, IrrelevantRendering, Periphery, ReferencePolicy, check_range,
};

/// Valid numbers of pixels per word.
const WORD_PIXELS: [u32; 3] = [1, 2, 4];
/// Smallest number of regions in a row of regions.
const MIN_COLUMNS: u32 = 4;
/// Smallest number of words in a row of the padded frame.
const MIN_ROW_WORDS: u32 = 16;
/// Largest width of a frame in pixels.
const MAX_WIDTH: u32 = 8192;

/// The properties that only a raster core has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RasterHardware {
    /// Pixels that the core takes per clock, K: 1, 2 or 4.
    pub pixels_per_clock: u32,
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
    /// The memory of the frame store.
    pub store: FrameStoreKind,
    /// True if the pixels of active regions leave.
    pub has_forwarding: bool,
    /// The interface by which the core is connected.
    pub interface_kind: InterfaceKind,
}

impl RasterHardware {
    /// Returns the properties, or an error if a key or a size is not valid.
    pub(crate) fn validate(
        own: &RasterConfig,
        pipelining: Pipelining,
        camera: &Camera,
    ) -> Result<Self, ConfigError> {
        let &RasterConfig { pixels_per_clock, store, forward, interface } = own;
        let pixels = pixels_per_clock.unwrap_or(WORD_PIXELS[0]);
        check_word(pixels, camera.region_size())?;
        check_interface(own)?;
        check_reference(own, camera.temporal().reference)?;
        if let Some(periphery) = camera.periphery() {
            check_summaries(own, pixels, periphery)?;
        }
        let why = " for organization = \"raster\"; use a narrower frame, or \"serial\"";
        check_range("frame.width", camera.width(), 1..=MAX_WIDTH, why)?;
        let size = camera.region_size();
        let columns = min_columns(size, pixels);
        if camera.columns() < columns {
            let remedy = format!(
                "a row must have at least {MIN_COLUMNS} regions and {MIN_ROW_WORDS} words of \
                 {pixels} pixels; use frames of at least {} pixels, or smaller regions",
                (columns - 1) * size + 1
            );
            return Err(Organization::Raster.combination_error(
                "frame.width",
                camera.width().to_string(),
                &remedy,
            ));
        }
        Ok(Self {
            pixels_per_clock: pixels,
            pipelining,
            store: store.unwrap_or_default(),
            has_forwarding: forward.unwrap_or(true),
            interface_kind: interface.unwrap_or_default(),
        })
    }

    /// Returns the keys that only this organization has.
    pub(crate) fn config(&self) -> RasterConfig {
        RasterConfig {
            pixels_per_clock: Some(self.pixels_per_clock),
            store: Some(self.store),
            forward: Some(self.has_forwarding),
            interface: Some(self.interface_kind),
        }
    }
}

/// Refuses a number of pixels per word that does not divide the rows of a region.
fn check_word(pixels: u32, size: u32) -> Result<(), ConfigError> {
    let key = "hardware.pixels_per_clock";
    if !WORD_PIXELS.contains(&pixels) {
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
    Err(Organization::Raster.combination_error(key, pixels.to_string(), &remedy))
}

/// Refuses the AXI interface without forwarding, because its packets carry pixels.
fn check_interface(own: &RasterConfig) -> Result<(), ConfigError> {
    match own.interface.unwrap_or_default() {
        InterfaceKind::Axi if own.forward == Some(false) => Err(ConfigError::Combination {
            key: "hardware.forward".to_owned(),
            value: false.to_string(),
            with: format!("interface = \"{}\"", InterfaceKind::Axi),
            remedy: "its packets carry the pixels of active regions; leave the key out, or use \
                     interface = \"ports\""
                .to_owned(),
        }),
        InterfaceKind::Ports | InterfaceKind::Axi => Ok(()),
    }
}

/// Refuses a frame store that cannot store the reference.
fn check_reference(own: &RasterConfig, reference: ReferencePolicy) -> Result<(), ConfigError> {
    match reference {
        // The scored pixels are written to the store in any case. They are the reference of the
        // next frame.
        ReferencePolicy::Previous => return Ok(()),
        ReferencePolicy::LastSent => {}
    }
    let clash = |key: &str, value: String, remedy: &str| {
        Err(ConfigError::Combination {
            key: key.to_owned(),
            value,
            with: format!("temporal.reference = \"{reference}\""),
            remedy: remedy.to_owned(),
        })
    };
    if own.forward == Some(false) {
        let remedy = "its references are the pixels that leave; leave the key out, or use \
                      reference = \"previous\"";
        return clash("hardware.forward", false.to_string(), remedy);
    }
    match own.store.unwrap_or_default() {
        FrameStoreKind::Block | FrameStoreKind::Ultra => Ok(()),
        store @ (FrameStoreKind::SinglePort | FrameStoreKind::External) => {
            let remedy = "it also writes regions that leave while others come, for which such a \
                          store has no port; use \"block\" or \"ultra\", or reference = \"previous\"";
            clash("hardware.store", format!("\"{store}\""), remedy)
        }
    }
}

/// Refuses words that span two blocks, and summaries without forwarding, because the screen shows
/// only what has left the core.
fn check_summaries(
    own: &RasterConfig,
    pixels: u32,
    periphery: &Periphery,
) -> Result<(), ConfigError> {
    let clash = |key: &str, value: String, with: String, remedy: String| {
        Err(ConfigError::Combination { key: key.to_owned(), value, with, remedy })
    };
    if own.forward == Some(false) {
        let with = format!("render.irrelevant = \"{}\"", IrrelevantRendering::Mean);
        let remedy = "the screen shows only what leaves the core; leave the key out, or set \
                      another render.irrelevant";
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
pub(super) fn min_columns(size: u32, pixels: u32) -> u32 {
    (MIN_ROW_WORDS * pixels).div_ceil(size).max(MIN_COLUMNS)
}
