// SPDX-License-Identifier: MIT OR Apache-2.0
//! The latencies and waiting regions of frames, against a count at every clock of the run.

use foveate_design::Design;
use foveate_pixels::FramePixels;
use foveate_timed::{
    BeatOffer, FrameDelivery, FrameTraffic, RateSink, SentKind, TimedModel, TrafficMeter,
    Transaction,
};

use crate::page_examples::{design, random_frames};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RegionEvent {
    Decided,
    SendsNext,
    LastWord { is_aborted: bool },
    Word,
    Lost,
}

/// A run as the meter saw it, and as a list of events with their clocks and frames.
struct MeteredRun {
    frames: Vec<FrameTraffic>,
    begins: Vec<u64>,
    events: Vec<(u64, u64, RegionEvent)>,
}

/// Runs frames through a design, each a number of edges after the core is ready for it.
fn metered_run(design: &Design, frames: &[Vec<u8>], rate: (u32, u32), pause: u64) -> MeteredRun {
    let mut model = TimedModel::new(design, Box::new(RateSink::new(rate.0, rate.1)));
    let mut meter = TrafficMeter::new(design);
    let mut run = MeteredRun { frames: Vec::new(), begins: Vec::new(), events: Vec::new() };
    let MeteredRun { frames: metered, begins, events } = &mut run;
    for frame in frames {
        let since = model.next_edge() + pause;
        begins.push(since);
        meter.begin_frame(since);
        let offers = [BeatOffer { beat: 0, clock: since }];
        let delivery =
            FrameDelivery { offers: &offers, ..FrameDelivery::whole(FramePixels::Bytes(frame)) };
        model
            .step(&delivery, &mut |transaction| {
                meter.add(transaction);
                push_events(transaction, events);
            })
            .unwrap();
        metered.extend(meter.end_frame());
    }
    model.finish(&mut |transaction| {
        meter.add(transaction);
        push_events(transaction, events);
    });
    metered.extend(meter.finish());
    run
}

fn push_events(transaction: &Transaction<'_>, events: &mut Vec<(u64, u64, RegionEvent)>) {
    match transaction {
        Transaction::Decisions(run) => {
            for (clock, region) in run.regions.iter() {
                let action = run.outcome.actions[region as usize];
                events.push((clock, run.frame, RegionEvent::Decided));
                if SentKind::from_action(action).is_some() {
                    events.push((clock, run.frame, RegionEvent::SendsNext));
                }
            }
        }
        Transaction::Words(run) => {
            for (first, _) in run.senders() {
                for word in 0..u64::from(run.words) {
                    let is_last = run.is_last && word + 1 == u64::from(run.words);
                    let event = match is_last {
                        true => RegionEvent::LastWord { is_aborted: run.is_aborted },
                        false => RegionEvent::Word,
                    };
                    events.push((first + word * run.word_step, run.frame, event));
                }
            }
        }
        Transaction::Loss(loss) => events.push((loss.clock, loss.frame, RegionEvent::Lost)),
        Transaction::Scores(_) | Transaction::SyncError { .. } => {}
    }
}

/// Counts the regions that wait after every edge of a run, and takes the largest number from the
/// begin of each frame to that of the next.
fn expected_frames(run: &MeteredRun) -> Vec<FrameTraffic> {
    let last = run.events.iter().map(|&(clock, ..)| clock).max().unwrap_or(0);
    let end = last.max(*run.begins.last().unwrap()) + 1;
    let mut waiting = vec![0_i64; end as usize];
    for &(clock, _, event) in &run.events {
        let change = match event {
            RegionEvent::SendsNext => 1,
            RegionEvent::LastWord { is_aborted: false } | RegionEvent::Lost => -1,
            RegionEvent::LastWord { is_aborted: true }
            | RegionEvent::Word
            | RegionEvent::Decided => 0,
        };
        waiting[clock as usize..].iter_mut().for_each(|regions| *regions += change);
    }
    let frame = |(number, &since): (usize, &u64)| {
        let own = || run.events.iter().filter(move |(_, frame, _)| *frame == number as u64);
        let last = |wanted: fn(RegionEvent) -> bool| {
            own().filter(|(.., event)| wanted(*event)).map(|&(clock, ..)| clock).max()
        };
        // The regions that wait at the begin of the frame were decided before.
        let begin = (since as usize).saturating_sub(1);
        let until = run.begins.get(number + 1).map_or(end, |&begin| begin) as usize;
        FrameTraffic {
            frame: number as u64,
            since,
            last_decision: last(|event| event == RegionEvent::Decided),
            last_word: last(|event| {
                matches!(event, RegionEvent::Word | RegionEvent::LastWord { .. })
            }),
            lost_regions: own().filter(|(.., event)| *event == RegionEvent::Lost).count() as u64,
            waiting_regions: *waiting[begin..until].iter().max().unwrap() as u64,
        }
    };
    run.begins.iter().enumerate().map(frame).collect()
}

#[test]
fn frames_have_the_latencies_and_waiting_regions_of_a_count_at_every_clock() {
    let mut lost = 0;
    for (keys, rates) in [
        ("", vec![(1, 1)]),
        ("hardware.pipelining = 'deep'\nregion.neighborhood = 'shared'", vec![(1, 1)]),
        ("hardware = { organization = 'serial', fold = 3 }", vec![(1, 1)]),
        ("hardware.organization = 'raster'", vec![(1, 1), (3, 4), (1, 2), (1, 7), (0, 1)]),
        (
            "hardware.organization = 'raster'\nrender.irrelevant = 'mean'\n[[spatial]]\n\
             feature = 'mad'\nmin_score = 60",
            vec![(1, 1), (1, 2), (1, 9)],
        ),
    ] {
        let design = design(&format!("frame = {{ width = 40, height = 40 }}\n{keys}"));
        let frames = random_frames(&design, 6);
        for rate in rates {
            for pause in [0, 37, 3000] {
                let run = metered_run(&design, &frames, rate, pause);
                let expected = expected_frames(&run);
                assert_eq!(run.frames, expected, "{keys}, {rate:?}, {pause}");
                lost += run.frames.iter().map(|frame| frame.lost_regions).sum::<u64>();
            }
        }
    }
    assert!(lost > 100, "{lost} regions were lost");
}

#[test]
fn a_core_without_forwarding_has_no_waiting_regions() {
    let design = design("hardware = { organization = 'raster', forward = false }");
    let run = metered_run(&design, &random_frames(&design, 3), (1, 1), 0);
    assert!(run.frames.iter().all(|frame| frame.waiting_regions == 0 && frame.last_word.is_none()));
    assert!(run.frames.iter().all(|frame| frame.last_decision > Some(frame.since)));
}
