// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams with valid packets and wrong numbers: they do not end the decoding, do not claim memory,
//! and their valid parts are decoded.

use std::fs;
use std::path::Path;

use fastrand::Rng;
use foveate_design::DesignConfig;
use foveate_media::{RunHooks, SilentHooks, testing::RecordingHooks};
use foveate_packets::{PacketLayout, StreamLoss, packet_encoding};
use foveate_simulator::{
    DecodedRecording, MAX_CLAIMED_PIXELS, PacketContent, PacketRecording, PacketStream, RunOptions,
    ShownFrame, SimulatorError, StreamItem,
};

use crate::packets::{DESIGNS, crc, options};
use crate::support::street;

/// Returns the packets of five frames, frame by frame.
fn sent() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    street(&folder.path().join("sent"), DESIGNS[0], &options(Some(PacketContent::Plain)));
    let bytes = fs::read(folder.path().join("sent/packets.bin")).unwrap();
    let mut frames = Vec::new();
    let mut rest = &bytes[..];
    while !rest.is_empty() {
        let length = 8 * usize::from(u16::from_le_bytes([rest[2], rest[3]]));
        let (packet, after) = rest.split_at(length);
        if packet[1] & 15 == 1 {
            frames.push(Vec::new());
        }
        frames.last_mut().unwrap().extend(packet);
        rest = after;
    }
    assert_eq!(frames.len(), 5);
    frames
}

/// Replaces a word in the FRAME packet at the start of these packets, and corrects its checksum.
fn with_word(packets: &[u8], number: usize, word: u64) -> Vec<u8> {
    let mut packets = packets.to_vec();
    packets[8 * number..8 * number + 8].copy_from_slice(&word.to_le_bytes());
    let check = crc(&packets[..52]);
    packets[52..56].copy_from_slice(&check.to_le_bytes());
    packets
}

const FINGERPRINT: usize = 2;
const TIME: usize = 3;
const SIZE: usize = 4;

fn config(overrides: &[&str]) -> DesignConfig {
    DesignConfig::from_toml_with("", overrides).unwrap()
}

/// Returns all received frames and losses, and the messages for refused frames.
fn receive(bytes: &[u8]) -> (Vec<ShownFrame>, Vec<StreamLoss>, Vec<String>) {
    let mut stream = PacketStream::new(&config(DESIGNS[0]));
    let (mut frames, mut losses, mut refused) = (Vec::new(), Vec::new(), Vec::new());
    stream.feed(bytes);
    stream.complete();
    loop {
        match stream.receive() {
            Ok(None) => return (frames, losses, refused),
            Ok(Some(StreamItem::Frame(frame))) => frames.push(*frame),
            Ok(Some(StreamItem::Loss(loss))) => losses.push(loss),
            Ok(Some(StreamItem::Register(_))) => {}
            Err(error) => refused.push(error.to_string()),
        }
    }
}

fn decode(
    bytes: &[u8],
    output: &Path,
    hooks: &dyn RunHooks,
) -> Result<DecodedRecording, SimulatorError> {
    let mut stream = bytes;
    let options = RunOptions { packets: None, ..options(None) };
    let config = config(DESIGNS[0]);
    PacketRecording { config: &config, stream: &mut stream, name: "sent" }
        .decode(output, &options, hooks)
}

#[test]
fn a_time_that_cannot_be_right_is_a_loss_and_the_stream_goes_on() {
    let sent = sent();
    let right: Vec<u64> =
        receive(&sent.concat()).0.iter().map(|frame| frame.time_us.unwrap()).collect();
    let interval = right[1];
    for wrong in [0, 1 << 63, u64::MAX, 90_000_000_000] {
        let mut forged = sent.clone();
        forged[3] = with_word(&sent[3], TIME, wrong);
        let (frames, losses, refused) = receive(&forged.concat());
        assert!(refused.is_empty(), "{refused:?}");
        assert!(losses.contains(&StreamLoss::Time { frame: 3 }), "{wrong}: {losses:?}");
        assert!(
            losses.iter().all(|loss| matches!(loss, StreamLoss::Time { frame: 3 | 4 })),
            "{losses:?}"
        );
        let times: Vec<u64> = frames.iter().map(|frame| frame.time_us.unwrap()).collect();
        assert_eq!((times.len(), &times[..3]), (5, &right[..3]));
        assert_eq!(times[3], times[2], "{wrong}");
        assert!(times[4] >= times[3] && times[4] <= times[3] + 5 * interval, "{times:?}");
        let folder = tempfile::tempdir().unwrap();
        let seen = folder.path().join("seen");
        let decoded = decode(&forged.concat(), &seen, &SilentHooks).unwrap();
        assert_eq!((decoded.summary.frames, decoded.loss_count), (5, losses.len() as u64));
        assert!(!decoded.summary.complete);
        let table = fs::read_to_string(seen.join("losses.csv")).unwrap();
        assert!(table.contains("time,3,,,,\n"), "{table}");
    }
}

#[test]
fn the_first_time_may_be_any() {
    let sent = sent();
    let layout_time = |number: u64| (1 << 63) + 33_333 * number;
    let forged: Vec<u8> = (0..)
        .zip(&sent)
        .flat_map(|(number, frame)| with_word(frame, TIME, layout_time(number)))
        .collect();
    let (frames, losses, _) = receive(&forged);
    assert!(losses.is_empty(), "{losses:?}");
    let times: Vec<u64> = frames.iter().map(|frame| frame.time_us.unwrap()).collect();
    assert_eq!(times, [0, 33_333, 66_666, 99_999, 133_332]);
}

#[test]
fn a_frame_of_another_camera_on_the_way_costs_no_more_than_itself() {
    let sent = sent();
    let mut forged = sent.clone();
    forged[2] = with_word(&sent[2], FINGERPRINT, 0x0123_4567_89AB_CDEF);
    let folder = tempfile::tempdir().unwrap();
    let seen = folder.path().join("seen");
    let decoded = decode(&forged.concat(), &seen, &SilentHooks).unwrap();
    assert_eq!((decoded.summary.frames, decoded.summary.complete), (4, false));
    let table = fs::read_to_string(seen.join("losses.csv")).unwrap();
    assert_eq!(table.lines().skip(1).collect::<Vec<_>>(), ["foreign,2,,,,", "frames,2,,,1,"]);
    // The first FRAME packet decides whether the configuration is that of the camera.
    let mut forged = sent;
    forged[0] = with_word(&forged[0], FINGERPRINT, 0x0123_4567_89AB_CDEF);
    let refused = decode(&forged.concat(), &folder.path().join("none"), &SilentHooks).unwrap_err();
    assert!(refused.to_string().contains("0123456789abcdef"), "{refused}");
}

#[test]
fn a_stream_alone_asks_for_no_more_memory_than_8k_video() {
    for (width, height) in [(16_384u32, 16_384u32), (16_384, 2049), (2049, 16_384)] {
        assert!(u64::from(width) * u64::from(height) > u64::from(MAX_CLAIMED_PIXELS));
        let given = [format!("frame.width={width}"), format!("frame.height={height}")];
        let own: Vec<&str> = given.iter().map(String::as_str).chain(["region.size=64"]).collect();
        let design = config(&own).validate().unwrap();
        let mut bytes = Vec::new();
        packet_encoding::append_frame(
            &mut bytes,
            &PacketLayout::new(&design, false, 1_000_000).unwrap(),
            0,
            (0, true),
        );
        let refusal = |overrides: &[&str]| {
            let mut stream = PacketStream::new(&config(overrides));
            stream.feed(&bytes);
            stream.receive().err().map(|error| error.to_string())
        };
        let message = refusal(&["region.size=64"]).unwrap();
        let size = format!("{width}x{height}");
        assert!(message.contains(&size) && message.contains("frame.width"), "{message}");
        // One side alone does not give the size.
        assert!(refusal(&[own[0], "region.size=64"]).is_some());
        if width > height {
            assert_eq!(refusal(&own), None, "the user's own size is refused");
        }
    }
    // Sizes that no camera has are refused, too.
    let sent = sent();
    for size in [0, u64::MAX << 32 | 1_000_000, 0xFFFF_0001 << 32 | 1_000_000] {
        let mut stream = PacketStream::new(&DesignConfig::default());
        stream.feed(&with_word(&sent[0], SIZE, size));
        assert!(!matches!(stream.receive(), Ok(Some(_))), "{size:#x}");
    }
}

#[test]
fn decoding_is_stopped_between_frames_that_cost_few_bytes() {
    let sent = sent();
    let design = config(DESIGNS[0]).validate_for_frames(45, 38).unwrap();
    let layout = PacketLayout::new(&design, false, 1_000_000).unwrap();
    // The first bytes that are read at once contain many frames.
    let mut bytes = sent[0].clone();
    for number in 1..500 {
        packet_encoding::append_frame(&mut bytes, &layout, number, (u64::from(number), false));
    }
    let folder = tempfile::tempdir().unwrap();
    let hooks = RecordingHooks::cancelling_after(1);
    let decoded = decode(&bytes, &folder.path().join("seen"), &hooks).unwrap();
    assert_eq!(decoded.summary.problem.as_deref(), Some("interrupted"));
    assert_eq!(decoded.summary.frames, 1);
}

/// Returns the number of cases, which `FOVEATE_FUZZ_CASES` can increase.
fn cases() -> u64 {
    std::env::var("FOVEATE_FUZZ_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(300)
}

#[test]
fn fuzz_any_numbers_in_any_packets_end_nothing() {
    let sent = sent();
    let last = receive(&sent.concat()).0.pop().unwrap();
    for seed in 0..cases() {
        let mut rng = Rng::with_seed(seed);
        let mut forged = sent[..3].concat();
        for _ in 0..rng.usize(1..8) {
            forge(&mut rng, &mut forged);
        }
        forged.extend(sent[3..].concat());
        let (frames, losses, _) = receive(&forged);
        let times: Vec<u64> = frames.iter().filter_map(|frame| frame.time_us).collect();
        assert!(times.is_sorted(), "seed {seed}: {times:?}");
        assert!(times.windows(2).all(|pair| pair[1] - pair[0] <= 86_400_000_000), "seed {seed}");
        // If the FRAME packet that begins a run is forged, it may give another unit of time. The
        // following frames are refused then.
        if let Some(shown) = frames.iter().rfind(|frame| frame.number == 4) {
            assert!(shown.outcome.srs == last.outcome.srs, "seed {seed}: {losses:?}");
        } else {
            assert!(frames.iter().all(|frame| frame.number != 3), "seed {seed}: {losses:?}");
        }
    }
}

/// Writes a random number into a packet of a stream, and corrects its checksum.
fn forge(rng: &mut Rng, bytes: &mut [u8]) {
    let mut starts = vec![0];
    while let Some(at) = starts.last().copied().filter(|&at| at + 4 <= bytes.len()) {
        let words = u16::from_le_bytes([bytes[at + 2], bytes[at + 3]]);
        if words < 3 || at + 8 * usize::from(words) >= bytes.len() {
            break;
        }
        starts.push(at + 8 * usize::from(words));
    }
    let at = *rng.choice(&starts).unwrap();
    let end =
        (at + 8 * usize::from(u16::from_le_bytes([bytes[at + 2], bytes[at + 3]]))).min(bytes.len());
    if end < at + 24 {
        return;
    }
    let place = rng.usize(at..end - 12);
    let odd = match rng.u8(0..4) {
        0 => u64::MAX,
        1 => 1 << rng.u32(0..64),
        2 => 0,
        _ => rng.u64(..),
    };
    let length = rng.usize(1..=8);
    bytes[place..place + length].copy_from_slice(&odd.to_le_bytes()[..length]);
    let check = crc(&bytes[at..end - 4]);
    bytes[end - 4..end].copy_from_slice(&check.to_le_bytes());
}
