// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hash of 64 bits over the results of a frame. With it, two engines on two machines can be
//! compared frame by frame.

use foveate_camera::RegionAction;
use foveate_pixels::FramePixels;

use crate::{Engine, FrameOutcome};

/// The state of a 64-bit FNV-1a hash.
struct FnvHasher(u64);

impl FnvHasher {
    fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    fn update(&mut self, bytes: impl IntoIterator<Item = u8>) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }
}

impl Engine {
    /// Returns the 64-bit FNV-1a hash of the results of the last frame. It covers, in this order
    /// and little-endian: every pixel of the screen as two bytes; SRS, TRS and action of every
    /// region as [`FrameOutcome::region_bytes`] packs them; the scores, feature by feature, as
    /// eight bytes each; the temporal counts as four bytes each; the displacements, if there are
    /// any, as two bytes each, dx and dy in two's complement.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut hash = FnvHasher::new();
        match self.rendered() {
            FramePixels::Bytes(pixels) => hash.update(pixels.iter().flat_map(|&pixel| [pixel, 0])),
            FramePixels::Words(pixels) => {
                hash.update(pixels.iter().flat_map(|pixel| pixel.to_le_bytes()));
            }
        }
        let outcome = self.outcome();
        hash.update(outcome.region_bytes());
        hash.update(outcome.scores.iter().flatten().flat_map(|score| score.to_le_bytes()));
        hash.update(outcome.temporal_count.iter().flat_map(|count| count.to_le_bytes()));
        let displacements = outcome.displacements.iter().flat_map(|one| [one.dx, one.dy]);
        hash.update(displacements.map(i8::cast_unsigned));
        hash.0
    }
}

impl FrameOutcome {
    /// Returns one byte per region. Bit 0 is SRS, bit 1 is TRS, and the bits above are the action:
    /// 0 forward, 1 hold, 2 blank, 3 summarize.
    pub fn region_bytes(&self) -> impl Iterator<Item = u8> {
        self.srs.iter().zip(&self.trs).zip(&self.actions).map(|((&srs, &trs), action)| {
            let action = match action {
                RegionAction::Forward => 0,
                RegionAction::Hold => 1,
                RegionAction::Blank => 2,
                RegionAction::Summarize => 3,
            };
            u8::from(srs) | u8::from(trs) << 1 | action << 2
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values are test vectors of the FNV draft (draft-eastlake-fnv).
    #[test]
    fn it_is_fnv_1a() {
        let hash = |bytes: &[u8]| {
            let mut hash = FnvHasher::new();
            hash.update(bytes.iter().copied());
            hash.0
        };
        assert_eq!(hash(b""), 0xCBF2_9CE4_8422_2325);
        assert_eq!(hash(b"a"), 0xAF63_DC4C_8601_EC8C);
        assert_eq!(hash(b"foobar"), 0x8594_4171_F739_67E8);
    }
}
