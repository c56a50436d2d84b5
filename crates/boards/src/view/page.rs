// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page of a view: one file, with the colours of the palette and the registers of the design.

use foveate_output::{
    page::colour_variables,
    palette::{DARK, LIGHT},
};
use serde_json::Value;

/// Returns the page, with a script that `nonce` allows.
pub(crate) fn stream_page(nonce: &str, registers: &Value) -> String {
    // The registers become part of a script, which `<` could end.
    let registers = registers.to_string().replace('<', "\\u003c");
    include_str!("page.html")
        .replace("NONCE", nonce)
        .replace("/*LIGHT*/", &colour_variables(&LIGHT))
        .replace("/*DARK*/", &colour_variables(&DARK))
        .replace("/*REGISTERS*/ null", &registers)
}
