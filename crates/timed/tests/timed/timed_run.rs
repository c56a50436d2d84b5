// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timed model, run over a recording, with its transactions expanded to events.

use foveate_camera::RegionAction;
use foveate_design::Design;
use foveate_pixels::FramePixels;
use foveate_timed::{
    CoreTiming, DecisionRun, FrameDelivery, ScoreRun, SentKind, StallList, TimedError, TimedModel,
    Transaction, WordRun,
};

use crate::driver::RecordedRun;
use crate::event::{CoreEvent, PortEvent};

/// Runs the timed model with a timing over the inputs of a recording, and returns its
/// events.
pub(crate) fn timed_events(
    design: &Design,
    timing: CoreTiming,
    recorded: &RecordedRun,
) -> Result<Vec<PortEvent>, TimedError> {
    let sink = Box::new(StallList::new(recorded.stalls.clone()));
    let mut model = TimedModel::with_timing(design, timing, sink);
    let mut events = Vec::new();
    for delivery in &recorded.deliveries {
        let words = delivery.frame.pixels();
        let bytes: Vec<u8> = words.iter().map(|&pixel| pixel.to_le_bytes()[0]).collect();
        let has_bytes = design.pixel_bits() <= 8;
        let pixels = if has_bytes { FramePixels::Bytes(&bytes) } else { FramePixels::Words(words) };
        let delivery = FrameDelivery {
            pixels,
            beats: Some(delivery.beats),
            is_marked: delivery.is_marked,
            offers: &delivery.offers,
            reset: delivery.reset,
        };
        model.step(&delivery, &mut |transaction| expand(design, transaction, &mut events))?;
    }
    model.finish(&mut |transaction| expand(design, transaction, &mut events));
    events.retain(|event| event.clock < recorded.edges);
    Ok(events)
}

fn expand(design: &Design, transaction: &Transaction<'_>, events: &mut Vec<PortEvent>) {
    match transaction {
        Transaction::Scores(run) => expand_scores(run, events),
        Transaction::Decisions(run) => expand_decisions(design, run, events),
        Transaction::Words(run) => expand_words(design, run, events),
        Transaction::Loss(loss) => {
            let event = CoreEvent::Loss { region: loss.region, frame: loss.frame % 256 };
            events.push(PortEvent { clock: loss.clock, event });
        }
        Transaction::SyncError { clock } => {
            events.push(PortEvent { clock: *clock, event: CoreEvent::SyncError });
        }
    }
}

fn expand_scores(run: &ScoreRun<'_>, events: &mut Vec<PortEvent>) {
    for (clock, region) in run.regions.iter() {
        let place = region as usize;
        let value = match run.number.checked_sub(1) {
            None => run.outcome.temporal_count[place].into(),
            Some(feature) => run.outcome.scores[feature as usize][place],
        };
        let event = CoreEvent::Score { region, number: run.number, value };
        events.push(PortEvent { clock, event });
    }
}

fn expand_decisions(design: &Design, run: &DecisionRun<'_>, events: &mut Vec<PortEvent>) {
    for (clock, region) in run.regions.iter() {
        let (place, outcome) = (region as usize, run.outcome);
        let relevance = [outcome.srs[place], outcome.trs[place]];
        let summary = outcome.actions[place] == RegionAction::Summarize;
        if design.as_serial().is_some() {
            let event = CoreEvent::SerialDecision { region, relevance, summary };
            events.push(PortEvent { clock, event });
            continue;
        }
        let event = CoreEvent::Decision {
            region,
            relevance,
            summary,
            scores: outcome.scores.iter().map(|scores| scores[place]).collect(),
            count: outcome.temporal_count[place],
        };
        events.push(PortEvent { clock, event });
    }
}

fn expand_words(design: &Design, run: &WordRun<'_>, events: &mut Vec<PortEvent>) {
    let mut values = Vec::new();
    for (clock, region) in run.senders() {
        values.clear();
        run.append_values(region, &mut values);
        let words = values.chunks_exact(values.len() / run.words as usize);
        for (place, values) in (0..).zip(words) {
            let is_end = place + 1 == run.words;
            let clock = clock + u64::from(place) * run.word_step;
            if design.as_serial().is_some() {
                let position = match run.kind {
                    SentKind::Pixels => run.first + place,
                    SentKind::Means => last_position(design, run.first + place),
                };
                let event = CoreEvent::SerialWord { region, position, value: values[0] };
                events.push(PortEvent { clock, event });
                continue;
            }
            let event = CoreEvent::Word {
                region,
                frame: if design.as_raster().is_some() { run.frame % 256 } else { 0 },
                number: run.first + place,
                is_mean: run.kind == SentKind::Means,
                values: values.to_vec(),
                is_last: is_end && run.is_last,
                is_aborted: is_end && run.is_aborted,
            };
            events.push(PortEvent { clock, event });
        }
    }
}

/// Returns the position of the lower right pixel of a block.
fn last_position(design: &Design, block: u32) -> u32 {
    let (side, periphery) = (design.region_size(), design.periphery().unwrap());
    let end = |block: u32| (block + 1) * periphery.block_side - 1;
    end(block / periphery.blocks) * side + end(block % periphery.blocks)
}
