// SPDX-License-Identifier: MIT OR Apache-2.0
//! What it takes at most to hold the messages of a file. An empty message has two bytes in a file and hundreds in memory, so a small file could
//! ask for all the memory of a machine.

use crate::onnx::{AttributeProto, NodeProto, TensorProto};
use prost::decode_length_delimiter as varint;

/// Bytes in memory of a field: of the largest message, in a list that grows to twice its length beside what it had.
const FIELD: u64 = 1280;
const fn fits(bytes: usize) -> bool {
    3 * bytes as u64 <= FIELD
}
const _: () = assert!(
    fits(size_of::<AttributeProto>())
        && fits(size_of::<NodeProto>())
        && fits(size_of::<TensorProto>())
);
/// Bytes in memory for each of a list of integers, which may have one in the file: eight, in a list that grows.
const INTEGERS: u64 = 24;
/// The same for values that have as many bytes in the file.
const REALS: u64 = 3;

/// A message that holds others, or lists.
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

/// What a field with a length holds.
enum Holds {
    Message(Kind),
    /// So many bytes in memory for each in the file.
    Bytes(u64),
}

/// What a field holds; its number is that in `onnx`.
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

/// Bytes that the model in a file takes at most in memory. What is damaged ends the count, as it ends the reading.
pub(super) fn of_model(bytes: &[u8]) -> u64 {
    let mut sum = 0;
    // Nothing stands behind damage, so what is left does not matter.
    let _ = add(&mut sum, Kind::Model, bytes);
    sum
}

/// Adds what a message takes; nothing if it is damaged.
fn add(sum: &mut u64, kind: Kind, mut bytes: &[u8]) -> Option<()> {
    while !bytes.is_empty() {
        let key = varint(&mut bytes).ok()?;
        *sum += FIELD;
        // The fields of a group, which nothing here has, are counted as those of the message around it.
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
