// SPDX-License-Identifier: MIT OR Apache-2.0
//! Times of frames are exact if they are possible. They never go back, and continue after an
//! impossible one.

use fastrand::Rng;
use foveate_packets::{FrameClock, FrameInfo, FrameTime, LONGEST_GAP_SECONDS, PacketLayout};

use crate::damage::case_count;
use crate::stream::design;

fn info(ticks_per_second: u32) -> FrameInfo {
    let layout =
        PacketLayout::new(&design("frame={width=8,height=8}\n"), false, ticks_per_second).unwrap();
    layout.info().clone()
}

fn take(clock: &mut FrameClock, info: &FrameInfo, time: u64) -> FrameTime {
    clock.next_time(&FrameInfo { time, ..info.clone() })
}

#[test]
fn fuzz_right_times_are_exact_and_any_times_never_go_back() {
    for seed in 0..case_count() {
        let mut rng = Rng::with_seed(seed);
        let per_second = *rng.choice(&[1, 7, 30, 90_000, 1_000_000, u32::MAX]).unwrap();
        let info = info(per_second);
        let day = LONGEST_GAP_SECONDS * u64::from(per_second);
        let (mut right, mut any) = (FrameClock::default(), FrameClock::default());
        let start = rng.u64(..1 << 62);
        let (mut time, mut last) = (start, 0);
        for _ in 0..50 {
            let exact = u128::from(time - start) * 1_000_000 / u128::from(per_second);
            let result = take(&mut right, &info, time);
            assert_eq!(
                (u128::from(result.time_us), result.is_impossible),
                (exact, false),
                "seed {seed}"
            );
            time += rng.u64(0..day) >> rng.u32(0..40);

            let wild = match rng.u8(0..4) {
                0 => rng.u64(..),
                1 => 1 << rng.u32(0..64),
                2 => u64::MAX - rng.u64(0..10),
                _ => time,
            };
            let result = take(&mut any, &info, wild);
            let step = result.time_us.checked_sub(last);
            let step = step.unwrap_or_else(|| panic!("seed {seed}: {last} to {}", result.time_us));
            assert!(step <= LONGEST_GAP_SECONDS * 1_000_000, "seed {seed}: a gap of {step} us");
            last = result.time_us;
        }
    }
}

#[test]
fn an_impossible_time_is_replaced_by_that_of_the_previous_frame() {
    let info = info(1000);
    let day = LONGEST_GAP_SECONDS * 1000;
    for wrong in [0, 4999, 5002 + day, 1 << 63, u64::MAX] {
        let mut clock = FrameClock::default();
        let times = [4000, 5000, wrong, 5001, 5003].map(|time| take(&mut clock, &info, time));
        let expected = [
            (0, false),
            (1_000_000, false),
            (1_000_000, true),
            (1_000_000, true),
            (1_002_000, false),
        ];
        // A time slightly before the last one does not make the next time doubtful.
        let expected =
            expected.map(|(time_us, is_wrong)| FrameTime { time_us, is_impossible: is_wrong });
        if wrong == 4999 {
            assert_eq!(times[2..4].iter().filter(|time| time.is_impossible).count(), 1);
            assert!(times[4].time_us > times[3].time_us);
        } else if wrong == 0 {
            assert_eq!(times[..3], expected[..3]);
            assert!(times[4].time_us > times[3].time_us);
        } else {
            assert_eq!(times, expected, "{wrong}");
        }
    }
}

#[test]
fn a_restarted_camera_may_restart_its_time() {
    let info = info(1_000_000);
    let mut clock = FrameClock::default();
    for (time, first, expected) in
        [(1 << 40, true, 0), ((1 << 40) + 7, false, 7), (3, true, 7), (9, false, 13)]
    {
        let result = clock.next_time(&FrameInfo { time, first, ..info.clone() });
        assert_eq!(result, FrameTime { time_us: expected, is_impossible: false });
    }
}
