// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the cheapest fold of a serial array for a frame rate.
//!
//! Fewer lanes take less logic, but the memory of a lane consists of whole block RAMs: 47 lanes of
//! 17 regions may take twice the blocks of 49 lanes of 16. So the folds that may be the cheapest
//! ([`Design::pareto_folds`]) are synthesized, and their areas are compared by
//! [`FpgaDevice::cost`]. The frame rate of a fold follows from the clock of its own netlist.

use std::collections::BTreeMap;

use foveate_design::Design;

use crate::FpgaDevice;
use crate::area::Area;
use crate::speed::{count_to_f64, most_clocks_per_frame};

/// The result of the synthesis of a fold.
#[derive(Clone, Debug)]
pub struct FoldCost {
    /// The clock in MHz; `None` for a design without logic between registers.
    pub clock_mhz: Option<f64>,
    /// The area of the array.
    pub area: Area,
}

/// Returns the design with its cheapest fold that reaches `rate` in frames per second, at the clock
/// of its own netlist. Returns the design `single` itself, which has fold 1, if no fold that was
/// tried reaches the rate.
///
/// # Errors
/// Fails if `synthesize` fails.
pub fn cheapest_fold<E>(
    single: Design,
    rate: u64,
    synthesize: impl Fn(&Design) -> Result<FoldCost, E>,
) -> Result<Design, E> {
    let device = FpgaDevice::xcvu9p();
    let max_clocks = |mhz: f64| most_clocks_per_frame(mhz * 1e6, count_to_f64(rate));
    let mut tried: BTreeMap<u32, Option<f64>> = BTreeMap::new();
    let mut fast: Vec<(f64, Design)> = Vec::new();
    // The clock of a folded array differs from that of fold 1. If the fold with the fewest lanes is
    // too slow at its own clock, the next folds are selected by that clock.
    let mut planning_clock = synthesize(&single)?.clock_mhz;
    while let Some(mhz) = planning_clock {
        let folds = single.pareto_folds(max_clocks(mhz));
        for &fold in &folds {
            if tried.contains_key(&fold) {
                continue;
            }
            let Ok(folded) = single.with_fold(fold) else { continue };
            let FoldCost { clock_mhz, area } = synthesize(&folded)?;
            let is_reached = |mhz| folded.timing().clocks_per_frame() <= max_clocks(mhz);
            let is_fast_enough = clock_mhz.is_some_and(is_reached);
            tried.insert(fold, clock_mhz.filter(|_| !is_fast_enough));
            if is_fast_enough {
                fast.push((device.cost(&area), folded));
            }
        }
        planning_clock = folds.first().and_then(|first| tried.get(first).copied().flatten());
    }
    let best = fast.into_iter().min_by(|one, other| one.0.total_cmp(&other.0));
    Ok(best.map_or(single, |(_, design)| design))
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::convert::Infallible;

    use foveate_design::DesignConfig;

    use super::*;

    fn single() -> Design {
        let toml = "hardware = { organization = 'serial', feed = 'raster' }";
        DesignConfig::from_toml(toml).unwrap().validate().unwrap()
    }

    /// Returns the fold that is chosen at 500 frames per second, and all folds that were
    /// synthesized. `clock` and `luts` give the clock and the LUTs of a lane by fold. With up to 8
    /// slots the memory of a lane consists of LUTs, else of block RAMs.
    fn chosen_fold(clock: impl Fn(u32) -> f64, luts: impl Fn(u32) -> u64) -> (u32, Vec<u32>) {
        let tried = RefCell::new(Vec::new());
        let found = cheapest_fold(single(), 500, |design| {
            let array = design.as_serial().unwrap();
            let (fold, lanes) = (array.fold(), u64::from(array.lanes()));
            tried.borrow_mut().push(fold);
            let blocks = if fold > 8 { array.lane_memory().blocks * lanes } else { 0 };
            let lut_total_packed = lanes * luts(fold);
            let area = Area { lut_total_packed, bram18: blocks, ..Area::default() };
            Ok::<_, Infallible>(FoldCost { clock_mhz: Some(clock(fold)), area })
        });
        let Ok(found) = found;
        (found.slots(), tried.into_inner())
    }

    /// Returns a clock in MHz slightly above that at which a fold reaches 500 frames per second.
    fn needed_clock(fold: u32) -> f64 {
        let clocks = single().with_fold(fold).unwrap().timing().clocks_per_frame();
        count_to_f64(clocks) * 500.0 / 1e6 + 1e-6
    }

    /// The array has 784 regions. 94 block RAMs of 4,320 are 2.18 % of the device, and 49 are 1.13
    /// %.
    #[test]
    fn a_fold_with_fewer_lanes_and_twice_the_block_rams_is_not_chosen() {
        let clock = |_| needed_clock(17);
        let lane_luts = |fold| if fold == 8 { 170 } else { 40 };
        assert_eq!(chosen_fold(clock, lane_luts), (16, vec![1, 17, 16, 8]));
        // 45 block RAMs are 1.0417 % of the device, which equals 12,315 LUTs, or 6,157.5 for each
        // of two lanes.
        let block_ram =
            |luts| chosen_fold(clock, move |fold| if fold == 8 { 9_999 } else { luts }).0;
        assert_eq!([6_157, 6_158].map(block_ram), [16, 17]);
        // 49 block RAMs equal 13,409.7 LUTs, or 136.8 for each of 98 lanes with distributed memory.
        let distributed = |luts| chosen_fold(clock, move |fold| if fold == 8 { luts } else { 0 }).0;
        assert_eq!([136, 137].map(distributed), [8, 16]);
    }

    /// A fold is accepted only if it is fast enough at its own clock. The clock of the fold with
    /// the fewest lanes decides which folds are tried next.
    #[test]
    fn every_fold_has_a_clock_of_its_own() {
        let lane_luts = |fold| if fold == 8 { 170 } else { 40 };
        let slow = |fold| if fold == 17 { needed_clock(17) - 0.001 } else { needed_clock(17) };
        assert_eq!(chosen_fold(slow, lane_luts), (16, vec![1, 17, 16, 8]));
        // 53 lanes of 15 slots have one block RAM each, and 98 lanes of 8 slots have more LUTs.
        let slower = |fold| if fold > 15 { needed_clock(15) } else { needed_clock(17) };
        assert_eq!(chosen_fold(slower, lane_luts), (15, vec![1, 17, 16, 8, 15]));
        assert_eq!(
            chosen_fold(|_| needed_clock(1) - 0.001, lane_luts),
            (1, vec![1]),
            "fold 1 is the fastest"
        );
        let fast_alone = |fold| if fold == 1 { needed_clock(17) } else { 0.001 };
        assert_eq!(
            chosen_fold(fast_alone, lane_luts),
            (1, vec![1, 17, 16, 8]),
            "what else is too slow"
        );
    }
}
