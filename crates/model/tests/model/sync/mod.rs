// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams that are damaged on their way, against `docs/sync.md`: which frames an array sees, and which beats are errors.

mod machine;
mod oracle;
mod states;
mod streams;
