// SPDX-License-Identifier: MIT OR Apache-2.0
//! EVT 2.0 and EVT 3.0: words are those of the format's definition, and damaged files end with an
//! error.

use crate::{event, file, read, round_trip};
use foveate_media::{EventEncoder, EventFormat, EventReader, PixelEvent};
use proptest::prelude::*;

const VERSIONS: [EventFormat; 2] = [EventFormat::Evt2, EventFormat::Evt3];

/// Returns the words of EVT 3.0 of some events.
fn words_3(events: &[PixelEvent]) -> Vec<u16> {
    let words = file(EventFormat::Evt3, (64, 64), events).1;
    words.chunks(2).map(|word| u16::from_le_bytes([word[0], word[1]])).collect()
}

#[test]
fn words_are_those_of_the_definition() {
    let events = [event(3, 2, 65, false), event(7, 2, 65, true), event(2047, 2047, 130, true)];
    let words = file(EventFormat::Evt2, (2048, 2048), &events).1;
    let words: Vec<u32> =
        words.chunks(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    let place = |x: u32, y: u32| x << 11 | y;
    assert_eq!(
        words,
        [
            0x8000_0000,
            0x8000_0001,
            1 << 22 | place(3, 2),
            0x1000_0000 | 1 << 22 | place(7, 2),
            0x8000_0002,
            0x1000_0000 | 2 << 22 | place(2047, 2047),
        ]
    );
    // Row 2 has an event, then three for which a vector is shorter, and one in the vector behind
    // it.
    let row = [1, 20, 22, 31, 33].map(|x| event(x, 2, 4097, true));
    let events = [&row[..], &[event(5, 2, 4097, false), event(5, 3, 4099, false)]].concat();
    let expected = [
        0x8000, 0x8001, 0x6001, 0x0002, // time 4097, row 2
        0x2801, // x 1, brighter
        0x3814, 0x4805, 0x4002, // vectors from x 20: 20, 22, 31, and 33
        0x2005, // x 5, darker
        0x6003, 0x0003, 0x2005, // time 4099, row 3, x 5
    ];
    assert_eq!(words_3(&events), expected);
}

#[test]
fn a_long_recording_has_all_its_times() {
    // Both formats begin a new loop: after 16.8 s, and after 4.8 hours.
    let times =
        [0, 1, 4095, 4096, 16_777_215, 16_777_216, 90_000_000, 17_179_869_183, 17_179_869_184];
    let events: Vec<_> = times
        .into_iter()
        .chain([80_000_000_000])
        .map(|time| event(1, 2, time, time % 2 == 0))
        .collect();
    for version in VERSIONS {
        assert_eq!(round_trip(version, (4, 4), &events), events, "{version}");
    }
}

/// Words that other cameras send: vectors of 8 pixels, triggers, and events before the first time.
#[test]
fn words_of_cameras_are_read() {
    let words: [u16; 12] = [
        0x2001, // an event before the first row and time
        0x8000, 0x6005, 0x2001, // an event before the first row
        0x0009, 0xa001, 0x3003, 0x4801, 0x5081, 0x2802, 0xe123, 0x7001,
    ];
    let words = words.iter().flat_map(|word| word.to_le_bytes());
    let bytes: Vec<u8> = b"% evt 3.0\n% end\n".iter().copied().chain(words).collect();
    let found = read(&bytes).unwrap();
    let expected = [(3, false), (14, false), (15, false), (22, false), (2, true)];
    assert_eq!(found, expected.map(|(x, is_brighter)| event(x, 9, 5, is_brighter)));
}

#[test]
fn vectors_beyond_a_row_end_with_an_error() {
    let start: [u16; 4] = [0x8000, 0x6001, 0x0000, 0x3000];
    for empty in [170, 5461, 5462, 6000] {
        let vectors = std::iter::repeat_n(0x4000, empty).chain([0x4ffe]);
        let words = start.into_iter().chain(vectors).flat_map(u16::to_le_bytes);
        let bytes: Vec<u8> = b"% evt 3.0\n% end\n".iter().copied().chain(words).collect();
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.contains("outside of the sensor"), "{empty}: {error}");
    }
}

#[test]
fn pauses_that_a_stream_cannot_hold_are_refused() {
    for version in VERSIONS {
        let (mut encoder, _) = EventEncoder::new(version, (40, 30)).unwrap();
        let mut bytes = Vec::new();
        encoder.push(event(1, 1, 5, true), &mut bytes).unwrap();
        let error = encoder.push(event(1, 1, u64::MAX, true), &mut bytes).unwrap_err().to_string();
        assert!(error.contains("30 days"), "{error}");
        assert!(bytes.len() < 100);
    }
}

#[test]
fn damaged_streams_end_with_an_error() {
    for version in VERSIONS {
        let events = [event(1, 1, 5, true), event(3, 3, 6, false)];
        let (header, words) = file(version, (4, 4), &events);
        let cut = [header.as_slice(), &words[..words.len() - 1]].concat();
        let error = read(&cut).unwrap_err().to_string();
        assert!(error.contains("ends within a word") && error.contains("at byte"), "{error}");
        let smaller = String::from_utf8(header).unwrap().replace("4x4", "3x3").replace("=4", "=3");
        let outside = [smaller.as_bytes(), &words].concat();
        let error = read(&outside).unwrap_err().to_string();
        assert!(error.contains("pixel (3, 3)") && error.contains("3x3"), "{error}");
        // After the error there are no more events.
        let mut reader = EventReader::open(outside.as_slice()).unwrap();
        assert!(reader.next().unwrap().is_ok() && reader.next().unwrap().is_err());
        assert!(reader.next().is_none());
    }
}

proptest! {
    /// Any bytes behind a header are read without a panic.
    #[test]
    fn any_words_are_read(words in prop::collection::vec(any::<u8>(), 0..400), second in any::<bool>()) {
        let header: &[u8] = if second { b"% evt 2.0\n% end\n" } else { b"% evt 3.0\n% end\n" };
        let bytes = [header, &words].concat();
        if let Ok(events) = read(&bytes) {
            prop_assert!(events.iter().all(|event| event.x < 2048 && event.y < 2048));
        }
    }
}
