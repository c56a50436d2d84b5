// SPDX-License-Identifier: MIT OR Apache-2.0
//! A random serial design as plain numbers, and the numbers of `docs/serial.md` that follow from
//! it.

use foveate_design::{Design, Organization, PixelFeed};
use proptest::prelude::*;
use proptest::sample::select;

use crate::parameters::{
    DesignParameters, FeatureParameters, PeripheryParameters, arbitrary_parameters_with_sides,
    arbitrary_zones_of,
};

#[derive(Clone, Debug)]
pub(crate) struct SerialParameters {
    pub(crate) base: DesignParameters,
    pub(crate) raster: bool,
    pub(crate) fold: i64,
}

/// A phase of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ExpectedPhase {
    WithoutOutput(i64),
    Rotation,
    Unload,
    UnloadMeans,
}

impl SerialParameters {
    pub(crate) fn design(&self) -> Design {
        let mut config = self.base.config();
        config.hardware.make_serial().feed =
            Some(if self.raster { PixelFeed::Raster } else { PixelFeed::Parallel });
        config.hardware.make_serial().fold = self.fold as u32;
        config.validate().unwrap_or_else(|error| panic!("{error}\n{self:?}"))
    }

    pub(crate) fn regions(&self) -> i64 {
        self.base.columns() * self.base.rows()
    }

    pub(crate) fn lanes(&self) -> i64 {
        (self.regions() + self.fold - 1) / self.fold
    }

    pub(crate) fn port_pixels(&self) -> i64 {
        if self.raster { 1 } else { self.lanes() }
    }

    fn has_window(&self) -> bool {
        self.base.has_feature_window()
    }

    pub(crate) fn halo(&self) -> i64 {
        if self.base.shared {
            i64::from(self.base.has_filter()) + i64::from(self.has_window())
        } else {
            0
        }
    }

    /// Returns the side of the denoised square, S.
    fn denoised_side(&self) -> i64 {
        self.base.side + if self.base.shared && self.has_window() { 2 } else { 0 }
    }

    /// Returns true if the reference stays as it is until the last score.
    fn copies_reference(&self) -> bool {
        self.base.last_sent || self.base.has_feature("flow")
    }

    /// Returns the clocks from an address to the accumulator, Q.
    pub(crate) fn read_latency(&self) -> i64 {
        let mut words = (self.base.side + 2 * self.halo()).pow(2);
        if self.base.has_filter() {
            words += self.denoised_side().pow(2);
        }
        if !self.base.has_filter() || self.copies_reference() {
            words += self.base.region_pixels();
        }
        let mut slot = 1;
        while slot < words {
            slot *= 2;
        }
        let luts = i64::from(self.base.bits) * ((self.fold * slot + 63) / 64);
        let sums = ["mad", "variance", "range", "surface", "flow"]
            .iter()
            .any(|name| self.base.has_feature(name));
        i64::from(luts > 128) + i64::from(self.base.deep) * if sums { 2 } else { 1 }
    }

    /// Returns the steps of a rotation before the first score, s.
    pub(crate) fn settling_steps(&self) -> i64 {
        i64::from(self.base.deep)
    }

    /// Returns the phases of a slot.
    pub(crate) fn phases(&self) -> Vec<ExpectedPhase> {
        use ExpectedPhase::{Rotation, Unload, UnloadMeans, WithoutOutput};
        let (n, p, q) = (self.base.region_pixels(), i64::from(self.base.bits), self.read_latency());
        let (median, copies) = (self.base.has_filter(), self.copies_reference());
        let mut phases = Vec::new();
        phases.extend(self.base.zones.as_ref().map(|_| WithoutOutput(self.lanes())));
        if median {
            let per_pixel = match self.base.filter {
                "median3x3" => 10 * p + 3 + i64::from(copies),
                "switching3x3" => 1 + 16 + (10 * p + 3) + 2 + i64::from(copies),
                "binomial3x3" => 51,
                other => panic!("docs/serial.md says no steps of {other}"),
            };
            phases.push(WithoutOutput(self.denoised_side().pow(2) * (per_pixel + q)));
        }
        if self.halo() == 2 {
            phases.push(WithoutOutput(4 * (self.base.side + 2) * (2 + q)));
        }
        if !median {
            phases.push(WithoutOutput(if copies { 3 * n } else { n * (3 + q) }));
        }
        phases.push(Rotation);
        if let Some(PeripheryParameters { blocks, .. }) = self.base.periphery {
            let pixels = (self.base.side / blocks).pow(2);
            phases.push(WithoutOutput(
                blocks.pow(2) * (pixels + 2 + self.settling_steps() + self.lanes()),
            ));
        }
        for feature in &self.base.features {
            phases.push(WithoutOutput(self.pass_steps(feature)));
            phases.push(Rotation);
        }
        if copies {
            phases.push(WithoutOutput(n * (2 + q)));
        }
        phases.push(Unload);
        phases.extend(self.base.periphery.map(|_| UnloadMeans));
        phases
    }

    fn pass_steps(&self, feature: &FeatureParameters) -> i64 {
        let (n, p) = (self.base.region_pixels(), i64::from(self.base.bits));
        let bits = |largest: i64| (0..).find(|&bits| largest >> bits == 0).unwrap_or(0i64);
        match feature.name {
            "edge" => 14 * n,
            "corner" => 36 * n,
            "mad" => 2 * n + p + 2 * i64::from(feature.fraction_bits) + 3,
            "range" => 4 * n + p + 2,
            "surface" => 8 * n + 11 * bits(n * self.base.pixel_max()) + 5,
            "segment" => (n + p + 2) + 3 * (p + n + 2) + 1,
            "variance" => {
                let ones = (0..13).filter(|bit| n >> bit & 1 == 1).count() as i64;
                n + p * n * ones + 2 * bits(n * self.base.pixel_max()) + p + bits(n) + 2
            }
            "flow" => {
                let (side, radius) = (self.base.side, feature.radius);
                let widths = || side - radius..=side;
                let is_multiple = |of: &i64| widths().all(|width| of % width == 0);
                // A multiple of the side is found at once, unless the side is large.
                let common = (1..).map(|times| times * side).find(is_multiple).unwrap();
                let (sum, product) = (
                    bits(n * self.base.pixel_max()),
                    bits(common * common * self.base.pixel_max()),
                );
                let displacement = |dx: i64, dy: i64| {
                    let pairs = (side - dx.abs()) * (side - dy.abs());
                    1 + 2 * pairs + sum + sum + product
                };
                let all = (-radius..=radius)
                    .flat_map(|dy| (-radius..=radius).map(move |dx| displacement(dx, dy)));
                all.sum::<i64>() + 1 + sum + product + sum + 1 + sum + 1
            }
            other => panic!("docs/serial.md says no steps of {other}"),
        }
    }

    pub(crate) fn steps(&self, phase: ExpectedPhase) -> i64 {
        match phase {
            ExpectedPhase::WithoutOutput(steps) => steps,
            ExpectedPhase::Rotation => self.settling_steps() + self.lanes(),
            ExpectedPhase::Unload => self.base.region_pixels() * self.round_steps(phase),
            ExpectedPhase::UnloadMeans => self.mean_count() * self.round_steps(phase),
        }
    }

    /// Returns the steps in which one pixel or mean of every lane leaves.
    pub(crate) fn round_steps(&self, phase: ExpectedPhase) -> i64 {
        match phase {
            _ if self.raster => 1 + self.lanes(),
            ExpectedPhase::UnloadMeans => self.lanes() + 2 + self.read_latency(),
            ExpectedPhase::Unload | ExpectedPhase::WithoutOutput(_) | ExpectedPhase::Rotation => 1,
        }
    }

    /// Returns the means of a region, q*q.
    pub(crate) fn mean_count(&self) -> i64 {
        self.base.periphery.map_or(0, |periphery| periphery.blocks.pow(2))
    }

    /// Returns the steps of a frame, J.
    pub(crate) fn steps_per_frame(&self) -> i64 {
        self.fold * self.phases().into_iter().map(|phase| self.steps(phase)).sum::<i64>()
    }

    /// Returns the pixels per port of a frame.
    pub(crate) fn frame_pixels(&self) -> i64 {
        if self.raster {
            self.regions() * self.base.region_pixels()
        } else {
            self.fold * (self.base.side + 2 * self.halo()).pow(2)
        }
    }

    /// Returns the number of clocks in which a pixel of a frame is written.
    pub(crate) fn clocks_of_pixel(&self, pixel: i64) -> i64 {
        if !self.raster {
            return 1;
        }
        let width = self.base.columns() * self.base.side;
        let shown = |at: i64, regions: i64| {
            let side = self.base.side;
            let windows = (0..regions).flat_map(|region| {
                (-self.halo()..side + self.halo()).map(move |place| region * side + place)
            });
            windows.filter(|place| (*place).clamp(0, regions * side - 1) == at).count() as i64
        };
        shown(pixel % width, self.base.columns()) * shown(pixel / width, self.base.rows())
    }
}

/// Generates every kind of serial design, with a few regions.
pub(crate) fn arbitrary_serial_parameters() -> impl Strategy<Value = SerialParameters> {
    let sides = prop_oneof![6 => select(vec![4i64, 4, 5, 6, 7, 8]), 1 => 4i64..=11];
    (
        arbitrary_parameters_with_sides(sides, Organization::Serial.feature_kinds()),
        any::<[bool; 2]>(),
        0i64..=9,
    )
        .prop_map(|(base, [raster, deep], fold)| {
            let regions = base.columns() * base.rows();
            SerialParameters {
                fold: 1 + fold % regions,
                raster,
                base: DesignParameters { deep, ..base },
            }
        })
}

/// Generates every kind of serial design with zones. A few have more regions than a word of the
/// map.
pub(crate) fn arbitrary_zoned_serial_parameters() -> impl Strategy<Value = SerialParameters> {
    (arbitrary_serial_parameters(), 0i64..8).prop_flat_map(|(mut recipe, more)| {
        if more == 0 && recipe.base.side < 6 {
            recipe.base.width += 6 * recipe.base.side;
            recipe.base.height += recipe.base.side;
        }
        let SerialParameters { base, raster, fold } = recipe;
        arbitrary_zones_of(base).prop_map(move |base| SerialParameters { base, raster, fold })
    })
}
