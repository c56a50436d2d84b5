// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of the events of both models.

use std::collections::BTreeSet;

use foveate_design::Design;
use foveate_pixels::Frame;
use foveate_timed::CoreTiming;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::clip_script::{clip, scripts};
use crate::driver::{Driver, RecordedRun};
use crate::event::PortEvent;
use crate::timed_run::timed_events;
use crate::traffic::{Traffic, traffic};

/// Returns the first difference between the events of both models, or `None`.
pub(crate) fn first_difference(
    design: &Design,
    timing: CoreTiming,
    recorded: &RecordedRun,
) -> Option<String> {
    let mut expected = recorded.events.clone();
    let mut actual = match timed_events(design, timing, recorded) {
        Ok(events) => events,
        Err(error) => return Some(error.to_string()),
    };
    expected.sort();
    actual.sort();
    let place = (expected.iter().zip(&actual).position(|(own, other)| own != other))
        .or((expected.len() != actual.len()).then_some(expected.len().min(actual.len())))?;
    let around = |events: &[PortEvent]| {
        let events = &events[place.saturating_sub(2).min(events.len())..];
        events.iter().take(5).map(|event| format!("\n    {event:?}")).collect::<String>()
    };
    Some(format!(
        "event {place} of {} and {} differs\n  cycle model:{}\n  timed model:{}",
        expected.len(),
        actual.len(),
        around(&expected),
        around(&actual)
    ))
}

/// Plays frames to both models, and returns the recording of the cycle model.
pub(crate) fn check(design: &Design, traffic: Traffic, frames: &[Frame]) -> RecordedRun {
    let recorded = Driver::new(design, traffic).play(frames);
    let timing = CoreTiming::from_design(design);
    if let Some(difference) = first_difference(design, timing, &recorded) {
        let deliveries: Vec<_> = recorded
            .deliveries
            .iter()
            .map(|own| {
                format!(
                    "\n  {} beats, marked {}, {:?}, reset {:?}",
                    own.beats, own.is_marked, own.offers, own.reset
                )
            })
            .collect();
        panic!("{difference}\n{traffic:?}\n{}{}", design.config().to_toml(), deliveries.concat());
    }
    recorded
}

/// Returns these designs, some with frame synchronization and some without.
pub(crate) fn with_any_sync(
    designs: impl Strategy<Value = Design>,
) -> impl Strategy<Value = Design> {
    (designs, any::<bool>()).prop_map(|(design, has_sync)| {
        let mut config = design.config();
        config.hardware.sync = has_sync;
        config.validate().unwrap()
    })
}

/// Returns random designs with recordings of random traffic, always the same.
pub(crate) fn recordings(
    designs: impl Strategy<Value = Design>,
    count: usize,
) -> Vec<(Design, RecordedRun)> {
    let mut runner = TestRunner::deterministic();
    let inputs = (designs, scripts(), traffic());
    let recordings = (0..count).map(|_| {
        let (design, (seed, script), traffic) = inputs.new_tree(&mut runner).unwrap().current();
        let recorded = Driver::new(&design, traffic).play(&clip(&design, seed, &script));
        (design, recorded)
    });
    recordings.collect()
}

/// Returns the kinds of events in some recordings, and "reset" if there are resets.
pub(crate) fn event_kinds(recordings: &[(Design, RecordedRun)]) -> BTreeSet<&'static str> {
    let mut kinds = BTreeSet::new();
    for (_, recorded) in recordings {
        let has_reset = recorded.deliveries.iter().any(|delivery| delivery.reset.is_some());
        kinds.extend(has_reset.then_some("reset"));
        kinds.extend(recorded.events.iter().map(|event| event.event.kind()));
    }
    kinds
}

/// A planted fault: its name, and the change that it makes.
pub(crate) type PlantedFault<T> = (&'static str, fn(&mut T));

/// Returns the number of recordings that differ from a timed model with a faulty timing.
pub(crate) fn found_faults(
    recordings: &[(Design, RecordedRun)],
    faulty: impl Fn(&Design) -> CoreTiming,
) -> usize {
    let differs = |(design, recorded): &&(Design, RecordedRun)| {
        first_difference(design, faulty(design), recorded).is_some()
    };
    recordings.iter().filter(differs).count()
}

/// Returns true if whole lists are tested in place of samples.
pub(crate) fn is_whole() -> bool {
    std::env::var_os("FOVEATE_WHOLE").is_some_and(|value| value == "1")
}

/// Returns the number of random cases of a property.
pub(crate) fn cases(sample: u32) -> u32 {
    if is_whole() { 40 * sample } else { sample }
}
