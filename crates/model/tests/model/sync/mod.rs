// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of damaged streams by the rules of `docs/sync.md`: the frames that an array takes, and the
//! beats that are errors.

mod array;
mod streams;
mod sync_oracle;
mod sync_states;
