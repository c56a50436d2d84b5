// SPDX-License-Identifier: MIT OR Apache-2.0
//! A reader of the hierarchy that Verilator writes as XML: modules, parameters, and the connections
//! in the top.

use super::array_instance::{ArrayInstance, ConnectionToken, PortConnection};
use super::{Elaboration, ModuleVariant};
use crate::error::CosimError;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::io::BufRead;

#[derive(Default)]
struct XmlReaderState {
    elaboration: Elaboration,
    module: Option<ModuleVariant>,
    is_top: bool,
    /// The parameter whose value comes next.
    parameter: Option<String>,
    instance: Option<ArrayInstance>,
    /// The current port of the tile, and the tokens of its expression.
    port: Option<(String, Vec<ConnectionToken>)>,
}

/// Reads the whole text; `top` is the module whose instances are kept.
pub(super) fn read(text: impl BufRead, top: &str) -> Result<Elaboration, CosimError> {
    let mut reader = Reader::from_reader(text);
    let (mut place, mut buffer) = (XmlReaderState::default(), Vec::new());
    loop {
        match reader.read_event_into(&mut buffer) {
            Ok(Event::Start(tag)) => place.begin_element(&tag, top),
            Ok(Event::Empty(tag)) => {
                place.begin_element(&tag, top);
                place.end_element(tag.name().as_ref());
            }
            Ok(Event::End(tag)) => place.end_element(tag.name().as_ref()),
            Ok(Event::Eof) => return Ok(place.elaboration),
            Ok(_) => {}
            Err(error) => return Err(CosimError::UnreadableHierarchy { why: error.to_string() }),
        }
        buffer.clear();
    }
}

impl XmlReaderState {
    fn begin_element(&mut self, tag: &BytesStart<'_>, top: &str) {
        let name = tag.name();
        match name.as_ref() {
            b"module" => {
                let module = attribute_value(tag, "origName").unwrap_or_default();
                self.is_top = module == top && attribute_value(tag, "topModule").is_some();
                self.module = Some(ModuleVariant { module, ..ModuleVariant::default() });
            }
            b"var" if attribute_value(tag, "param").is_some() => {
                self.parameter = attribute_value(tag, "name");
            }
            b"const" => {
                let number = attribute_value(tag, "name").unwrap_or_default();
                if let (Some(module), Some(name)) = (&mut self.module, self.parameter.take()) {
                    module.parameters.insert(name, digits(&number));
                } else {
                    self.connect(ConnectionToken::Number(digits(&number)));
                }
            }
            b"instance" if self.is_top => {
                let module = attribute_value(tag, "defName").unwrap_or_default();
                self.instance = Some(ArrayInstance { module, ports: Vec::new() });
            }
            b"port" if self.instance.is_some() => {
                self.port = attribute_value(tag, "name").map(|name| (name, Vec::new()));
            }
            b"sel" => self.connect(ConnectionToken::Select),
            b"varref" => self
                .connect(ConnectionToken::Signal(attribute_value(tag, "name").unwrap_or_default())),
            _ => self.connect(ConnectionToken::Other),
        }
    }

    fn connect(&mut self, token: ConnectionToken) {
        if let Some((_, tokens)) = &mut self.port {
            tokens.push(token);
        }
    }

    fn end_element(&mut self, name: &[u8]) {
        match name {
            b"module" => self.elaboration.variants.extend(self.module.take()),
            b"var" => self.parameter = None,
            b"instance" => self.elaboration.instances.extend(self.instance.take()),
            b"port" => {
                if let (Some(tile), Some((port, tokens))) = (&mut self.instance, self.port.take()) {
                    tile.ports.push((port, PortConnection::from_tokens(&tokens)));
                }
            }
            _ => {}
        }
    }
}

fn attribute_value(tag: &BytesStart<'_>, name: &str) -> Option<String> {
    let attribute = tag.try_get_attribute(name).ok().flatten()?;
    let text = String::from_utf8_lossy(&attribute.value).into_owned();
    Some(text.replace("&apos;", "'").replace("&quot;", "\"").replace("&amp;", "&"))
}

/// Returns the digits of a number such as `32'sh1f`; any other text is returned as it is.
fn digits(number: &str) -> String {
    let digits = number.split_once('\'').map_or(number, |(_, rest)| rest);
    let digits = digits.trim_start_matches('s').strip_prefix('h').unwrap_or(digits);
    let short = digits.trim_start_matches('0');
    if short.is_empty() { "0".to_owned() } else { short.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"<?xml version="1.0"?><verilator_xml><netlist>
        <module name="rcm" origName="rcm" topModule="1">
          <var name="COLUMNS" param="true"><const name="32&apos;sh1c"/></var>
          <var name="REGION" localparam="true"><const name="32&apos;h3"/></var>
          <begin><instance name="u_rpu" defName="rpu" origName="u_rpu">
            <port name="clk_i" direction="in"><varref name="clk_i"/></port>
            <port name="pixel_i" direction="in"><sel>
              <varref name="pixel_i"/><const name="15&apos;h18"/><const name="32&apos;sh8"/>
            </sel></port>
            <port name="border_i" direction="in"><const name="4&apos;h0"/></port>
            <port name="odd_i" direction="in"><not><varref name="pixel_i"/></not></port>
          </instance></begin>
        </module>
        <module name="memory__W8" origName="memory">
          <var name="WIDTH" param="true"><const name="32&apos;h00000008"/></var>
          <var name="STYLE" param="true"><const name="&quot;block&quot;"/></var>
        </module></netlist></verilator_xml>"#;

    #[test]
    fn modules_parameters_and_connections_are_read() {
        let Elaboration { variants, instances: tiles } = read(TEXT.as_bytes(), "rcm").unwrap();
        let said: Vec<String> = variants.iter().map(|v| format!("{v:?}")).collect();
        assert_eq!(said.len(), 2, "{said:?}");
        let memory = variants.iter().find(|variant| variant.module == "memory").unwrap();
        assert_eq!(memory.parameters["WIDTH"], "8");
        assert_eq!(memory.parameters["STYLE"], "\"block\"");
        let rcm = variants.iter().find(|variant| variant.module == "rcm").unwrap();
        assert_eq!(rcm.parameters.len(), 1, "no localparam: {rcm:?}");
        assert_eq!(tiles.len(), 1);
        let ports: Vec<_> = tiles[0].ports.iter().map(|(_, connection)| connection).collect();
        let part = PortConnection::Bits { signal: "pixel_i".to_owned(), from: 0x18, width: 8 };
        let all = PortConnection::WholeSignal("clk_i".to_owned());
        assert_eq!(ports, [&all, &part, &PortConnection::Constant(0), &PortConnection::Other]);
    }

    #[test]
    fn a_text_that_is_no_hierarchy_is_an_error() {
        assert!(read("<a></b>".as_bytes(), "rcm").is_err());
    }
}
