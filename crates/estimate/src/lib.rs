// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area of a Foveate design from Yosys, beside the paper's table
