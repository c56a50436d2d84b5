// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge of cores with zones, while maps are written and committed
//! at any edge.

use proptest::prelude::*;

use super::driver::RasterDriver;
use super::properties::{arbitrary_traffic, check_zoned_sequence};
use super::raster_parameters::arbitrary_zoned_raster_parameters;
use crate::class_maps::ClassMapLog;
use crate::frames::{SeededRandom, arbitrary_scripts};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(600)))]

    /// The reset comes at any edge of the first clip, in half of the cases after it. The maps stay.
    #[test]
    fn every_port_after_every_edge_while_maps_are_written(
        recipe in arbitrary_zoned_raster_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), 1i64..=2),
    ) {
        let mut driver = RasterDriver::new(&recipe, traffic);
        let mut maps = ClassMapLog::new(&recipe.base);
        // A sink that is never ready stops every frame that waits for it, so the number of clocks
        // is limited.
        let most = 60 * recipe.advances();
        let anywhere = SeededRandom(cut).below(recipe.advances() * before.len() as i64 + 100);
        let clocks = if cut % 2 == 0 { anywhere } else { most };
        let check = check_zoned_sequence(&mut driver, &recipe, &before, clocks, &mut maps);
        prop_assert_eq!(check, Ok(()));
        driver.reset(held);
        maps.push_reset();
        let check = check_zoned_sequence(&mut driver, &recipe, &after, most, &mut maps);
        prop_assert_eq!(check, Ok(()));
    }
}
