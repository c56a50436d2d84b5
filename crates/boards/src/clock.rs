// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock of a core, which the PLL of the device makes from the clock of the board.

use crate::BoardError;
use crate::board::{Board, DeviceFamily};

/// The source of the core's clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClockSource {
    /// The clock of the board.
    Direct,
    /// `SB_PLL40`, with the frequency in * (feedback + 1) / (2^output (reference + 1)).
    Ice40 { pad: bool, reference: u32, feedback: u32, output: u32, filter: u32 },
    /// `EHXPLLL`, with the frequency in * feedback / reference. `output` divides the oscillator.
    Ecp5 { reference: u32, feedback: u32, output: u32 },
}

/// Finds the settings for the clock of the core.
///
/// # Errors
/// Fails if the PLL of the family cannot make that clock exactly.
pub(crate) fn clock_source(board: &Board) -> Result<ClockSource, BoardError> {
    let (mhz, core) = (board.clock.mhz, board.clock.core_mhz);
    if mhz == core {
        return Ok(ClockSource::Direct);
    }
    let found = match board.device.family {
        DeviceFamily::Ice40 => ice40_pll(mhz, core, board.clock.pll_pad),
        DeviceFamily::Ecp5 => ecp5_pll(mhz, core),
        DeviceFamily::Gowin | DeviceFamily::Vivado => None,
    };
    found.ok_or_else(|| BoardError::Invalid {
        name: board.name.clone(),
        reason: format!(
            "clock.core_mhz = {core}: no PLL makes it from {mhz} MHz here; {mhz} needs none"
        ),
    })
}

/// Returns the settings of an iCE40. The oscillator runs at 533 to 1066 MHz, its reference at 10 to
/// 133 MHz.
fn ice40_pll(mhz: u32, core: u32, pad: bool) -> Option<ClockSource> {
    let setting = |reference: u32, output: u32| {
        let reference_mhz = mhz / (reference + 1);
        let oscillator = core << output;
        let in_range = (10..=133).contains(&reference_mhz) && (533..=1066).contains(&oscillator);
        let is_exact = in_range
            && mhz.is_multiple_of(reference + 1)
            && oscillator.is_multiple_of(reference_mhz);
        let feedback =
            is_exact.then(|| oscillator / reference_mhz).filter(|feedback| *feedback <= 128)? - 1;
        let filter = match reference_mhz {
            ..17 => 1,
            17..26 => 2,
            26..44 => 3,
            44..66 => 4,
            66..101 => 5,
            _ => 6,
        };
        Some(ClockSource::Ice40 { pad, reference, feedback, output, filter })
    };
    (0..16).find_map(|reference| (1..7).find_map(|output| setting(reference, output)))
}

/// Returns the settings of an ECP5. The oscillator runs at 400 to 800 MHz, best in the middle of
/// this range, and its reference at 4 MHz or more.
fn ecp5_pll(mhz: u32, core: u32) -> Option<ClockSource> {
    let reference = (1..=mhz / 4).find(|reference| (core * reference).is_multiple_of(mhz))?;
    let feedback = core * reference / mhz;
    let output = (1..=128).filter(|output| (400..=800).contains(&(core * output)));
    let output = output.min_by_key(|output| (core * output).abs_diff(600))?;
    (feedback <= 80).then_some(ClockSource::Ecp5 { reference, feedback, output })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_make_the_clock() {
        let expected =
            ClockSource::Ice40 { pad: true, reference: 0, feedback: 63, output: 5, filter: 1 };
        assert_eq!(ice40_pll(12, 24, true), Some(expected));
        assert_eq!(ice40_pll(12, 25, true), None);
        assert_eq!(
            ecp5_pll(25, 75),
            Some(ClockSource::Ecp5 { reference: 1, feedback: 3, output: 8 })
        );
        assert_eq!(
            ecp5_pll(25, 60),
            Some(ClockSource::Ecp5 { reference: 5, feedback: 12, output: 10 })
        );
        assert_eq!(ecp5_pll(25, 900), None);
        for mhz in [1, 12, 16, 25, 48] {
            for core in 10..200 {
                if let Some(ClockSource::Ice40 { reference, feedback, output, .. }) =
                    ice40_pll(mhz, core, false)
                {
                    assert_eq!(mhz * (feedback + 1), (core * (reference + 1)) << output);
                }
                if let Some(ClockSource::Ecp5 { reference, feedback, .. }) = ecp5_pll(mhz, core) {
                    assert_eq!(mhz * feedback, core * reference);
                }
            }
        }
    }
}
