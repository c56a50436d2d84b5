// SPDX-License-Identifier: MIT OR Apache-2.0
//! The form of a set as files. A set that is made from it can have the same form.

/// The files and the labels of a set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SetForm {
    /// The kind of the files that hold the images.
    pub files: SetFiles,
    /// The kind of the labels.
    pub labels: SetLabels,
}

/// The kind of the files that hold the images of a set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SetFiles {
    /// Every image is a file.
    #[default]
    Images,
    /// The images are records in another file, without names of their own.
    Records,
    /// The images are in an IDX file, and the labels in another one.
    Idx {
        /// The file of images.
        images: IdxFile,
        /// The file of labels, if there is one.
        labels: Option<IdxFile>,
    },
}

/// An IDX file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdxFile {
    /// The name of the file, without the folder.
    pub name: String,
    /// True if the file is gzipped.
    pub packed: bool,
}

/// The kind of the labels of a set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SetLabels {
    /// There are no labels.
    #[default]
    None,
    /// The labels are numbers.
    Numbers,
    /// The labels are names, each listed once and in byte order. The number of a label is its index
    /// in this list.
    Names(Vec<String>),
}

impl SetLabels {
    /// Returns the number of a label, or -1 if there is none.
    #[must_use]
    pub fn number(&self, label: Option<&str>) -> i64 {
        let number = label.and_then(|label| match self {
            Self::None => None,
            Self::Numbers => label.parse().ok(),
            Self::Names(names) => {
                let place = names.binary_search_by(|name| name.as_str().cmp(label)).ok()?;
                i64::try_from(place).ok()
            }
        });
        number.unwrap_or(-1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_numbers() {
        let names = SetLabels::Names(vec!["ant".to_owned(), "bee".to_owned()]);
        assert_eq!([Some("bee"), Some("cat"), None].map(|label| names.number(label)), [1, -1, -1]);
        assert_eq!(SetLabels::Numbers.number(Some("42")), 42);
        assert_eq!(SetLabels::None.number(Some("42")), -1);
    }
}
