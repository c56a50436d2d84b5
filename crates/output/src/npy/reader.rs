// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads NumPy files (NPY 1.0 to 3.0) as `numpy.save` writes them. A file may come from an
//! untrusted source.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// The largest header in bytes. NumPy, too, rejects longer headers in untrusted files.
const HEADER_LIMIT: usize = 10_000;
/// The largest array in bytes.
const ARRAY_LIMIT: u64 = 1 << 31;

/// An array that was read from a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NpyArray {
    /// The type of a value as NumPy writes it, such as `<f4`.
    pub dtype: String,
    /// The length of every axis.
    pub shape: Vec<usize>,
    /// The bytes of the values in row-major (C) order.
    pub bytes: Vec<u8>,
}

/// The error of an array that cannot be read.
#[derive(Debug, Error)]
#[error("cannot read the array `{}`: {problem}", path.display())]
pub struct NpyError {
    path: PathBuf,
    problem: String,
}

/// Reads a file of one array.
///
/// # Errors
/// Fails if the file cannot be read or is damaged, if its array is larger than 2 GiB, or if its
/// values are not plain numbers.
pub fn read_array(path: &Path) -> Result<NpyArray, NpyError> {
    let array_error = |problem| NpyError { path: path.to_owned(), problem };
    // Opening a FIFO would wait for a writer.
    let metadata = path.metadata().map_err(|error| array_error(error.to_string()))?;
    if !metadata.is_file() {
        return Err(array_error("it is not a file".to_owned()));
    }
    let mut file =
        foveate_tools::open_file(path).map_err(|error| array_error(error.to_string()))?;
    read_from(&mut file).map_err(array_error)
}

fn read_from(file: &mut impl Read) -> Result<NpyArray, String> {
    let header = read_header(file)?;
    let (dtype, is_fortran, shape) = parse_header(&header).ok_or_else(|| {
        format!("its header is not one that numpy.save writes: {}", header.trim_end())
    })?;
    let width = value_bytes(&dtype)?;
    let count = shape.iter().try_fold(1u64, |count, &length| count.checked_mul(length as u64));
    let wanted = count.and_then(|count| count.checked_mul(width as u64));
    let wanted = wanted
        .filter(|&wanted| wanted <= ARRAY_LIMIT)
        .ok_or_else(|| format!("an array of {shape:?} values is larger than 2 GiB"))?;
    let mut bytes = Vec::new();
    file.take(wanted + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    match bytes.len() as u64 {
        found if found < wanted => {
            Err(format!("it ends after {found} of {wanted} bytes of its values"))
        }
        found if found > wanted => {
            Err(format!("its shape {shape:?} has {wanted} bytes, but more follow"))
        }
        _ if is_fortran => {
            Ok(NpyArray { bytes: to_row_major(&bytes, &shape, width), dtype, shape })
        }
        _ => Ok(NpyArray { dtype, shape, bytes }),
    }
}

fn read_header(file: &mut impl Read) -> Result<String, String> {
    let header_error = |error: io::Error| match error.kind() {
        io::ErrorKind::UnexpectedEof => "it ends in its header".to_owned(),
        _ => error.to_string(),
    };
    let mut start = [0; 8];
    file.read_exact(&mut start).map_err(header_error)?;
    if start[..6] != *b"\x93NUMPY" {
        return Err("it is not a NumPy file; numpy.save writes one".to_owned());
    }
    let length = match start[6] {
        1 => {
            let mut length = [0; 2];
            file.read_exact(&mut length).map_err(header_error)?;
            u32::from(u16::from_le_bytes(length))
        }
        2 | 3 => {
            let mut length = [0; 4];
            file.read_exact(&mut length).map_err(header_error)?;
            u32::from_le_bytes(length)
        }
        other => return Err(format!("its format has version {other}; versions 1 to 3 are read")),
    };
    let length = usize::try_from(length).ok().filter(|&length| length <= HEADER_LIMIT);
    let length = length.ok_or_else(|| format!("its header is longer than {HEADER_LIMIT} bytes"))?;
    let mut text = vec![0; length];
    file.read_exact(&mut text).map_err(header_error)?;
    String::from_utf8(text).map_err(|_| "its header is not text".to_owned())
}

/// Parses a header. Returns the type, true if the array is in Fortran order, and the shape.
fn parse_header(header: &str) -> Option<(String, bool, Vec<usize>)> {
    let value_of = |key: &str| Some(header.split_once(&format!("'{key}':"))?.1.trim_start());
    // A structured type is a list. Only its bracket is returned, which `value_bytes` rejects.
    let dtype = value_of("descr")?;
    let dtype = match dtype.strip_prefix('\'') {
        Some(text) => text.split_once('\'')?.0,
        None => dtype.get(..1)?,
    };
    let order = value_of("fortran_order")?;
    let is_fortran = order.starts_with("True");
    if !is_fortran && !order.starts_with("False") {
        return None;
    }
    let lengths = value_of("shape")?.strip_prefix('(')?.split_once(')')?.0;
    let lengths = lengths.split(',').map(str::trim).filter(|length| !length.is_empty());
    let shape = lengths.map(|length| length.trim_end_matches('L').parse().ok());
    Some((dtype.to_owned(), is_fortran, shape.collect::<Option<_>>()?))
}

fn value_bytes(dtype: &str) -> Result<usize, String> {
    match dtype {
        "|b1" | "|u1" | "|i1" => Ok(1),
        "<f2" | "<u2" | "<i2" => Ok(2),
        "<f4" | "<u4" | "<i4" => Ok(4),
        "<f8" | "<u8" | "<i8" => Ok(8),
        other if other.starts_with('>') => Err(format!(
            "its values are of type {other}, the highest byte first; save array.astype(\"<{}\")",
            &other[1..]
        )),
        other => Err(format!("its values are of type {other}, which are not plain numbers")),
    }
}

/// Converts values from Fortran order to row-major (C) order.
fn to_row_major(bytes: &[u8], shape: &[usize], width: usize) -> Vec<u8> {
    // In Fortran order the first axis varies fastest, so its neighbors are one value apart.
    let steps: Vec<usize> = shape
        .iter()
        .scan(1, |step, &length| Some(std::mem::replace(step, *step * length)))
        .collect();
    let mut row_major = Vec::with_capacity(bytes.len());
    let mut index = vec![0; shape.len()];
    for _ in 0..bytes.len() / width {
        let source: usize = index.iter().zip(&steps).map(|(at, step)| at * step).sum();
        row_major.extend_from_slice(&bytes[source * width..][..width]);
        for (at, &length) in index.iter_mut().zip(shape).rev() {
            *at += 1;
            if *at < length {
                break;
            }
            *at = 0;
        }
    }
    row_major
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::npy::npy_header;

    fn file((descr, shape): (&str, &str), bytes: &[u8]) -> Vec<u8> {
        [&npy_header(128, descr, shape)[..], bytes].concat()
    }

    #[test]
    fn an_array_is_read_as_numpy_wrote_it() {
        let array = read_from(&mut &file(("'<f4'", "2, 1"), &[1, 2, 3, 4, 5, 6, 7, 8])[..]);
        let wanted = NpyArray {
            dtype: "<f4".to_owned(),
            shape: vec![2, 1],
            bytes: vec![1, 2, 3, 4, 5, 6, 7, 8],
        };
        assert_eq!(array, Ok(wanted));
        let scalar = read_from(&mut &file(("'|u1'", ""), &[7])[..]).unwrap();
        assert_eq!((scalar.shape, scalar.bytes), (vec![], vec![7]));
    }

    #[test]
    fn an_array_in_fortran_order_is_read_in_row_major_order() {
        let mut bytes = file(("'|u1'", "2, 3"), &[0, 3, 1, 4, 2, 5]);
        let header = String::from_utf8_lossy(&bytes[10..128]).replace("False,", "True, ");
        bytes.splice(10..128, header.bytes());
        assert_eq!(read_from(&mut &bytes[..]).unwrap().bytes, [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_file_that_is_no_array_is_refused_with_the_reason() {
        for (bytes, expected) in [
            (b"PK\x03\x04 an archive".to_vec(), "it is not a NumPy file"),
            (b"\x93NUMPY\x01".to_vec(), "it ends in its header"),
            (b"\x93NUMPY\x09\x00\x01\x00 ".to_vec(), "version 9"),
            (b"\x93NUMPY\x02\x00\xff\xff\xff\xff".to_vec(), "longer than 10000"),
            (file(("'>f4'", "1,"), &[0; 4]), "astype(\"<f4\")"),
            (file(("'|O'", "1,"), &[0; 4]), "not plain numbers"),
            (file(("[('a', '<f4')]", "1,"), &[0; 4]), "not plain numbers"),
            (file(("'<f4'", "2,"), &[0; 7]), "it ends after 7 of 8 bytes"),
            (file(("'<f4'", "2,"), &[0; 9]), "but more follow"),
            (file(("'<f8'", "4294967296, 4294967296"), &[]), "larger than 2 GiB"),
            (file(("'<f4'", "-1,"), &[]), "not one that numpy.save writes"),
        ] {
            let problem = read_from(&mut &bytes[..]).unwrap_err();
            assert!(problem.contains(expected), "{problem} for {expected}");
        }
    }
}
