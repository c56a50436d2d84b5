// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds, checks and runs the external tools, and caches what they build
