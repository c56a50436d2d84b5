// SPDX-License-Identifier: MIT OR Apache-2.0
//! A decoded stream of packets gives the files of the simulation. Losses are listed, and outputs
//! that a stream cannot give are refused.

use std::fs;
use std::path::Path;

use foveate_design::DesignConfig;
use foveate_media::SilentHooks;
use foveate_simulator::{
    DecodedRecording, PacketContent, PacketRecording, PictureFormat, PixelEventOptions, RunOptions,
    SimulatorError,
};

use crate::packets::{DESIGNS, FLOW_DESIGN, crc, options};
use crate::support::{NpyArray, design, names, street};

fn decode(
    stream: &[u8],
    overrides: &[&str],
    output: &Path,
    options: &RunOptions,
) -> Result<DecodedRecording, SimulatorError> {
    let config = DesignConfig::from_toml_with("", overrides).unwrap();
    let mut stream = stream;
    PacketRecording { config: &config, stream: &mut stream, name: "scene:street" }.decode(
        output,
        options,
        &SilentHooks,
    )
}

/// Returns all files below a folder with their contents, except the stream and the list of files.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for name in names(folder).into_iter().filter(|name| name != "packets.bin" && name != ".foveate")
    {
        let path = folder.join(&name);
        if path.is_dir() {
            let inside = |(inner, bytes)| (format!("{name}/{inner}"), bytes);
            files.extend(self::files(&path).into_iter().map(inside));
        } else {
            files.push((name, fs::read(path).unwrap()));
        }
    }
    files
}

/// Removes the column of names, which packets do not have.
fn without_names(table: &[u8]) -> Vec<String> {
    let text = String::from_utf8(table.to_vec()).unwrap();
    let cut = |line: &str| {
        let fields = line.split(',').enumerate().filter(|(at, _)| *at != 2);
        fields.map(|(_, field)| field).collect::<Vec<_>>().join(",")
    };
    text.lines().map(cut).collect()
}

#[test]
fn what_comes_back_is_what_was_simulated() {
    for (number, overrides) in DESIGNS.into_iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
        let heat = RunOptions {
            heatmap: Some(PictureFormat::Png),
            ..options(Some(PacketContent::WithScores))
        };
        let summary = street(&sent, overrides, &heat);
        let stream = fs::read(sent.join("packets.bin")).unwrap();
        let decoded =
            decode(&stream, overrides, &seen, &RunOptions { packets: None, ..heat }).unwrap();
        assert_eq!((decoded.loss_count, &decoded.summary), (0, &summary), "design {number}");
        let (sent, seen) = (files(&sent), files(&seen));
        assert_eq!(sent.len(), seen.len());
        for ((name, sent), (also, seen)) in sent.iter().zip(&seen) {
            assert_eq!(name, also);
            if name == "frames.csv" {
                assert_eq!(without_names(sent), without_names(seen), "design {number}");
            } else {
                assert!(sent == seen, "design {number}: {name} differs");
            }
        }
    }
}

#[test]
fn without_scores_all_else_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    street(&sent, DESIGNS[5], &options(Some(PacketContent::Plain)));
    let stream = fs::read(sent.join("packets.bin")).unwrap();
    decode(&stream, DESIGNS[5], &seen, &options(None)).unwrap();
    let lost: Vec<String> =
        names(&sent).into_iter().filter(|name| !names(&seen).contains(name)).collect();
    assert_eq!(lost, ["packets.bin", "score_edge.npy", "t_count.npy"]);
    let events = fs::read_to_string(seen.join("events.csv")).unwrap();
    assert!(events.starts_with("frame,t_us,x,y,x0,y0,srs,trs,action\n"), "{events:.80}");
    for name in ["srs.npy", "trs.npy", "active.npy", "summary.npy", "rendered/000004.png"] {
        assert!(fs::read(sent.join(name)).unwrap() == fs::read(seen.join(name)).unwrap(), "{name}");
    }
}

#[test]
fn displacements_come_back_without_scores() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    street(&sent, FLOW_DESIGN, &options(Some(PacketContent::Plain)));
    let stream = fs::read(sent.join("packets.bin")).unwrap();
    decode(&stream, FLOW_DESIGN, &seen, &options(None)).unwrap();
    let lost: Vec<String> =
        names(&sent).into_iter().filter(|name| !names(&seen).contains(name)).collect();
    assert_eq!(lost, ["packets.bin", "score_edge.npy", "score_flow.npy", "t_count.npy"]);
    assert!(fs::read(sent.join("flow.npy")).unwrap() == fs::read(seen.join("flow.npy")).unwrap());
    let [sent, seen] =
        [sent, seen].map(|folder| fs::read_to_string(folder.join("events.csv")).unwrap());
    assert!(seen.starts_with("frame,t_us,x,y,x0,y0,srs,trs,dx,dy,action\n"), "{seen:.80}");
    let without_scores = |line: &str| {
        let fields = line.split(',').enumerate().filter(|(at, _)| !(8..11).contains(at));
        fields.map(|(_, field)| field).collect::<Vec<_>>().join(",")
    };
    let expected: Vec<_> = sent.lines().map(without_scores).collect();
    assert_eq!(seen.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn lost_displacements_are_zero_and_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    street(&sent, FLOW_DESIGN, &options(Some(PacketContent::Plain)));
    let whole = NpyArray::read(&sent.join("flow.npy")).data;
    let mut stream = fs::read(sent.join("packets.bin")).unwrap();
    // A FLOW of 6 regions has 24 bytes. Each of the first four frames has 5 of them. The fourth
    // frame has displacements in its second row.
    let is_flow = |at: &usize| stream[*at..].starts_with(&[0xFA, 7, 3, 0]);
    let starts: Vec<usize> = (0..stream.len()).step_by(8).filter(is_flow).collect();
    assert_eq!(starts.len(), 25);
    let lost = (0..25).find(|&row| whole[12 * row..12 * (row + 1)] != [0; 12]).unwrap();
    stream[starts[lost] + 8] ^= 1;
    let decoded = decode(&stream, FLOW_DESIGN, &seen, &options(None)).unwrap();
    assert_eq!((decoded.loss_count, decoded.summary.complete), (2, false));
    let mut expected = whole;
    expected[12 * lost..12 * (lost + 1)].fill(0);
    assert_eq!(NpyArray::read(&seen.join("flow.npy")).data, expected);
    let losses = fs::read_to_string(seen.join("losses.csv")).unwrap();
    let expected = [
        "what,frame,row,column,count,offset".to_owned(),
        format!("bytes,,,,24,{}", starts[lost]),
        format!("flow,{},{},,,", lost / 5, lost % 5),
    ];
    assert_eq!(losses.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn a_decoder_without_flow_takes_nothing_of_a_stream_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    street(&sent, FLOW_DESIGN, &options(Some(PacketContent::Plain)));
    let with_flow = fs::read(sent.join("packets.bin")).unwrap();
    fs::remove_dir_all(&sent).unwrap();
    street(&sent, DESIGNS[0], &options(Some(PacketContent::Plain)));
    let own = fs::read(sent.join("packets.bin")).unwrap();
    let error = decode(&with_flow, DESIGNS[0], &seen, &options(None)).unwrap_err().to_string();
    assert!(error.contains(&design(FLOW_DESIGN).fingerprint()), "{error}");
    assert!(error.contains(&design(DESIGNS[0]).fingerprint()), "{error}");
    // The bytes of the other camera stand between two streams of this one.
    let stream = [&own[..], &with_flow, &own].concat();
    let decoded = decode(&stream, DESIGNS[0], &seen, &options(None)).unwrap();
    assert_eq!((decoded.loss_count, decoded.summary.frames), (5, 10));
    let losses = fs::read_to_string(seen.join("losses.csv")).unwrap();
    assert!(losses.lines().skip(1).all(|line| line.starts_with("foreign,")), "{losses}");
    assert!(!seen.join("flow.npy").exists());
}

#[test]
fn a_lost_region_stays_as_it_was_and_is_listed() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    street(&sent, DESIGNS[0], &options(Some(PacketContent::Plain)));
    let mut stream = fs::read(sent.join("packets.bin")).unwrap();
    // The first REGION packet of the first frame follows FRAME (56 bytes) and ROW (24 bytes).
    let is_region = |at: &usize| stream[*at] == 0xFA && stream[at + 1] & 15 == 4;
    let at = (56..stream.len()).step_by(8).find(is_region).unwrap();
    stream[at + 20] ^= 1;
    let decoded = decode(&stream, DESIGNS[0], &seen, &options(None)).unwrap();
    assert_eq!(decoded.loss_count, 2);
    assert!(!decoded.summary.complete);
    assert_eq!(decoded.summary.frames, 5);
    let row = u16::from_le_bytes([stream[at + 4], stream[at + 5]]);
    let column = u16::from_le_bytes([stream[at + 6], stream[at + 7]]);
    let losses = fs::read_to_string(seen.join("losses.csv")).unwrap();
    let expected = [
        "what,frame,row,column,count,offset".to_owned(),
        format!("bytes,,,,80,{at}"),
        format!("region,0,{row},{column},,"),
    ];
    assert_eq!(losses.lines().collect::<Vec<_>>(), expected);
    let events = fs::read_to_string(seen.join("events.csv")).unwrap();
    let held = format!("0,0,{column},{row},{},{},1,1,hold", 8 * column, 8 * row);
    assert!(events.lines().any(|line| line == held), "{held}");
}

#[test]
fn what_cannot_be_is_refused_with_both_sides() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    street(&sent, DESIGNS[0], &options(Some(PacketContent::Plain)));
    let stream = fs::read(sent.join("packets.bin")).unwrap();
    let refused = |stream: &[u8], overrides: &[&str], options: &RunOptions| {
        let message = decode(stream, overrides, &seen, options).unwrap_err().to_string();
        assert!(!seen.exists(), "{message}");
        message
    };
    let plain = options(None);
    let other = refused(&stream, &["region.size=4"], &plain);
    let resized = |overrides: &[&str]| design(&[DESIGNS[0], overrides].concat()).fingerprint();
    assert!(
        other.contains(&resized(&[])) && other.contains(&resized(&["region.size=4"])),
        "{other}"
    );
    let fixed = refused(&stream, &["frame.width=46"], &plain);
    assert!(fixed.contains("46") && fixed.contains("45"), "{fixed}");
    assert!(refused(b"", DESIGNS[0], &plain).contains("0 bytes"));
    assert!(refused(&[7; 5000], DESIGNS[0], &plain).contains("no FRAME packet"));
    let heat = RunOptions { heatmap: Some(PictureFormat::Png), ..plain.clone() };
    assert!(refused(&stream, DESIGNS[0], &heat).contains("without scores"));
    let pixel_events = PixelEventOptions { csv: true, ..PixelEventOptions::default() };
    let events = RunOptions { pixel_events, ..plain.clone() };
    assert!(refused(&stream, DESIGNS[0], &events).contains("pixel events"));
    let mut newer = stream.clone();
    newer[4] = 2;
    let check = crc(&newer[..52]);
    newer[52..56].copy_from_slice(&check.to_le_bytes());
    assert!(refused(&newer, DESIGNS[0], &plain).contains("version 2"));
}

/// In a stream without scores the arrows of `flow` alone are as bright as in the simulation,
/// because SRS is then the vote of `flow`.
#[test]
fn arrows_of_a_stream_without_scores_are_bright_where_regions_are_relevant() {
    let overrides = [
        "frame={width=224,height=160}",
        "hardware.organization=\"serial\"",
        "spatial=[{feature=\"flow\",min_score=1}]",
    ];
    let folder = tempfile::tempdir().unwrap();
    let (sent, seen) = (folder.path().join("sent"), folder.path().join("seen"));
    let overlay =
        RunOptions { overlay: Some(PictureFormat::Png), ..options(Some(PacketContent::Plain)) };
    street(&sent, &overrides, &overlay);
    let stream = fs::read(sent.join("packets.bin")).unwrap();
    decode(&stream, &overrides, &seen, &RunOptions { packets: None, ..overlay }).unwrap();
    let white_pixels = |folder: &Path, name: &str| {
        let picture = image::open(folder.join("overlay").join(name)).unwrap().into_rgb8();
        picture.pixels().filter(|pixel| pixel.0 == [255; 3]).count()
    };
    let counts: Vec<_> = names(&sent.join("overlay"))
        .iter()
        .map(|name| [&sent, &seen].map(|folder| white_pixels(folder, name)))
        .collect();
    assert!(counts.iter().any(|[sent, _]| *sent > 0), "{counts:?}");
    assert!(counts.iter().all(|[sent, seen]| sent == seen), "{counts:?}");
}
