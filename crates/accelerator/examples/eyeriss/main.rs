// SPDX-License-Identifier: MIT OR Apache-2.0
//! The convolutions of AlexNet and VGG-16 on the preset `eyeriss`, beside what was measured on the chip, as `docs/accelerators.md` shows them.
//! With `--layers` also every layer.

mod networks;
mod table;

#[allow(clippy::print_stdout, reason = "a program")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", table::totals()?);
    if std::env::args().any(|argument| argument == "--layers") {
        print!("\n{}", table::layers()?);
    }
    Ok(())
}
