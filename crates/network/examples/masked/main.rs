// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the share of multiplications, cycles and energy that remains if only a square of a layer
//! is computed, on every preset. The Markdown table has the data of
//! `docs/data/accelerators-masked.csv`.

mod table;

#[allow(clippy::print_stdout, reason = "a program")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", table::shares_table()?);
    Ok(())
}
