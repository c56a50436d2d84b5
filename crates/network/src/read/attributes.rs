// SPDX-License-Identifier: MIT OR Apache-2.0
//! The attributes of a node, and which of them were looked at.

use crate::onnx::{AttributeProto, NodeProto};
use std::cell::RefCell;

/// The attributes of a node. One that nobody looks at may mean something that is not computed, so each look is noted.
pub(super) struct NodeAttributes<'a> {
    node: &'a NodeProto,
    /// Which were looked at, in the order of the node.
    read: RefCell<Vec<bool>>,
}

impl<'a> NodeAttributes<'a> {
    pub(super) fn of(node: &'a NodeProto) -> Self {
        Self { node, read: RefCell::new(vec![false; node.attribute.len()]) }
    }

    pub(super) fn node(&self) -> &'a NodeProto {
        self.node
    }

    /// An attribute by its name, which counts as looked at.
    pub(super) fn get(&self, name: &str) -> Option<&'a AttributeProto> {
        let at = self.node.attribute.iter().position(|own| own.name.as_deref() == Some(name))?;
        self.read.borrow_mut()[at] = true;
        Some(&self.node.attribute[at])
    }

    /// The attributes that nobody has looked at.
    pub(super) fn not_read(&self) -> impl Iterator<Item = &'a AttributeProto> {
        let read = self.read.borrow().clone();
        self.node.attribute.iter().zip(read).filter(|(_, read)| !read).map(|(own, _)| own)
    }
}
