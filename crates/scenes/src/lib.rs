// SPDX-License-Identifier: MIT OR Apache-2.0
//! Synthetic frames: small, deterministic, one scene per hard case
