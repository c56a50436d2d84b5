// SPDX-License-Identifier: MIT OR Apache-2.0
//! The valid values of keys whose range depends on other keys, for tools that offer one key at a
//! time.

use crate::periphery::valid_block_counts;
use crate::ranges::{FLOW_RADII, largest_flow_radius, largest_level};
use crate::width::index_bits;
use crate::{Camera, Decimal, SpatialFeature};

/// The valid values of one key while all other keys stay as they are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyBound {
    /// The numbers from 0 to `largest`: whole numbers only, or decimal numbers too.
    Maximum {
        /// The largest valid number.
        largest: Decimal,
        /// True if the number must be whole.
        whole: bool,
    },
    /// The listed values.
    OneOf(Vec<u32>),
}

impl KeyBound {
    fn whole_maximum(largest: u32) -> Self {
        Self::Maximum { largest: Decimal::from_whole(largest.into()), whole: true }
    }
}

impl Camera {
    /// Returns the keys of this camera whose range depends on other keys, with their valid values.
    /// Keys are written as overrides name them (`spatial.0.level`).
    #[must_use]
    pub fn bounds(&self) -> Vec<(String, KeyBound)> {
        let (max, pixels) = (self.pixel_max(), self.region_pixels());
        let mut bounds = vec![
            (
                "temporal.level".to_owned(),
                KeyBound::whole_maximum(largest_level(max, self.temporal().min_count == 0)),
            ),
            ("temporal.min_count".to_owned(), KeyBound::whole_maximum(pixels)),
        ];
        if self.periphery().is_some() {
            let blocks = valid_block_counts(self.region_size()).collect();
            bounds.push(("periphery.blocks".to_owned(), KeyBound::OneOf(blocks)));
            let level = KeyBound::whole_maximum(largest_level(max, false));
            bounds.push(("periphery.level".to_owned(), level));
            if self.zones().is_some() {
                bounds.push(("zones.off_level".to_owned(), KeyBound::whole_maximum(max)));
            }
        }
        let features = self.features().iter().zip(&self.config().spatial);
        for (index, (feature, entry)) in features.enumerate() {
            let key = |name| format!("spatial.{index}.{name}");
            if let Some(level) = feature.largest_level() {
                bounds.push((key("level"), KeyBound::whole_maximum(level)));
            }
            let needs_zero = feature.needs_zero_minimum(self.pixel_max())
                || (feature.kind().is_displacement()
                    && self.config().references_need_displacement());
            let largest =
                if needs_zero { Decimal::from_whole(0) } else { feature.largest_min_score() };
            let whole = feature.kind().score_unit().is_count();
            bounds.push((key("min_score"), KeyBound::Maximum { largest, whole }));
            if let Some(bits) = entry.mean_fraction_bits {
                bounds.push((key("mean_fraction_bits"), self.mean_fraction_bound(feature, bits)));
            }
            if feature.radius().is_some() {
                let radii = *FLOW_RADII.start()..=largest_flow_radius(self.region_size());
                bounds.push((key("radius"), KeyBound::OneOf(radii.collect())));
            }
        }
        bounds
    }

    /// Returns the valid fraction bits of the mean of one feature, which has `bits` now. The mean
    /// of two features cannot be changed by the key of only one of them.
    fn mean_fraction_bound(&self, feature: &SpatialFeature, bits: u32) -> KeyBound {
        let entries = self.config().spatial.iter();
        let largest = index_bits(self.region_pixels().into());
        if entries.filter(|entry| entry.has_mean_fraction()).count() > 1 {
            KeyBound::OneOf(vec![bits])
        } else if feature.needs_mean_fraction(self.pixel_max()) {
            KeyBound::OneOf((1..=largest).collect())
        } else {
            KeyBound::whole_maximum(largest)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CameraConfig;

    /// Validation accepts both ends of every bound and refuses the next value beyond the upper end.
    #[test]
    fn bounds_are_what_is_taken() {
        let entry = |kind: &crate::FeatureKind| {
            let mean = if kind.has_second_pass() { ",mean_fraction_bits=1" } else { "" };
            format!("{{feature=\"{kind}\"{mean}}}")
        };
        let entries: Vec<_> = crate::FeatureKind::ALL.iter().map(entry).collect();
        let all = format!("spatial=[{}]", entries.join(","));
        const SEGMENT: &str = "spatial=[{feature=\"segment\",min_score=3}]";
        let mut keys = 0;
        for overrides in [
            vec![],
            vec![&all, "render.irrelevant=\"mean\""],
            vec![&all, "region.size=6", "render.irrelevant=\"mean\"", "frame.pixel_bits=3"],
            vec![&all, "region.size=5", "frame.pixel_bits=12", "temporal.min_count=0"],
            vec!["spatial=[{feature=\"corner\",min_score=0}]", "frame.pixel_bits=1"],
            vec!["zones={}", "render.irrelevant=\"mean\"", "frame.pixel_bits=3"],
            vec![SEGMENT, "region.size=3"],
            vec![SEGMENT, "spatial.0.mean_fraction_bits=2", "spatial.0.level=127"],
            vec![SEGMENT, "spatial.0.mean_fraction_bits=1", "frame.pixel_bits=1"],
            vec![SEGMENT, "spatial.0.min_score=0", "spatial.0.level=200"],
            vec!["spatial=[{feature=\"segment\",min_score=0}]", "frame.pixel_bits=1"],
            vec!["spatial=[{feature=\"flow\",min_score=0}]", "temporal.reference=\"last-sent\""],
        ] {
            let camera = |more: &str| {
                let all = [&overrides[..], &[more]].concat();
                let all: Vec<&str> = all.into_iter().filter(|text| !text.is_empty()).collect();
                CameraConfig::from_toml_with("", &all).and_then(|config| config.validate())
            };
            for (key, bound) in camera("").unwrap().bounds() {
                let is_taken =
                    |value: &dyn std::fmt::Display| camera(&format!("{key}={value}")).is_ok();
                match bound {
                    KeyBound::Maximum { largest, whole } => {
                        // The largest decimal number is cut off after four digits, so `beyond` is
                        // the next whole number.
                        let beyond = largest.ceil_times(1)
                            + u128::from(whole || largest.as_whole().is_some());
                        assert!(
                            is_taken(&0) && is_taken(&largest),
                            "{overrides:?} {key} {largest}"
                        );
                        assert!(!is_taken(&beyond), "{overrides:?} {key} {beyond}");
                        assert_eq!(
                            is_taken(&0.5),
                            !whole && largest != Decimal::from_whole(0),
                            "{key}"
                        );
                    }
                    KeyBound::OneOf(values) => {
                        for value in 0..=9 {
                            assert_eq!(is_taken(&value), values.contains(&value), "{key} {value}");
                        }
                    }
                }
                keys += 1;
            }
        }
        assert_eq!(keys, 4 + 18 + 18 + 16 + 4 + 7 + 5 * 5 + 4);
    }
}
