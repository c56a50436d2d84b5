// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rules of `docs/sync.md` as one function over a whole stream, without states: it collects a
//! frame from each marked beat on.

/// The ports at an edge at which the array would take a beat.
#[derive(Clone, Debug)]
pub(crate) struct StreamEdge {
    pub(crate) clock: usize,
    pub(crate) valid: bool,
    pub(crate) sof: bool,
    pub(crate) pixels: Vec<u16>,
}

/// The result of cutting a stream into frames.
#[derive(Debug, Default)]
pub(crate) struct CutStream {
    /// The frames that the array takes completely, as beats.
    pub(crate) frames: Vec<Vec<Vec<u16>>>,
    /// The clocks of the beats that are errors.
    pub(crate) errors: Vec<usize>,
    /// Number of frames that the array completed by itself.
    pub(crate) completed: usize,
}

/// Cuts a stream into frames of `beats` beats. `fill` is on the pixel port while the array
/// completes a frame. Without it the array takes the pixels of the next edges.
pub(crate) fn cut_stream(edges: &[StreamEdge], beats: usize, fill: Option<&[u16]>) -> CutStream {
    let mut cut = CutStream::default();
    let mut rest = edges.iter();
    // True if the frame before has just ended by itself.
    let mut ended = false;
    while let Some(edge) = rest.find(|edge| edge.valid) {
        if !edge.sof {
            cut.errors.extend(ended.then_some(edge.clock));
            ended = false;
            continue;
        }
        let mut frame = vec![edge.pixels.clone()];
        ended = true;
        while frame.len() < beats {
            let Some(edge) = rest.find(|edge| edge.valid) else { return cut };
            if edge.sof {
                cut.errors.push(edge.clock);
                ended = false;
                let missing = beats - frame.len();
                match fill {
                    Some(fill) => frame.extend(vec![fill.to_vec(); missing]),
                    None => frame.extend(rest.by_ref().take(missing).map(|e| e.pixels.clone())),
                }
                cut.completed += 1;
                break;
            }
            frame.push(edge.pixels.clone());
        }
        if frame.len() < beats {
            cut.completed -= 1;
            return cut;
        }
        cut.frames.push(frame);
    }
    cut
}

/// The expected results are written by hand, for frames of three beats.
#[test]
fn a_stream_is_cut_as_the_page_says() {
    let stream = |text: &str| -> Vec<StreamEdge> {
        let edge = |(clock, letter): (usize, char)| StreamEdge {
            clock,
            valid: letter != '.',
            sof: letter.is_ascii_uppercase(),
            pixels: vec![letter as u16],
        };
        text.chars().enumerate().map(edge).collect()
    };
    let example = |text: &str, fill: Option<&[u16]>| {
        let CutStream { frames, errors, completed } = cut_stream(&stream(text), 3, fill);
        let letter = |beat: &Vec<u16>| char::from(beat[0] as u8);
        let frames: Vec<String> =
            frames.iter().map(|frame| frame.iter().map(letter).collect()).collect();
        (frames.join(" "), errors, completed)
    };
    let fill: Option<&[u16]> = Some(&[b'_' as u16]);
    for (text, fill, frames, errors, completed) in [
        ("Abc.D.efGhi", fill, "Abc Def Ghi", vec![], 0),
        ("xyAbcDef", fill, "Abc Def", vec![], 0),
        // One beat is missing, so the next frame is dropped.
        ("AbcDeGhiJkl", fill, "Abc De_ Jkl", vec![5], 1),
        ("AbcDeGhiJkl", None, "Abc Deh Jkl", vec![5], 1),
        ("ABCDefGhi", fill, "A__ C__ Ghi", vec![1, 3], 2),
        ("ABCDefGhi", None, "ACD Ghi", vec![1], 1),
        // There is one beat too many, then two.
        ("AbcxDefxyGhi", fill, "Abc Def Ghi", vec![3, 7], 0),
        // A mark is missing.
        ("AbcdefGhi", fill, "Abc Ghi", vec![3], 0),
        ("Ab", fill, "", vec![], 0),
        ("AB", None, "", vec![1], 0),
    ] {
        assert_eq!(example(text, fill), (frames.to_owned(), errors, completed), "{text}");
    }
}
