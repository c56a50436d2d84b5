// SPDX-License-Identifier: MIT OR Apache-2.0
//! The boxes of a file, by frame.
//!
//! MOT files go by the number of a frame. It is the number in the name of the image file
//! (`000012.jpg`), as in every MOT sequence. Frames without such a name are numbered from 1 in
//! their order in the input, and frames that are not selected count, too. All other formats go by
//! the name of the image. The name in the file may have folders: it fits an image whose path ends
//! with it.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::error::BoxError;
use super::exclusions::BoxExclusions;
use super::format::{BoxFormat, coco, csv_table, mot, yolo};
use super::image_name::path_endings;
use super::view::{BoxView, ImageBoxes, LabelledBox};
use crate::{CropRect, FrameOrigin, SourceFrame};
use foveate_pixels::Rect;

/// The properties of a frame by which its boxes are found.
#[derive(Clone, Copy, Debug)]
pub struct FrameKey<'a> {
    /// The path of the frame's file, or another name.
    pub name: &'a Path,
    /// True if `name` is the path of a file that holds only this frame.
    pub own_file: bool,
    /// The number of the frame in the input, counted from 0.
    pub number: u64,
    /// The width and height of the frame before it is cropped and scaled.
    pub size: (u32, u32),
}

impl<'a> FrameKey<'a> {
    /// Makes the key of a frame that a source returned with this origin.
    #[must_use]
    pub fn from_source_frame(frame: &'a SourceFrame, origin: &FrameOrigin) -> Self {
        let name = Path::new(&frame.name);
        Self { name, own_file: origin.own_file, number: origin.number, size: origin.size }
    }
}

/// The boxes of a frame, or `None` if the file has no entry for it.
pub type FrameBoxes = Option<Vec<LabelledBox>>;

/// The boxes of a file or folder.
#[derive(Debug)]
pub struct BoxFile {
    path: PathBuf,
    format: BoxFormat,
    entries: BoxEntries,
    left_out: BoxExclusions,
    /// The image that took the boxes of each name.
    assigned_images: Mutex<HashMap<String, PathBuf>>,
}

#[derive(Debug)]
enum BoxEntries {
    Numbers(BTreeMap<u64, Vec<LabelledBox>>),
    Names(HashMap<String, ImageBoxes>),
    /// The entries are files of a folder, which are read when an image needs them.
    Folder,
}

impl BoxFile {
    /// Reads a file, or opens a folder of YOLO files without reading them.
    ///
    /// # Errors
    /// Fails if the file cannot be read. The message names the file, and the line if the format has
    /// lines.
    pub fn read(path: &Path) -> Result<Self, BoxError> {
        let format = BoxFormat::detect(path)?;
        let mut left_out = BoxExclusions::default();
        let entries = match format {
            BoxFormat::Mot => BoxEntries::Numbers(mot::read(path, &mut left_out)?),
            BoxFormat::Coco => BoxEntries::Names(coco::read(path, &mut left_out)?),
            BoxFormat::Csv => BoxEntries::Names(csv_table::read(path)?),
            BoxFormat::Yolo => BoxEntries::Folder,
        };
        let (path, assigned_images) = (path.to_owned(), Mutex::default());
        Ok(Self { path, format, entries, left_out, assigned_images })
    }

    /// Returns the path of the file or folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the format.
    #[must_use]
    pub fn format(&self) -> BoxFormat {
        self.format
    }

    /// Reads the files of a YOLO folder for these images, so that a mistake is found before the
    /// frames are read. Other formats have been read already.
    ///
    /// # Errors
    /// Fails if a file cannot be read.
    pub fn check_images<P: AsRef<Path>>(&self, images: &[P]) -> Result<(), BoxError> {
        if !matches!(self.entries, BoxEntries::Folder) {
            return Ok(());
        }
        for image in images {
            if let Some(file) = yolo::find_file(&self.path, &path_endings(image.as_ref())) {
                yolo::read(&file, (1, 1))?;
            }
        }
        Ok(())
    }

    /// Returns a sentence about the boxes that are no objects, counted by reason, if there are any.
    #[must_use]
    pub fn left_out_in_words(&self) -> Option<String> {
        self.left_out.in_words(&self.path)
    }

    /// Returns the number of boxes of frames behind this number, which is counted from 1. Boxes
    /// that go by names belong to no frame behind another one.
    #[must_use]
    pub fn boxes_behind(&self, frame: u64) -> usize {
        match &self.entries {
            BoxEntries::Numbers(frames) => {
                frames.range(frame + 1..).map(|(_, own)| own.len()).sum()
            }
            BoxEntries::Names(_) | BoxEntries::Folder => 0,
        }
    }

    /// Returns true if the boxes go by frame numbers and therefore belong to one clip.
    #[must_use]
    pub fn is_for_one_clip(&self) -> bool {
        matches!(self.entries, BoxEntries::Numbers(_))
    }

    /// Returns the boxes of a frame.
    ///
    /// # Errors
    /// Fails if a file of a YOLO folder cannot be read, a name fits two images, an image has
    /// another size than the file states, or an image has the number 0 although frames are numbered
    /// from 1.
    pub fn boxes_of_frame(&self, place: &FrameKey<'_>) -> Result<FrameBoxes, BoxError> {
        match &self.entries {
            BoxEntries::Numbers(frames) => Ok(frames.get(&self.frame_number(place)?).cloned()),
            BoxEntries::Names(images) => {
                let found = path_endings(place.name)
                    .into_iter()
                    .find_map(|name| images.get(&name).map(|image| (name, image)));
                let Some((name, image)) = found else { return Ok(None) };
                if let Some(stated) = image.size.filter(|&stated| stated != place.size) {
                    let (path, image) = (self.path.clone(), place.name.to_owned());
                    return Err(BoxError::ImageSize { path, image, size: place.size, stated });
                }
                self.assign_name(name, place)?;
                Ok(Some(image.boxes.clone()))
            }
            BoxEntries::Folder => {
                let Some(file) = yolo::find_file(&self.path, &path_endings(place.name)) else {
                    return Ok(None);
                };
                self.assign_name(file.display().to_string(), place)?;
                yolo::read(&file, place.size).map(Some)
            }
        }
    }

    /// Returns the rectangles of a frame's objects in the frame as it is cropped and scaled,
    /// without those that lie mostly outside. Returns `None` if the file has no entry for the
    /// frame.
    ///
    /// # Errors
    /// The errors are those of [`BoxFile::boxes_of_frame`].
    pub fn object_rects(
        &self,
        frame: &SourceFrame,
        origin: &FrameOrigin,
        crop: Option<CropRect>,
    ) -> Result<Option<Vec<Rect>>, BoxError> {
        let view = BoxView::from_source_frame(frame, origin, crop);
        let found = self.boxes_of_frame(&FrameKey::from_source_frame(frame, origin))?;
        Ok(found.map(|found| {
            found.iter().filter_map(|one| view.transform_and_cut(&one.rect)).collect()
        }))
    }

    /// Returns the error for a clip of which no frame has an entry.
    #[must_use]
    pub fn no_entry_error(&self, clip: &str) -> BoxError {
        let first = match &self.entries {
            BoxEntries::Numbers(frames) => {
                frames.keys().next().map(|frame| format!("frame {frame}"))
            }
            BoxEntries::Names(images) => images.keys().min().map(|name| format!("`{name}`")),
            BoxEntries::Folder => None,
        };
        let holds = match (&self.entries, first) {
            (_, Some(first)) => format!("begins with {first}"),
            (BoxEntries::Folder, _) => "needs a file for each, with its name and .txt".to_owned(),
            _ => "has no entries at all".to_owned(),
        };
        BoxError::NoEntry { path: self.path.clone(), clip: clip.to_owned(), holds }
    }

    /// Returns the number by which the boxes of a frame are found, counted from 1.
    ///
    /// # Errors
    /// Fails if an image has the number 0.
    pub fn frame_number(&self, place: &FrameKey<'_>) -> Result<u64, BoxError> {
        let stem = place.name.file_stem().and_then(|stem| stem.to_str());
        let digits = stem.filter(|stem| stem.bytes().all(|byte| byte.is_ascii_digit()));
        match digits.filter(|_| place.own_file).and_then(|digits| digits.parse().ok()) {
            Some(0) => {
                let (path, image) = (self.path.clone(), place.name.to_owned());
                Err(BoxError::FrameZero { path, image })
            }
            Some(number) => Ok(number),
            None => Ok(place.number + 1),
        }
    }

    /// Assigns the boxes of a name to an image, unless another image has them.
    fn assign_name(&self, name: String, place: &FrameKey<'_>) -> Result<(), BoxError> {
        let mut taken = self.assigned_images.lock().unwrap_or_else(PoisonError::into_inner);
        let owner = taken.entry(name.clone()).or_insert_with(|| place.name.to_owned());
        if owner == place.name {
            return Ok(());
        }
        let mut both = [owner.clone(), place.name.to_owned()];
        both.sort();
        let [one, other] = both;
        Err(BoxError::Ambiguous { path: self.path.clone(), name, one, other })
    }
}
