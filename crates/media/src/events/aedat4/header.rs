// SPDX-License-Identifier: MIT OR Apache-2.0
//! The header of a file ([`Aedat4Header`]): the line of its format, and a flatbuffer with the
//! compression, the place of the table of packets, and the streams. The streams are XML with
//! their content and the size of the sensor ([`StreamInfo`]).

use super::event_packet::{EVENTS_IDENTIFIER, PacketCompression};
use super::flat_table::{FlatTable, LENGTH_BYTES};
use crate::events::frame_size::check_frame_size;
use crate::events::{EventFileError, EventFormat};
use flatbuffers::{FlatBufferBuilder, InvalidFlatbuffer, field_index_to_field_offset};
use roxmltree::{Document, Node};
use std::io::{BufRead, Read as _};

/// The first byte of a file.
pub(crate) const HEADER_START: u8 = FORMAT_LINE[0];
/// The line that a file begins with.
const FORMAT_LINE: &[u8; 14] = b"#!AER-DAT4.0\r\n";
/// The largest header in bytes, without its line.
const MAX_HEADER_BYTES: u32 = 1 << 20;
const HEADER_IDENTIFIER: &str = "IOHE";
/// The fields of a header.
const COMPRESSION: u16 = 0;
const TABLE_PLACE: u16 = 1;
const STREAMS: u16 = 2;
/// The number of the compression with LZ4.
const LZ4: i32 = 1;
/// The place of the table in a file without one.
const NO_TABLE: i64 = -1;

/// The facts of a header that a reader needs.
#[derive(Clone, Debug)]
pub(super) struct Aedat4Header {
    pub(super) compression: PacketCompression,
    /// The place of the table of packets, which ends the packets, in bytes from 0.
    pub(super) table_at: Option<u64>,
    /// The streams of the file; none if the header does not name them.
    pub(super) streams: Vec<StreamInfo>,
    /// The length of the header in bytes.
    pub(super) bytes: u64,
}

/// Returns the header of a file for a sensor of `size` (width, height) pixels.
pub(super) fn header_bytes(size: (u32, u32)) -> Vec<u8> {
    let mut builder = FlatBufferBuilder::new();
    let streams = builder.create_string(&stream_info_text(size));
    let table = builder.start_table();
    builder.push_slot_always(field_index_to_field_offset(TABLE_PLACE), NO_TABLE);
    builder.push_slot_always(field_index_to_field_offset(STREAMS), streams);
    builder.push_slot_always(field_index_to_field_offset(COMPRESSION), LZ4);
    let table = builder.end_table(table);
    builder.finish_size_prefixed(table, Some(HEADER_IDENTIFIER));
    [FORMAT_LINE.as_slice(), builder.finished_data()].concat()
}

impl Aedat4Header {
    pub(super) fn read(input: &mut impl BufRead) -> Result<Self, EventFileError> {
        let content = read_content(input)?;
        let table = FlatTable::new(&content).filter(|table| {
            table.identifier().is_some_and(|found| found == *HEADER_IDENTIFIER.as_bytes())
        });
        let table = table
            .ok_or_else(|| problem("the header has no part `IOHE`; the file may be damaged"))?;
        let header = Self::of_table(table, (FORMAT_LINE.len() + content.len()) as u64)?;
        for size in header.streams.iter().filter_map(|stream| stream.size) {
            check_frame_size(EventFormat::Aedat4, size)?;
        }
        Ok(header)
    }

    fn of_table(table: FlatTable<'_>, bytes: u64) -> Result<Self, EventFileError> {
        let damaged = |error: InvalidFlatbuffer| {
            // Further lines say where the library found it.
            let first = error.to_string().lines().next().unwrap_or_default().to_owned();
            problem(format!("the header is damaged: {first}"))
        };
        let number = table.scalar(COMPRESSION).map_err(damaged)?.map_or(0, i32::from_le_bytes);
        let compression = PacketCompression::from_number(number).ok_or_else(|| {
            problem(format!("the packets have compression {number}, and only 0 to 4 are known: none, LZ4, Zstandard"))
        })?;
        let place =
            table.scalar(TABLE_PLACE).map_err(damaged)?.map_or(NO_TABLE, i64::from_le_bytes);
        let text = table.vector(STREAMS, 1).map_err(damaged)?.unwrap_or_default();
        let text = String::from_utf8_lossy(text);
        let streams = if text.trim().is_empty() { Ok(Vec::new()) } else { streams_of_text(&text) };
        Ok(Self {
            compression,
            table_at: u64::try_from(place).ok(),
            streams: streams.map_err(problem)?,
            bytes,
        })
    }
}

/// Returns the part of a header behind the line of the format, with the length that it begins with.
fn read_content(input: &mut impl BufRead) -> Result<Vec<u8>, EventFileError> {
    let mut line = Vec::new();
    input.by_ref().take(FORMAT_LINE.len() as u64).read_to_end(&mut line)?;
    if line != FORMAT_LINE {
        let found = String::from_utf8_lossy(&line).trim().to_owned();
        return Err(problem(format!(
            "the file begins with `{found}`, and only `#!AER-DAT4.0` can be read"
        )));
    }
    let mut content = Vec::new();
    input.by_ref().take(LENGTH_BYTES as u64).read_to_end(&mut content)?;
    let length = content.first_chunk().copied().map_or(0, u32::from_le_bytes);
    if length > MAX_HEADER_BYTES {
        return Err(problem(format!(
            "the header states {length} bytes, and has at most {MAX_HEADER_BYTES}; the file may be damaged"
        )));
    }
    input.by_ref().take(length.into()).read_to_end(&mut content)?;
    Ok(content)
}

fn problem(problem: impl Into<String>) -> EventFileError {
    EventFileError::Header { problem: problem.into() }
}

/// The stream of the events in the files that are written.
pub(super) const EVENT_STREAM: i32 = 0;

/// A stream of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct StreamInfo {
    pub(super) number: i32,
    /// The identifier of its packets.
    pub(super) identifier: String,
    /// The width and height of the sensor in pixels, if they are known.
    pub(super) size: Option<(u32, u32)>,
}

impl StreamInfo {
    pub(super) fn has_events(&self) -> bool {
        self.identifier == EVENTS_IDENTIFIER
    }
}

/// Returns the XML of a file with one stream of events. Readers of iniVation find a stream by its
/// output name.
pub(super) fn stream_info_text((width, height): (u32, u32)) -> String {
    let text =
        |key: &str, value: &str| format!("<attr key=\"{key}\" type=\"string\">{value}</attr>\n");
    let number =
        |key: &str, value: u32| format!("<attr key=\"{key}\" type=\"int\">{value}</attr>\n");
    let stream = [
        text("compression", "LZ4"),
        text("originalModuleName", "foveate"),
        text("originalOutputName", "events"),
        text("typeDescription", "Array of events (polarity ON/OFF)."),
        text("typeIdentifier", EVENTS_IDENTIFIER),
    ]
    .concat();
    let sensor =
        [number("sizeX", width), number("sizeY", height), text("source", "foveate")].concat();
    format!(
        "<dv version=\"2.0\">\n<node name=\"outInfo\" path=\"/mainloop/Recorder/outInfo/\">\n\
         <node name=\"{EVENT_STREAM}\" path=\"/mainloop/Recorder/outInfo/{EVENT_STREAM}/\">\n{stream}\
         <node name=\"info\" path=\"/mainloop/Recorder/outInfo/{EVENT_STREAM}/info/\">\n{sensor}</node>\n\
         </node>\n</node>\n</dv>\n"
    )
}

/// Returns the streams that a text names. Returns the problem if the text is damaged.
pub(super) fn streams_of_text(text: &str) -> Result<Vec<StreamInfo>, String> {
    let document = Document::parse(text).map_err(|error| {
        format!("the header describes its streams in XML, which is damaged: {error}")
    })?;
    let streams = named_child(document.root_element(), "outInfo");
    let streams = streams.into_iter().flat_map(|streams| streams.children());
    Ok(streams.filter_map(stream_of_node).collect())
}

/// Returns the stream of a node; `None` if it has no number or no identifier.
fn stream_of_node(node: Node<'_, '_>) -> Option<StreamInfo> {
    let number = node.attribute("name")?.parse().ok()?;
    let identifier = attribute_text(node, "typeIdentifier")?.to_owned();
    let info = named_child(node, "info");
    let side = |key| attribute_text(info?, key)?.trim().parse().ok().filter(|&side: &u32| side > 0);
    Some(StreamInfo { number, identifier, size: side("sizeX").zip(side("sizeY")) })
}

fn named_child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children()
        .find(|child| child.has_tag_name("node") && child.attribute("name") == Some(name))
}

fn attribute_text<'a>(node: Node<'a, 'a>, key: &str) -> Option<&'a str> {
    node.children()
        .find(|child| child.has_tag_name("attr") && child.attribute("key") == Some(key))?
        .text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_those_that_were_written() {
        let events = StreamInfo {
            number: EVENT_STREAM,
            identifier: EVENTS_IDENTIFIER.to_owned(),
            size: Some((640, 480)),
        };
        assert_eq!(streams_of_text(&stream_info_text((640, 480))), Ok(vec![events]));
    }

    #[test]
    fn other_texts_have_less() {
        assert_eq!(streams_of_text("<dv version=\"2.0\"></dv>"), Ok(Vec::new()));
        let nodes = "<dv><node name=\"outInfo\"><node name=\"3\"><attr key=\"typeIdentifier\">IMUS</attr></node>\
                     <node name=\"x\"/></node></dv>";
        let found = streams_of_text(nodes).unwrap();
        assert_eq!((found.len(), found[0].number, found[0].size), (1, 3, None));
        assert!(!found[0].has_events());
        for damaged in ["", "<dv>", "<dv><node></dv>"] {
            assert!(streams_of_text(damaged).unwrap_err().contains("damaged"), "{damaged}");
        }
        // Levels take no room on the stack.
        assert!(streams_of_text(&"<a>".repeat(1 << 18)).is_err());
    }
}
