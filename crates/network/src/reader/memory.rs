// SPDX-License-Identifier: MIT OR Apache-2.0
//! An upper bound of the memory for the messages of a file. An empty message has two bytes in a
//! file and hundreds in memory, so a small file could ask for all the memory of a machine.

use crate::onnx::{AttributeProto, NodeProto, TensorProto};
use prost::decode_length_delimiter as varint;

/// The bytes in memory of a field: three times those of the largest message, because a list that
/// grows holds its old values next to twice as many new ones.
const FIELD_BYTES: u64 = 1280;

const fn fits_in_field(bytes: usize) -> bool {
    3 * bytes as u64 <= FIELD_BYTES
}

const _: () = assert!(
    fits_in_field(size_of::<AttributeProto>())
        && fits_in_field(size_of::<NodeProto>())
        && fits_in_field(size_of::<TensorProto>())
);

/// The bytes in memory for each byte of a list of integers in the file. An integer may have one
/// byte there and has eight in memory, in a list that grows to three times this size.
const BYTES_PER_INTEGER_BYTE: u64 = 24;

/// The bytes in memory for each byte of a list of floating-point values in the file. They have as
/// many bytes in memory, in a list that grows to three times this size.
const BYTES_PER_FLOAT_BYTE: u64 = 3;

/// A message that holds other messages or lists.
#[derive(Clone, Copy)]
enum MessageKind {
    Model,
    Function,
    Graph,
    Node,
    Attribute,
    Tensor,
    Value,
    Type,
    TensorType,
    Shape,
}

/// The content of a field that has a length.
enum FieldContent {
    Message(MessageKind),
    /// Data that take this many bytes in memory for each byte in the file.
    Bytes(u64),
}

/// Returns the content of a field. Field numbers are those of the messages in `onnx`.
fn field_content(kind: MessageKind, field: usize) -> FieldContent {
    match (kind, field) {
        (MessageKind::Model, 7) => FieldContent::Message(MessageKind::Graph),
        (MessageKind::Model, 25) => FieldContent::Message(MessageKind::Function),
        (MessageKind::Graph, 1) => FieldContent::Message(MessageKind::Node),
        (MessageKind::Graph | MessageKind::Attribute, 5) => {
            FieldContent::Message(MessageKind::Tensor)
        }
        (MessageKind::Graph, 11 | 12) => FieldContent::Message(MessageKind::Value),
        (MessageKind::Node, 5) => FieldContent::Message(MessageKind::Attribute),
        (MessageKind::Value, 2) => FieldContent::Message(MessageKind::Type),
        (MessageKind::Type, 1) => FieldContent::Message(MessageKind::TensorType),
        (MessageKind::TensorType, 2) => FieldContent::Message(MessageKind::Shape),
        (MessageKind::Attribute, 8) | (MessageKind::Tensor, 1 | 5 | 7) => {
            FieldContent::Bytes(BYTES_PER_INTEGER_BYTE)
        }
        (MessageKind::Attribute, 7) | (MessageKind::Tensor, 4 | 10) => {
            FieldContent::Bytes(BYTES_PER_FLOAT_BYTE)
        }
        _ => FieldContent::Bytes(1),
    }
}

/// Returns the largest number of bytes that the model in a file takes in memory. The count ends at
/// damaged data, because decoding ends there, too.
pub(super) fn model_memory(bytes: &[u8]) -> u64 {
    let mut sum = 0;
    // Data behind the damage are not decoded, so the result is ignored.
    let _ = add_message(&mut sum, MessageKind::Model, bytes);
    sum
}

/// Adds the memory of a message, or returns `None` if the message is damaged.
fn add_message(sum: &mut u64, kind: MessageKind, mut bytes: &[u8]) -> Option<()> {
    while !bytes.is_empty() {
        let key = varint(&mut bytes).ok()?;
        *sum += FIELD_BYTES;
        // Groups are not used by ONNX; their fields are counted as fields of the message that
        // contains them.
        let length = match key % 8 {
            0 => varint(&mut bytes).map(|_| 0).ok()?,
            1 => 8,
            2 => varint(&mut bytes).ok()?,
            5 => 4,
            _ => 0,
        };
        let (content, rest) = bytes.split_at_checked(length)?;
        bytes = rest;
        match field_content(kind, key / 8) {
            FieldContent::Message(inner) if key % 8 == 2 => add_message(sum, inner, content)?,
            FieldContent::Message(_) => {}
            FieldContent::Bytes(each) => *sum += each * content.len() as u64,
        }
    }
    Some(())
}
