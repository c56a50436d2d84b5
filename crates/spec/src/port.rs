// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of an RPU and of an RCM. Module headers, harnesses, vectors and benches all follow
//! from these lists.

use crate::{Design, FeatureKind, Thresholds};

/// Direction of a port, seen from the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Into the core.
    Input,
    /// Out of the core.
    Output,
}

/// What a port carries; the model answers by role, never by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PortRole {
    /// The clock.
    Clock,
    /// Synchronous reset, active high.
    Reset,
    /// A pixel is on the pixel port.
    Valid,
    /// One pixel per region.
    Pixel,
    /// Which sides of the region are the frame's border: `{bottom, top, right, left}`.
    Border,
    /// Per-pixel threshold of a feature.
    Level(FeatureKind),
    /// Per-region threshold of a feature, in units of its score.
    MinScore(FeatureKind),
    /// Per-pixel threshold of the temporal score.
    TemporalLevel,
    /// Per-region threshold of the temporal score.
    TemporalMinCount,
    /// The outputs below are those of a whole frame.
    DecisionValid,
    /// Spatial relevance.
    Srs,
    /// Temporal relevance.
    Trs,
    /// Both: the region's pixels will leave.
    Active,
    /// Score of a feature.
    Score(FeatureKind),
    /// Temporal score.
    TemporalCount,
    /// A pixel of an active region leaves.
    ForwardValid,
    /// That pixel.
    ForwardPixel,
}

/// One port: `lanes` values of `width` bits, lane 0 in the lowest bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Name in the Verilog.
    pub name: String,
    /// Direction, seen from the core.
    pub direction: Direction,
    /// What it carries.
    pub role: PortRole,
    /// Bits of one lane.
    pub width: u32,
    /// One, or one per region of the RCM.
    pub lanes: u32,
    /// Whether there is a lane per region: in the RCM, even if it has but one.
    pub per_region: bool,
    /// One line of documentation.
    pub doc: String,
}

impl Port {
    /// Bits of the whole port.
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.width * self.lanes
    }
}

/// Whether a port of the RCM is one per region or one for all.
#[derive(Clone, Copy, PartialEq)]
enum Spread {
    PerRegion,
    Common,
    /// Constant per region inside the RCM, so no port of it.
    Inside,
}

impl Design {
    /// The ports of one RPU, inputs first.
    #[must_use]
    pub fn rpu_ports(&self) -> Vec<Port> {
        ports(self).into_iter().map(|(_, port)| port).collect()
    }

    /// The ports of the RCM: those of the RPU, per region where they differ by region.
    #[must_use]
    pub fn rcm_ports(&self) -> Vec<Port> {
        let in_rcm = |(spread, mut port): (Spread, Port)| match spread {
            Spread::Inside => None,
            Spread::Common => Some(port),
            Spread::PerRegion => {
                port.lanes = self.regions();
                port.per_region = true;
                port.doc.push_str("; region i in lane i");
                Some(port)
            }
        };
        ports(self).into_iter().filter_map(in_rcm).collect()
    }
}

fn ports(design: &Design) -> Vec<(Spread, Port)> {
    use Direction::{Input, Output};
    use Spread::{Common, Inside, PerRegion};
    let mut list = Vec::new();
    let mut add = |spread, direction, role: PortRole, width, doc: &str| {
        let (name, doc) = (port_name(role), doc.to_owned());
        list.push((
            spread,
            Port { name, direction, role, width, lanes: 1, per_region: false, doc },
        ));
    };
    let pixel = design.pixel_bits();

    add(Common, Input, PortRole::Clock, 1, "clock, rising edge");
    add(Common, Input, PortRole::Reset, 1, "synchronous reset, active high");
    add(Common, Input, PortRole::Valid, 1, "a pixel is taken at this edge");
    add(PerRegion, Input, PortRole::Pixel, pixel, "pixel, row by row");
    if design.needs_border() {
        add(
            Inside,
            Input,
            PortRole::Border,
            4,
            "sides on the frame's border: {bottom, top, right, left}",
        );
    }
    if design.thresholds() == Thresholds::Runtime {
        for feature in design.features() {
            let kind = feature.kind();
            if feature.level().is_some() {
                add(
                    Common,
                    Input,
                    PortRole::Level(kind),
                    feature.level_bits(),
                    "a pixel is a hit above this",
                );
            }
            add(
                Common,
                Input,
                PortRole::MinScore(kind),
                feature.score_bits(),
                "the feature votes from this score on",
            );
        }
        add(
            Common,
            Input,
            PortRole::TemporalLevel,
            pixel,
            "a pixel has changed above this difference",
        );
        add(
            Common,
            Input,
            PortRole::TemporalMinCount,
            design.count_bits(),
            "TRS from this count on",
        );
    }

    add(
        Common,
        Output,
        PortRole::DecisionValid,
        1,
        "decision and scores are those of a whole frame",
    );
    add(PerRegion, Output, PortRole::Srs, 1, "spatial relevance; 0 unless decision_valid_o");
    add(PerRegion, Output, PortRole::Trs, 1, "temporal relevance; 0 unless decision_valid_o");
    add(PerRegion, Output, PortRole::Active, 1, "SRS and TRS; 0 unless decision_valid_o");
    for feature in design.features() {
        add(
            PerRegion,
            Output,
            PortRole::Score(feature.kind()),
            feature.score_bits(),
            "score; final with decision_valid_o",
        );
    }
    add(
        PerRegion,
        Output,
        PortRole::TemporalCount,
        design.count_bits(),
        "changed pixels; final with decision_valid_o",
    );
    add(PerRegion, Output, PortRole::ForwardValid, 1, "a pixel of an active region leaves");
    add(PerRegion, Output, PortRole::ForwardPixel, pixel, "that pixel; 0 unless forward_valid_o");
    list
}

fn port_name(role: PortRole) -> String {
    match role {
        PortRole::Clock => "clk_i".to_owned(),
        PortRole::Reset => "rst_i".to_owned(),
        PortRole::Valid => "valid_i".to_owned(),
        PortRole::Pixel => "pixel_i".to_owned(),
        PortRole::Border => "border_i".to_owned(),
        PortRole::Level(kind) => format!("{kind}_level_i"),
        PortRole::MinScore(kind) => format!("{kind}_min_i"),
        PortRole::TemporalLevel => "temporal_level_i".to_owned(),
        PortRole::TemporalMinCount => "temporal_min_i".to_owned(),
        PortRole::DecisionValid => "decision_valid_o".to_owned(),
        PortRole::Srs => "srs_o".to_owned(),
        PortRole::Trs => "trs_o".to_owned(),
        PortRole::Active => "active_o".to_owned(),
        PortRole::Score(kind) => format!("{kind}_score_o"),
        PortRole::TemporalCount => "temporal_count_o".to_owned(),
        PortRole::ForwardValid => "forward_valid_o".to_owned(),
        PortRole::ForwardPixel => "forward_pixel_o".to_owned(),
    }
}
