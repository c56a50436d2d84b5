// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memories of a raster core, as its Verilog declares them. Each memory has a write port and a
//! read port, except a single-port frame store.

use super::RasterTiming;
use crate::{CLASS_BITS, CLASS_WORD_BITS, Design, FeatureHardware, FrameStoreKind, RasterDesign};
use foveate_camera::{
    Periphery, ReferencePolicy, ReferenceWriteTime, SpatialFeature, bits_for, index_bits,
};

/// Bits of the number of a row of regions in a queue, modulo 8.
const ROW_BITS: u32 = 3;

/// A memory of a raster core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterMemory {
    /// Contents of the memory in words for users.
    pub contents: &'static str,
    /// Number of words.
    pub words: u64,
    /// Width of a word in bits.
    pub bits: u32,
}

impl RasterMemory {
    /// Returns the size of the memory in bits.
    #[must_use]
    pub fn total_bits(&self) -> u64 {
        self.words * u64::from(self.bits)
    }

    /// Returns the frame store of the design, or `None` if it is outside of the core.
    #[must_use]
    pub fn frame_store(design: RasterDesign<'_>) -> Option<Self> {
        let words = RasterTiming::from_design(design).words();
        let pixel = design.temporal().reference.bits_per_pixel(design.pixel_bits());
        let word = design.pixels_per_clock() * pixel;
        let (words, bits) = match design.store() {
            FrameStoreKind::Block | FrameStoreKind::Ultra => (words, word),
            FrameStoreKind::SinglePort => (words.div_ceil(2), 2 * word),
            FrameStoreKind::External => return None,
        };
        Some(Self { contents: "references: the frame store", words, bits })
    }

    /// Returns all memories of the design. A frame store inside of the core comes first.
    #[must_use]
    pub fn all_memories(design: RasterDesign<'_>) -> Vec<Self> {
        let sizes = MemorySizes::from_design(design);
        let means = design.periphery().map(|periphery| sizes.means(periphery, &design));
        [
            sizes.pixels(design),
            sizes.rows(design),
            sizes.scores(design),
            sizes.queues(design),
            means.unwrap_or_default(),
            design.zones().map(|_| class_banks(&design)).into_iter().collect(),
        ]
        .concat()
    }
}

/// Returns the two banks of the memory of classes.
fn class_banks(design: &Design) -> RasterMemory {
    let words = 2 << design.class_address_bits();
    RasterMemory { contents: "classes of regions, in two banks", words, bits: CLASS_WORD_BITS }
}

/// The numbers that the sizes of the memories are derived from.
struct MemorySizes {
    timing: RasterTiming,
    /// Width of a word of pixels in bits.
    word: u32,
    /// Number of words of the buffer for pixels that leave.
    buffer: u64,
    columns: u64,
    regions: u64,
    reference: ReferencePolicy,
    /// Number of features that count hits.
    hits: u32,
}

impl MemorySizes {
    fn from_design(design: RasterDesign<'_>) -> Self {
        let timing = RasterTiming::from_design(design);
        let rows = u64::from(timing.buffer_rows * design.region_size());
        let counts = |feature: &&SpatialFeature| feature.kind().counts_window_hits();
        let hits = design.features().iter().filter(counts).count();
        Self {
            word: design.pixels_per_clock() * design.pixel_bits(),
            buffer: rows * u64::from(timing.row_words),
            columns: design.columns().into(),
            regions: design.regions().into(),
            reference: design.temporal().reference,
            hits: u32::try_from(hits).expect("no more than there are kinds"),
            timing,
        }
    }

    /// Returns the frame store and the buffers of pixels.
    fn pixels(&self, design: RasterDesign<'_>) -> Vec<RasterMemory> {
        let buffer = |holds| RasterMemory { contents: holds, words: self.buffer, bits: self.word };
        let mut list: Vec<_> = RasterMemory::frame_store(design).into_iter().collect();
        if design.has_forwarding() {
            list.push(buffer("pixels that may leave"));
        }
        if design.has_second_pass() {
            list.push(buffer("a copy for the second pass"));
        }
        match self.reference.write_time() {
            ReferenceWriteTime::EveryFrame => {}
            ReferenceWriteTime::WhenSent if design.has_separate_raw_pixels() => {
                list.push(buffer("denoised pixels, which become references when raw ones leave"));
            }
            ReferenceWriteTime::WhenSent => {}
        }
        list
    }

    /// Returns the buffers of rows of pixels in front of the windows.
    fn rows(&self, design: RasterDesign<'_>) -> Vec<RasterMemory> {
        let row = |holds, bits| RasterMemory {
            contents: holds,
            words: self.timing.row_words.into(),
            bits,
        };
        let mut list = Vec::new();
        if design.filter().has_window() {
            list.push(row("two rows of pixels, for the filter", 2 * self.word));
        }
        if design.has_feature_window() {
            list.push(row("two rows of pixels, for the features", 2 * self.word));
        }
        if design.has_feature_window()
            && design.has_separate_raw_pixels()
            && design.has_forwarding()
        {
            list.push(row("a row of raw pixels", self.word));
        }
        if self.timing.windows == 0 && self.timing.rows > self.timing.taken_rows {
            list.push(row("a row of pixels, repeated below the frame", self.word));
        }
        list
    }

    /// Returns the memories of the scores of a row of regions.
    fn scores(&self, design: RasterDesign<'_>) -> Vec<RasterMemory> {
        let side = u64::from(design.region_size());
        let column = |holds, bits| RasterMemory { contents: holds, words: self.columns, bits };
        let mut list = vec![column("counts", (self.hits + 1) * bits_for((side - 1) * side))];
        let features = design.features().iter();
        if features.clone().any(|feature| feature.kind().spec().source.needs_pixel_sum()) {
            list.push(column("sums of pixels", design.pixel_sum_bits()));
        }
        let mut own: Vec<_> = features.collect();
        own.sort_by_key(|feature| feature.kind());
        list.extend(own.into_iter().filter_map(|feature| {
            let (contents, bits) = FeatureHardware::in_raster(feature.kind()).memory?;
            Some(column(contents, bits(&design, feature)))
        }));
        list
    }

    /// Returns the memories of the means of blocks: means that are being summed, means that are
    /// ready to leave, and means that the screen shows.
    fn means(&self, periphery: &Periphery, design: &Design) -> Vec<RasterMemory> {
        let (side, means) = (u64::from(periphery.blocks), u64::from(periphery.mean_count()));
        let pixel = design.pixel_bits();
        // The low bits of the numbers of columns and rows of regions tell the entries apart.
        let rows = u64::from(self.timing.buffer_rows).next_power_of_two();
        let columns = self.columns.next_power_of_two();
        let shown = |holds| RasterMemory { contents: holds, words: self.regions, bits: 1 };
        vec![
            RasterMemory {
                contents: "sums of blocks, and whether their means differ",
                words: columns * side,
                bits: periphery.sum_bits + u32::from(periphery.blocks > 1),
            },
            RasterMemory {
                contents: "means that may leave",
                words: columns * rows * means,
                bits: pixel,
            },
            RasterMemory {
                contents: "means that were sent",
                words: self.regions * means,
                bits: pixel,
            },
            shown("which regions show a summary, by decisions"),
            shown("which regions sent one that was lost"),
        ]
    }

    /// Returns the bits of the frame number that a queue entry stores. The row of regions that is
    /// being decided is at most B rows later than that of the entry, and its frame number is known.
    fn frame_bits(&self, design: RasterDesign<'_>) -> u32 {
        if design.rows() < self.timing.buffer_rows { 2 } else { 1 }
    }

    /// Returns the queues of regions, and the flags of regions with a valid reference.
    fn queues(&self, design: RasterDesign<'_>) -> Vec<RasterMemory> {
        let waiting = 1 << index_bits(u64::from(self.timing.buffer_rows) * self.columns);
        let queue = |holds, bits| RasterMemory { contents: holds, words: waiting, bits };
        let start = index_bits(self.buffer);
        // An entry stores the address at which the reference is written, and whether it is written.
        let reference = match self.reference.write_time() {
            ReferenceWriteTime::EveryFrame => 0,
            ReferenceWriteTime::WhenSent => index_bits(self.timing.words()) + 1,
        };
        // An entry stores whether the means of the region leave.
        let summary = u32::from(design.periphery().is_some());
        let mut list = Vec::new();
        if design.has_forwarding() {
            list.push(queue(
                "active regions that wait for the sink",
                ROW_BITS
                    + design.region_bits()
                    + start
                    + self.frame_bits(design)
                    + reference
                    + summary,
            ));
        }
        let bits = |feature: &SpatialFeature| match feature.kind().has_second_pass() {
            true => 0,
            false => feature.score_bits(),
        };
        let decision_bits = design.count_bits() + design.features().iter().map(bits).sum::<u32>();
        let decision_bits = decision_bits + 2 * u32::from(design.periphery().is_some());
        let class_bits = design.zones().map_or(0, |_| CLASS_BITS);
        list.extend(design.second_pass_mean().map(|mean| {
            queue(
                "regions that wait for the second pass",
                mean.mean_bits + start + decision_bits + class_bits,
            )
        }));
        let bits = self.reference.bits_per_region();
        if bits > 0 {
            let mut all =
                |holds| list.push(RasterMemory { contents: holds, words: self.regions, bits });
            all("which regions have a reference, by decisions");
            if self.reference.is_lost_with_its_region() {
                all("which regions have a reference, by losses");
            }
        }
        list
    }
}
