// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the events of a file in EVT 2.0, EVT 3.0 or AEDAT4 as CSV: `cargo run --release -p
//! foveate-eventfiles --example events_as_csv -- FILE > events.csv`.

use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write, stdout};

use foveate_media::EventReader;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("name a file in EVT 2.0, EVT 3.0 or AEDAT4")?;
    let mut output = BufWriter::new(stdout().lock());
    writeln!(output, "x,y,t,p")?;
    for event in EventReader::open(BufReader::new(File::open(path)?))? {
        let event = event?;
        let polarity = u8::from(event.is_brighter);
        writeln!(output, "{},{},{},{polarity}", event.x, event.y, event.time_us)?;
    }
    Ok(output.flush()?)
}
