// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random streams, and the frames that are read from them.

use std::ops::Range;

use fastrand::Rng;
use foveate_design::{Config, Design};
use foveate_packets::{
    Assembler, Decision, End, Found, Layout, Loss, ReceivedFrame, RegionFlags, Splitter, write,
};

pub(crate) fn design(toml: &str) -> Design {
    Config::from_toml(toml).unwrap().validate().unwrap()
}

/// A stream, and the byte range of each of its frames.
pub(crate) struct Stream {
    pub(crate) layout: Layout,
    pub(crate) bytes: Vec<u8>,
    pub(crate) frames: Vec<Range<usize>>,
}

/// Makes a stream of `count` frames with random decisions and pixels. REGION packets come before or
/// after their ROW.
pub(crate) fn random(rng: &mut Rng, count: u32) -> Stream {
    let (width, height, size) = (rng.u32(4..40), rng.u32(4..30), rng.u32(2..9));
    let (bits, mean) = (rng.u32(1..=16), rng.bool());
    let irrelevant = if mean { "mean" } else { "zero" };
    let design = design(&format!(
        "frame={{width={width},height={height},pixel_bits={bits}}}\nregion.size={size}\ntemporal.min_count=1\n\
         spatial=[{{feature='mad',min_score=0}}]\nrender.irrelevant='{irrelevant}'\n"
    ));
    let layout = Layout::new(&design, rng.bool(), 1_000_000).unwrap();
    let (mut bytes, mut frames) = (Vec::new(), Vec::new());
    for number in 0..count {
        let start = bytes.len();
        write::frame(&mut bytes, &layout, number, (u64::from(number) * 40_000, number == 0));
        let mut regions_sent = 0;
        for row in 0..layout.rows() {
            let decision = |_| {
                let (srs, trs) = (rng.bool(), rng.bool());
                Decision { srs, trs, summary: mean && !srs && rng.bool() }
            };
            let decisions: Vec<Decision> = (0..layout.columns()).map(decision).collect();
            let early = rng.bool();
            if !early {
                write::row(&mut bytes, &layout, number, row, &decisions).unwrap();
            }
            for (column, decision) in (0..).zip(&decisions) {
                if decision.summary || (decision.srs && decision.trs) {
                    let summary = decision.summary;
                    let values: Vec<u16> =
                        (0..layout.values(summary)).map(|_| rng.u16(..) >> (16 - bits)).collect();
                    let flags = RegionFlags { raw: false, summary };
                    write::region(&mut bytes, &layout, number, (row, column), (flags, &values))
                        .unwrap();
                    regions_sent += 1;
                }
            }
            if early {
                write::row(&mut bytes, &layout, number, row, &decisions).unwrap();
            }
            if layout.info().has_scores {
                let scores = (0..layout.columns()).map(|_| [rng.u64(0..3), rng.u64(0..3)]);
                write::scores(&mut bytes, &layout, number, row, scores).unwrap();
            }
        }
        write::end(&mut bytes, number, End { regions_sent, ..End::default() }).unwrap();
        frames.push(start..bytes.len());
    }
    Stream { layout, bytes, frames }
}

/// Reads all frames of a stream, in pieces of random length, and the losses.
pub(crate) fn read(
    rng: &mut Rng,
    layout: &Layout,
    bytes: &[u8],
) -> (Vec<ReceivedFrame>, Vec<Loss>) {
    let (mut splitter, mut assembler) = (Splitter::default(), Assembler::new(layout.clone()));
    let (mut frames, mut rest) = (Vec::new(), bytes);
    loop {
        let (piece, after) = rest.split_at(rng.usize(0..=rest.len().min(700)));
        rest = after;
        splitter.feed(piece);
        if rest.is_empty() {
            splitter.complete();
        }
        loop {
            match splitter.next(Some(layout)) {
                Found::Nothing => break,
                Found::Skipped { offset, bytes } => assembler.lose(Loss::Bytes { offset, bytes }),
                Found::Packet { frame, packet } => {
                    let ended = assembler.push(frame, packet).unwrap();
                    frames.extend(ended.into_iter().flatten());
                }
            }
        }
        if rest.is_empty() {
            frames.extend(assembler.end());
            return (frames, assembler.losses());
        }
    }
}
