// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page: one file, with the colours of the palette and the registers of the design.

use foveate_pictures::page::variables;
use foveate_pictures::palette::{DARK, LIGHT};
use serde_json::Value;

/// The page with a script that `nonce` allows.
pub(crate) fn render(nonce: &str, registers: &Value) -> String {
    // As a part of a script; `<` could end that.
    let registers = registers.to_string().replace('<', "\\u003c");
    include_str!("page.html")
        .replace("NONCE", nonce)
        .replace("/*LIGHT*/", &variables(&LIGHT))
        .replace("/*DARK*/", &variables(&DARK))
        .replace("/*REGISTERS*/ null", &registers)
}
