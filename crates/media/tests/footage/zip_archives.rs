// SPDX-License-Identifier: MIT OR Apache-2.0
//! ZIP archives of images.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::clips::{all, frames, opened};
use foveate_media::{ImageRelation, InputOptions, SourceKind, input_warnings};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const IMAGE: &str = "P2 2 1 255 1 2\n";

/// Writes an archive with these entries, every second of them packed.
fn archive(folder: &Path, entries: &[(&str, &str)]) -> PathBuf {
    let path = folder.join("frames.zip");
    let mut archive = ZipWriter::new(fs::File::create(&path).unwrap());
    for (number, (name, content)) in entries.iter().enumerate() {
        let method = [CompressionMethod::Stored, CompressionMethod::Deflated][number % 2];
        archive.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        archive.write_all(content.as_bytes()).unwrap();
    }
    archive.finish().unwrap();
    path
}

fn set() -> InputOptions {
    InputOptions { images: ImageRelation::Set, ..InputOptions::default() }
}

fn error(path: &Path, options: &InputOptions) -> String {
    let read = opened(path, 8, options).map(|mut source| {
        while source.next_frame()?.is_some() {}
        Ok(())
    });
    read.and_then(|read| read).unwrap_err().to_string()
}

#[test]
fn an_archive_is_read_as_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let entries = [
        ("take/f10.pgm", "P2 2 1 255 7 8\n"),
        ("take/f2.pgm", "P2 2 1 255 5 6\n"),
        ("take/notes.txt", "text"),
        ("take/.hidden.pgm", IMAGE),
        ("__MACOSX/take/f2.pgm", IMAGE),
    ];
    let path = archive(dir.path(), &entries);
    let (found, problem) = all(&path);
    assert_eq!((found.len(), problem), (2, None));
    assert!(found[0].name.ends_with("frames.zip/take/f2.pgm"));
    let pixels = found.iter().map(|frame| frame.frame.borrowed_pixels().to_words());
    assert_eq!(pixels.collect::<Vec<_>>(), [[5, 6], [7, 8]]);
    assert_eq!((found[0].time_us, found[1].time_us), (0, 33_333));
    assert_eq!(opened(&path, 8, &InputOptions::default()).unwrap().frames(), Some(2));
    assert!(input_warnings(&[&path], &InputOptions::default()).is_empty());
}

#[test]
fn an_archive_of_folders_is_a_set_with_labels() {
    let dir = tempfile::tempdir().unwrap();
    let entries =
        [("data/cat/1.pgm", IMAGE), ("data/dog/1.pgm", IMAGE), ("data/cat/2.webp", "RIFF")];
    let path = archive(dir.path(), &entries);
    let source = opened(&path, 8, &set()).unwrap();
    assert_eq!((source.kind(), source.frames()), (SourceKind::Set, Some(2)));
    let labels = frames(&path, 8, &set()).0.into_iter().map(|frame| frame.label.unwrap());
    assert_eq!(labels.collect::<Vec<_>>(), ["cat", "dog"]);
    let said = input_warnings(&[&path], &set()).join("\n");
    assert!(said.contains("2.webp` is skipped: images of the type WebP"), "{said}");
    let clip = error(&path, &InputOptions::default());
    assert!(clip.contains("several folders, one of them `cat`"), "{clip}");
}

#[test]
fn archives_without_frames_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    for (entries, options, problem) in [
        (&[][..], InputOptions::default(), "it holds no image;"),
        (&[("a.txt", "text")], InputOptions::default(), "it holds no image;"),
        (&[("a.webp", "RIFF")], set(), "but images of the type WebP"),
        (&[("a.mp4", "x")], InputOptions::default(), "it holds videos, such as `a.mp4`"),
        (&[("a.mp4", "x"), ("b.pgm", IMAGE)], InputOptions::default(), "it holds videos"),
        (&[("a.pgm", "P2 2 1 255 1\n")], InputOptions::default(), "frames.zip/a.pgm` is damaged"),
        (
            &[("a.png", IMAGE)],
            InputOptions { images: ImageRelation::CifarSheet, ..InputOptions::default() },
            "a CIFAR sheet is one PNG",
        ),
    ] {
        let said = error(&archive(dir.path(), entries), &options);
        assert!(said.contains(problem), "{said}");
    }
}

#[test]
fn damage_is_found() {
    let dir = tempfile::tempdir().unwrap();
    let path = archive(dir.path(), &[("a.pgm", IMAGE), ("b.pgm", IMAGE)]);
    let bytes = fs::read(&path).unwrap();
    let place = bytes.windows(IMAGE.len()).position(|found| found == IMAGE.as_bytes()).unwrap();
    let mut changed = bytes.clone();
    changed[place + IMAGE.len() - 2] = b'3';
    fs::write(&path, &changed).unwrap();
    let said = error(&path, &InputOptions::default());
    assert!(said.contains("its entry `a.pgm`: ") && said.contains("checksum"), "{said}");
    // A cut archive has no list of its files.
    for length in 4..bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let said = error(&path, &InputOptions::default());
        assert!(said.contains("the ZIP archive") && !said.contains('\n'), "{length}: {said}");
    }
}

#[test]
fn a_set_in_an_archive_is_that_of_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let labels = |entries: &[(&str, &str)]| -> Vec<(String, Option<String>)> {
        let path = archive(dir.path(), entries);
        let names = frames(&path, 8, &set()).0.into_iter().map(|frame| {
            let name = Path::new(&frame.name).file_name().unwrap().to_string_lossy().into_owned();
            (name, frame.label)
        });
        names.collect()
    };
    let found = |name: &str, label: Option<&str>| (name.to_owned(), label.map(str::to_owned));
    assert_eq!(
        labels(&[("cat/1.pgm", IMAGE), ("cat/2.pgm", IMAGE)]),
        [found("1.pgm", Some("cat")), found("2.pgm", Some("cat"))]
    );
    // Images without a label come first, deeper ones are left out, and a backslash may stand
    // between folders.
    let entries = [("a\\1.pgm", IMAGE), ("b.pgm", IMAGE), ("a/sub/2.pgm", IMAGE), ("z.pgm", IMAGE)];
    assert_eq!(
        labels(&entries),
        [found("b.pgm", None), found("z.pgm", None), found("1.pgm", Some("a"))]
    );
    let said = input_warnings(&[archive(dir.path(), &entries)], &set()).join("\n");
    assert!(said.contains("2.pgm` is skipped: it lies deeper"), "{said}");
}

#[test]
fn entries_that_may_be_missed_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let entries = [("f1.pgm", IMAGE), ("f01.pgm", IMAGE), ("b", IMAGE), ("more.zip", "PK")];
    let path = archive(dir.path(), &entries);
    let said = input_warnings(&[&path], &InputOptions::default()).join("\n");
    for part in [
        "b` is skipped: it has no extension",
        "more.zip` is skipped: archives",
        "have the same number",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // A file that only ends as an archive does is none.
    let other = dir.path().join("clip.y4m");
    let bytes = [b"YUV4MPEG2 W2 H1 Cmono\nFRAME\n12".to_vec(), fs::read(&path).unwrap()].concat();
    fs::write(&other, bytes).unwrap();
    assert!(input_warnings(&[&other], &InputOptions::default()).is_empty());
}

#[test]
fn archives_that_are_no_set_of_images_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let plain = InputOptions::default();
    let document = [("[Content_Types].xml", "x"), ("word/media/1.pgm", IMAGE)];
    let said = error(&archive(dir.path(), &document), &plain);
    assert!(said.contains("it is a document or a program; unpack it"), "{said}");
    // Two entries of one name.
    let path = archive(dir.path(), &[("a.pgm", IMAGE), ("b.pgm", IMAGE)]);
    let bytes = fs::read(&path).unwrap();
    let renamed: Vec<u8> =
        bytes.iter().map(|&byte| if byte == b'b' { b'a' } else { byte }).collect();
    fs::write(&path, renamed).unwrap();
    let said = error(&path, &plain);
    assert!(said.contains("several entries of one name"), "{said}");
    // An entry whose bit says that it is encrypted, in both of its headers.
    let path = archive(dir.path(), &[("a.pgm", IMAGE)]);
    let mut bytes = fs::read(&path).unwrap();
    let central = bytes.windows(4).position(|found| found == b"PK\x01\x02").unwrap();
    bytes[6] |= 1;
    bytes[central + 8] |= 1;
    fs::write(&path, bytes).unwrap();
    let said = error(&path, &plain);
    assert!(said.contains("its entry `a.pgm`: it is encrypted; unpack it"), "{said}");
    // A name outside of the archive is a place in it.
    let path = archive(dir.path(), &[("/etc/../a.pgm", IMAGE)]);
    assert!(all(&path).0[0].name.ends_with("frames.zip/etc/a.pgm"));
}
