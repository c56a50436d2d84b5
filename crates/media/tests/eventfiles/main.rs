// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files of events: what is written is read again, in all formats.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod aedat4;
mod evt;

use foveate_media::{EventEncoder, EventFileError, EventFormat, EventReader, PixelEvent};
use proptest::prelude::*;

fn event(x: u16, y: u16, time_us: u64, is_brighter: bool) -> PixelEvent {
    PixelEvent { x, y, time_us, is_brighter }
}

/// Returns the header of a file, and what follows.
fn file(format: EventFormat, size: (u32, u32), events: &[PixelEvent]) -> (Vec<u8>, Vec<u8>) {
    let (mut encoder, header) = EventEncoder::new(format, size).unwrap();
    let mut bytes = Vec::new();
    events.iter().for_each(|&event| encoder.push(event, &mut bytes).unwrap());
    encoder.finish(&mut bytes);
    (header, bytes)
}

fn read(bytes: &[u8]) -> Result<Vec<PixelEvent>, EventFileError> {
    EventReader::open(bytes)?.collect()
}

fn round_trip(format: EventFormat, size: (u32, u32), events: &[PixelEvent]) -> Vec<PixelEvent> {
    let (header, bytes) = file(format, size, events);
    let file = [header, bytes].concat();
    let reader = EventReader::open(file.as_slice()).unwrap();
    assert_eq!((reader.format(), reader.size()), (format, Some(size)));
    reader.map(Result::unwrap).collect()
}

#[test]
fn a_time_does_not_go_back() {
    for format in EventFormat::ALL {
        let events = [event(0, 0, 9000, true), event(1, 0, 10, true)];
        let found = round_trip(format, (2, 2), &events);
        assert_eq!(found.iter().map(|event| event.time_us).collect::<Vec<_>>(), [9000, 9000]);
    }
}

#[test]
fn frames_that_are_too_large_are_refused() {
    for format in EventFormat::ALL {
        let side = format.max_side();
        assert!(EventEncoder::new(format, (side, side)).is_ok());
        for size in [(side + 1, 1), (1, 2 * side)] {
            let error = EventEncoder::new(format, size).unwrap_err().to_string();
            let words =
                [format!("{side}x{side}"), format!("{}x{}", size.0, size.1), format.to_string()];
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        }
    }
}

#[test]
fn events_outside_of_the_sensor_are_refused() {
    for format in EventFormat::ALL {
        let (mut encoder, _) = EventEncoder::new(format, (40, 30)).unwrap();
        let mut bytes = Vec::new();
        for (x, y) in [(40, 0), (0, 30), (u16::MAX, 0), (0, u16::MAX)] {
            let error = encoder.push(event(x, y, 0, true), &mut bytes).unwrap_err().to_string();
            assert!(error.contains(&format!("({x}, {y})")) && error.contains("40x30"), "{error}");
        }
        encoder.finish(&mut bytes);
        assert!(bytes.is_empty(), "{format}");
    }
}

#[test]
fn other_files_are_refused() {
    for bytes in [&b""[..], b"t_us,x,y\n", b"\x89HDF\r\n"] {
        let error = read(bytes).unwrap_err().to_string();
        assert!(error.contains("AEDAT4"), "{error}");
    }
}

proptest! {
    /// Events of frames: several per pixel, rows in any order, long pauses.
    #[test]
    fn what_is_written_is_read(
        events in prop::collection::vec(
            (0_u16..40, 0_u16..4, prop_oneof![Just(0_u64), 1..5000_u64, 1..40_000_000_000_u64], any::<bool>(), 1_usize..20),
            0..60,
        )
    ) {
        let mut time = 0;
        let mut all = Vec::new();
        for (x, y, pause, is_brighter, run) in events {
            time += pause;
            // Neighbours in a row make vectors.
            all.extend((0..run).map(|step| {
                event(x + u16::try_from(step * step % 40).unwrap(), y, time, is_brighter)
            }));
        }
        for format in EventFormat::ALL {
            prop_assert_eq!(&round_trip(format, (100, 4), &all), &all);
        }
    }
}
