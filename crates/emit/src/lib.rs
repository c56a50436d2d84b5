// SPDX-License-Identifier: MIT OR Apache-2.0
//! Verilog and everything beside it for a Foveate design
