// SPDX-License-Identifier: MIT OR Apache-2.0
//! Deliveries that are refused.

use foveate_pixels::FramePixels;
use foveate_timed::{BeatOffer, FrameDelivery, ReadySink, TimedError, TimedModel, Transaction};

use crate::page_examples::{design, first_region, random_frames};

#[test]
fn impossible_deliveries_are_refused_and_change_nothing() {
    let design = design("frame = { width = 32, height = 8 }\nhardware.organization = 'raster'");
    let frames = random_frames(&design, 2);
    let mut model = TimedModel::new(&design, Box::new(ReadySink));
    let mut clocks = Vec::new();
    let mut step = |delivery: &FrameDelivery<'_>| {
        model.step(delivery, &mut |transaction| {
            if let Transaction::Decisions(run) = transaction {
                clocks.push(run.regions.clock);
            }
        })
    };
    let whole = |number: usize| FrameDelivery::whole(FramePixels::Bytes(&frames[number]));
    step(&whole(0)).unwrap();
    let offers = [BeatOffer { beat: 5, clock: 0 }, BeatOffer { beat: 4, clock: 900 }];
    let long = FramePixels::Bytes(&frames[0][1..]);
    let refused = [
        step(&FrameDelivery { beats: Some(0), ..whole(1) }),
        step(&FrameDelivery { beats: Some(255), ..whole(1) }),
        step(&FrameDelivery { offers: &offers, ..whole(1) }),
        step(&FrameDelivery { reset: Some(300), ..whole(1) }),
        step(&FrameDelivery { pixels: long, ..whole(1) }),
        step(&FrameDelivery { pixels: FramePixels::Words(&[0; 256]), ..whole(1) }),
    ];
    assert!(matches!(
        refused.map(Result::unwrap_err),
        [
            TimedError::NoBeats,
            TimedError::Beats { given: 255, expected: 256 },
            TimedError::OfferOrder { beat: 4, before: 5 },
            TimedError::EarlyReset { reset: 300, .. },
            TimedError::Engine(_),
            TimedError::Engine(_),
        ]
    ));
    step(&whole(1)).unwrap();
    let (expected, _) = first_region(&design, &frames);
    assert_eq!([clocks[0], clocks[4]], expected[..]);
}
