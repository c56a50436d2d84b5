// SPDX-License-Identifier: MIT OR Apache-2.0
//! AVI files that end early. ffmpeg decodes the existing frames and reports nothing if the cut is
//! between two frames. For other containers ffmpeg reports it.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Returns a text about the missing bytes if the file is an AVI and shorter than its header states.
pub(super) fn truncation_problem(path: &Path) -> Option<String> {
    let mut file = File::open(path).ok()?;
    let length = file.metadata().ok().filter(std::fs::Metadata::is_file)?.len();
    let mut start = [0; 12];
    file.read_exact(&mut start).ok()?;
    missing_bytes(&start, length)
        .map(|bytes| format!("the file is truncated, {bytes} bytes are missing"))
}

fn missing_bytes(start: &[u8; 12], length: u64) -> Option<u64> {
    let [b'R', b'I', b'F', b'F', size @ .., b'A', b'V', b'I', b' '] = start else { return None };
    let [a, b, c, d] = *size;
    let said = u64::from(u32::from_le_bytes([a, b, c, d]));
    // A recorder that was killed leaves 0, or the largest number.
    let missing = (said + 8).checked_sub(length).filter(|&bytes| bytes > 0)?;
    (said != u64::from(u32::MAX)).then_some(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_avi_knows_its_length() {
        let start = b"RIFF\x64\x00\x00\x00AVI ";
        assert_eq!(missing_bytes(start, 108), None);
        assert_eq!(missing_bytes(start, 109), None);
        assert_eq!(missing_bytes(start, 100), Some(8));
        assert_eq!(missing_bytes(b"RIFF\x64\x00\x00\x00WAVE", 20), None);
        assert_eq!(missing_bytes(b"RIFF\xFF\xFF\xFF\xFFAVI ", 20), None);
    }
}
