// SPDX-License-Identifier: MIT OR Apache-2.0
//! Configuration, validation and every derived number of a Foveate design
