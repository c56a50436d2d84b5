// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that a recording holds whole frames, and has a limit.

use foveate_web::{MAX_RECORDING, PageCameras};

#[test]
fn a_recording_has_a_row_per_region_and_frame_until_it_is_full() {
    let mut desk = PageCameras::default();
    // The frame has 24,576 regions, each with a row of 40 bytes or more.
    let toml = b"[region]\nsize = 2\n[temporal]\nmin_count = 4\n[[spatial]]\nfeature = \"edge\"\nmin_score = 4\n";
    let (handle, _) = desk.configure(toml, (256, 384)).unwrap();
    let camera = desk.camera(handle).unwrap();
    assert!(camera.recorded_events().unwrap_err().to_string().contains("nothing is recorded"));
    camera.set_recording(true, false);
    let frame = vec![9; 256 * 384];
    let first = camera.step_grey(&frame, Some(5)).unwrap().recording.unwrap();
    assert_eq!((first.frames, first.full), (1, false));
    let text = String::from_utf8(camera.recorded_events().unwrap().to_vec()).unwrap();
    assert!(text.starts_with(
        "frame,t_us,x,y,x0,y0,srs,trs,score_edge,t_count,action\n0,5,0,0,0,0,0,1,0,4,blank\n"
    ));
    assert_eq!(text.lines().count(), 1 + 128 * 192);
    let last = (0..200).map(|_| camera.step_grey(&frame, None).unwrap().recording.unwrap());
    let last = last.last().unwrap();
    assert!(last.full && last.bytes <= MAX_RECORDING && last.bytes > MAX_RECORDING / 10 * 9);
    let text = camera.recorded_events().unwrap();
    assert_eq!(text.len(), last.bytes);
    let lines = text.iter().filter(|&&byte| byte == b'\n').count();
    assert_eq!(u64::try_from(lines).unwrap(), 1 + last.frames * 128 * 192, "no frame is cut");
    camera.reset();
    let again = camera.step_grey(&frame, Some(5)).unwrap().recording.unwrap();
    assert_eq!(again, first, "a recording begins anew");
    camera.set_recording(true, true);
    assert_eq!(camera.step_grey(&frame, None).unwrap().recording.unwrap().frames, 1);
    assert_eq!(camera.recorded_events().unwrap().iter().filter(|&&byte| byte == b'\n').count(), 1);
    camera.set_recording(false, false);
    assert_eq!(camera.step_grey(&frame, None).unwrap().recording, None);
}

/// Times that are left out are those of `simulate` at 30 frames per second.
#[test]
fn frames_without_a_time_are_thirty_a_second() {
    let mut desk = PageCameras::default();
    let (handle, _) = desk.configure(b"", (8, 8)).unwrap();
    let camera = desk.camera(handle).unwrap();
    camera.set_recording(true, false);
    for _ in 0..4 {
        camera.step_grey(&[0; 64], None).unwrap();
    }
    let text = String::from_utf8(camera.recorded_events().unwrap().to_vec()).unwrap();
    let times: Vec<&str> =
        text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap()).collect();
    assert_eq!(times, ["0", "33333", "66667", "100000"]);
}
