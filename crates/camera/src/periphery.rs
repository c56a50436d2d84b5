// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries that irrelevant regions send in place of their pixels: the means of their blocks.

use crate::ranges::largest_level;
use crate::{CameraConfig, ConfigError, IrrelevantRendering, Reciprocal, bits_for};
use crate::{SUMMARY_BLOCKS, check_range};

/// The parameters of summaries: q x q means per region, of blocks of b x b pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Periphery {
    /// Blocks per side q.
    pub blocks: u32,
    /// Side of a block b in pixels, N / q.
    pub block_side: u32,
    /// A summary is sent again when a mean differs from the mean that was sent last by more than
    /// this many grey levels.
    pub level: u32,
    /// Bits of the sum of the pixels of a block plus half of their number, which rounds the mean.
    pub sum_bits: u32,
    /// The division by b * b.
    pub reciprocal: Reciprocal,
}

impl Periphery {
    /// Checks the periphery of a configuration whose frame and region have been checked. Returns
    /// `None` if irrelevant regions send no summaries.
    pub(crate) fn resolve(config: &CameraConfig) -> Result<Option<Self>, ConfigError> {
        let asked = &config.periphery;
        match config.render.irrelevant {
            IrrelevantRendering::Zero | IrrelevantRendering::Hold => {
                let given = [("blocks", asked.blocks), ("level", asked.level)];
                match given.into_iter().find_map(|(key, value)| Some((key, value?))) {
                    None => Ok(None),
                    Some((key, value)) => {
                        Err(Self::without_means_error(config, &format!("periphery.{key}"), value))
                    }
                }
            }
            IrrelevantRendering::Mean => {
                let (side, bits) = (config.region.size, config.frame.pixel_bits);
                let (blocks, level) = (asked.blocks_or_default(side), asked.level_or_default(bits));
                check_blocks(blocks, side)?;
                let pixel_max = (1 << bits) - 1;
                let why = format!(
                    " for pixels of {bits} bits, whose means differ by at most {pixel_max}"
                );
                check_range("periphery.level", level, 0..=largest_level(pixel_max, false), &why)?;
                Ok(Some(Self::new(side, blocks, level, pixel_max)))
            }
        }
    }

    /// Returns the error for a key of summaries in a camera whose irrelevant regions send none.
    pub(crate) fn without_means_error(config: &CameraConfig, key: &str, value: u32) -> ConfigError {
        ConfigError::Combination {
            key: key.to_owned(),
            value: value.to_string(),
            with: format!("render.irrelevant = \"{}\"", config.render.irrelevant),
            remedy: "leave the key out, or show means: render.irrelevant = \"mean\"".to_owned(),
        }
    }

    fn new(side: u32, blocks: u32, level: u32, pixel_max: u32) -> Self {
        let block_side = side / blocks;
        let pixels = u64::from(block_side * block_side);
        let dividend_max = pixels * u64::from(pixel_max) + pixels / 2;
        Self {
            blocks,
            block_side,
            level,
            sum_bits: bits_for(dividend_max),
            reciprocal: Reciprocal::new(pixels, dividend_max),
        }
    }

    /// Returns the number of means of a region, q * q.
    #[must_use]
    pub fn mean_count(&self) -> u32 {
        self.blocks * self.blocks
    }

    /// Returns the number of pixels of a block, b * b.
    #[must_use]
    pub fn block_pixels(&self) -> u32 {
        self.block_side * self.block_side
    }
}

/// Returns the valid numbers of blocks per side for regions of `side` pixels a side.
pub(crate) fn valid_block_counts(side: u32) -> impl Iterator<Item = u32> {
    SUMMARY_BLOCKS.iter().copied().filter(move |&blocks| side.is_multiple_of(blocks))
}

fn check_blocks(blocks: u32, side: u32) -> Result<(), ConfigError> {
    if valid_block_counts(side).any(|valid| valid == blocks) {
        return Ok(());
    }
    let valid: Vec<_> = valid_block_counts(side).map(|blocks| blocks.to_string()).collect();
    Err(ConfigError::Range {
        key: "periphery.blocks".to_owned(),
        value: blocks.to_string(),
        valid: format!("{} for regions of {side}x{side} pixels", valid.join(" or ")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    fn camera(toml: &str) -> Result<Camera, String> {
        let config = CameraConfig::from_toml(toml).map_err(|error| error.to_string())?;
        config.validate().map_err(|error| error.to_string())
    }

    const MEAN: &str = "[render]\nirrelevant = \"mean\"\n";

    #[test]
    fn defaults_follow_region_and_depth() {
        for (more, blocks, side, level) in [
            ("", 2, 4, 4),
            ("[region]\nsize = 5\n", 1, 5, 4),
            ("[frame]\npixel_bits = 10\n", 2, 4, 16),
            ("[frame]\npixel_bits = 1\n", 2, 4, 0),
            ("[region]\nsize = 4\n[periphery]\nblocks = 4\nlevel = 7\n", 4, 1, 7),
        ] {
            let camera = camera(&format!("{more}{MEAN}")).unwrap();
            let own = *camera.periphery().unwrap();
            assert_eq!((own.blocks, own.block_side, own.level), (blocks, side, level), "{more}");
            let config = &camera.config().periphery;
            assert_eq!((config.blocks, config.level), (Some(blocks), Some(level)));
        }
        assert_eq!(camera("").unwrap().periphery(), None);
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        for (text, words) in [
            ("[periphery]\nblocks = 2\n".to_owned(), "render.irrelevant"),
            (format!("{MEAN}[periphery]\nblocks = 3\n"), "1 or 2 or 4"),
            (
                format!("{MEAN}[region]\nsize = 6\n[periphery]\nblocks = 4\n"),
                "1 or 2 for regions of 6x6",
            ),
            (format!("{MEAN}[periphery]\nlevel = 255\n"), "0..=254"),
            (format!("{MEAN}[periphery]\nlevels = 4\n"), "periphery.level"),
        ] {
            let error = camera(&text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
    }

    #[test]
    fn the_division_is_exact_up_to_the_largest_sum() {
        for side in 2..=64 {
            for &blocks in SUMMARY_BLOCKS.iter().filter(|blocks| side % **blocks == 0) {
                let own = Periphery::new(side, blocks, 0, 65_535);
                let pixels = u64::from(own.block_pixels());
                let largest = pixels * 65_535 + pixels / 2;
                assert!(largest < 1 << own.sum_bits);
                for sum in (0..=largest).rev().take(3000).chain(0..3000.min(largest)) {
                    assert_eq!(own.reciprocal.divide(sum), sum / pixels);
                }
            }
        }
    }
}
