// SPDX-License-Identifier: MIT OR Apache-2.0
//! Compares the convolutions of AlexNet and VGG-16 on the preset `eyeriss` with the measurements of
//! the chip, as in `docs/accelerators.md`. With `--layers` it also prints every layer.

mod networks;
mod table;

#[allow(clippy::print_stdout, reason = "a program")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", table::totals_table()?);
    if std::env::args().any(|argument| argument == "--layers") {
        print!("\n{}", table::layers_table()?);
    }
    Ok(())
}
