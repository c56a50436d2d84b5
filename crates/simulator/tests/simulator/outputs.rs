// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a run equal the results of the model, byte for byte.

use crate::support;
use std::fs;

use crate::packets::FLOW_DESIGN;
use crate::support::{NpyArray, STREET, names, outcomes, run, street};
use foveate_model::FunctionalOutcome;
use foveate_pixels::{Scene, convert_depth};
use foveate_simulator::{EventTableOptions, PictureFormat, PixelEventOptions, RunOptions};

/// Returns the low bytes of every value, and checks that the others are zero.
fn little_endian(bytes: usize, values: impl Iterator<Item = u64>) -> Vec<u8> {
    let low = |value: u64| {
        assert!(value < 1 << (8 * bytes));
        value.to_le_bytes().into_iter().take(bytes)
    };
    values.flat_map(low).collect()
}

#[test]
fn arrays_hold_every_outcome() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    street(&output, &STREET, &RunOptions::default());
    let outcomes = outcomes(&STREET);
    let expect = |name: &str, descr: &str, data: Vec<u8>| {
        let npy = NpyArray::read(&output.join(name));
        assert_eq!((npy.descr.as_str(), &npy.shape[..]), (descr, &[5, 5, 6][..]), "{name}");
        assert!(npy.data == data, "{name}");
    };
    let flags = |of: fn(&FunctionalOutcome) -> &Vec<bool>| {
        outcomes.iter().flat_map(|outcome| of(outcome).iter().map(|&bit| u8::from(bit))).collect()
    };
    expect("srs.npy", "|u1", flags(|outcome| &outcome.srs));
    expect("trs.npy", "|u1", flags(|outcome| &outcome.trs));
    expect("active.npy", "|u1", flags(|outcome| &outcome.active));
    // A region has 64 pixels of 8 bits, so counts are up to 64, and each deviation is at most
    // 127.5, with a fraction bit.
    let counts = outcomes.iter().flat_map(|o| o.temporal_count.iter().copied().map(u64::from));
    expect("t_count.npy", "|u1", little_endian(1, counts));
    let scores = |index: usize| outcomes.iter().flat_map(move |o| o.scores[index].iter().copied());
    expect("score_edge.npy", "|u1", little_endian(1, scores(0)));
    expect("score_mad.npy", "<u2", little_endian(2, scores(1)));
    assert!(outcomes.iter().any(|o| o.active.contains(&true) && o.active.contains(&false)));
}

#[test]
fn displacements_hold_every_outcome() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    street(&output, FLOW_DESIGN, &RunOptions::default());
    let npy = NpyArray::read(&output.join("flow.npy"));
    assert_eq!((npy.descr.as_str(), &npy.shape[..]), ("|i1", &[5, 5, 6, 2][..]));
    let outcomes = outcomes(FLOW_DESIGN);
    let displacements = outcomes.iter().flat_map(|outcome| &outcome.displacements);
    let expected: Vec<u8> =
        displacements.flat_map(|one| [one.dx, one.dy]).map(i8::cast_unsigned).collect();
    assert!(npy.data == expected);
    assert!(expected.contains(&0) && expected.contains(&2) && expected.contains(&254));
    assert!(!expected.contains(&3));

    let other = folder.path().join("other");
    street(&other, &STREET, &RunOptions::default());
    assert!(!other.join("flow.npy").exists(), "a design without flow has no such file");
}

/// A clip that pans by (2, -1) pixels per frame: the regions inside find this displacement.
#[test]
fn the_displacements_of_a_pan_are_those_of_the_pan() {
    let folder = tempfile::tempdir().unwrap();
    let texture =
        |x: u32, y: u32| (x.wrapping_mul(x) ^ y.wrapping_mul(37 * y + x)).to_le_bytes()[0];
    let inputs: Vec<_> = (0..4)
        .map(|t| {
            let pan = |x, y| texture(100 + x - 2 * t, 100 + y + t);
            support::grey(&folder.path().join(format!("{t}.png")), 32, 24, pan)
        })
        .collect();
    let output = folder.path().join("out");
    let overrides = [
        "spatial=[{feature='flow',radius=2}]",
        "denoise.filter='none'",
        "hardware.organization='serial'",
    ];
    run(&inputs, &overrides, &output, &RunOptions::default()).unwrap();
    let npy = NpyArray::read(&output.join("flow.npy"));
    assert_eq!(npy.shape, [4, 3, 4, 2]);
    let (first, others) = npy.data.split_at(24);
    assert_eq!(first, [0; 24], "the first frame has no reference");
    assert_eq!(others, [2, 255].repeat(36));
}

#[test]
fn the_summary_is_that_of_the_golden_file() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let summary = street(&output, &STREET, &RunOptions::default());
    let written = fs::read_to_string(output.join("summary.json")).unwrap();
    assert_eq!(written, summary.to_json());
    let version = format!("\"foveate_version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(written.contains(&version));
    let actual = written.replace(&version, "\"foveate_version\": \"*\"")
        + &fs::read_to_string(output.join("frames.csv")).unwrap();
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/simulator/golden/street.txt");
    if std::env::var_os("FOVEATE_BLESS").is_some() {
        fs::write(golden, &actual).unwrap();
    }
    assert_eq!(fs::read_to_string(golden).unwrap(), actual);
}

#[test]
fn sums_of_the_summary_follow_from_the_outcomes() {
    let folder = tempfile::tempdir().unwrap();
    let summary = street(&folder.path().join("out"), &STREET, &RunOptions::default());
    let mut forwarded = 0;
    for outcome in outcomes(&STREET) {
        for y in 0..38 {
            for x in 0..45 {
                forwarded += u64::from(outcome.active[y / 8 * 6 + x / 8]);
            }
        }
    }
    assert_eq!(summary.pixels_forwarded, forwarded, "padding does not count");
    assert_eq!(summary.pixels_in, 5 * 45 * 38);
    assert_eq!((summary.frames, summary.regions, summary.grid.columns), (5, 30, 6));
    assert!((summary.active_share_per_frame.max - summary.active_share_per_frame.min) > 0.0);
}

#[test]
fn rendered_frames_are_widened_to_a_depth_that_png_has() {
    for (bits, depth) in [(1, 8), (5, 8), (8, 8), (10, 16), (16, 16)] {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("out");
        let bits_override = format!("frame.pixel_bits={bits}");
        let overrides = [
            "frame.width=45",
            "frame.height=38",
            "temporal.level=0",
            "temporal.min_count=0",
            "spatial.0.level=0",
            "spatial.0.min_score=0",
            &bits_override,
        ];
        street(&output, &overrides, &RunOptions::default());
        assert_eq!(names(&output.join("rendered")).len(), 5);
        for (t, outcome) in outcomes(&overrides).iter().enumerate() {
            let path = output.join(format!("rendered/{t:06}.png"));
            let picture = image::open(path).unwrap();
            assert_eq!(picture.color().bits_per_pixel(), depth);
            let expected: Vec<u16> = outcome
                .rendered
                .pixels()
                .iter()
                .map(|&value| convert_depth(value, bits, depth.into()))
                .collect();
            let seen: Vec<u16> = match picture {
                image::DynamicImage::ImageLuma8(p) => {
                    p.as_raw().iter().map(|&v| v.into()).collect()
                }
                other => other.into_luma16().into_raw(),
            };
            assert_eq!(seen, expected, "P = {bits}, frame {t}");
        }
    }
}

#[test]
fn frames_have_their_names_and_times() {
    let folder = tempfile::tempdir().unwrap();
    let inputs: Vec<_> = ["b,1#2 \"c\".png", "a.png"]
        .map(|name| support::grey(&folder.path().join(name), 8, 8, |x, _| u8::try_from(x).unwrap()))
        .into();
    let output = folder.path().join("out");
    run(&inputs, &[], &output, &RunOptions::default()).unwrap();
    let table = fs::read_to_string(output.join("frames.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert!(lines[0].starts_with("frame,t_us,name,"));
    // No character is left in a name that a reader could interpret.
    let first = folder.path().join("b%2C1%232 %22c%22.png");
    assert!(lines[1].starts_with(&format!("0,0,{},", first.display())), "{}", lines[1]);
    assert!(lines[2].starts_with(&format!("1,33333,{},", inputs[1].display())));
}

#[test]
fn every_scene_runs_and_runs_the_same_twice() {
    let folder = tempfile::tempdir().unwrap();
    for scene in Scene::ALL {
        let options = RunOptions {
            overlay: Some(PictureFormat::Png),
            heatmap: Some(PictureFormat::Png),
            events: EventTableOptions { csv: true, parquet: true, only_active: false },
            pixel_events: PixelEventOptions {
                npz: true,
                evt2: true,
                evt3: true,
                csv: true,
                ..PixelEventOptions::default()
            },
            ..RunOptions::default()
        };
        let input = format!("scene:{scene}");
        let overrides = ["frame.width=16", "frame.height=12", "frame.pixel_bits=10"];
        let outputs = ["1", "2"].map(|run| folder.path().join(format!("{scene}-{run}")));
        for output in &outputs {
            let summary = run(&[&input], &overrides, output, &options).unwrap();
            assert_eq!(summary.frames, u64::from(scene.default_frames()));
        }
        for name in [
            "summary.json",
            "frames.csv",
            "srs.npy",
            "score_edge.npy",
            "rendered/000003.png",
            "overlay/000003.png",
            "heatmap_edge/000003.png",
            "events.csv",
            "events.parquet",
            "pixel_events.npz",
            "pixel_events.csv",
            "pixel_events_evt2.raw",
            "pixel_events_evt3.raw",
        ] {
            let [first, second] =
                outputs.each_ref().map(|output| fs::read(output.join(name)).unwrap());
            assert!(first == second, "{scene} {name}");
        }
    }
}
