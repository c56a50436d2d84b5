// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of a pipelined RPU and of the RCM of such.

use crate::port::{sync_input, sync_output, threshold_ports};
use crate::{Design, Direction, Port, PortRole};

/// Whether a port of the RCM is one per region or one for all.
#[derive(Clone, Copy, PartialEq)]
enum Spread {
    PerRegion,
    Common,
    /// Constant per region inside the RCM, so no port of it.
    Inside,
}

/// The ports of one RPU.
pub(crate) fn rpu(design: &Design) -> Vec<Port> {
    ports(design).into_iter().map(|(_, port)| port).collect()
}

/// The ports of the RCM: those of the RPU, per region where they differ by region.
pub(crate) fn rcm(design: &Design) -> Vec<Port> {
    let in_rcm = |(spread, mut port): (Spread, Port)| match spread {
        Spread::Inside => None,
        Spread::Common => Some(port),
        Spread::PerRegion => {
            port.lanes = design.regions();
            port.per_lane = true;
            port.doc.push_str("; element i is region i");
            Some(port)
        }
    };
    let mut list: Vec<Port> = ports(design).into_iter().filter_map(in_rcm).collect();
    // What finds the frames stands in front of all RPUs.
    insert(&mut list, |port| port.role == PortRole::Pixel, sync_input(design));
    insert(&mut list, |port| port.direction == Direction::Output, sync_output(design));
    list
}

/// Puts a port, if there is one, in front of the first of these.
fn insert(list: &mut Vec<Port>, before: impl Fn(&Port) -> bool, port: Option<Port>) {
    let place = list.iter().position(before).unwrap_or(list.len());
    if let Some(port) = port {
        list.insert(place, port);
    }
}

fn ports(design: &Design) -> Vec<(Spread, Port)> {
    use Direction::{Input, Output};
    use Spread::{Common, Inside, PerRegion};
    let single = Port::single;
    let pixel = design.pixel_bits();
    let mut list = vec![
        (Common, single(Input, PortRole::Clock, 1, "clock, rising edge")),
        (Common, single(Input, PortRole::Reset, 1, "synchronous reset, active high")),
        (Common, single(Input, PortRole::Valid, 1, "a pixel is taken at this edge")),
        (PerRegion, single(Input, PortRole::Pixel, pixel, "pixel, row by row")),
    ];
    if design.needs_border() {
        let doc = "sides on the frame's border: {bottom, top, right, left}";
        list.push((Inside, single(Input, PortRole::Border, 4, doc)));
    }
    list.extend(threshold_ports(design).into_iter().map(|port| (Common, port)));

    let doc = "decision and scores are those of a whole frame";
    list.push((Common, single(Output, PortRole::DecisionValid, 1, doc)));
    let mut add = |role, width, doc| list.push((PerRegion, single(Output, role, width, doc)));
    add(PortRole::Srs, 1, "spatial relevance; 0 unless decision_valid_o");
    add(PortRole::Trs, 1, "temporal relevance; 0 unless decision_valid_o");
    add(PortRole::Active, 1, "SRS and TRS; 0 unless decision_valid_o");
    for feature in design.features() {
        let doc = "score; final with decision_valid_o";
        add(PortRole::Score(feature.kind()), feature.score_bits(), doc);
    }
    let doc = "changed pixels; final with decision_valid_o";
    add(PortRole::TemporalCount, design.count_bits(), doc);
    add(PortRole::ForwardValid, 1, "a pixel of an active region leaves");
    add(PortRole::ForwardPixel, pixel, "that pixel; 0 unless forward_valid_o");
    list
}
