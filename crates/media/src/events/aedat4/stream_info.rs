// SPDX-License-Identifier: MIT OR Apache-2.0
//! The XML of a header: the streams of a file, their content, and the size of the sensor.

use roxmltree::{Document, Node};

use super::event_packet::EVENTS_IDENTIFIER;

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

/// Returns the XML of a file with one stream of events. Readers of iniVation find a stream by its output name.
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
