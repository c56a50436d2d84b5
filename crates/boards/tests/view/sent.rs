// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets and the screens that `simulate` makes of a few frames of the street.

use std::fs;

use foveate_design::DesignConfig;
use foveate_media::{InputOptions, SilentHooks, open};
use foveate_simulator::{EventTableOptions, PacketContent, PictureFormat, RunOptions, Simulation};

/// A stream, and what the page must show of it.
pub(crate) struct SentStream {
    /// The packets of each frame.
    pub(crate) frames: Vec<Vec<u8>>,
    /// The decisions and pixels of each frame: a byte per region, then a byte per pixel.
    pub(crate) pictures: Vec<Vec<u8>>,
}

impl SentStream {
    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.frames.concat()
    }
}

/// Returns the packet at the beginning of `bytes`.
pub(crate) fn first_packet(bytes: &[u8]) -> &[u8] {
    &bytes[..8 * usize::from(u16::from_le_bytes([bytes[2], bytes[3]]))]
}

/// A design on AXI with frames of 40 x 30 pixels.
pub(crate) const CORE: [&str; 4] = [
    "frame={width=40,height=30}",
    "hardware.organization='raster'",
    "hardware.interface='axi'",
    "temporal.reference='last-sent'",
];

pub(crate) fn street_stream(set: &[&str], frames: u32) -> SentStream {
    let folder = tempfile::tempdir().unwrap();
    let config = DesignConfig::from_toml_with("", set).unwrap();
    let limit = InputOptions { frames: Some(frames), ..InputOptions::default() };
    let source = open(&["scene:street"], &config.camera, &limit).unwrap();
    let options = RunOptions {
        rendered: Some(PictureFormat::Png),
        events: EventTableOptions { csv: true, ..EventTableOptions::default() },
        packets: Some(PacketContent::Plain),
        ..RunOptions::default()
    };
    let out = folder.path().join("out");
    Simulation::new(&config, source).unwrap().run(&out, &options, &SilentHooks).unwrap();

    let (stream, mut frames) = (fs::read(out.join("packets.bin")).unwrap(), vec![Vec::new()]);
    let mut rest = &stream[..];
    while !rest.is_empty() {
        let packet = first_packet(rest);
        rest = &rest[packet.len()..];
        frames.last_mut().unwrap().extend(packet);
        // The END packet is the last one of its frame.
        if packet[1] & 15 == 5 {
            frames.push(Vec::new());
        }
    }
    assert_eq!(frames.pop(), Some(Vec::new()));

    let mut pictures = vec![Vec::new(); frames.len()];
    let events = fs::read_to_string(out.join("events.csv")).unwrap();
    for row in events.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let actions = ["forward", "hold", "blank", "summarize"];
        let action = actions.iter().position(|name| cells.last() == Some(name)).unwrap();
        let bit = |place: usize| u8::from(cells[place] == "1");
        let region = bit(6) | bit(7) << 1 | u8::try_from(action).unwrap() << 2;
        pictures[cells[0].parse::<usize>().unwrap()].push(region);
    }
    for (number, picture) in pictures.iter_mut().enumerate() {
        let file = image::open(out.join(format!("rendered/{number:06}.png"))).unwrap();
        match file {
            image::DynamicImage::ImageLuma8(file) => picture.extend(file.as_raw()),
            image::DynamicImage::ImageLuma16(file) => {
                // The page shows the 8 high bits.
                let pixels = file.as_raw().iter().map(|value| value.to_be_bytes()[0]);
                picture.extend(pixels);
            }
            _ => panic!("a rendered frame is grey"),
        }
    }
    SentStream { frames, pictures }
}
