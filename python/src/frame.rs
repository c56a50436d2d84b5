// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames from Python: arrays of any layout. Rows whose pixels are adjacent are read in place.

use foveate_design::{Design, DesignConfig};
use foveate_pixels::{ByteFrame, FramePixels};
use numpy::ndarray::ArrayView2;
use numpy::{
    Element, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::array::{conversion, untyped};
use crate::error::{raise, value_error};

/// An array that was checked to be a grey frame.
pub(crate) enum Grey<'py> {
    Bytes(PyReadonlyArray2<'py, u8>),
    Words(PyReadonlyArray2<'py, u16>),
}

impl<'py> Grey<'py> {
    /// Returns a frame from a two-dimensional array of `uint8` or `uint16`, for a design of some bits per pixel. A value that is
    /// no array is converted, as NumPy does.
    pub(crate) fn of(frame: &Bound<'py, PyAny>, bits: u32) -> PyResult<Self> {
        const RIGHT: &str = "a frame is a 2-D array of grey pixels (height, width)";
        let array = untyped(frame, RIGHT)?;
        let shape = array.shape().to_vec();
        if shape.len() != 2 {
            return Err(PyValueError::new_err(format!(
                "{RIGHT}, not one of shape {}{}",
                array.getattr("shape")?,
                hint(&shape)
            )));
        }
        if shape.contains(&0) {
            return Err(PyValueError::new_err(format!(
                "the frame has no pixels: its shape is {}",
                array.getattr("shape")?
            )));
        }
        let (py, dtype) = (frame.py(), array.dtype());
        if dtype.is_equiv_to(&u8::get_dtype(py)) {
            return Ok(Self::Bytes(array.cast::<numpy::PyArray2<u8>>()?.try_readonly()?));
        }
        if dtype.is_equiv_to(&u16::get_dtype(py)) {
            let array = if array.getattr("flags")?.getattr("aligned")?.extract()? {
                array
            } else {
                array.call_method0("copy")?.cast_into::<PyUntypedArray>()?
            };
            return Ok(Self::Words(array.cast::<numpy::PyArray2<u16>>()?.try_readonly()?));
        }
        Err(PyTypeError::new_err(format!(
            "a frame has dtype uint8, or uint16 above 8 bits per pixel, not {}{}",
            dtype.str()?,
            conversion(&array, bits)?
        )))
    }

    /// Refuses a frame of another depth than the design's.
    pub(crate) fn check(&self, bits: u32) -> PyResult<()> {
        match (self, bits) {
            (Self::Bytes(_), 9..) => Err(PyTypeError::new_err(format!(
                "the frame has dtype uint8, but the design has {bits} bits per pixel; give a frame of uint16 with \
                 values of {bits} bits, or set frame={{\"pixel_bits\": 8}}"
            ))),
            (Self::Words(_), ..=8) => Err(PyTypeError::new_err(format!(
                "the frame has dtype uint16, but the design has {bits} bits per pixel; give a frame of uint8, or \
                 set frame={{\"pixel_bits\": 16}}"
            ))),
            _ => Ok(()),
        }
    }

    /// Returns the pixels row by row without gaps: in place, or copied into `scratch` if there are gaps.
    pub(crate) fn packed<'a>(&'a self, scratch: &'a mut Scratch) -> FramePixels<'a> {
        match self {
            Self::Bytes(array) => FramePixels::Bytes(packed(array.as_array(), &mut scratch.bytes)),
            Self::Words(array) => FramePixels::Words(packed(array.as_array(), &mut scratch.words)),
        }
    }

    /// Returns a copy of the frame with the depth of the design.
    pub(crate) fn raster(&self, bits: u32) -> PyResult<ByteFrame> {
        self.check(bits)?;
        let (width, height) = sides(self.size());
        match self {
            Self::Bytes(array) => {
                let pixels = array.as_array().iter().copied().collect();
                ByteFrame::from_bytes(width, height, bits, pixels)
            }
            Self::Words(_) => ByteFrame::from_words(width, height, bits, self.values()),
        }
        .map_err(value_error)
    }

    /// Returns a copy of the pixels, row by row.
    pub(crate) fn values(&self) -> Vec<u16> {
        match self {
            Self::Bytes(array) => array.as_array().iter().map(|&value| value.into()).collect(),
            Self::Words(array) => array.as_array().iter().copied().collect(),
        }
    }

    /// Returns width and height in pixels.
    pub(crate) fn size(&self) -> (usize, usize) {
        let shape = match self {
            Self::Bytes(array) => array.shape(),
            Self::Words(array) => array.shape(),
        };
        (shape[1], shape[0])
    }
}

/// Refuses a frame of another size than the frames before it.
pub(crate) fn check_size((width, height): (usize, usize), own: (usize, usize)) -> PyResult<()> {
    let (own_width, own_height) = own;
    if (width, height) == own {
        return Ok(());
    }
    Err(PyValueError::new_err(format!(
        "the frame has {width}x{height} pixels, but this camera has taken frames of {own_width}x{own_height}; \
         make a camera for each size, or call reset() before the first frame of another size"
    )))
}

pub(crate) fn design_of_size(config: &DesignConfig, size: (usize, usize)) -> PyResult<Design> {
    let (width, height) = sides(size);
    config.validate_for_frames(width, height).map_err(raise)
}

/// Returns the width and height of the frames of a design.
pub(crate) fn size_of(design: &Design) -> (usize, usize) {
    (design.width() as usize, design.height() as usize)
}

fn sides((width, height): (usize, usize)) -> (u32, u32) {
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    (side(width), side(height))
}

/// Describes how to make a frame of a value that is none.
fn hint(shape: &[usize]) -> &'static str {
    match shape {
        [_, _, 1] => "; take frame[:, :, 0]",
        [_, _, 3] => "; foveate.luma(frame) makes a grey frame of red, green and blue",
        [1, _, _] => "; take frame[0]",
        [_, _, _] => "; give the frames one by one",
        _ => "",
    }
}

/// Memory for pixels that cannot be read in place.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) bytes: Vec<u8>,
    pub(crate) words: Vec<u16>,
}

/// Returns the pixels and the distance of their rows: in place, or copied into `scratch` if the pixels of a row are not
/// adjacent, or if rows overlap or are in reverse order.
pub(crate) fn rows<'a, T: Copy>(
    view: ArrayView2<'a, T>,
    scratch: &'a mut Vec<T>,
) -> (&'a [T], usize) {
    let (height, width) = view.dim();
    let [down, across] = *view.strides() else { unreachable!("two dimensions have two strides") };
    let stride = usize::try_from(down).ok().filter(|&stride| stride >= width || height == 1);
    if let (Some(stride), true) = (stride, across == 1 || width == 1) {
        let stride = stride.max(width);
        let len = (height - 1) * stride + width;
        // SAFETY: the view contains its first and its last pixel, which is `len - 1` after the first, as both strides are
        // positive. A NumPy array is one allocation, so all pixels between are readable. They are `u8` or `u16`, for which
        // every bit pattern is valid. The borrow that made the view outlives the slice.
        #[allow(unsafe_code, reason = "ndarray gives no slice of rows with gaps")]
        let values = unsafe { std::slice::from_raw_parts(view.as_ptr(), len) };
        return (values, stride);
    }
    (packed(view, scratch), width)
}

fn packed<'a, T: Copy>(view: ArrayView2<'a, T>, scratch: &'a mut Vec<T>) -> &'a [T] {
    if let Some(pixels) = view.to_slice() {
        return pixels;
    }
    scratch.clear();
    scratch.extend(view.iter().copied());
    scratch
}
