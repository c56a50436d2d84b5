// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered files, named as ffmpeg and OpenCV name them: `frames/f%04d.png`.

use std::path::{Path, PathBuf};

use super::entry::{EntryKind, entries, entry_kind};
use super::pattern::unread_kind_error;
use super::skip_reason::{SkipReason, SkippedInput};
use crate::FootageError;
use crate::source::file_feeds::ImageFile;

/// The name of numbered files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SequenceName {
    folder: PathBuf,
    before: String,
    after: String,
    /// The smallest number of digits, for which zeros are put in front.
    digits: usize,
}

impl SequenceName {
    /// Returns the name if a text has exactly one `%d`, `%4d` or `%04d`, in the name of the file.
    /// `%%` is a percent sign.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let path = Path::new(text);
        let name = path.file_name()?.to_str()?;
        let mut parts = Vec::new();
        let (mut literal, mut rest) = (String::new(), name);
        while let Some((before, after)) = rest.split_once('%') {
            literal.push_str(before);
            if let Some(after) = after.strip_prefix('%') {
                literal.push('%');
                rest = after;
                continue;
            }
            let (width, after) = after.split_once('d')?;
            let is_number = width.bytes().all(|byte| byte.is_ascii_digit());
            let digits =
                if width.is_empty() { 1 } else { width.parse().ok().filter(|_| is_number)? };
            parts.push((std::mem::take(&mut literal), usize::max(digits, 1)));
            rest = after;
        }
        literal.push_str(rest);
        let [(before, digits)] = parts.try_into().ok()?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).to_owned();
        Some(Self { folder, before, after: literal, digits })
    }

    /// Returns true if the folder of the files exists.
    pub(crate) fn has_folder(&self) -> bool {
        self.folder.is_dir()
    }

    /// Returns the number in a name; `None` for another name.
    fn number_of(&self, name: &str) -> Option<u128> {
        let digits = self.digits_of(name)?;
        // A longer number has no zeros in front, and so `f%02d` does not match `f0012`.
        let is_padded =
            digits.len() == self.digits || (digits.len() > self.digits && !digits.starts_with('0'));
        if is_padded { digits.parse().ok() } else { None }
    }

    /// Returns the digits in a name, however many there are; `None` for another name.
    fn digits_of<'a>(&self, name: &'a str) -> Option<&'a str> {
        let digits = name.strip_prefix(&self.before)?.strip_suffix(&self.after)?;
        let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then_some(digits)
    }

    fn path_of(&self, number: u128) -> PathBuf {
        let Self { before, after, digits, .. } = self;
        self.folder.join(format!("{before}{number:0digits$}{after}"))
    }

    fn files(&self) -> Result<Vec<(u128, PathBuf)>, FootageError> {
        let mut files: Vec<(u128, PathBuf)> = entries(&self.folder)?
            .into_iter()
            .filter_map(|path| Some((self.number_of(path.file_name()?.to_str()?)?, path)))
            .collect();
        files.sort();
        Ok(files)
    }

    /// Returns the images of the sequence in order.
    pub(super) fn images(&self, text: &str) -> Result<Vec<ImageFile>, FootageError> {
        let files = self.files()?;
        let not_image = files.iter().find(|(_, path)| entry_kind(path) != EntryKind::Image);
        if let Some((_, path)) = not_image {
            let error = match entry_kind(path) {
                EntryKind::Folder | EntryKind::Skipped(Some(SkipReason::NotAFile)) => {
                    FootageError::Unreadable {
                        path: path.clone(),
                        problem: "it is not a file".to_owned(),
                    }
                }
                EntryKind::Image | EntryKind::Video | EntryKind::Skipped(_) => {
                    FootageError::UnsupportedType { path: path.clone() }
                }
            };
            return Err(unread_kind_error(text, path).unwrap_or(error));
        }
        if files.is_empty() {
            return Err(self
                .other_width_error(text)?
                .unwrap_or_else(|| FootageError::NoMatch { pattern: text.to_owned() }));
        }
        Ok(files.into_iter().map(|(_, path)| ImageFile::plain(path)).collect())
    }

    /// Returns the error for a name that no file has, if there are files whose numbers have another
    /// number of digits.
    fn other_width_error(&self, text: &str) -> Result<Option<FootageError>, FootageError> {
        let files = entries(&self.folder)?;
        let found = files.iter().find_map(|path| {
            let digits = self.digits_of(path.file_name()?.to_str()?)?;
            (entry_kind(path) == EntryKind::Image).then_some((path, digits))
        });
        Ok(found.map(|(path, digits)| {
            let number = if digits.starts_with('0') {
                format!("%0{}d", digits.len())
            } else {
                "%d".to_owned()
            };
            let [before, after] = [&self.before, &self.after].map(|part| part.replace('%', "%%"));
            let problem = format!(
                "no image matches `{text}`, but `{}` exists; write `{}`",
                path.display(),
                Path::new(text).with_file_name(format!("{before}{number}{after}")).display()
            );
            FootageError::Option { option: "the pattern", problem }
        }))
    }

    /// Returns the first missing file of each gap between the numbers.
    pub(crate) fn gaps(&self) -> Vec<SkippedInput> {
        let files = self.files().unwrap_or_default();
        let pairs = files.iter().zip(files.iter().skip(1));
        let gaps = pairs.filter(|((one, _), (next, _))| one + 1 != *next);
        gaps.map(|((one, _), _)| SkippedInput::new(&self.path_of(one + 1), SkipReason::NumberGap))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_sequences_have_one_number() {
        let name = |text: &str| {
            SequenceName::parse(text).map(|name| (name.before, name.digits, name.after))
        };
        let found =
            |before: &str, digits, after: &str| Some((before.to_owned(), digits, after.to_owned()));
        assert_eq!(name("a/f%04d.png"), found("f", 4, ".png"));
        assert_eq!(name("%d.png"), found("", 1, ".png"));
        assert_eq!(name("100%%-%3d.png"), found("100%-", 3, ".png"));
        assert_eq!(name("%0d.png"), found("", 1, ".png"));
        for text in
            ["f.png", "%+4d.png", "f%.png", "f%x.png", "%d-%d.png", "a%04d/f.png", "f%%d.png", ""]
        {
            assert_eq!(name(text), None, "{text}");
        }
    }

    #[test]
    fn numbers_are_padded_as_printf_does() {
        let name = SequenceName::parse("f%03d.png").unwrap();
        for (file, number) in [
            ("f000.png", Some(0)),
            ("f012.png", Some(12)),
            ("f1234.png", Some(1234)),
            ("f12.png", None),
            ("f0123.png", None),
            ("f1a2.png", None),
            ("g012.png", None),
            ("f012.jpg", None),
        ] {
            assert_eq!(name.number_of(file), number, "{file}");
        }
        assert_eq!(name.path_of(7), Path::new("./f007.png"));
    }
}
