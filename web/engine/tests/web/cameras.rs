// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that a page computes what the model computes, and that the facts about a camera are true.

use foveate_camera::{FeatureKind, RegionClass};
use foveate_design::{DesignConfig, PRESETS};
use foveate_model::FunctionalCamera;
use foveate_pixels::{Frame, convert_depth, luma};
use foveate_web::PageCameras;

pub(crate) const SIZE: (u32, u32) = (61, 43);
/// The organization that supports all features.
const SERIAL: &str = "hardware.organization=\"serial\"";

/// Returns the presets, and configurations for what they do not reach: other depths, sizes with
/// padding, means of raw pixels.
pub(crate) fn configurations() -> Vec<String> {
    let presets = PRESETS.iter().filter(|preset| !preset.toml.contains("[frame]"));
    let entries = FeatureKind::ALL.iter().map(|kind| format!("{{feature=\"{kind}\"}}"));
    let all = &*format!("spatial=[{}]", entries.collect::<Vec<_>>().join(","));
    let more = [
        &[
            all,
            SERIAL,
            "frame.pixel_bits=10",
            "render.irrelevant=\"mean\"",
            "render.payload=\"raw\"",
        ][..],
        &[
            all,
            SERIAL,
            "frame.pixel_bits=5",
            "region.size=7",
            "temporal.reference=\"last-sent\"",
            "denoise.filter=\"switching3x3\"",
        ],
        &[
            "region.size=12",
            "render.irrelevant=\"mean\"",
            "periphery.blocks=4",
            "region.neighborhood=\"shared\"",
        ],
        &[
            all,
            SERIAL,
            "render.irrelevant=\"mean\"",
            "zones={off_level=9,keen={temporal={level=3},spatial=[{feature=\"edge\",min_score=2}]},areas=[{class=\"off\",rectangle=[0,0,20,30]},{class=\"keen\",rectangle=[20,8,16,16]},{class=\"always\",rectangle=[40,30,9,9]}]}",
        ],
        &[
            "frame.pixel_bits=16",
            "region.size=16",
            "render.irrelevant=\"hold\"",
            "denoise.filter=\"binomial3x3\"",
        ],
    ];
    let more = more.map(|keys| DesignConfig::from_toml_with("", keys).unwrap().to_toml());
    presets.map(|preset| preset.toml.to_owned()).chain(more).collect()
}

pub(crate) fn grey(desk: &mut PageCameras, number: u32) -> Vec<u8> {
    desk.scene_frame(b"street", SIZE, 8, number).unwrap().to_vec()
}

/// Returns the frame that the model takes.
pub(crate) fn frame(grey: &[u8], bits: u32) -> Frame {
    let pixels = grey.iter().map(|&grey| convert_depth(grey.into(), 8, bits)).collect();
    Frame::new(SIZE.0, SIZE.1, bits, pixels).unwrap()
}

#[test]
fn every_camera_equals_the_model() {
    let mut moved = 0;
    for toml in configurations() {
        let mut desk = PageCameras::default();
        let (handle, _) = desk.configure(toml.as_bytes(), SIZE).unwrap();
        let design = desk.camera(handle).unwrap().design().clone();
        let bits = design.pixel_bits();
        let mut model = FunctionalCamera::new(&design);
        for number in 0..6 {
            let grey = grey(&mut desk, number * 3);
            let expected = model.step(&frame(&grey, bits)).unwrap();
            let camera = desk.camera(handle).unwrap();
            let sent = camera.step_grey(&grey, None).unwrap();
            let outcome = camera.engine().outcome();
            assert_eq!(camera.engine().rendered().to_words(), expected.rendered.pixels(), "{toml}");
            assert_eq!(outcome.actions, expected.actions, "{toml}");
            assert_eq!(
                (0..design.features().len())
                    .map(|at| camera.scores(u32::try_from(at).unwrap()).unwrap().to_vec())
                    .collect::<Vec<_>>(),
                expected.scores
            );
            let flow = design.features().iter().position(|one| one.kind().is_displacement());
            let votes = flow.map(|at| (design.features()[at].min_score(), &expected.scores[at]));
            let told = expected.displacements.iter().enumerate().flat_map(|(region, one)| {
                let (min_score, scores) = votes.unwrap();
                [one.dx, one.dy, i8::from(scores[region] >= min_score)]
            });
            assert!(told.eq(camera.displacements().iter().copied()), "{toml}");
            moved += camera.displacements().chunks(3).filter(|told| told[..2] != [0, 0]).count();
            assert_eq!(
                sent.bits,
                design.bits_sent(1, design.values_sent_per_frame(&expected.actions))
            );
            let count =
                |bits: &[bool]| u32::try_from(bits.iter().filter(|&&bit| bit).count()).unwrap();
            assert_eq!(
                (sent.number, sent.active, sent.srs, sent.trs),
                (
                    number.into(),
                    count(&expected.active),
                    count(&expected.srs),
                    count(&expected.trs)
                )
            );
            let actions = sent.actions;
            assert_eq!(
                actions.forward + actions.hold + actions.blank + actions.summarize,
                design.regions()
            );
            assert_eq!(actions.forward, sent.active);
            let shown =
                expected.rendered.pixels().iter().map(|&pixel| convert_depth(pixel, bits, 8));
            assert!(camera.screen().iter().map(|&grey| u16::from(grey)).eq(shown), "{toml}");
            if bits >= 8 {
                assert_eq!(camera.input(), grey);
            }
        }
    }
    assert!(moved > 50, "only {moved} regions have moved");
}

/// Colours are converted to grey by the rule of images. A camera that was reset equals a new one.
#[test]
fn colours_are_the_luma_of_images_and_a_reset_is_a_new_start() {
    let mut desk = PageCameras::default();
    let (first, _) = desk.configure(b"", SIZE).unwrap();
    let colours: Vec<u8> =
        grey(&mut desk, 5).iter().flat_map(|&grey| [grey, 255 - grey, grey / 2, 9]).collect();
    let luma =
        colours.as_chunks::<4>().0.iter().map(|&[r, g, b, _]| luma(r.into(), g.into(), b.into()));
    let luma: Vec<u8> = luma.map(|grey| u8::try_from(grey).unwrap()).collect();
    let mut hashes = Vec::new();
    for _ in 0..2 {
        let camera = desk.camera(first).unwrap();
        camera.reset();
        assert_eq!(camera.step_rgba(&colours, None).unwrap().number, 0);
        assert_eq!(camera.input(), luma);
        hashes.push(camera.engine().digest());
    }
    let (second, _) = desk.configure(b"", SIZE).unwrap();
    let camera = desk.camera(second).unwrap();
    camera.step_grey(&luma, None).unwrap();
    hashes.push(camera.engine().digest());
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:x?}");
    camera.step_grey(&luma, None).unwrap();
    assert_ne!(camera.engine().digest(), hashes[0], "the second frame is compared with the first");
}

/// The TOML of a camera describes the same camera, and its bounds belong to its keys.
#[test]
fn facts_are_those_of_the_camera() {
    let mut desk = PageCameras::default();
    for toml in configurations() {
        let (handle, facts) = desk.configure(toml.as_bytes(), SIZE).unwrap();
        let design = desk.camera(handle).unwrap().design().clone();
        let again = DesignConfig::from_toml(facts["toml"].as_str().unwrap()).unwrap();
        assert_eq!(again.validate().unwrap().fingerprint(), design.fingerprint());
        assert_eq!(facts["fingerprint"], design.fingerprint());
        assert_eq!(facts["raw_bits_per_frame"], u64::from(61 * 43 * design.pixel_bits()));
        for key in facts["bounds"].as_object().unwrap().keys() {
            let path = format!("/{}", key.replace('.', "/"));
            assert!(facts["config"].pointer(&path).is_some(), "{key} is no key of {facts}");
        }
        desk.remove(handle).unwrap();
    }
}

#[test]
fn what_is_described_can_be_asked_for() {
    let mut desk = PageCameras::default();
    let told = desk.description().unwrap();
    for preset in told["presets"].as_array().unwrap() {
        let size = if preset["name"] == "raster" { (640, 480) } else { SIZE };
        let (handle, _) =
            desk.configure(preset["toml"].as_str().unwrap().as_bytes(), size).unwrap();
        desk.remove(handle).unwrap();
    }
    for scene in told["scenes"].as_array().unwrap() {
        let (name, frames) = (scene["name"].as_str().unwrap(), scene["frames"].as_u64().unwrap());
        let frames = u32::try_from(frames).unwrap();
        let first = desk.scene_frame(name.as_bytes(), SIZE, 8, 0).unwrap().to_vec();
        assert_eq!(desk.scene_frame(name.as_bytes(), SIZE, 8, frames).unwrap(), first, "{name}");
    }
    let organizations: Vec<(&str, usize)> = told["features"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| {
            (one["feature"].as_str().unwrap(), one["organizations"].as_array().unwrap().len())
        })
        .collect();
    assert_eq!((organizations[0], organizations[7]), (("edge", 3), ("flow", 1)));
    let keys = told["keys"].as_array().unwrap();
    let key = |name: &str| keys.iter().find(|key| key["key"] == name).unwrap();
    assert_eq!((&key("region.size")["min"], &key("region.size")["max"]), (&2.into(), &64.into()));
    assert_eq!(key("temporal.reference")["choices"], serde_json::json!(["previous", "last-sent"]));
    for (name, default) in [
        ("region.size", 8),
        ("spatial.level", 100),
        ("periphery.blocks", 2),
        ("periphery.level", 4),
    ] {
        assert_eq!(key(name)["default"], default, "{name}");
    }
}

/// Returns the classes of frame `number`, as numbers; the first map has regions of every class.
pub(crate) fn classes(regions: u32, number: u32) -> Vec<u8> {
    (0..regions).map(|region| ((region * 7 + number * 3) % 5 % 4) as u8).collect()
}

#[test]
fn a_map_holds_from_the_next_frame_on_and_is_in_the_configuration() {
    for more in ["", "[render]\nirrelevant = \"mean\"\n", "[temporal]\nreference = \"last-sent\"\n"]
    {
        let toml = format!("{more}[zones]\nkeen = {{ temporal = {{ level = 2 }} }}\n");
        let mut desk = PageCameras::default();
        let (handle, _) = desk.configure(toml.as_bytes(), SIZE).unwrap();
        let design = desk.camera(handle).unwrap().design().clone();
        let mut model = FunctionalCamera::new(&design);
        for number in 0..6 {
            if number % 2 == 1 {
                let codes = classes(design.regions(), number);
                let facts = desk.set_classes(handle, &codes).unwrap();
                let digits: String = codes.iter().map(u8::to_string).collect();
                let rows = &facts["config"]["zones"]["classes"];
                let rows: String =
                    rows.as_array().unwrap().iter().flat_map(|row| row.as_str()).collect();
                assert_eq!(rows, digits);
                let own = DesignConfig::from_toml(facts["toml"].as_str().unwrap()).unwrap();
                assert_eq!(&own.validate().unwrap(), desk.camera(handle).unwrap().design());
                let classes = codes.iter().map(|&code| RegionClass::from_code(code).unwrap());
                model.set_classes(&classes.collect::<Vec<_>>()).unwrap();
            }
            let grey = grey(&mut desk, number * 3);
            let expected = model.step(&frame(&grey, 8)).unwrap();
            let camera = desk.camera(handle).unwrap();
            camera.step_grey(&grey, None).unwrap();
            assert_eq!(camera.engine().outcome().actions, expected.actions, "{toml} {number}");
            assert_eq!(camera.engine().rendered().to_words(), expected.rendered.pixels());
        }
        let normal = vec![0; design.regions() as usize];
        let facts = desk.set_classes(handle, &normal).unwrap();
        assert_eq!(facts["config"]["zones"].get("classes"), None);
    }
}
