// SPDX-License-Identifier: MIT OR Apache-2.0
//! AEDAT4: the bytes are those of the format's definition, files of other writers are read, and
//! damaged files end with an error.

use crate::{event, file, read, round_trip};
use flatbuffers::{FlatBufferBuilder, field_index_to_field_offset as slot};
use foveate_media::{EventEncoder, EventFormat, EventReader, PixelEvent};
use proptest::prelude::*;

const FORMAT: EventFormat = EventFormat::Aedat4;
const LINE: &[u8] = b"#!AER-DAT4.0\r\n";

/// Streams of a camera with frames, in the order of a header, and the events in the third one.
const CAMERA: &str = "<dv version=\"2.0\"><node name=\"outInfo\" path=\"/\">\
     <node name=\"0\" path=\"/\"><attr key=\"typeIdentifier\" type=\"string\">FRME</attr></node>\
     <node name=\"1\" path=\"/\"><attr key=\"typeIdentifier\" type=\"string\">TRIG</attr></node>\
     <node name=\"2\" path=\"/\"><attr key=\"typeIdentifier\" type=\"string\">EVTS</attr>\
     <node name=\"info\" path=\"/\"><attr key=\"sizeX\" type=\"int\">9</attr>\
     <attr key=\"sizeY\" type=\"int\">7</attr></node></node></node></dv>";

/// Returns the header of a file of another writer.
fn header(compression: i32, table_at: Option<i64>, streams: Option<&str>) -> Vec<u8> {
    let mut builder = FlatBufferBuilder::new();
    let streams = streams.map(|streams| builder.create_string(streams));
    let table = builder.start_table();
    // Fields with default values are left out, as other writers do.
    builder.push_slot(slot(0), compression, 0);
    if let Some(streams) = streams {
        builder.push_slot_always(slot(2), streams);
    }
    if let Some(table_at) = table_at {
        builder.push_slot_always(slot(1), table_at);
    }
    let table = builder.end_table(table);
    builder.finish_size_prefixed(table, Some("IOHE"));
    [LINE, builder.finished_data()].concat()
}

/// Returns the content of a packet of events: their times, columns, rows and polarities.
fn events_content(events: &[(i64, i16, i16, u8)]) -> Vec<u8> {
    let mut builder = FlatBufferBuilder::new();
    builder.start_vector::<i64>(2 * events.len());
    for &(time, x, y, polarity) in events.iter().rev() {
        // The bytes that pad an event have any values.
        for byte in [7, 7, 7, polarity] {
            builder.push(byte);
        }
        builder.push(y);
        builder.push(x);
        builder.push(time);
    }
    let elements = builder.end_vector::<i64>(events.len());
    let table = builder.start_table();
    builder.push_slot_always(slot(0), elements);
    let table = builder.end_table(table);
    builder.finish_size_prefixed(table, Some("EVTS"));
    builder.finished_data().to_vec()
}

fn packet(stream: i32, content: &[u8]) -> Vec<u8> {
    let length = i32::try_from(content.len()).unwrap();
    [&stream.to_le_bytes()[..], &length.to_le_bytes(), content].concat()
}

/// Returns the problem of a file.
fn problem(parts: &[&[u8]]) -> String {
    read(&parts.concat()).unwrap_err().to_string()
}

#[test]
fn bytes_are_those_of_the_definition() {
    let (header, packets) =
        file(FORMAT, (640, 480), &[event(3, 2, 65, false), event(639, 479, 1 << 40, true)]);
    assert_eq!(&header[..14], LINE);
    let length = u32::from_le_bytes(header[14..18].try_into().unwrap()) as usize;
    assert_eq!((header.len(), &header[22..26]), (18 + length, &b"IOHE"[..]));
    let text = String::from_utf8_lossy(&header);
    for words in ["\"sizeX\" type=\"int\">640<", "\"sizeY\" type=\"int\">480<", ">EVTS<", ">LZ4<"] {
        assert!(text.contains(words), "{words}");
    }
    assert_eq!(packets[..4], 0_i32.to_le_bytes());
    assert_eq!(packets[4..8], i32::try_from(packets.len() - 8).unwrap().to_le_bytes());
    let mut content = Vec::new();
    let mut frame = lz4_flex::frame::FrameDecoder::new(&packets[8..]);
    std::io::Read::read_to_end(&mut frame, &mut content).unwrap();
    // The length, the place of the root, the identifier, fields, and the vector, as iniVation's
    // library writes them.
    let start = [60_u32, 16, u32::from_le_bytes(*b"EVTS"), 6 << 16, 4 << 16 | 8, 6, 4, 2];
    let events = [65, 3 | 2 << 16, 1 << 40, 639 | 479 << 16 | 1 << 32];
    let expected: Vec<u8> = start
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .chain(events.iter().flat_map(|word: &u64| word.to_le_bytes()))
        .collect();
    assert_eq!(content, expected);
}

/// Times do not wrap, and packets have a bounded size.
#[test]
fn a_long_recording_has_all_its_times() {
    let mut events: Vec<PixelEvent> = (0..20_000_u64)
        .map(|number| event((number % 7) as u16, 1, number * 1_000_000_007, number % 3 == 0))
        .collect();
    events.push(event(6, 1, i64::MAX as u64, true));
    assert_eq!(round_trip(FORMAT, (7, 2), &events), events);
    let (mut encoder, _) = EventEncoder::new(FORMAT, (7, 2)).unwrap();
    let (mut bytes, mut largest) = (Vec::new(), 0);
    for &event in &events {
        let before = bytes.len();
        encoder.push(event, &mut bytes).unwrap();
        largest = largest.max(bytes.len() - before);
    }
    assert!((1..70_000).contains(&largest), "{largest}");
    let error = encoder.push(event(0, 0, 1 << 63, true), &mut bytes).unwrap_err().to_string();
    assert!(error.contains("9223372036854775808") && error.contains("2^63"), "{error}");
}

#[test]
fn files_of_other_writers_are_read() {
    let content = events_content(&[(5, 8, 6, 1), (4, 0, 0, 0), (1_700_000_000_000_000, 1, 2, 1)]);
    let expected =
        [event(8, 6, 5, true), event(0, 0, 4, false), event(1, 2, 1_700_000_000_000_000, true)];
    // Packets of other streams are skipped, whatever they are.
    let others = [packet(0, b"a frame"), packet(1, b""), packet(0, &[9; 300])].concat();
    let events = packet(2, &content);
    let packets = [&others[..], &events, &others].concat();
    let start = header(0, Some(0), Some(CAMERA)).len();
    let end = i64::try_from(start + packets.len()).unwrap();
    let table = b"a table of packets";
    for (header, after) in [
        (header(0, None, Some(CAMERA)), &b""[..]),
        (header(0, Some(-1), Some(CAMERA)), b""),
        (header(0, Some(end), Some(CAMERA)), table),
    ] {
        let file = [&header[..], &packets, after].concat();
        let reader = EventReader::open(file.as_slice()).unwrap();
        assert_eq!((reader.format(), reader.size()), (FORMAT, Some((9, 7))));
        assert_eq!(reader.map(Result::unwrap).collect::<Vec<_>>(), expected);
    }
    // Without names, packets with events are those with their identifier, and the size is not
    // known.
    let other = packet(0, &content[..12].iter().map(|byte| byte ^ 1).collect::<Vec<u8>>());
    for streams in [None, Some(""), Some("<dv/>")] {
        let file = [header(0, None, streams), other.clone(), events.clone()].concat();
        let reader = EventReader::open(file.as_slice()).unwrap();
        assert_eq!(reader.size(), None);
        assert_eq!(reader.map(Result::unwrap).collect::<Vec<_>>(), expected, "{streams:?}");
    }
}

#[test]
fn compressed_files_are_read() {
    let content = events_content(&[(5, 8, 6, 1)]);
    let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
    std::io::Write::write_all(&mut encoder, &content).unwrap();
    let lz4 = encoder.finish().unwrap();
    let zstd = ruzstd::encoding::compress_to_vec(
        &content[..],
        ruzstd::encoding::CompressionLevel::Fastest,
    );
    for (numbers, packed) in [([1, 2], lz4), ([3, 4], zstd)] {
        for number in numbers {
            let file = [header(number, None, Some(CAMERA)), packet(2, &packed)].concat();
            assert_eq!(read(&file).unwrap(), [event(8, 6, 5, true)], "{number}");
            for damaged in [&packed[..packed.len() - 20], b"", &content] {
                let error = problem(&[&header(number, None, Some(CAMERA)), &packet(2, damaged)]);
                assert!(
                    error.contains("at byte") && error.contains("damaged"),
                    "{number}: {error}"
                );
            }
        }
    }
}

/// A small packet whose content is beyond the limit.
#[test]
fn packets_that_unpack_to_too_much_are_refused() {
    let zeros = vec![0; (1 << 26) + 1];
    let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
    std::io::Write::write_all(&mut encoder, &zeros).unwrap();
    let packed = encoder.finish().unwrap();
    assert!(packed.len() < 1 << 20);
    let error = problem(&[&header(1, None, Some(CAMERA)), &packet(2, &packed)]);
    assert!(error.contains("67108864 bytes"), "{error}");
    // A length that is only stated takes no memory.
    let stated = [2_i32.to_le_bytes(), i32::MAX.to_le_bytes()].concat();
    let error = problem(&[&header(0, None, Some(CAMERA)), &stated]);
    assert!(error.contains("67108864 bytes"), "{error}");
}

#[test]
fn damaged_headers_end_with_an_error() {
    let whole = header(0, None, Some(CAMERA));
    let two = CAMERA.replace("TRIG", "EVTS");
    for (bytes, words) in [
        (b"#!AER-DAT3.1\r\n\0\0\0\0".to_vec(), "`#!AER-DAT3.1`"),
        (b"#!AER".to_vec(), "`#!AER`"),
        (LINE.to_vec(), "IOHE"),
        (whole[..whole.len() - 9].to_vec(), "IOHE"),
        ([LINE, &u32::MAX.to_le_bytes()].concat(), "4294967295 bytes"),
        (header(5, None, Some(CAMERA)), "compression 5"),
        (header(0, None, Some("<dv>")), "XML"),
        (header(0, None, Some(&two)), "streams 1 and 2"),
        (header(0, None, Some(&CAMERA.replace("EVTS", "IMUS"))), "FRME, TRIG, IMUS"),
        (header(0, None, Some(&CAMERA.replace(">9<", ">40000<"))), "32767x32767"),
    ] {
        let error = problem(&[&bytes]);
        assert!(error.contains(words), "{words}: {error}");
    }
}

#[test]
fn damaged_packets_end_with_an_error() {
    let header_of = |table_at| header(0, table_at, Some(CAMERA));
    let (start, good) = (header_of(None), packet(2, &events_content(&[(5, 8, 6, 1)])));
    let wrong = |content: &[(i64, i16, i16, u8)]| packet(2, &events_content(content));
    let mut less = events_content(&[(5, 8, 6, 1)]);
    // The number of events.
    less[28] = 9;
    for (packets, words) in [
        (good[..good.len() - 1].to_vec(), "cut off"),
        (good[..5].to_vec(), "cut off"),
        (packet(0, b"a frame")[..12].to_vec(), "cut off"),
        (packet(7, b""), "stream 7"),
        (packet(2, b""), "no valid events"),
        (packet(2, b"a frame that is no flatbuffer"), "no valid events"),
        (packet(2, &less), "no valid events"),
        ([2_i32.to_le_bytes(), (-5_i32).to_le_bytes()].concat(), "-5 bytes"),
        (wrong(&[(-1, 0, 0, 0)]), "time -1 us"),
        (wrong(&[(0, -3, 0, 0)]), "pixel (-3, 0)"),
        (wrong(&[(0, 9, 0, 0)]), "9x7"),
    ] {
        // The place is that of the damaged packet.
        let error = problem(&[&start, &good, &packets]);
        let at = format!("at byte {}: ", start.len() + good.len());
        assert!(error.starts_with(&at) && error.contains(words), "{words}: {error}");
    }
    let table_at = |at: usize| header_of(Some(i64::try_from(at).unwrap()));
    let start = table_at(0).len();
    let error = problem(&[&table_at(start + good.len() - 3), &good]);
    assert!(error.contains("within a packet"), "{error}");
    let error = problem(&[&table_at(start + good.len() + 3), &good]);
    assert!(error.contains("cut off"), "{error}");
    let unnamed = header(0, None, None);
    let error = problem(&[&unnamed, &good, &packet(3, &events_content(&[(5, 1, 1, 1)]))]);
    assert!(error.contains("streams 2 and 3"), "{error}");
    // After the error there are no more events.
    let bytes = [header_of(None), good.clone(), packet(2, b""), good].concat();
    let mut reader = EventReader::open(bytes.as_slice()).unwrap();
    assert!(reader.next().unwrap().is_ok() && reader.next().unwrap().is_err());
    assert!(reader.next().is_none());
}

proptest! {
    /// A file with any damage is read without a panic.
    #[test]
    fn damaged_files_are_read(
        compression in 0..5_i32,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        length in any::<prop::sample::Index>(),
    ) {
        let content = events_content(&[(5, 8, 6, 1), (7, 0, 0, 0)]);
        let packed = match compression {
            1 | 2 => {
                let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
                std::io::Write::write_all(&mut encoder, &content).unwrap();
                encoder.finish().unwrap()
            }
            3 | 4 => ruzstd::encoding::compress_to_vec(&content[..], ruzstd::encoding::CompressionLevel::Fastest),
            _ => content,
        };
        let mut bytes = [header(compression, None, Some(CAMERA)), packet(2, &packed), packet(2, &packed)].concat();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        bytes.truncate(bytes.len() - length.index(bytes.len()) / 4);
        if let Ok(events) = read(&bytes) {
            prop_assert!(events.iter().all(|event| event.x < 1 << 15 && event.y < 1 << 15));
        }
    }
}
