// SPDX-License-Identifier: MIT OR Apache-2.0
//! The foveate command.

fn main() {}
