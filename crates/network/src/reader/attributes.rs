// SPDX-License-Identifier: MIT OR Apache-2.0
//! The attributes of a node, with a record of which were read.

use crate::onnx::{AttributeProto, NodeProto};
use std::cell::RefCell;

/// The attributes of a node. An attribute that no reader asks for may change what the node
/// computes, so each access is recorded.
pub(super) struct NodeAttributes<'a> {
    node: &'a NodeProto,
    /// True for each attribute that was read, in the order of the node.
    was_read: RefCell<Vec<bool>>,
}

impl<'a> NodeAttributes<'a> {
    pub(super) fn new(node: &'a NodeProto) -> Self {
        Self { node, was_read: RefCell::new(vec![false; node.attribute.len()]) }
    }

    pub(super) fn node(&self) -> &'a NodeProto {
        self.node
    }

    /// Returns an attribute by its name, and records it as read.
    pub(super) fn get(&self, name: &str) -> Option<&'a AttributeProto> {
        let at = self
            .node
            .attribute
            .iter()
            .position(|attribute| attribute.name.as_deref() == Some(name))?;
        self.was_read.borrow_mut()[at] = true;
        Some(&self.node.attribute[at])
    }

    /// Returns the attributes that were not read.
    pub(super) fn unread(&self) -> impl Iterator<Item = &'a AttributeProto> {
        let read = self.was_read.borrow().clone();
        self.node
            .attribute
            .iter()
            .zip(read)
            .filter(|(_, read)| !read)
            .map(|(attribute, _)| attribute)
    }
}
