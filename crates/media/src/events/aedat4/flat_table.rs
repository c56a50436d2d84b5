// SPDX-License-Identifier: MIT OR Apache-2.0
//! The root table of a flatbuffer behind its length, read through the checks of the library: its
//! accessors of tables are unsafe functions.

use flatbuffers::{InvalidFlatbuffer, Verifier, VerifierOptions};

/// The bytes of a length, and of an offset.
pub(super) const LENGTH_BYTES: usize = 4;
/// The place of the identifier of the content, behind the length and the place of the root.
const IDENTIFIER_AT: usize = 8;

/// A flatbuffer with its length before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatTable<'a> {
    bytes: &'a [u8],
}

impl<'a> FlatTable<'a> {
    /// Takes a buffer. Returns `None` if it has less bytes than it states.
    pub(super) fn new(bytes: &'a [u8]) -> Option<Self> {
        let length = u32::from_le_bytes(*bytes.first_chunk()?);
        let end = usize::try_from(length).ok()?.checked_add(LENGTH_BYTES)?;
        Some(Self { bytes: bytes.get(..end)? })
    }

    /// Returns the identifier of the content.
    pub(super) fn identifier(self) -> Option<[u8; 4]> {
        self.bytes.get(IDENTIFIER_AT..)?.first_chunk().copied()
    }

    /// Returns the bytes of a number, field `number` of the table; `None` if the table does not
    /// have it.
    pub(super) fn scalar<const BYTES: usize>(
        self,
        number: u16,
    ) -> Result<Option<[u8; BYTES]>, InvalidFlatbuffer> {
        let Some(at) = self.place(number)? else { return Ok(None) };
        self.slice(at, BYTES).map(|bytes| bytes.first_chunk().copied())
    }

    /// Returns the bytes of a vector or a string, field `number` of the table, whose elements have
    /// `size` bytes; `None` if the table does not have it.
    pub(super) fn vector(
        self,
        number: u16,
        size: usize,
    ) -> Result<Option<&'a [u8]>, InvalidFlatbuffer> {
        let Some(field) = self.place(number)? else { return Ok(None) };
        let at = field.saturating_add(self.offset(field)?);
        let length = self.offset(at)?.saturating_mul(size);
        self.slice(at.saturating_add(LENGTH_BYTES), length).map(Some)
    }

    /// Returns the place of a field.
    fn place(self, number: u16) -> Result<Option<usize>, InvalidFlatbuffer> {
        let root = LENGTH_BYTES.saturating_add(self.offset(LENGTH_BYTES)?);
        let options = VerifierOptions::default();
        let field = flatbuffers::field_index_to_field_offset(number);
        Verifier::new(&options, self.bytes).visit_table(root)?.deref(field)
    }

    fn offset(self, at: usize) -> Result<usize, InvalidFlatbuffer> {
        let options = VerifierOptions::default();
        let offset = Verifier::new(&options, self.bytes).get_uoffset(at)?;
        Ok(usize::try_from(offset).unwrap_or(usize::MAX))
    }

    fn slice(self, at: usize, length: usize) -> Result<&'a [u8], InvalidFlatbuffer> {
        let options = VerifierOptions::default();
        Verifier::new(&options, self.bytes).range_in_buffer(at, length)?;
        Ok(&self.bytes[at..at + length])
    }
}
