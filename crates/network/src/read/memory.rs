// SPDX-License-Identifier: MIT OR Apache-2.0
//! An upper bound of the memory for the messages of a file. An empty message has two bytes in a
//! file and hundreds in memory, so a small file could ask for all the memory of a machine.

use crate::onnx::{AttributeProto, NodeProto, TensorProto};
use prost::decode_length_delimiter as varint;

/// The bytes in memory of a field: three times those of the largest message, because a list that
/// grows holds its old values next to twice as many new ones.
const FIELD: u64 = 1280;
const fn fits(bytes: usize) -> bool {
    3 * bytes as u64 <= FIELD
}
const _: () = assert!(
    fits(size_of::<AttributeProto>())
        && fits(size_of::<NodeProto>())
        && fits(size_of::<TensorProto>())
);
/// The bytes in memory for each byte of a list of integers in the file. An integer may have one
/// byte there and has eight in memory, in a list that grows to three times this size.
const INTEGERS: u64 = 24;
/// The bytes in memory for each byte of a list of floating-point values in the file. They have as
/// many bytes in memory, in a list that grows to three times this size.
const REALS: u64 = 3;

/// A message that holds other messages or lists.
#[derive(Clone, Copy)]
enum Kind {
    Model,
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
enum Holds {
    Message(Kind),
    /// Data that take this many bytes in memory for each byte in the file.
    Bytes(u64),
}

/// Returns the content of a field. Field numbers are those of the messages in `onnx`.
fn holds(kind: Kind, field: usize) -> Holds {
    match (kind, field) {
        (Kind::Model, 7) => Holds::Message(Kind::Graph),
        (Kind::Graph, 1) => Holds::Message(Kind::Node),
        (Kind::Graph | Kind::Attribute, 5) => Holds::Message(Kind::Tensor),
        (Kind::Graph, 11 | 12) => Holds::Message(Kind::Value),
        (Kind::Node, 5) => Holds::Message(Kind::Attribute),
        (Kind::Value, 2) => Holds::Message(Kind::Type),
        (Kind::Type, 1) => Holds::Message(Kind::TensorType),
        (Kind::TensorType, 2) => Holds::Message(Kind::Shape),
        (Kind::Attribute, 8) | (Kind::Tensor, 1 | 5 | 7) => Holds::Bytes(INTEGERS),
        (Kind::Attribute, 7) | (Kind::Tensor, 4 | 10) => Holds::Bytes(REALS),
        _ => Holds::Bytes(1),
    }
}

/// Returns the largest number of bytes that the model in a file takes in memory. The count ends at
/// damaged data, because decoding ends there, too.
pub(super) fn of_model(bytes: &[u8]) -> u64 {
    let mut sum = 0;
    // Data behind the damage are not decoded, so the result is ignored.
    let _ = add(&mut sum, Kind::Model, bytes);
    sum
}

/// Adds the memory of a message, or returns `None` if the message is damaged.
fn add(sum: &mut u64, kind: Kind, mut bytes: &[u8]) -> Option<()> {
    while !bytes.is_empty() {
        let key = varint(&mut bytes).ok()?;
        *sum += FIELD;
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
        match holds(kind, key / 8) {
            Holds::Message(inner) if key % 8 == 2 => add(sum, inner, content)?,
            Holds::Message(_) => {}
            Holds::Bytes(each) => *sum += each * content.len() as u64,
        }
    }
    Some(())
}
