// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs that do not fit a study or end early, and recordings of a sensor.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use crate::support::{cells, run};
use flate2::Compression;
use flate2::write::GzEncoder;
use foveate_design::DesignConfig;
use foveate_explore::studies::{Study, StudyError, StudyRequest, analyze};
use foveate_media::{
    CropRect, EventEncoder, EventFormat, FrameRate, ImageRelation, InputOptions, PixelEvent,
    PlaybackError, SilentHooks, testing::RecordingHooks,
};

#[test]
fn what_cannot_be_studied_is_refused_and_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let config = DesignConfig::default();
    let message =
        |study, inputs: &[&str]| run(study, inputs, &config, &out).unwrap_err().to_string();
    assert!(message(Study::Temporal, &["scene:zero", "nowhere.mp4"]).contains("nowhere.mp4"));
    assert!(message(Study::Sensor, &["scene:zero"]).contains("--sensor-events"));
    assert!(message(Study::Size, &["scene:stret"]).contains("street"));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn sets_have_no_change_to_study() {
    let dir = tempfile::tempdir().unwrap();
    let image = dir.path().join("a.pgm");
    fs::write(&image, [b"P5 16 16 255\n".as_slice(), &[7; 256]].concat()).unwrap();
    let input = InputOptions { images: ImageRelation::Set, ..InputOptions::default() };
    let config = DesignConfig::default();
    let request = |study| StudyRequest {
        study,
        inputs: std::slice::from_ref(&image),
        input: &input,
        config: &config,
        sensor_events: None,
        sensor_start_us: 0,
        boxes: &[],
    };
    let out = dir.path().join("out");
    let refused = analyze(&request(Study::Temporal), &out, false, &SilentHooks).unwrap_err();
    assert!(refused.to_string().contains("set of unrelated images"), "{refused}");
    let report = analyze(&request(Study::Threshold), &out, false, &SilentHooks).unwrap();
    assert!(report.rows.iter().all(|row| row[1] == "spatial.0.min_score"));
}

#[test]
fn a_sensor_that_sees_the_same_correlates_fully() {
    let dir = tempfile::tempdir().unwrap();
    write_frames(dir.path(), 0, 1);
    let events = dir.path().join("events.csv");
    let csv = "t_us,x,y,on\n500,1,1,1\n1001,1,1,1\n1002,3,7,0\n90000,9,0,1\n900000,23,0,1\n";
    fs::write(&events, csv).unwrap();
    let input = InputOptions { frame_rate: FrameRate::default(), ..InputOptions::default() };
    let request = StudyRequest {
        study: Study::Sensor,
        inputs: &[dir.path().join("*.pgm")],
        input: &input,
        config: &DesignConfig::default(),
        sensor_events: Some(&events),
        sensor_start_us: 1000,
        boxes: &[],
    };
    let out = dir.path().join("out");
    let report = analyze(&request, &out, true, &SilentHooks).unwrap();
    // Events before the first frame and after the last are left out.
    assert_eq!(cells(&report, "sensor_events"), ["3"; 3]);
    assert_eq!(cells(&report, "spearman"), ["undefined", "1.0000", "1.0000"]);
    // The same events in other formats, one of them packed, have the same figures.
    let own = [(1, 1, 500), (1, 1, 1001), (3, 7, 1002), (9, 0, 90_000), (23, 0, 900_000)];
    for format in EventFormat::ALL {
        let (mut encoder, mut bytes) = EventEncoder::new(format, (24, 8)).unwrap();
        for (x, y, time_us) in own {
            encoder.push(PixelEvent { x, y, time_us, is_brighter: true }, &mut bytes).unwrap();
        }
        encoder.finish(&mut bytes);
        let raw = dir.path().join("events.raw");
        let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
        packed.write_all(&bytes).unwrap();
        let is_packed = format == EventFormat::Evt3;
        fs::write(&raw, if is_packed { packed.finish().unwrap() } else { bytes.clone() }).unwrap();
        let with = StudyRequest { sensor_events: Some(&raw), ..request.clone() };
        let found = analyze(&with, &out, true, &SilentHooks).unwrap();
        assert_eq!(found.rows, report.rows, "{format}");
        fs::write(&raw, &bytes[..bytes.len() - 1]).unwrap();
        let cut = analyze(&with, &out, true, &SilentHooks).unwrap_err().to_string();
        assert!(cut.contains("events.raw") && cut.contains("cut off"), "{cut}");
    }
    // The recordings below have another clock, no event, or no event inside of the frame.
    let late = StudyRequest { sensor_start_us: 5_000_000, ..request.clone() };
    let refused = analyze(&late, &out, true, &SilentHooks).unwrap_err().to_string();
    for part in ["events.csv", "5000000 to 5100000 us", "from 500 to 900000 us", "--sensor-start"] {
        assert!(refused.contains(part), "{part}: {refused}");
    }
    let at_first = StudyRequest { sensor_start_us: 900_000, ..request.clone() };
    assert!(analyze(&at_first, &out, true, &SilentHooks).is_err(), "nothing comes after frame 0");
    for (csv, part) in [
        ("t_us,x,y\n", "no event"),
        ("t_us,x,y\n1001,24,0\n", "24x8 pixels"),
        ("# Format: [timestamp, x, y, polarity]\n0.001 3 2 1\n", "v2e"),
        ("0.001 3 2 1\n", "v2e"),
        ("1001,3,2,1\n", "such as `t,x,y`"),
        ("time;a;b\n1;2;3\n", "`time;a;b`"),
        ("Event Stream\u{2}", "an event stream (`.es`)"),
        ("version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
    ] {
        fs::write(&events, csv).unwrap();
        let refused = analyze(&request, &out, true, &SilentHooks).unwrap_err().to_string();
        assert!(refused.contains(part) && refused.contains("events.csv"), "{refused}");
    }
    fs::write(&events, "t_us,x,y\n1,2\n").unwrap();
    let refused = analyze(&request, &out, true, &SilentHooks).unwrap_err().to_string();
    assert!(refused.contains("line 2") && refused.contains("events.csv"), "{refused}");
}

/// Writes four frames of three regions of 8x8 pixels, of which the left one changes in every frame,
/// the middle one once, and the right one never. `before` columns lie at their left, and every
/// pixel is `scale` pixels wide and high.
fn write_frames(folder: &Path, before: usize, scale: usize) {
    for (frame, values) in [[0, 0, 0], [200, 200, 0], [0, 200, 0], [200, 200, 0]].iter().enumerate()
    {
        let regions = values.iter().flat_map(|&value| [value; 8]);
        let row: Vec<u8> = std::iter::repeat_n(7, before).chain(regions).collect();
        let row: Vec<u8> = row.iter().flat_map(|&value| vec![value; scale]).collect();
        let size = format!("P5 {} {} 255\n", row.len(), 8 * scale);
        let image = [size.into_bytes(), row.repeat(8 * scale)].concat();
        fs::write(folder.join(format!("{frame}.pgm")), image).unwrap();
    }
}

#[test]
fn events_of_a_sensor_are_cropped_and_scaled_as_its_frames() {
    let events = [(1, 1, 1001), (3, 7, 1002), (9, 0, 90_000)];
    let table = |before: usize, scale: usize| {
        let row = |&(x, y, t): &(usize, usize, u64)| {
            format!("{t},{},{}\n", (x + before) * scale, y * scale)
        };
        format!("t_us,x,y\n{}", events.iter().map(row).collect::<String>())
    };
    let study = |before, scale, csv: &[u8], input: &InputOptions| {
        let dir = tempfile::tempdir().unwrap();
        write_frames(dir.path(), before, scale);
        let path = dir.path().join("events");
        fs::write(&path, csv).unwrap();
        let request = StudyRequest {
            study: Study::Sensor,
            inputs: &[dir.path().join("*.pgm")],
            input,
            config: &DesignConfig::default(),
            sensor_events: Some(&path),
            sensor_start_us: 1000,
            boxes: &[],
        };
        let out = dir.path().join("out");
        let found = analyze(&request, &out, true, &SilentHooks);
        let found = found.map_err(|error| error.to_string())?;
        Ok::<_, String>((found, fs::read_to_string(out.join("sensor.csv")).unwrap()))
    };
    let (plain, _) = study(0, 1, table(0, 1).as_bytes(), &InputOptions::default()).unwrap();
    assert_eq!(cells(&plain, "sensor_events"), ["3"; 3]);
    // Our own tables of pixel events call the column `t`.
    let own = table(0, 1).replace("t_us", "t");
    let found = study(0, 1, own.as_bytes(), &InputOptions::default()).unwrap();
    assert_eq!(found.0.rows, plain.rows);
    let scaled = InputOptions { resize: Some((24, 8)), ..InputOptions::default() };
    assert_eq!(study(0, 3, table(0, 3).as_bytes(), &scaled).unwrap().0.rows, plain.rows);
    let part = CropRect { size: (24, 8), origin: (8, 0) };
    let cropped = InputOptions { crop: Some(part), ..InputOptions::default() };
    let csv = table(8, 1) + "1003,3,3\n";
    let (found, notes) = study(8, 1, csv.as_bytes(), &cropped).unwrap();
    assert_eq!(found.rows, plain.rows);
    assert!(notes.contains("1 of that time are outside of the frame, left out"), "{notes}");
    let part = CropRect { size: (72, 24), origin: (24, 0) };
    let both = InputOptions { crop: Some(part), ..scaled };
    assert_eq!(study(8, 3, table(8, 3).as_bytes(), &both).unwrap().0.rows, plain.rows);
    // A sensor of another size is that of another camera.
    for format in EventFormat::ALL {
        let (mut encoder, mut bytes) = EventEncoder::new(format, (48, 16)).unwrap();
        for (x, y, time_us) in events {
            let (x, y) = (u16::try_from(x).unwrap(), u16::try_from(y).unwrap());
            encoder.push(PixelEvent { x, y, time_us, is_brighter: true }, &mut bytes).unwrap();
        }
        encoder.finish(&mut bytes);
        let refused = study(0, 1, &bytes, &InputOptions::default()).map(|_| ()).unwrap_err();
        assert!(refused.contains("48x16") && refused.contains("24x8"), "{format}: {refused}");
    }
    // An event that is outside of the frame has no wrong clock.
    let refused =
        study(0, 1, b"t_us,x,y\n0,700,20\n", &InputOptions::default()).map(|_| ()).unwrap_err();
    assert!(refused.contains("outside") && refused.contains("24x8"), "{refused}");
}

#[test]
fn a_cut_clip_is_marked_and_a_stopped_study_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let clip = dir.path().join("cut.y4m");
    let frame = [b"FRAME\n".as_slice(), &[9; 256]].concat();
    let header = b"YUV4MPEG2 W16 H16 F25:1 Cmono\n".as_slice();
    fs::write(&clip, [header, &frame, &frame, &frame[..99]].concat()).unwrap();
    let (input, config) = (InputOptions::default(), DesignConfig::default());
    let request = StudyRequest {
        study: Study::Temporal,
        inputs: &[clip],
        input: &input,
        config: &config,
        sensor_events: None,
        sensor_start_us: 0,
        boxes: &[],
    };
    let out = dir.path().join("out");
    let stopped = analyze(&request, &out, false, &RecordingHooks::cancelling_after(0)).unwrap_err();
    assert!(matches!(stopped, StudyError::Playback(PlaybackError::Interrupted)) && !out.exists());
    let report = analyze(&request, &out, false, &SilentHooks).unwrap();
    assert_eq!((cells(&report, "frames")[0], report.problems.len()), ("2", 1));
    for file in ["temporal.csv", "temporal.svg"] {
        let text = fs::read_to_string(out.join(file)).unwrap();
        assert!(text.contains("NOT COMPLETE: cut: "), "{file}: {text}");
    }
}
