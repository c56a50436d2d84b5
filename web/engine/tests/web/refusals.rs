// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that wrong input gives a message with the fault and with what would be right, and changes
//! nothing.

use foveate_web::{MAX_CAMERAS, PageCameras};

fn refused<T>(result: Result<T, foveate_web::WebError>) -> String {
    result.err().map(|error| error.to_string()).unwrap()
}

#[test]
fn faults_are_reported() {
    let mut desk = PageCameras::default();
    for (toml, size, words) in [
        (&b"[region]\nsize = 65\n"[..], (16, 16), "2..=64"),
        (b"[regoin]\n", (16, 16), "did you mean `region`"),
        (b"a\xFF", (16, 16), "not UTF-8 text, from byte 1 on"),
        (b"[frame]\nwidth = 8\n", (16, 16), "an input of 16x16 pixels"),
        (b"", (0, 16), "frame.width"),
        (b"", (16_384, 16_384), "1 to 8294400 pixels"),
    ] {
        let message = refused(desk.configure(toml, size));
        assert!(message.contains(words), "{message}");
    }
    assert!(refused(desk.scene_frame(b"steet", (8, 8), 8, 0)).contains("did you mean `street`"));
    assert!(refused(desk.scene_frame(b"street", (8, 0), 8, 0)).contains("8x0 pixels"));
    assert!(refused(desk.scene_frame(b"street", (u32::MAX, u32::MAX), 8, 0)).contains("refused"));
}

#[test]
fn frames_of_another_length_change_nothing() {
    let mut desk = PageCameras::default();
    let (handle, _) = desk.configure(b"", (16, 12)).unwrap();
    let camera = desk.camera(handle).unwrap();
    camera.step_grey(&[100; 16 * 12], None).unwrap();
    let before = camera.engine().digest();
    assert!(
        refused(camera.step_grey(&[0; 191], None)).contains("16x12 pixels has 192, 1 per pixel")
    );
    assert!(
        refused(camera.step_rgba(&[0; 192], None)).contains("16x12 pixels has 768, 4 per pixel")
    );
    assert!(refused(camera.scores(1)).contains("the camera has 1, counted from 0"));
    assert_eq!(camera.engine().digest(), before);
    assert_eq!(camera.step_grey(&[100; 16 * 12], None).unwrap().number, 1);
}

#[test]
fn maps_that_do_not_fit_change_nothing() {
    let mut desk = PageCameras::default();
    let (handle, _) = desk.configure(b"[zones]\nclasses = [\"12\"]\n", (16, 8)).unwrap();
    let (plain, _) = desk.configure(b"", (16, 8)).unwrap();
    assert!(refused(desk.set_classes(handle, &[0, 4])).contains("region 1 has the class 4"));
    assert!(refused(desk.set_classes(handle, &[0; 3])).contains("3 classes, but the camera has 2"));
    assert!(refused(desk.set_classes(plain, &[0, 1])).contains("the camera has no zones"));
    assert!(refused(desk.set_classes(7, &[0, 1])).contains("no camera number 7"));
    let camera = desk.camera(handle).unwrap();
    assert_eq!(camera.design().config().camera.zones.as_ref().unwrap().classes, ["12"]);
    assert_eq!(camera.engine().classes().len(), 2);
    assert!(desk.set_classes(plain, &[0, 0]).is_ok());
}

#[test]
fn the_number_of_cameras_is_limited_and_they_can_be_removed() {
    let mut desk = PageCameras::default();
    let all: Vec<u32> = (0..MAX_CAMERAS).map(|_| desk.configure(b"", (8, 8)).unwrap().0).collect();
    assert!(refused(desk.configure(b"", (8, 8))).contains("8 cameras already"));
    desk.remove(all[3]).unwrap();
    assert!(refused(desk.remove(all[3])).contains("no camera number 3"));
    assert!(refused(desk.camera(u32::MAX)).contains("no camera number"));
    assert_eq!(desk.configure(b"", (8, 8)).unwrap().0, all[3]);
}
