// SPDX-License-Identifier: MIT OR Apache-2.0
//! Image sets in, region events, arrays and rendered frames out
