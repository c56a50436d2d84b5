// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads tables of any length whose records have a limit.

use std::cell::Cell;
use std::io::{self, Read};
use std::rc::Rc;

use csv::{Reader, ReaderBuilder, StringRecord};

use crate::reading::size_text::size_text;

/// The largest record of a table in bytes. A row of the widest format that is read has nine
/// numbers.
pub const RECORD_LIMIT: u64 = 1 << 20;

/// A CSV reader that fails at a record of more than [`RECORD_LIMIT`] bytes. It may accept a few
/// bytes more, because it reads blocks.
#[derive(Debug)]
pub struct TableReader<R> {
    reader: Reader<RecordLimitReader<R>>,
    bytes_since_record: Rc<Cell<u64>>,
}

/// Makes a reader of a table. Blank lines count towards the record that follows them.
pub fn table_reader<R: Read>(builder: &ReaderBuilder, source: R) -> TableReader<R> {
    let bytes_since_record = Rc::new(Cell::new(0));
    let source = RecordLimitReader { source, since: Rc::clone(&bytes_since_record) };
    TableReader { reader: builder.from_reader(source), bytes_since_record }
}

impl<R: Read> TableReader<R> {
    /// Returns the names of the columns; these are the first record unless the builder sets other
    /// names.
    ///
    /// # Errors
    /// Fails if the record cannot be read or is longer than the limit.
    pub fn headers(&mut self) -> csv::Result<&StringRecord> {
        let headers = self.reader.headers();
        self.bytes_since_record.set(0);
        headers
    }

    /// Returns the records in order.
    pub fn records(&mut self) -> TableRecords<'_, R> {
        TableRecords { table: self }
    }
}

/// The records of a table in order. A record that cannot be read, is not text, or is longer than
/// the limit is an error.
#[derive(Debug)]
pub struct TableRecords<'a, R> {
    table: &'a mut TableReader<R>,
}

impl<R: Read> Iterator for TableRecords<'_, R> {
    type Item = csv::Result<StringRecord>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut record = StringRecord::new();
        let result = self.table.reader.read_record(&mut record);
        self.table.bytes_since_record.set(0);
        match result {
            Ok(true) => Some(Ok(record)),
            Ok(false) => None,
            Err(error) => Some(Err(error)),
        }
    }
}

/// A source that counts the bytes since the last complete record, and fails beyond the limit.
#[derive(Debug)]
struct RecordLimitReader<R> {
    source: R,
    since: Rc<Cell<u64>>,
}

impl<R: Read> Read for RecordLimitReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.since.get() > RECORD_LIMIT {
            let limit = size_text(RECORD_LIMIT);
            let message = format!(
                "a record has more than {limit}, which is the limit; expected short lines of text"
            );
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
        }
        let count = self.source.read(buffer)?;
        self.since.set(self.since.get() + count as u64);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of records, or the error.
    fn count(source: impl Read) -> Result<usize, String> {
        let mut table = table_reader(ReaderBuilder::new().flexible(true), source);
        table.headers().map_err(|error| error.to_string())?;
        let mut count = 0;
        for record in table.records() {
            record.map_err(|error| error.to_string())?;
            count += 1;
        }
        Ok(count)
    }

    #[test]
    fn a_table_has_any_length() {
        let text = "a,b\n".to_owned() + &"1,2\n".repeat(1 << 20);
        assert!(text.len() as u64 > 3 * RECORD_LIMIT);
        assert_eq!(count(text.as_bytes()).unwrap(), 1 << 20);
    }

    #[test]
    fn a_record_without_an_end_is_an_error() {
        let row = io::repeat(b'7');
        // The quotation mark is never closed, so every line break is a part of the field.
        let quoted = io::repeat(b'\n');
        let blank = io::repeat(b'\n');
        let error = "a record has more than 1 MiB";
        assert!(count(row).unwrap_err().contains(error));
        assert!(count((&b"a,b\n\""[..]).chain(quoted)).unwrap_err().contains(error));
        assert!(count((&b"a,b\n1,2\n"[..]).chain(blank)).unwrap_err().contains(error));
    }
}
