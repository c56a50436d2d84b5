// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge of arrays with zones, while maps are written and committed
//! at any edge.

use foveate_model::SerialRcm;
use proptest::prelude::*;

use super::bench::SerialBench;
use super::properties::{arbitrary_traffic, check_skipping, run_with_reset, stimuli};
use super::serial_parameters::arbitrary_zoned_serial_parameters;
use crate::frames::{SeededRandom, arbitrary_scripts};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(400)))]

    /// The reset comes at any edge of the first clip, in half of the cases after it. The maps stay.
    #[test]
    fn every_port_after_every_edge_while_maps_are_written(
        recipe in arbitrary_zoned_serial_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), any::<bool>()),
    ) {
        let rcm = SerialRcm::new(recipe.design().as_serial().unwrap());
        let mut bench = SerialBench::new(&recipe, rcm, traffic);
        let frame = recipe.frame_pixels() + recipe.steps_per_frame() + 1;
        let anywhere = SeededRandom(cut).below(frame * before.len() as i64);
        let edges = if cut % 2 == 0 { anywhere } else { i64::MAX };
        let (before, after) = (stimuli(&recipe, &before), stimuli(&recipe, &after));
        prop_assert_eq!(run_with_reset(&mut bench, &before, &after, edges, held), Ok(()));
    }

    #[test]
    fn skipping_is_stepping_with_zones(
        recipe in arbitrary_zoned_serial_parameters(),
        script in arbitrary_scripts(2),
        cut in any::<u64>(),
        clocks in prop_oneof![0u64..5, 0u64..100_000],
    ) {
        check_skipping(&recipe, &script, cut, clocks)?;
    }
}
