// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is left of multiplications, cycles and energy where only a square of a layer is computed, on every preset: in
//! Markdown what `docs/data/accelerators-masked.csv` holds.

mod table;

#[allow(clippy::print_stdout, reason = "a program")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", table::shares()?);
    Ok(())
}
