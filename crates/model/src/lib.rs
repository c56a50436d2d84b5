// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an RPU computes, and when: the bit-accurate models of a Foveate design
