// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of a pipelined RPU, and that of the RCM that consists of such RPUs.

use crate::interface::{BeatRegion, CoreInterface, CoreStream, StreamRole};
use crate::port::{class_input, decision_ports, sync_input, sync_output};
use crate::thresholds::threshold_ports;
use crate::{Design, Port, PortDirection, PortRole};

pub(crate) fn rpu_interface(design: &Design) -> CoreInterface {
    use PortDirection::{Input, Output};
    let single = Port::scalar;
    let pixels = CoreStream::into_core(
        StreamRole::Pixels,
        "a pixel of the region with its halo",
        single(Input, PortRole::Valid, 1, "a pixel is taken at this edge"),
        vec![single(Input, PortRole::Pixel, design.pixel_bits(), "pixel, row by row")],
    );
    let decisions = CoreStream::out_of_core(
        StreamRole::Decisions,
        "the decision of the region with its scores",
        single(
            Output,
            PortRole::DecisionValid,
            1,
            "decision and scores are those of a whole frame",
        ),
        decision_and_score_ports(design),
    );
    let doc = "the pixel that leaves; 0 unless forward_valid_o";
    let (beat, leaves) = match design.periphery() {
        None => ("a pixel of the region", "a pixel of an active region leaves"),
        Some(_) => {
            ("a pixel or a mean of the region", "a pixel of an active region leaves, or a mean")
        }
    };
    let forwarded = CoreStream::out_of_core(
        StreamRole::ForwardedPixels,
        beat,
        single(Output, PortRole::ForwardValid, 1, leaves),
        vec![single(Output, PortRole::ForwardPixel, design.pixel_bits(), doc)],
    );
    let doc = "sides on the frame's border: {bottom, top, right, left}";
    let border = design.needs_border().then(|| single(Input, PortRole::Border, 4, doc));
    let controls = border.into_iter().chain(class_input(design)).chain(threshold_ports(design));
    let controls = controls.collect();
    CoreInterface::new(vec![pixels, decisions, forwarded], controls)
}

fn decision_and_score_ports(design: &Design) -> Vec<Port> {
    let output = |role, width, doc| Port::scalar(PortDirection::Output, role, width, doc);
    let mut list = decision_ports(design, "the region's");
    for feature in design.features() {
        let doc = "score; final with decision_valid_o";
        list.push(output(PortRole::Score(feature.kind()), feature.score_bits(), doc));
    }
    let doc = "changed pixels; final with decision_valid_o";
    list.push(output(PortRole::TemporalCount, design.count_bits(), doc));
    list
}

/// Returns the interface of the RCM: that of the RPU, with one lane per region for ports that
/// differ by region. The border inputs are constants inside the RCM, and the logic that finds the
/// start of a frame is in front of all RPUs.
pub(crate) fn rcm_interface(design: &Design) -> CoreInterface {
    let mut interface = rpu_interface(design);
    interface.controls.retain(|port| port.role != PortRole::Border);
    for stream in &mut interface.streams {
        stream.region = BeatRegion::Lane;
        match stream.role {
            StreamRole::Pixels => {
                stream.beat = "a pixel of every region";
                stream.start = sync_input(design);
                stream.status.extend(sync_output(design));
            }
            StreamRole::Decisions => stream.beat = "the decisions of all regions with their scores",
            StreamRole::ForwardedPixels => {
                stream.beat = match design.periphery() {
                    None => "a pixel of every active region",
                    Some(_) => "a pixel of every active region, or a mean of every summary",
                };
            }
            StreamRole::ClassWords
            | StreamRole::ClassCommits
            | StreamRole::References
            | StreamRole::StoredWords
            | StreamRole::Scores
            | StreamRole::LostRegions => {}
        }
    }
    let make_per_region = |port: &mut Port| {
        if is_per_region(port.role) {
            port.lanes = design.regions();
            port.per_lane = true;
            port.doc.push_str("; element i is region i");
        }
    };
    interface.controls.iter_mut().for_each(make_per_region);
    interface.change_stream_ports(make_per_region);
    interface
}

/// Returns true if the RCM has one lane per region on the port of this role.
fn is_per_region(role: PortRole) -> bool {
    matches!(
        role,
        PortRole::Pixel
            | PortRole::RegionClass
            | PortRole::Srs
            | PortRole::Trs
            | PortRole::Active
            | PortRole::Summary
            | PortRole::Score(_)
            | PortRole::TemporalCount
            | PortRole::ForwardValid
            | PortRole::ForwardPixel
    )
}
