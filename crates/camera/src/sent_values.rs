// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effect of a decision: what a region sends, and how the screen shows it
//! ([`RegionAction`]). A region and frame take two bits, the displacement if the camera has `flow`, and values of P bits.
//!
//! | bits | the region | values that follow |
//! | --- | --- | --- |
//! | 00 | SRS = 0, no summary is sent | none |
//! | 01 | SRS = 0, its summary is sent | q * q means |
//! | 10 | SRS = 1, TRS = 0 | none |
//! | 11 | active | its pixels, without padding |
//!
//! The two bits say what happens to every region, so no addresses are sent. A displacement has
//! the bits of dx and dy: 4 for a radius of 1, and 6 for a larger one.

use crate::{Camera, Periphery};

/// Bits per region and frame that encode the decision and whether a summary is sent.
const DECISION_BITS: u64 = 2;

impl Camera {
    /// Returns the number of bits that every region sends in every frame: its decision, and its
    /// displacement.
    #[must_use]
    pub fn bits_per_region(&self) -> u64 {
        DECISION_BITS + u64::from(self.displacement_bits())
    }

    /// Returns the number of values of P bits that a region sends: its pixels inside of the frame,
    /// its means, or none.
    #[must_use]
    pub fn values_sent(&self, region: u32, action: RegionAction) -> u64 {
        match action {
            RegionAction::Forward => self.pixels_inside(region),
            RegionAction::Summarize => {
                self.periphery().map_or(0, |own| Periphery::mean_count(own).into())
            }
            RegionAction::Hold | RegionAction::Blank => 0,
        }
    }

    /// Returns the number of values of P bits that a frame sends, given the actions of its regions
    /// in order.
    #[must_use]
    pub fn values_sent_per_frame(&self, actions: &[RegionAction]) -> u64 {
        (0..).zip(actions).map(|(region, &action)| self.values_sent(region, action)).sum()
    }

    /// Returns the number of pixels of a region that are not padding.
    #[must_use]
    pub fn pixels_inside(&self, region: u32) -> u64 {
        let side = self.region_size();
        let inside = |position: u32, size: u32| u64::from(side.min(size - position * side));
        inside(region % self.columns(), self.width())
            * inside(region / self.columns(), self.height())
    }

    /// Returns the number of bits that `frames` frames send, with `values` values in all.
    #[must_use]
    pub fn bits_sent(&self, frames: u64, values: u64) -> u64 {
        let regions = u64::from(self.regions()) * frames;
        self.bits_per_region() * regions + values * u64::from(self.pixel_bits())
    }
}

/// The effect of a decision on a region of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RegionAction {
    /// The region is active: its current pixels are forwarded and shown.
    Forward,
    /// The screen keeps the pixels that it shows of the region.
    Hold,
    /// The region becomes black on the screen.
    Blank,
    /// The summary of the region is sent: the screen shows every block as its mean.
    Summarize,
}

impl RegionAction {
    /// Returns the name that tables use.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Hold => "hold",
            Self::Blank => "blank",
            Self::Summarize => "summarize",
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{CameraConfig, IrrelevantRendering, RegionAction};

    #[test]
    fn pixels_are_counted_without_padding_and_means_with_it() {
        let mut config = CameraConfig::default();
        (config.frame.width, config.frame.height) = (Some(20), Some(9));
        (config.frame.pixel_bits, config.render.irrelevant) = (10, IrrelevantRendering::Mean);
        config.periphery.blocks = Some(2);
        let camera = config.validate().unwrap();
        let actions = [
            RegionAction::Forward,
            RegionAction::Hold,
            RegionAction::Summarize,
            RegionAction::Blank,
        ];
        let values = |region| actions.map(|action| camera.values_sent(region, action));
        assert_eq!(values(0), [64, 0, 4, 0]);
        assert_eq!(values(2), [32, 0, 4, 0]);
        assert_eq!(values(5), [4, 0, 4, 0]);
        let sent = [
            RegionAction::Forward,
            RegionAction::Summarize,
            RegionAction::Hold,
            RegionAction::Forward,
        ];
        assert_eq!(camera.values_sent_per_frame(&sent), 64 + 4 + 8);
        assert_eq!(camera.bits_sent(3, 76), 3 * 6 * 2 + 760);
    }

    #[test]
    fn displacements_are_counted_with_the_bits_of_their_radius() {
        for (radius, bits) in [(1, 4), (2, 6), (3, 6)] {
            let text = format!(
                "frame={{width=20,height=9}}\nspatial=[{{feature='edge'}},{{feature='flow',radius={radius}}}]"
            );
            let camera = CameraConfig::from_toml(&text).unwrap().validate().unwrap();
            assert_eq!(camera.bits_sent(3, 76), 3 * 6 * (2 + bits) + 8 * 76, "radius {radius}");
        }
    }
}
