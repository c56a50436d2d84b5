// SPDX-License-Identifier: MIT OR Apache-2.0
//! Controls of the comparison: a timed model with slightly other inputs than the cycle model.

use foveate_design::{Design, FrameStoreKind};
use foveate_timed::CoreTiming;
use proptest::prelude::*;

use crate::comparison::{first_difference, recordings};
use crate::driver::RecordedRun;
use crate::raster_parameters::arbitrary_raster_parameters;

/// A change of the inputs, or `None` if a recording has nothing to change.
type InputChange = fn(&mut RecordedRun) -> Option<()>;

fn designs() -> impl Strategy<Value = Design> {
    arbitrary_raster_parameters().prop_map(|recipe| {
        let mut config = recipe.design().config();
        config.hardware.sync = true;
        config.hardware.make_raster().store = Some(FrameStoreKind::Block);
        config.validate().unwrap()
    })
}

#[test]
fn the_comparison_finds_every_wrong_input() {
    let changes: [(&str, InputChange); 7] = [
        ("a stall that begins late", |run| {
            run.stalls.iter_mut().for_each(|stall| stall.start += 1);
            (!run.stalls.is_empty()).then_some(())
        }),
        ("a stall that ends late", |run| {
            run.stalls.iter_mut().for_each(|stall| stall.end += 1);
            (!run.stalls.is_empty()).then_some(())
        }),
        ("a pause that ends late", |run| {
            run.deliveries.iter_mut().find(|own| own.offers.len() > 1)?.offers[1].clock += 1;
            Some(())
        }),
        ("a late reset", |run| {
            let mut resets = run.deliveries.iter_mut().filter_map(|own| own.reset.as_mut());
            *resets.next()? += 1;
            Some(())
        }),
        ("no mark", |run| {
            run.deliveries.iter_mut().for_each(|own| own.is_marked = false);
            Some(())
        }),
        ("a beat too many", |run| {
            run.deliveries.first_mut()?.beats += 1;
            Some(())
        }),
        ("frames in another order", |run| {
            run.deliveries.reverse();
            (run.deliveries.first()?.frame != run.deliveries.last()?.frame).then_some(())
        }),
    ];
    let recordings = recordings(designs(), 40);
    for (name, change) in changes {
        let is_found = |(design, recorded): &(Design, RecordedRun)| {
            let mut changed = recorded.clone();
            change(&mut changed)?;
            let timing = CoreTiming::from_design(design);
            first_difference(design, timing, &changed)
        };
        assert!(recordings.iter().any(|recording| is_found(recording).is_some()), "{name}");
    }
}
