// SPDX-License-Identifier: MIT OR Apache-2.0
//! One port of an RPU or an RCM. Each organization says in its [`crate::Interface`] which there are, from what is here.

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
    /// It is the first of a frame (designs with `hardware.sync`).
    StartOfFrame,
    /// One pixel per lane; of a serial array with raster feed one; of a raster core a word of K pixels, the
    /// left one in the lowest bits.
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
    /// A summary is sent again when a mean differs by more (designs with a periphery).
    SummaryLevel,
    /// A reference is on the port below (`raster`, store outside).
    ReferenceValid,
    /// The word with which the next word is compared (`raster`, store outside).
    ReferencePixel,
    /// The sink takes what is on the forward ports (`raster`).
    ForwardReady,
    /// A pixel would be taken (`serial`, `raster`).
    Ready,
    /// Something came that fits no frame (designs with `hardware.sync`).
    SyncError,
    /// A reference is taken at the next edge (`raster`, store outside).
    ReferenceReady,
    /// A word is stored (`raster`, store outside).
    StoreValid,
    /// That word (`raster`, store outside).
    StorePixel,
    /// It is the last of a row (`raster`, store outside).
    StoreLast,
    /// A reference was taken without being valid since reset (`raster`, store outside).
    Underrun,
    /// A score stands at the score port (`serial`).
    ScoreValid,
    /// Which score: 0 the temporal count, 1.. the features in the order of the design (`serial`).
    ScoreIndex,
    /// The region that scores and decision belong to (`serial`, `raster`).
    Region,
    /// That score (`serial`).
    AnyScore,
    /// A decision is valid, with the outputs below: of all regions (`pipelined`), of one (`serial`, `raster`).
    DecisionValid,
    /// Spatial relevance.
    Srs,
    /// Temporal relevance.
    Trs,
    /// Both: the region's pixels will leave.
    Active,
    /// The region's means will leave (designs with a periphery).
    Summary,
    /// Score of a feature (`pipelined`, `raster`).
    Score(FeatureKind),
    /// Temporal score (`pipelined`, `raster`).
    TemporalCount,
    /// A pixel of an active region leaves; of a raster core a word.
    ForwardValid,
    /// That pixel, or that word.
    ForwardPixel,
    /// Number of that pixel in its region, in raster order (`serial`); of the first of a word (`raster`).
    ForwardPosition,
    /// Slot of that region in its lane (`serial`, parallel feed, fold > 1).
    ForwardSlot,
    /// Number of that region (`serial`, raster feed; `raster`).
    ForwardRegion,
    /// That word is the first of its region (`raster`).
    ForwardFirst,
    /// It is the last that comes of its region (`raster`).
    ForwardLast,
    /// It is, because its region was lost in the middle (`raster`).
    ForwardAbort,
    /// Number of the frame of its region, modulo [`crate::FRAME_NUMBERS`] (`raster`).
    ForwardFrame,
    /// That word is the mean of a block (`raster`, designs with a periphery).
    ForwardSummary,
    /// A region was lost since reset (`raster`).
    Lost,
    /// How many (`raster`).
    LostCount,
    /// A region was lost at the last edge (`raster`).
    LostValid,
    /// Number of that region (`raster`).
    LostRegion,
    /// Number of its frame, modulo [`crate::FRAME_NUMBERS`] (`raster`).
    LostFrame,
}

impl PortRole {
    /// Whether it is a number, or pixels; else a flag.
    #[must_use]
    pub fn is_number(self) -> bool {
        match self {
            Self::Pixel
            | Self::Border
            | Self::Level(_)
            | Self::MinScore(_)
            | Self::TemporalLevel
            | Self::TemporalMinCount
            | Self::SummaryLevel
            | Self::ReferencePixel
            | Self::StorePixel
            | Self::ScoreIndex
            | Self::Region
            | Self::AnyScore
            | Self::Score(_)
            | Self::TemporalCount
            | Self::ForwardPixel
            | Self::ForwardPosition
            | Self::ForwardSlot
            | Self::ForwardRegion
            | Self::ForwardFrame
            | Self::LostCount
            | Self::LostRegion
            | Self::LostFrame => true,
            Self::Clock
            | Self::Reset
            | Self::Valid
            | Self::StartOfFrame
            | Self::ReferenceValid
            | Self::ForwardReady
            | Self::Ready
            | Self::SyncError
            | Self::ReferenceReady
            | Self::StoreValid
            | Self::StoreLast
            | Self::Underrun
            | Self::ScoreValid
            | Self::DecisionValid
            | Self::Srs
            | Self::Trs
            | Self::Active
            | Self::Summary
            | Self::ForwardValid
            | Self::ForwardFirst
            | Self::ForwardLast
            | Self::ForwardAbort
            | Self::ForwardSummary
            | Self::Lost
            | Self::LostValid => false,
        }
    }
}

/// When the value of an output means something. Otherwise it may be anything, and is not compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Qualifier {
    /// At every clock.
    Always,
    /// While the port of that role is 1: where both have a value per lane, in the same lane; where only
    /// that port has, in any lane.
    With(PortRole),
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
    /// One, or one per region of the pipelined RCM or per lane of the serial one.
    pub lanes: u32,
    /// Whether there is a value per lane: in the array, even if that has but one lane.
    pub per_lane: bool,
    /// When the value of an output means something; [`Qualifier::Always`] for an input.
    pub qualifier: Qualifier,
    /// One line of documentation.
    pub doc: String,
}

impl Port {
    /// Bits of the whole port.
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.width * self.lanes
    }

    /// A port with one value, which always means something.
    pub(crate) fn single(direction: Direction, role: PortRole, width: u32, doc: &str) -> Self {
        Self {
            name: port_name(role),
            direction,
            role,
            width,
            lanes: 1,
            per_lane: false,
            qualifier: Qualifier::Always,
            doc: doc.to_owned(),
        }
    }
}

/// The input that says where frames start, behind that which says that something comes: the same for every
/// organization; none where the design does not find its frames.
pub(crate) fn sync_input(design: &Design) -> Option<Port> {
    let doc = "what comes is the first of a frame; only with valid_i";
    let port = || Port::single(Direction::Input, PortRole::StartOfFrame, 1, doc);
    design.syncs().then(port)
}

/// The output that says that what came fits no frame, likewise.
pub(crate) fn sync_output(design: &Design) -> Option<Port> {
    let doc = "what came at this edge fits no frame";
    let port = || Port::single(Direction::Output, PortRole::SyncError, 1, doc);
    design.syncs().then(port)
}

/// What is decided of a region, the same for every organization; `whose` is what the region is called where its means
/// are spoken of.
pub(crate) fn decided_ports(design: &Design, whose: &str) -> Vec<Port> {
    let mut list = Vec::new();
    let mut add = |role, doc: &str| {
        let doc = format!("{doc}; 0 unless decision_valid_o");
        list.push(Port::single(Direction::Output, role, 1, &doc));
    };
    add(PortRole::Srs, "spatial relevance");
    add(PortRole::Trs, "temporal relevance");
    add(PortRole::Active, "SRS and TRS");
    if design.periphery().is_some() {
        add(PortRole::Summary, &format!("{whose} means will leave"));
    }
    list
}

/// The threshold inputs, the same for every organization: none where thresholds are constants.
pub(crate) fn threshold_ports(design: &Design) -> Vec<Port> {
    let mut list = Vec::new();
    match design.thresholds() {
        Thresholds::Constant => return list,
        Thresholds::Runtime => {}
    }
    let mut add = |role, width, doc| list.push(Port::single(Direction::Input, role, width, doc));
    for feature in design.features() {
        let kind = feature.kind();
        if feature.level().is_some() {
            add(PortRole::Level(kind), feature.level_bits(), "a pixel is a hit above this");
        }
        let doc = "the feature votes from this score on";
        add(PortRole::MinScore(kind), feature.score_bits(), doc);
    }
    let doc = "a pixel has changed above this difference";
    add(PortRole::TemporalLevel, design.pixel_bits(), doc);
    add(PortRole::TemporalMinCount, design.count_bits(), "TRS from this count on");
    if design.periphery().is_some() {
        let doc = "a mean that differs by more is sent again";
        add(PortRole::SummaryLevel, design.pixel_bits(), doc);
    }
    list
}

fn port_name(role: PortRole) -> String {
    match role {
        PortRole::Clock => "clk_i".to_owned(),
        PortRole::Reset => "rst_i".to_owned(),
        PortRole::Valid => "valid_i".to_owned(),
        PortRole::StartOfFrame => "sof_i".to_owned(),
        PortRole::Pixel => "pixel_i".to_owned(),
        PortRole::Border => "border_i".to_owned(),
        PortRole::Level(kind) => format!("{kind}_level_i"),
        PortRole::MinScore(kind) => format!("{kind}_min_i"),
        PortRole::TemporalLevel => "temporal_level_i".to_owned(),
        PortRole::TemporalMinCount => "temporal_min_i".to_owned(),
        PortRole::SummaryLevel => "summary_level_i".to_owned(),
        PortRole::ReferenceValid => "reference_valid_i".to_owned(),
        PortRole::ReferencePixel => "reference_pixel_i".to_owned(),
        PortRole::ForwardReady => "forward_ready_i".to_owned(),
        PortRole::Ready => "ready_o".to_owned(),
        PortRole::SyncError => "sync_error_o".to_owned(),
        PortRole::ReferenceReady => "reference_ready_o".to_owned(),
        PortRole::StoreValid => "store_valid_o".to_owned(),
        PortRole::StorePixel => "store_pixel_o".to_owned(),
        PortRole::StoreLast => "store_last_o".to_owned(),
        PortRole::Underrun => "underrun_o".to_owned(),
        PortRole::ScoreValid => "score_valid_o".to_owned(),
        PortRole::ScoreIndex => "score_index_o".to_owned(),
        PortRole::Region => "region_o".to_owned(),
        PortRole::AnyScore => "score_o".to_owned(),
        PortRole::DecisionValid => "decision_valid_o".to_owned(),
        PortRole::Srs => "srs_o".to_owned(),
        PortRole::Trs => "trs_o".to_owned(),
        PortRole::Active => "active_o".to_owned(),
        PortRole::Summary => "summary_o".to_owned(),
        PortRole::Score(kind) => format!("{kind}_score_o"),
        PortRole::TemporalCount => "temporal_count_o".to_owned(),
        PortRole::ForwardValid => "forward_valid_o".to_owned(),
        PortRole::ForwardPixel => "forward_pixel_o".to_owned(),
        PortRole::ForwardPosition => "forward_position_o".to_owned(),
        PortRole::ForwardSlot => "forward_slot_o".to_owned(),
        PortRole::ForwardRegion => "forward_region_o".to_owned(),
        PortRole::ForwardFirst => "forward_first_o".to_owned(),
        PortRole::ForwardLast => "forward_last_o".to_owned(),
        PortRole::ForwardAbort => "forward_abort_o".to_owned(),
        PortRole::ForwardFrame => "forward_frame_o".to_owned(),
        PortRole::ForwardSummary => "forward_summary_o".to_owned(),
        PortRole::Lost => "lost_o".to_owned(),
        PortRole::LostCount => "lost_count_o".to_owned(),
        PortRole::LostValid => "lost_valid_o".to_owned(),
        PortRole::LostRegion => "lost_region_o".to_owned(),
        PortRole::LostFrame => "lost_frame_o".to_owned(),
    }
}
