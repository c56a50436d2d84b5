// SPDX-License-Identifier: MIT OR Apache-2.0
//! The buffer and the windows against a simulation that moves one bit at a time.

use foveate_explore::link::{LinkFigures, LinkUnit, Timeline, WindowRates, send_over_link};
use proptest::prelude::*;

/// Simulates every nanosecond: it takes the bits that come, and passes on a bit whenever the last
/// one has taken its time.
fn bit_by_bit(units: &[LinkUnit], ns_per_bit: u64) -> (Vec<u64>, u64) {
    let mut finished = vec![0; units.len()];
    let mut queue = std::collections::VecDeque::new();
    let (mut next, mut busy_until, mut now, mut most) = (0, None, 0, 0);
    while next < units.len() || !queue.is_empty() {
        if busy_until == Some(now) {
            let done: usize = queue.pop_front().unwrap();
            finished[done] = now;
            busy_until = None;
        }
        while next < units.len() && units[next].sent_ns == now {
            queue.extend((0..units[next].bits).map(|_| next));
            if units[next].bits == 0 {
                // A unit without bits has arrived when everything before it has.
                finished[next] = now;
            }
            next += 1;
        }
        if busy_until.is_none() && !queue.is_empty() {
            busy_until = Some(now + ns_per_bit);
        }
        most = most.max(queue.len() as u64);
        now += 1;
    }
    (finished, most)
}

fn unit(frame: u64, sent: u64, bits: u64) -> LinkUnit {
    LinkUnit { frame, read_ns: sent, decided_ns: sent, sent_ns: sent, bits }
}

fn units() -> impl Strategy<Value = Vec<LinkUnit>> {
    let one = (0_u64..400, 1_u64..40);
    prop::collection::vec(one, 1..12).prop_map(|mut list| {
        list.sort_unstable();
        list.into_iter().map(|(sent, bits)| unit(0, sent, bits)).collect()
    })
}

/// Returns durations of a bit in whole nanoseconds; other rates are rounded up, which another test
/// checks.
fn whole_nanoseconds() -> impl Strategy<Value = u64> {
    prop::sample::select(vec![1, 2, 4, 5, 8, 10, 16, 20])
}

proptest! {
    #[test]
    fn a_link_moves_one_bit_after_the_other(units in units(), ns_per_bit in whole_nanoseconds()) {
        let served = send_over_link(&units, 1_000_000_000 / ns_per_bit);
        let (finished, most) = bit_by_bit(&units, ns_per_bit);
        prop_assert_eq!(&served.finished_ns, &finished);
        prop_assert_eq!(served.backlog_bits, most);
    }

    #[test]
    fn windows_add_up(units in units(), end in 1_u64..2000, window in 1_u64..4) {
        let scale = 100_000;
        let units: Vec<LinkUnit> =
            units.into_iter().map(|old| unit(0, old.sent_ns * scale, old.bits)).collect();
        let rates = WindowRates::from_units(&units, (0, end * scale), window);
        // The naive count compares every window with every unit.
        let length = window * 1_000_000;
        let last = units.last().unwrap().sent_ns;
        let mut sums = Vec::new();
        for start in (0..(end * scale).max(last + 1)).step_by(usize::try_from(length).unwrap()) {
            let inside = units.iter().filter(|u| u.sent_ns >= start && u.sent_ns < start + length);
            sums.push(inside.map(|unit| unit.bits).sum::<u64>());
        }
        sums.sort_unstable();
        // Bytes per second are 125 times the bits of a millisecond, rounded to the nearest.
        let is_rate = |rate: u64, bits: u64| 2 * (rate * window).abs_diff(125 * bits) <= window;
        prop_assert!(is_rate(rates.peak, *sums.last().unwrap()));
        // This is the smallest value that at least 99 of 100 windows do not exceed.
        let enough = |&value: &u64| {
            100 * sums.iter().filter(|&&sum| sum <= value).count() >= 99 * sums.len()
        };
        prop_assert!(is_rate(rates.p99, sums.iter().copied().find(|v| enough(v)).unwrap()));
    }
}

#[test]
fn a_link_that_does_not_divide_a_second_is_rounded_up_once() {
    // At 3 bits per second the first bit has left after a third of a second, the third one after a
    // second.
    let units = [unit(0, 0, 1), unit(0, 0, 1), unit(0, 0, 1)];
    let served = send_over_link(&units, 3);
    assert_eq!(served.finished_ns, [333_333_334, 666_666_667, 1_000_000_000]);
    // At 0.5 s the first bit has left; half of the second and all of the third have not. With the
    // new bit these are 1.5 + 1 bits.
    let units = [unit(0, 0, 3), unit(0, 500_000_000, 1)];
    assert_eq!(send_over_link(&units, 3).backlog_bits, 3);
}

#[test]
fn figures_of_a_burst_by_hand() {
    // Two frames of 100 ms send 8,000 bits each at their end over 1 Mbit/s, which takes 8 ms each.
    let timeline = Timeline::new("clip", &[0, 100_000], 10).unwrap();
    assert_eq!((timeline.end_ns(), timeline.shortest_interval_ns()), (200_000_000, 100_000_000));
    let units: Vec<LinkUnit> = (0..2)
        .map(|frame| {
            let sent = timeline.start_ns(frame + 1);
            LinkUnit {
                frame,
                read_ns: timeline.row_read_ns(frame, 0),
                decided_ns: sent,
                sent_ns: sent,
                bits: 8000,
            }
        })
        .collect();
    let figures = LinkFigures::from_units(units, &timeline, 1_000_000);
    assert_eq!((figures.bytes, figures.bytes_per_second), (2000, 10_000));
    assert_eq!((figures.largest_frame_bytes, figures.buffer_bytes), (1000, 1000));
    // The first row is read after 10 ms, and the last after 100 ms.
    assert_eq!(figures.decision_ns, 90_000_000);
    assert_eq!(figures.delivery_ns.longest, 98_000_000);
    assert_eq!(figures.windows.map(|rates| rates.peak), [1_000_000, 100_000, 10_000]);
    // There are 201 windows of 1 ms, and two of them have bits: the 199th is empty.
    assert_eq!(figures.windows.map(|rates| rates.p99), [0, 100_000, 10_000]);
    assert!(!figures.overloaded);
}

#[test]
fn a_link_below_the_mean_is_overloaded() {
    let timeline = Timeline::new("clip", &[0, 1000], 1).unwrap();
    let units = || vec![unit(0, 0, 1001), unit(1, 1_000_000, 999)];
    assert!(!LinkFigures::from_units(units(), &timeline, 1_000_000).overloaded);
    assert!(LinkFigures::from_units(units(), &timeline, 999_999).overloaded);
}

#[test]
fn rows_are_read_evenly_and_the_sensor_goes_on_after_the_last_frame() {
    let timeline = Timeline::new("clip", &[5, 15, 35], 3).unwrap();
    assert_eq!((timeline.frames(), timeline.end_ns()), (3, 45_000));
    assert_eq!(
        [0, 1, 2, 3, 4, 5].map(|t| timeline.start_ns(t)),
        [0, 10_000, 30_000, 45_000, 60_000, 75_000]
    );
    assert_eq!([0, 1, 2].map(|row| timeline.row_read_ns(0, row)), [3_333, 6_666, 10_000]);
    assert_eq!(timeline.row_read_ns(1, 2), timeline.start_ns(2));
    assert_eq!(timeline.shortest_interval_ns(), 10_000);
}

#[test]
fn times_that_make_no_rate_are_refused() {
    let refused = |times: &[u64]| Timeline::new("clip", times, 1).unwrap_err().to_string();
    assert!(refused(&[]).contains("`clip` has 0 frame"));
    assert!(refused(&[7]).contains("`clip` has 1 frame"));
    assert!(refused(&[0, 10, 10]).starts_with("frame 2 of `clip` is at 10 us"));
    // Two frames last twice the time between them, and 2^63 - 1 ns are the limit.
    let longest = i64::MAX as u64 / 1000 / 2;
    let timeline = Timeline::new("clip", &[5, longest + 5], 1).unwrap();
    assert_eq!(timeline.start_ns(1), longest * 1000);
    assert_eq!(timeline.end_ns(), longest * 2000);
    let problem = refused(&[5, longest + 6]);
    assert!(
        problem
            .starts_with("`clip` lasts 9223372036 s, but a link is timed for at most 9223372036 s"),
        "{problem}"
    );
    assert!(refused(&[0, u64::MAX]).starts_with("`clip` lasts 36893488147419 s"));
}
