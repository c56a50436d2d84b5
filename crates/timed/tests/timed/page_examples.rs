// SPDX-License-Identifier: MIT OR Apache-2.0
//! The examples and numbers of the pages on timing.

use foveate_design::{Design, DesignConfig};
use foveate_pixels::FramePixels;
use foveate_timed::{FrameDelivery, ReadySink, SentKind, TimedModel, Transaction};

use crate::traffic::Random;

pub(crate) fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

/// Returns frames of random pixels.
pub(crate) fn random_frames(design: &Design, count: usize) -> Vec<Vec<u8>> {
    let (mut random, size) = (Random::new(9), design.width() * design.height());
    (0..count).map(|_| (0..size).map(|_| random.below(256) as u8).collect()).collect()
}

/// Returns the clocks of the decisions of region 0, and the first clocks and numbers of the runs of
/// words that it sends.
pub(crate) fn first_region(design: &Design, frames: &[Vec<u8>]) -> (Vec<u64>, Vec<(u64, u32)>) {
    let mut model = TimedModel::new(design, Box::new(ReadySink));
    let (mut decisions, mut words) = (Vec::new(), Vec::new());
    let mut visit = |transaction: &Transaction<'_>| match transaction {
        Transaction::Decisions(run) if run.regions.region == 0 => decisions.push(run.regions.clock),
        Transaction::Words(run) if run.kind == SentKind::Pixels => {
            let sent = run.senders().filter(|&(_, region)| region == 0);
            words.extend(sent.map(|(clock, _)| (clock, run.words)));
        }
        Transaction::Decisions(_)
        | Transaction::Words(_)
        | Transaction::Scores(_)
        | Transaction::Loss(_)
        | Transaction::SyncError { .. } => {}
    };
    for frame in frames {
        model.step(&FrameDelivery::whole(FramePixels::Bytes(frame)), &mut visit).unwrap();
    }
    model.finish(&mut visit);
    (decisions, words)
}

/// The example at the end of `docs/timing.md`.
#[test]
fn two_frames_of_four_pixels_are_decided_after_edges_6_and_10() {
    let design = design(
        "frame = { width = 2, height = 2 }\nregion.size = 2\ndenoise.filter = 'none'\n\
         temporal.min_count = 0\n         [[spatial]]\nfeature = 'edge'\nmin_score = 0",
    );
    let (decisions, words) = first_region(&design, &random_frames(&design, 2));
    assert_eq!((decisions, words), (vec![6, 10], vec![(7, 4)]));
}

/// The numbers in `docs/serial.md` and `docs/raster.md`.
#[test]
fn frames_that_follow_at_once_take_the_clocks_of_the_pages() {
    for (toml, clocks) in [
        ("", 64),
        ("hardware.organization = 'serial'", 7905),
        ("hardware = { organization = 'serial', pipelining = 'deep' }", 7971),
        (
            "frame = { width = 1920, height = 1080 }\nhardware.organization = 'raster'",
            // D is S + 4, and S is 2 + 4 + 1.
            2_077_442 + 11,
        ),
    ] {
        let design = design(toml);
        let (decisions, _) = first_region(&design, &random_frames(&design, 2));
        assert_eq!(decisions[1] - decisions[0], clocks, "{toml}");
    }
}
