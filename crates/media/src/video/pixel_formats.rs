// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixel formats: the filter that leaves luma, or the colours from which luma is computed, and the
//! layout of the filtered frames.

/// The formats that frames may have after the filter, as the filter `format` takes them.
const GREY: &str = "format=gray|gray9le|gray10le|gray12le|gray14le|gray16le|\
                    gray9be|gray10be|gray12be|gray14be|gray16be";

/// The formats whose words hold luma and other bits, each with the planar format that replaces it.
/// In some versions `extractplanes` copies these words unchanged.
const SHARED_WORD_FORMATS: [(&str, &str); 8] = [
    ("p0", "yuv420p"),
    ("p2", "yuv422p"),
    ("p4", "yuv444p"),
    ("y2", "yuv422p"),
    ("nv20", "yuv422p"),
    ("xv", "yuv444p"),
    ("v30", "yuv444p"),
    ("ayuv64", "yuva444p"),
];

/// The layout of the samples of a frame in the pipe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SampleFormat {
    /// The number of bits per sample.
    pub(super) depth: u32,
    /// True if a pixel has three samples.
    pub(super) colour: bool,
    /// True if high bytes come first.
    pub(super) big_endian: bool,
}

pub(super) fn conversion_filter(name: &str) -> String {
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    let deep_planes = name.starts_with("gbr") && name.contains(|c: char| c.is_ascii_digit());
    let deep_colours = [
        "rgb48", "bgr48", "rgba64", "bgra64", "x2", "xyz", "bayer", "rgbf", "rgbaf", "rgb96",
        "rgba128",
    ];
    if starts(&deep_colours) || deep_planes {
        "format=rgb48le".to_owned()
    } else if starts(&["rgb", "bgr", "gbr", "argb", "abgr", "0rgb", "0bgr", "pal8"]) {
        "format=rgb24".to_owned()
    } else if starts(&["mono"]) {
        "format=gray".to_owned()
    } else if starts(&["grayf", "yaf", "gray32"]) {
        // ffmpeg would take numbers from 0 to 1 for the narrow range.
        "scale=in_range=pc:out_range=pc,format=gray16le".to_owned()
    } else {
        let shared = SHARED_WORD_FORMATS.iter().find(|(prefix, _)| name.starts_with(prefix));
        let planar = shared
            .and_then(|(_, planes)| Some(format!("format={planes}{}le,", shared_bits(name)?)));
        // ffmpeg converts other formats that `extractplanes` does not know to planar formats of the
        // same kind.
        format!("{}extractplanes=y,{GREY}", planar.unwrap_or_default())
    }
}

/// Returns the bits per sample of a format whose words hold luma and other bits. They are the last
/// two digits of its name.
fn shared_bits(name: &str) -> Option<u32> {
    if name.starts_with("ayuv64") || name.starts_with("xv48") {
        return Some(16);
    }
    let name = name.trim_end_matches(['l', 'b', 'e', 'x']);
    match name.strip_prefix("xv") {
        Some("30") => Some(10),
        Some("36") => Some(12),
        _ if name == "nv20" || name == "v30" => Some(10),
        _ => name.get(name.len().checked_sub(2)?..)?.parse().ok(),
    }
}

/// Returns the layout of the samples of a format that frames may have after the filter.
pub(super) fn sample_format(format: &str) -> Option<SampleFormat> {
    let plain = |depth, colour| Some(SampleFormat { depth, colour, big_endian: false });
    match format {
        "gray" => return plain(8, false),
        "rgb24" => return plain(8, true),
        "rgb48le" => return plain(16, true),
        _ => {}
    }
    let rest = format.strip_prefix("gray")?;
    let (depth, big_endian) = match (rest.strip_suffix("le"), rest.strip_suffix("be")) {
        (Some(depth), _) => (depth, false),
        (_, Some(depth)) => (depth, true),
        _ => return None,
    };
    let depth = depth.parse().ok().filter(|depth| [9, 10, 12, 14, 16].contains(depth))?;
    Some(SampleFormat { depth, colour: false, big_endian })
}

#[cfg(test)]
mod tests;
