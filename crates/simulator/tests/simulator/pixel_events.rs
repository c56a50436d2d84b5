// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixel events are those of a naive implementation, and the files contain them byte for byte.
#![allow(clippy::cast_possible_truncation, reason = "a test fails by panicking")]

use crate::support;
use std::fs;
use std::io::Read as _;
use std::path::Path;

use crate::support::{NpyArray, STREET, design, frames, names, street};
use flate2::read::DeflateDecoder;
use foveate_camera::Decimal;
use foveate_media::{EventFormat, EventReader, FrameRate};
use foveate_pixels::Frame;
use foveate_simulator::{
    PIXEL_EVENT_BYTES, PixelCamera, PixelEventOptions, RunOptions, RunSummary, SimulatorError,
};

/// An event: x, y, t and p.
type EventTuple = (u32, u32, u64, u8);

/// Returns the events of a naive camera in floating point, one pixel and one crossing at a time.
fn naive(frames: &[Frame], contrast: f64, log: bool) -> Vec<EventTuple> {
    let max = f64::from(u16::MAX >> (16 - frames[0].bits()));
    let level = |value: u16| {
        let value = f64::from(value);
        match value * 255.0 / max {
            _ if !log => value,
            grey if grey <= 20.0 => grey * 20f64.ln() / 20.0,
            grey => grey.ln(),
        }
    };
    let mut events = Vec::new();
    for (x, y) in (0..frames[0].height()).flat_map(|y| (0..frames[0].width()).map(move |x| (x, y)))
    {
        let mut remembered = level(frames[0].get(x, y));
        for (number, frame) in frames.iter().enumerate() {
            let now = level(frame.get(x, y));
            let time = FrameRate::default().time_us(number as u64);
            while now - remembered >= contrast - 1e-9 {
                remembered += contrast;
                events.push((x, y, time, 1));
            }
            while remembered - now >= contrast - 1e-9 {
                remembered -= contrast;
                events.push((x, y, time, 0));
            }
        }
    }
    events.sort_by_key(|&(x, y, time, _)| (time, y, x));
    events
}

fn simulate(output: &Path, overrides: &[&str], options: PixelEventOptions) -> RunSummary {
    let options = RunOptions { pixel_events: options, rendered: None, ..RunOptions::default() };
    street(output, overrides, &options)
}

/// Returns the files of a deflated archive, by the directory at its end.
fn unzip(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let u16_at = |at: usize| usize::from(u16::from_le_bytes(bytes[at..at + 2].try_into().unwrap()));
    let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let u64_at = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let short = bytes.len() - 22;
    assert_eq!(&bytes[short..short + 4], b"PK\x05\x06");
    let locator = short - 20;
    assert_eq!(&bytes[locator..locator + 4], b"PK\x06\x07");
    let long = u64_at(locator + 8);
    assert_eq!((&bytes[long..long + 4], u64_at(long + 4)), (&b"PK\x06\x06"[..], 44));
    assert_eq!(long + 56, locator);
    let (entries, size, mut at) = (u64_at(long + 32), u64_at(long + 40), u64_at(long + 48));
    assert_eq!(at + size, long);
    let mut files = Vec::new();
    for _ in 0..entries {
        assert_eq!(&bytes[at..at + 4], b"PK\x01\x02");
        assert_eq!(u16_at(at + 10), 8, "deflated");
        let (name, extra) = (u16_at(at + 28), u16_at(at + 30));
        let sizes = at + 46 + name;
        assert_eq!((u16_at(sizes), u16_at(sizes + 2), extra), (1, 24, 28));
        let [size, packed, start] = [4, 12, 20].map(|long| u64_at(sizes + long));
        assert_eq!(&bytes[start..start + 4], b"PK\x03\x04");
        assert_eq!(u32_at(start + 14), u32_at(at + 16), "checksums of both headers");
        assert_eq!(u16_at(start + 8), 8);
        assert_eq!([4, 12].map(|long| u64_at(start + 30 + name + long)), [size, packed]);
        let from = start + 30 + name + u16_at(start + 28);
        let mut data = Vec::new();
        let read = DeflateDecoder::new(&bytes[from..from + packed]).read_to_end(&mut data).unwrap();
        assert_eq!(read, size);
        assert_eq!(crc(&data), u32_at(at + 16));
        files.push((String::from_utf8(bytes[at + 46..sizes].to_vec()).unwrap(), data));
        at = sizes + extra;
    }
    files
}

/// Returns the CRC-32, computed bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 }
        })
    })
}

fn events_of(npy: &NpyArray) -> Vec<EventTuple> {
    assert_eq!(npy.descr, "[('x', '<i2'), ('y', '<i2'), ('t', '<i8'), ('p', '|b1')]");
    let event = |bytes: &[u8]| {
        let small = |at: usize| u32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        (small(0), small(2), u64::from_le_bytes(bytes[4..12].try_into().unwrap()), bytes[12])
    };
    assert_eq!(npy.shape, [npy.data.len() / 13]);
    npy.data.chunks_exact(13).map(event).collect()
}

#[test]
fn events_are_those_of_a_naive_camera() {
    let cases = [
        (8, None, false, 9.0),
        (8, Some(2.5), false, 2.5),
        (8, None, true, 0.2),
        (8, Some(0.05), true, 0.05),
        (12, Some(100.0), false, 100.0),
        (12, Some(0.1), true, 0.1),
        (1, Some(1.0), false, 1.0),
    ];
    for (bits, contrast, log, expected) in cases {
        let bits = format!("frame.pixel_bits={bits}");
        let overrides = [
            "frame.width=45",
            "frame.height=38",
            "spatial.0.level=1",
            "temporal.min_count=0",
            &bits,
        ];
        let level = if bits.ends_with("=1") { "temporal.level=0" } else { "temporal.level=8" };
        let design = design(&[&overrides[..], &[level]].concat());
        let contrast = contrast.map(|contrast| Decimal::from_f64(contrast).unwrap());
        let options =
            PixelEventOptions { contrast, is_logarithmic: log, ..PixelEventOptions::default() };
        let mut camera = PixelCamera::new(&design, options).unwrap();
        let frames: Vec<Frame> = frames(&design).collect();
        let mut events: Vec<EventTuple> = Vec::new();
        for (number, frame) in frames.iter().enumerate() {
            let time = FrameRate::default().time_us(number as u64);
            camera.step(frame, |event| {
                events.push((event.x, event.y, time, event.brighter.into()));
            });
        }
        let naive = naive(&frames, expected, log);
        assert!(!naive.is_empty(), "{options:?}");
        assert!(events == naive, "{bits} {options:?}");
    }
}

#[test]
fn a_step_brings_one_event_per_contrast_and_what_is_left_counts_on() {
    let design = design(&["frame.width=1", "frame.height=1"]);
    let options = PixelEventOptions {
        contrast: Some(Decimal::from_whole(10)),
        ..PixelEventOptions::default()
    };
    let mut camera = PixelCamera::new(&design, options).unwrap();
    let mut counts = Vec::new();
    for value in [100, 109, 110, 135, 139, 140, 100, 100] {
        let mut count = 0i32;
        let frame = Frame::filled(1, 1, 8, value).unwrap();
        camera.step(&frame, |event| count += if event.brighter { 1 } else { -1 });
        counts.push(count);
    }
    assert_eq!(counts, [0, 0, 1, 2, 0, 1, -4, 0]);
}

#[test]
fn all_files_hold_the_same_events_and_the_summary_counts_them() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let options = PixelEventOptions {
        npz: true,
        csv: true,
        evt2: true,
        evt3: true,
        aedat4: true,
        ..PixelEventOptions::default()
    };
    let summary = simulate(&output, &STREET, options);
    assert!(names(&output).iter().all(|name| name == ".foveate" || !name.starts_with('.')));
    let files = unzip(&fs::read(output.join("pixel_events.npz")).unwrap());
    assert_eq!(
        files.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
        ["events.npy", "frame_start.npy"]
    );
    let frames: Vec<Frame> = frames(&design(&STREET)).collect();
    let events = events_of(&NpyArray::parse(&files[0].1));
    assert!(events == naive(&frames, 9.0, false));
    let starts = NpyArray::parse(&files[1].1);
    assert_eq!((starts.descr.as_str(), &starts.shape[..]), ("<i8", &[6][..]));
    let starts: Vec<usize> = starts
        .data
        .chunks_exact(8)
        .map(|bytes| u64::from_le_bytes(bytes.try_into().unwrap()) as usize)
        .collect();
    assert_eq!((starts[0], starts[5]), (0, events.len()));
    for frame in 0..5 {
        let time = FrameRate::default().time_us(frame as u64);
        let own = &events[starts[frame]..starts[frame + 1]];
        assert!(own.iter().all(|event| event.2 == time), "frame {frame}");
    }
    let csv = fs::read_to_string(output.join("pixel_events.csv")).unwrap();
    let lines = events.iter().map(|(x, y, t, p)| format!("{x},{y},{t},{p}\n"));
    assert_eq!(csv, "x,y,t,p\n".to_owned() + &lines.collect::<String>());
    for (file, format) in [
        ("pixel_events_evt2.raw", EventFormat::Evt2),
        ("pixel_events_evt3.raw", EventFormat::Evt3),
        ("pixel_events.aedat4", EventFormat::Aedat4),
    ] {
        let bytes = fs::read(output.join(file)).unwrap();
        let reader = EventReader::open(bytes.as_slice()).unwrap();
        let design = design(&STREET);
        assert_eq!(reader.format(), format);
        assert_eq!(reader.size(), Some((design.width(), design.height())));
        let read = reader.map(|event| {
            let event = event.unwrap();
            (event.x.into(), event.y.into(), event.time_us, u8::from(event.is_brighter))
        });
        assert!(read.eq(events.iter().copied()), "{file}");
    }
    let pixel = summary.bandwidth.pixel.unwrap();
    assert_eq!(pixel.events, Some(events.len() as u64));
    assert_eq!(pixel.bytes, events.len() as u64 * PIXEL_EVENT_BYTES);
}

#[test]
fn a_still_clip_gives_files_without_events() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let image = support::grey(&folder.path().join("a.png"), 9, 9, |x, _| u8::try_from(x).unwrap());
    let pixel_events = PixelEventOptions {
        npz: true,
        csv: true,
        is_logarithmic: true,
        ..PixelEventOptions::default()
    };
    let options = RunOptions { pixel_events, ..RunOptions::default() };
    support::run(&[&image, &image], &[], &output, &options).unwrap();
    let files = unzip(&fs::read(output.join("pixel_events.npz")).unwrap());
    assert!(events_of(&NpyArray::parse(&files[0].1)).is_empty());
    assert_eq!(NpyArray::parse(&files[1].1).data, [0; 24]);
    assert_eq!(fs::read_to_string(output.join("pixel_events.csv")).unwrap(), "x,y,t,p\n");
}

#[test]
fn frames_that_a_format_cannot_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let design = ["frame.width=2056", "frame.height=8"];
    for options in [
        PixelEventOptions { evt2: true, ..PixelEventOptions::default() },
        PixelEventOptions { evt3: true, ..PixelEventOptions::default() },
    ] {
        let options = RunOptions { pixel_events: options, rendered: None, ..RunOptions::default() };
        let scene = Path::new("scene:street").to_owned();
        let error = support::run(&[&scene], &design, &output, &options).unwrap_err().to_string();
        for words in ["2048x2048", "2056x8", "--resize"] {
            assert!(error.contains(words), "{error}");
        }
    }
}

#[test]
fn a_contrast_that_is_too_small_is_refused() {
    let design = design(&["frame.width=8", "frame.height=8"]);
    for contrast in [0.0, 0.009] {
        let contrast = Decimal::from_f64(contrast);
        let options = PixelEventOptions { contrast, ..PixelEventOptions::default() };
        let error = PixelCamera::new(&design, options).unwrap_err();
        assert!(matches!(error, SimulatorError::Contrast { .. }), "{error}");
    }
}
