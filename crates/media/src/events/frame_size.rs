// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sizes of frames that a format can hold.

use crate::events::{EventFileError, EventFormat};

/// Refuses a size (width, height) whose coordinates the format cannot hold.
pub(crate) fn check_frame_size(
    format: EventFormat,
    (width, height): (u32, u32),
) -> Result<(), EventFileError> {
    if width.max(height) > format.max_side() {
        return Err(EventFileError::FrameTooLarge { format, width, height });
    }
    Ok(())
}
