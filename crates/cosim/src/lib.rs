// SPDX-License-Identifier: MIT OR Apache-2.0
//! Feeds identical vectors to the model and to the RTL and compares every output at every clock
