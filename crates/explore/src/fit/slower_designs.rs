// SPDX-License-Identifier: MIT OR Apache-2.0
//! The slower and cheaper designs that follow from a synthesized design, whose clock is known:
//! deeper folds of a serial array, and fewer pixels per clock of a raster core.

use foveate_design::{Design, Hardware};
use foveate_estimate::{Area, FpgaDevice, FrameRate, most_clocks_per_frame};

use super::cost_objective::CostObjective;
use super::rough_cost::RoughCostModel;
use super::synthesized_design::SynthesizedDesign;
use crate::cost::DesignArea;

/// Returns the deeper folds of a serial design that are fast enough at the low end of its clock and
/// may be the cheapest, or a raster design with half the pixels per clock, if it is fast enough.
pub(super) fn slower_designs(design: &Design, speed: &FrameRate, min_fps: f64) -> Vec<Design> {
    let most = most_clocks_per_frame(speed.low_clock_mhz * 1e6, min_fps);
    match design.hardware() {
        Hardware::Pipelined(_) => Vec::new(),
        Hardware::Serial(own) => {
            let deeper = design.pareto_folds(most).into_iter().filter(|fold| *fold > own.fold);
            deeper.filter_map(|fold| design.with_fold(fold).ok()).collect()
        }
        Hardware::Raster(own) => {
            let mut config = design.config();
            config.hardware.make_raster().pixels_per_clock = Some(own.pixels_per_clock / 2);
            let half = config.validate().ok();
            half.filter(|half| half.timing().clocks_per_frame() <= most).into_iter().collect()
        }
    }
}

/// Returns the expected cost of a slower design from the design that it is derived from. In a
/// process, the rough costs of the two have about the ratio of their costs.
pub(super) fn expected_cost(
    design: &Design,
    from: &SynthesizedDesign,
    cost_model: RoughCostModel,
) -> f64 {
    match from.objective {
        CostObjective::Bytes | CostObjective::Area => expected_share(design, &from.silicon),
        CostObjective::Mm2 | CostObjective::Energy => {
            from.cost() * cost_model.cost(design) / cost_model.cost(&from.design)
        }
    }
}

/// Returns the expected share of the FPGA of a slower design, from the area of the design that it
/// is derived from. Its lanes have the logic of that design's lanes, and their memory follows from
/// the fold. Half the pixels per clock take half the logic.
fn expected_share(design: &Design, silicon: &DesignArea) -> f64 {
    let DesignArea { unit, units, array, .. } = silicon;
    let area = match design.hardware() {
        Hardware::Pipelined(_) => *array,
        Hardware::Serial(own) => {
            let slower = design.with_hardware(own);
            let logic = unit.lut_total_packed - unit.lut_memory_packed;
            let lanes = u64::from(slower.lanes());
            let shared = array.lut_total_packed.saturating_sub(units * unit.lut_total_packed);
            let (luts, blocks) = slower.lane_memory().resources();
            Area {
                lut_total_packed: shared + lanes * (logic + luts),
                bram18: lanes * blocks,
                dsp: array.dsp * lanes / units.max(&1),
                ff: array.ff * lanes / units.max(&1),
                ..*array
            }
        }
        Hardware::Raster(_) => Area { lut_total_packed: array.lut_total_packed / 2, ..*array },
    };
    FpgaDevice::xcvu9p().cost(&area)
}

#[cfg(test)]
mod tests {
    use foveate_design::DesignConfig;

    use super::*;
    use crate::row::count_to_f64;

    #[test]
    fn a_design_is_folded_as_deep_as_the_low_end_of_its_clock_allows() {
        let text = "[frame]\nwidth = 64\nheight = 64\n[hardware]\norganization = \"serial\"\n";
        let single = DesignConfig::from_toml(text).unwrap().validate().unwrap();
        let speed = |mhz| FrameRate { low_clock_mhz: mhz, ..FrameRate::at_given_clock(1000.0, 1) };
        let (low, fps) = (60.0, 500.0);
        let fast =
            |design: &Design| low * 1e6 / count_to_f64(design.timing().clocks_per_frame()) >= fps;
        let all = slower_designs(&single, &speed(low), fps);
        assert!(all.iter().all(|design| design.slots() > 1 && fast(design)));
        let found = &all[0];
        // No fold with fewer lanes is fast enough.
        let deeper = (found.slots() + 1..=64).map(|fold| single.with_fold(fold).unwrap());
        assert!(deeper.filter(fast).all(|deeper| deeper.unit().count == found.unit().count));
        assert!(slower_designs(found, &speed(low), fps).is_empty(), "it is as deep already");
        assert!(slower_designs(found, &speed(low / 2.0), fps).is_empty(), "it is too deep already");
    }

    /// About 1,574 clocks take two pixels per clock, about 3,110 clocks take one.
    #[test]
    fn a_raster_core_takes_fewer_pixels_per_clock_where_its_clock_allows() {
        let text = "[frame]\nwidth = 64\nheight = 48\n[hardware]\norganization = \"raster\"\n\
                    pixels_per_clock = 2\n";
        let double = DesignConfig::from_toml(text).unwrap().validate().unwrap();
        let speed = FrameRate { low_clock_mhz: 60.0, ..FrameRate::at_given_clock(1000.0, 1) };
        let single = slower_designs(&double, &speed, 15_000.0);
        assert_eq!(
            single.iter().map(|d| d.as_raster().unwrap().pixels_per_clock()).collect::<Vec<_>>(),
            [1]
        );
        assert!(
            slower_designs(&double, &speed, 30_000.0).is_empty(),
            "one pixel at a clock is too slow"
        );
        assert!(slower_designs(&single[0], &speed, 1.0).is_empty(), "there are no fewer");
    }

    /// Four lanes of 16 regions are derived from eight lanes of 8: their logic is half, and each
    /// has a block RAM instead of 128 LUTs.
    #[test]
    fn a_slower_design_has_fewer_lanes_and_the_memory_of_its_fold() {
        let text =
            "[frame]\nwidth = 64\nheight = 64\n[hardware]\norganization = \"serial\"\nfold = 8\n";
        let eight = DesignConfig::from_toml(text).unwrap().validate().unwrap();
        let unit = Area { lut_total_packed: 168, lut_memory_packed: 128, ..Area::default() };
        let array = Area { lut_total_packed: 300 + 8 * 168, ff: 80, ..Area::default() };
        let silicon = DesignArea { unit, units: 8, array, logic_levels: 7 };
        let cost = |fold: u32| expected_share(&eight.with_fold(fold).unwrap(), &silicon);
        let area =
            |lut_total_packed, bram18, ff| Area { lut_total_packed, bram18, ff, ..Area::default() };
        let device = FpgaDevice::xcvu9p();
        assert!((cost(16) - device.cost(&area(300 + 4 * 40, 4, 40))).abs() < 1e-12);
        assert!((cost(8) - device.cost(&array)).abs() < 1e-12);
    }
}
