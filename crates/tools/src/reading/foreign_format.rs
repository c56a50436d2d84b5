// SPDX-License-Identifier: MIT OR Apache-2.0
//! Formats of recordings that are recognized only to be named in a message.

/// The first bytes of the formats, and what a file of each is.
const FORMATS: [(&[u8], &str); 7] = [
    (b"#ROSBAG V", "a ROS 1 bag"),
    (b"SQLite format 3\0", "an SQLite database, as ROS 2 bags are"),
    (b"\x89MCAP0\r\n", "an MCAP file, as ROS 2 bags are"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
    (b"Event Stream", "an event stream (`.es`)"),
    (b"#!AER-DAT", "an AEDAT file"),
    (b"\x93NUMPY", "a NumPy array"),
];
/// The position of the name of the first entry in a ZIP archive.
const ENTRY_NAME: usize = 30;

/// Returns what a file is that begins with these bytes, if it is a recording or an array that is
/// read nowhere or only in other places.
#[must_use]
pub fn foreign_format(start: &[u8]) -> Option<&'static str> {
    let found = FORMATS.iter().find(|(magic, _)| start.starts_with(magic));
    found
        .map(|&(_, what)| what)
        .or_else(|| starts_as_npz(start).then_some("an NPZ archive of NumPy arrays"))
}

fn starts_as_npz(start: &[u8]) -> bool {
    let length =
        start.get(26..28).map_or(0, |bytes| usize::from(bytes[0]) + 256 * usize::from(bytes[1]));
    start.starts_with(b"PK\x03\x04")
        && start.get(ENTRY_NAME..ENTRY_NAME + length).is_some_and(|name| name.ends_with(b".npy"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recordings_are_named_and_other_files_are_not() {
        let npz = [&b"PK\x03\x04"[..], &[0; 22], &[5, 0, 0, 0], b"a.npy", b"\x93NUMPY"].concat();
        for (start, part) in [
            (&b"#ROSBAG V2.0\n"[..], "ROS 1"),
            (b"SQLite format 3\0...", "ROS 2"),
            (b"\x89HDF\r\n\x1a\n...", "HDF5"),
            (b"Event Stream\x02", "`.es`"),
            (&npz, "NPZ"),
        ] {
            assert!(foreign_format(start).unwrap().contains(part), "{part}");
        }
        let images = [&npz[..30], b"a.png", b"\x89PNG"].concat();
        for start in [&b"t,x,y\n"[..], b"", b"SQLite format", &images] {
            assert_eq!(foreign_format(start), None);
        }
    }
}
