// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes the live page to standard output, for its tests: `cargo run -p foveate-view --example camera_page > page.html`.

use std::io::Write as _;

fn main() -> std::io::Result<()> {
    std::io::stdout().write_all(foveate_view::camera_page(None).as_bytes())
}
