// SPDX-License-Identifier: MIT OR Apache-2.0
//! NPZ: a ZIP archive of deflated NPY files. An array is compressed while it grows, so that its
//! length, sizes and checksum are known only at the end. They are in a stored block of their own
//! before the compressed data, which is overwritten then ([`DeflatePacker`]). Every entry has ZIP64
//! sizes, so that archives beyond 4 GiB need no other format.

use crate::SimulatorError;
use crc32fast::Hasher;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use foveate_tools::GrowingFile;
use std::io::Write as _;

/// The number of bytes of an NPY header in this archive, a multiple of 64.
const NPY_HEADER_BYTES: usize = 192;

/// The compression level. It is low, because events are compressed during the run.
const LEVEL: Compression = Compression::new(1);

/// An archive with one open entry.
pub(super) struct NpzArchive {
    file: GrowingFile,
    position: u64,
    done: Vec<ArchiveEntry>,
    open: ArchiveEntry,
    packer: DeflatePacker,
}

/// A file of the archive.
struct ArchiveEntry {
    name: &'static str,
    /// The type of an element in Python's notation.
    descr: &'static str,
    start: u64,
    bytes: u64,
    packed_bytes: u64,
    crc: u32,
}

impl NpzArchive {
    /// Makes an archive whose first array is `name`, with elements of type `descr`.
    pub(super) fn new(file: GrowingFile, name: &'static str, descr: &'static str) -> Self {
        let open = ArchiveEntry::new(name, descr, 0);
        let mut npz =
            Self { file, position: 0, done: Vec::new(), open, packer: DeflatePacker::new(LEVEL) };
        npz.begin();
        npz
    }

    /// Appends elements to the open array.
    pub(super) fn write(&mut self, elements: &[u8]) {
        let pending = self.file.pending_mut();
        let before = pending.len();
        self.packer.write(elements, pending);
        let packed = length(&pending[before..]);
        self.open.packed_bytes += packed;
        self.position += packed;
    }

    pub(super) fn write_out(&mut self) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending()?)
    }

    /// Closes the open array, which has `count` elements, and begins another one.
    pub(super) fn next_array(
        &mut self,
        count: u64,
        name: &'static str,
        descr: &'static str,
    ) -> Result<(), SimulatorError> {
        self.close(count)?;
        let closed =
            std::mem::replace(&mut self.open, ArchiveEntry::new(name, descr, self.position));
        self.done.push(closed);
        self.begin();
        Ok(())
    }

    /// Closes the open array and the archive.
    pub(super) fn finish(mut self, count: u64) -> Result<(), SimulatorError> {
        self.close(count)?;
        self.done.push(self.open);
        let directory: Vec<u8> = self.done.iter().flat_map(ArchiveEntry::directory_entry).collect();
        self.file.append(&directory);
        self.file.append(&end_of_directory(self.position, length(&directory), length(&self.done)));
        Ok(self.file.write_all()?)
    }

    /// Reserves space for the headers of the open entry.
    fn begin(&mut self) {
        let header =
            stored_block(&foveate_output::npy::npy_header(NPY_HEADER_BYTES, self.open.descr, "0,"));
        self.open.packed_bytes = length(&header);
        let placeholder = [self.open.local_header(), header].concat();
        self.position += length(&placeholder);
        self.file.append(&placeholder);
    }

    fn close(&mut self, count: u64) -> Result<(), SimulatorError> {
        let header = foveate_output::npy::npy_header(
            NPY_HEADER_BYTES,
            self.open.descr,
            &format!("{count},"),
        );
        let packer = std::mem::replace(&mut self.packer, DeflatePacker::new(LEVEL));
        let (last, crc, bytes) = packer.finish(&header);
        self.file.append(&last);
        self.position += length(&last);
        self.open.packed_bytes += length(&last);
        (self.open.crc, self.open.bytes) = (crc, bytes);
        let local = [self.open.local_header(), stored_block(&header)].concat();
        Ok(self.file.overwrite(self.open.start, &local)?)
    }
}

impl ArchiveEntry {
    fn new(name: &'static str, descr: &'static str, start: u64) -> Self {
        Self { name, descr, start, bytes: 0, packed_bytes: 0, crc: 0 }
    }

    /// Returns the header before the data.
    fn local_header(&self) -> Vec<u8> {
        let mut bytes = b"PK\x03\x04".to_vec();
        bytes.extend(self.common_fields());
        let sizes = [self.bytes, self.packed_bytes];
        self.name_and_sizes(bytes, &[], &sizes)
    }

    /// Returns the entry of the central directory.
    fn directory_entry(&self) -> Vec<u8> {
        let mut bytes = b"PK\x01\x02\x2d\x03".to_vec();
        bytes.extend(self.common_fields());
        let sizes = [self.bytes, self.packed_bytes, self.start];
        // The fields are: no comment, first disk, no attributes but -rw-r--r--. The offset is among
        // the ZIP64 sizes.
        let rest = [&[0; 6][..], &(0o100_644u32 << 16).to_le_bytes(), &[0xFF; 4]].concat();
        self.name_and_sizes(bytes, &rest, &sizes)
    }

    /// Returns the common fields: version 4.5, no flags, deflated, 1980-01-01, checksum, and the
    /// mark that the sizes are in the ZIP64 field.
    fn common_fields(&self) -> Vec<u8> {
        let fixed = [0x2d, 0, 0, 0, 8, 0, 0, 0, 0x21, 0];
        [&fixed[..], &self.crc.to_le_bytes(), &[0xFF; 8]].concat()
    }

    fn name_and_sizes(&self, mut bytes: Vec<u8>, between: &[u8], sizes: &[u64]) -> Vec<u8> {
        let size = u16::try_from(8 * sizes.len()).expect("two or three sizes");
        let name = format!("{}.npy", self.name);
        bytes.extend(u16::try_from(name.len()).expect("names are short").to_le_bytes());
        bytes.extend((size + 4).to_le_bytes());
        bytes.extend(between);
        bytes.extend(name.as_bytes());
        bytes.extend(1u16.to_le_bytes());
        bytes.extend(size.to_le_bytes());
        bytes.extend(sizes.iter().flat_map(|size| size.to_le_bytes()));
        bytes
    }
}

/// Returns the end of the central directory, in its ZIP64 form and in its short form.
fn end_of_directory(start: u64, size: u64, entries: u64) -> Vec<u8> {
    // The ZIP64 end: 44 more bytes, version 4.5 on Unix, and no further disks.
    let mut bytes = b"PK\x06\x06".to_vec();
    bytes.extend(44u64.to_le_bytes());
    bytes.extend([0x2d, 3, 0x2d, 0]);
    bytes.extend([0; 8]);
    for number in [entries, entries, size, start] {
        bytes.extend(number.to_le_bytes());
    }
    // The locator of the ZIP64 end, which is behind the directory, and the number of disks.
    bytes.extend(b"PK\x06\x07\x00\x00\x00\x00");
    bytes.extend((start + size).to_le_bytes());
    bytes.extend(1u32.to_le_bytes());
    // The short end, whose fields refer to the ZIP64 end, and a comment of length 0.
    bytes.extend(b"PK\x05\x06\x00\x00\x00\x00");
    bytes.extend([0xFF; 12]);
    bytes.extend([0; 2]);
    bytes
}

fn length<T>(items: &[T]) -> u64 {
    items.len() as u64
}

/// The number of bytes before the content of a stored block: its kind, and its length twice.
pub(super) const STORED_BLOCK_HEADER_BYTES: usize = 5;

/// Returns the stored block of at most 65,535 bytes.
pub(super) fn stored_block(bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).expect("a header has a few bytes");
    [&[0][..], &length.to_le_bytes(), &(!length).to_le_bytes(), bytes].concat()
}

/// The compressor of the data after the stored block.
pub(super) struct DeflatePacker {
    encoder: DeflateEncoder<Vec<u8>>,
    checksum: Hasher,
    /// The number of bytes before compression.
    length: u64,
}

impl DeflatePacker {
    pub(super) fn new(level: Compression) -> Self {
        let encoder = DeflateEncoder::new(Vec::new(), level);
        Self { encoder, checksum: Hasher::new(), length: 0 }
    }

    /// Compresses bytes, and appends the finished output to `packed`.
    pub(super) fn write(&mut self, bytes: &[u8], packed: &mut Vec<u8>) {
        self.checksum.update(bytes);
        self.length += bytes.len() as u64;
        // A write into memory cannot fail.
        let _ = self.encoder.write_all(bytes);
        packed.append(self.encoder.get_mut());
    }

    /// Returns the last packed bytes, the checksum of `header` and the data, and the length of
    /// both.
    pub(super) fn finish(self, header: &[u8]) -> (Vec<u8>, u32, u64) {
        let mut whole = Hasher::new();
        whole.update(header);
        whole.combine(&self.checksum);
        let last = self.encoder.finish().expect("memory takes everything");
        (last, whole.finalize(), self.length + header.len() as u64)
    }
}
