// SPDX-License-Identifier: MIT OR Apache-2.0
//! A sensor which reads the rows of a frame one after the other, as a source of pauses.

use foveate_design::{Design, Hardware, RasterTiming};

use crate::BeatOffer;

/// A sensor in front of an array or core, by the rows that it has read.
///
/// It has a line memory in front of a raster core: the core is offered the words of a row at
/// consecutive edges, the last of them at the edge at which the row has been read. Pipelined and
/// serial arrays take a frame when all of it has been read, so it waits in a memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowSensor {
    rows: u32,
    /// The number of words of a row that a raster core takes, or `None` in front of an array.
    row_words: Option<u32>,
}

impl RowSensor {
    /// Makes the sensor of a design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        let row_words = match design.hardware() {
            Hardware::Raster(own) => {
                Some(RasterTiming::from_design(design.with_hardware(own)).taken_words)
            }
            Hardware::Pipelined(_) | Hardware::Serial(_) => None,
        };
        Self { rows: design.height(), row_words }
    }

    /// Returns the pauses of a frame whose row of pixels `row` has been read at edge
    /// `read_edge(row)`.
    ///
    /// A row that has been read fewer edges after edge 0 than it has words is offered from edge 0
    /// on.
    #[must_use]
    pub fn frame_offers(&self, read_edge: impl Fn(u32) -> u64) -> Vec<BeatOffer> {
        let Some(words) = self.row_words else {
            return vec![BeatOffer { beat: 0, clock: read_edge(self.rows - 1) }];
        };
        let words = u64::from(words);
        let row_offer = |row: u32| BeatOffer {
            beat: u64::from(row) * words,
            clock: read_edge(row).saturating_sub(words - 1),
        };
        (0..self.rows).map(row_offer).collect()
    }
}

#[cfg(test)]
mod tests {
    use foveate_design::DesignConfig;
    use foveate_pixels::FramePixels;

    use super::*;
    use crate::{FrameDelivery, ReadySink, TimedModel, Transaction};

    /// Returns a design with frames of 31x12 pixels, which has regions of 4 without windows.
    fn design(hardware: &str) -> Design {
        let toml = format!(
            "frame = {{ width = 31, height = 12 }}\nregion.size = 4\ndenoise.filter = \"none\"\n\
             hardware = {{ {hardware} }}\n[[spatial]]\nfeature = \"variance\""
        );
        DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
    }

    /// Returns the edge at which a row has been read: a row takes 50 edges.
    fn read_edge(row: u32) -> u64 {
        50 * (u64::from(row) + 1)
    }

    /// Returns the clock of the last decision of each row of regions of a first frame.
    fn decision_clocks(design: &Design) -> Vec<u64> {
        let offers = RowSensor::new(design).frame_offers(read_edge);
        let pixels = FramePixels::Bytes(&[0; 31 * 12]);
        let delivery = FrameDelivery { offers: &offers, ..FrameDelivery::whole(pixels) };
        let mut clocks = vec![0; design.rows() as usize];
        let mut record = |transaction: &Transaction<'_>| {
            if let Transaction::Decisions(run) = transaction {
                for (clock, region) in run.regions.iter() {
                    clocks[(region / design.columns()) as usize] = clock;
                }
            }
        };
        let mut model = TimedModel::new(design, Box::new(ReadySink));
        model.step(&delivery, &mut record).unwrap();
        model.finish(&mut record);
        clocks
    }

    #[test]
    fn the_last_word_of_a_row_comes_when_the_row_has_been_read() {
        // A row has 31 words, or 16 words of two pixels.
        for (keys, words) in [("", 31), (", pixels_per_clock = 2", 16)] {
            let design = design(&format!("organization = \"raster\"{keys}"));
            let offers = RowSensor::new(&design).frame_offers(read_edge);
            assert_eq!(offers.len(), 12);
            assert_eq!(offers[0], BeatOffer { beat: 0, clock: 50 - (words - 1) });
            assert_eq!(offers[11], BeatOffer { beat: 11 * words, clock: 600 - (words - 1) });
        }
        // The core makes the 32nd word of a row itself, one edge later, and decides 9 clocks later.
        let design = design("organization = \"raster\"");
        assert_eq!(decision_clocks(&design), [200 + 1 + 9, 400 + 1 + 9, 600 + 1 + 9]);
    }

    #[test]
    fn a_row_that_is_read_too_early_is_offered_from_the_first_edge_on() {
        let design = design("organization = \"raster\"");
        let offers = RowSensor::new(&design).frame_offers(|row| 20 * (u64::from(row) + 1));
        assert_eq!(offers[0], BeatOffer { beat: 0, clock: 0 });
        assert_eq!(offers[1], BeatOffer { beat: 31, clock: 40 - 30 });
    }

    #[test]
    fn an_array_takes_a_frame_when_its_last_row_has_been_read() {
        for organization in ["pipelined", "serial"] {
            let design = design(&format!("organization = \"{organization}\""));
            let offers = RowSensor::new(&design).frame_offers(read_edge);
            assert_eq!(offers, [BeatOffer { beat: 0, clock: 600 }], "{organization}");
            let decided = decision_clocks(&design);
            assert!(decided.iter().all(|&clock| clock > 600), "{organization}: {decided:?}");
        }
    }
}
