// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of an RPU or an RCM. The [`crate::CoreInterface`] of each organization is made of
//! them.

use crate::Design;
use foveate_camera::FeatureKind;

/// The direction of a port, seen from the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortDirection {
    /// Into the core.
    Input,
    /// Out of the core.
    Output,
}

/// The meaning of a port. The model refers to a port by its role, never by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PortRole {
    /// The clock.
    Clock,
    /// Synchronous reset, active high.
    Reset,
    /// The pixel port holds a pixel.
    Valid,
    /// The pixel or word on the pixel port is the first of a frame (designs with `hardware.sync`).
    StartOfFrame,
    /// The pixels: one per lane; one in all for a serial array with raster feed; a word of K pixels
    /// for a raster core, the left pixel in the lowest bits.
    Pixel,
    /// The sides of the region that are sides of the frame: `{bottom, top, right, left}`.
    Border,
    /// Per-pixel threshold of a feature.
    Level(FeatureKind),
    /// Per-region threshold of a feature, in units of its score.
    MinScore(FeatureKind),
    /// Per-pixel threshold of the temporal score.
    TemporalLevel,
    /// Per-region threshold of the temporal score.
    TemporalMinCount,
    /// A summary is sent again when a mean differs by more than this (designs with a periphery).
    SummaryLevel,
    /// Per-pixel threshold of a feature in keen regions (designs with zones; so are the next five).
    KeenLevel(FeatureKind),
    /// Per-region threshold of a feature in keen regions.
    KeenMinScore(FeatureKind),
    /// Per-pixel threshold of the temporal score in keen regions.
    KeenTemporalLevel,
    /// Per-region threshold of the temporal score in keen regions.
    KeenTemporalMinCount,
    /// The level of the summaries of keen regions.
    KeenSummaryLevel,
    /// The level of the summaries of regions that are off.
    OffSummaryLevel,
    /// The codes of the classes of regions, one per lane (`pipelined`, designs with zones).
    RegionClass,
    /// A word of the map of classes is written (`serial` and `raster`, designs with zones; so are
    /// the next four).
    ClassWrite,
    /// The number of the word that is written.
    ClassAddress,
    /// The word that is written: the codes of [`crate::CLASSES_PER_WORD`] classes.
    ClassWord,
    /// Frames use the map that has been written.
    ClassCommit,
    /// Frames do not use the committed map yet.
    ClassPending,
    /// The port `ReferencePixel` holds a reference (`raster`, external store).
    ReferenceValid,
    /// The reference of the next word (`raster`, external store).
    ReferencePixel,
    /// The sink takes the word on the forward ports (`raster`).
    ForwardReady,
    /// The core would take a pixel or word (`serial`, `raster`).
    Ready,
    /// A pixel or word came that fits no frame (designs with `hardware.sync`).
    SyncError,
    /// The core takes a reference at the next edge (`raster`, external store).
    ReferenceReady,
    /// The port `StorePixel` holds a word to store (`raster`, external store).
    StoreValid,
    /// The word to store (`raster`, external store).
    StorePixel,
    /// The word to store is the last of a row (`raster`, external store).
    StoreLast,
    /// Since reset, a reference was taken while it was not valid (`raster`, external store).
    Underrun,
    /// The port `AnyScore` holds a score (`serial`).
    ScoreValid,
    /// The number of the score: 0 for the temporal count, 1.. for the features in the order of the
    /// design (`serial`).
    ScoreIndex,
    /// The number of the region of the scores and the decision (`serial`, `raster`).
    Region,
    /// The score whose number is on the port `ScoreIndex` (`serial`).
    AnyScore,
    /// The displacement of the region in columns to the right, in two's complement (`serial`, with
    /// `flow`).
    DisplacementX,
    /// The displacement of the region in rows down, in two's complement (`serial`, with `flow`).
    DisplacementY,
    /// A decision is valid: that of all regions (`pipelined`), or of one region (`serial`,
    /// `raster`).
    DecisionValid,
    /// Spatial relevance, SRS.
    Srs,
    /// Temporal relevance, TRS.
    Trs,
    /// SRS and TRS are both 1, so the pixels of the region will leave.
    Active,
    /// The means of the region will leave (designs with a periphery).
    Summary,
    /// The score of a feature (`pipelined`, `raster`).
    Score(FeatureKind),
    /// The temporal score (`pipelined`, `raster`).
    TemporalCount,
    /// A pixel or mean leaves; of a raster core a word.
    ForwardValid,
    /// The pixel or mean that leaves; of a raster core the word.
    ForwardPixel,
    /// The number of the pixel in its region, in row-major order (`serial`), or the number of the
    /// first pixel of the word (`raster`).
    ForwardPosition,
    /// The slot, in its lane, of the region whose pixel leaves (`serial`, parallel feed, fold > 1).
    ForwardSlot,
    /// The number of the region whose pixel leaves (`serial` with raster feed; `raster`).
    ForwardRegion,
    /// The word that leaves is the first of its region (`raster`).
    ForwardFirst,
    /// The word that leaves is the last of its region, also if the region was lost in the middle
    /// (`raster`).
    ForwardLast,
    /// The word that leaves is the last because its region was lost in the middle (`raster`).
    ForwardAbort,
    /// The number of the frame of the region whose word leaves, modulo [`crate::FRAME_NUMBERS`]
    /// (`raster`).
    ForwardFrame,
    /// The word that leaves is the mean of a block (`raster`, designs with a periphery).
    ForwardSummary,
    /// A region has been lost since reset (`raster`).
    Lost,
    /// The number of regions that have been lost since reset, up to a largest value (`raster`).
    LostCount,
    /// A region was lost at the last edge (`raster`).
    LostValid,
    /// The number of the region that was lost at the last edge (`raster`).
    LostRegion,
    /// The number of the frame of the lost region, modulo [`crate::FRAME_NUMBERS`] (`raster`).
    LostFrame,
}

impl PortRole {
    /// Returns true if the port carries a number or pixels, and false if it carries flags.
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
            | Self::KeenLevel(_)
            | Self::KeenMinScore(_)
            | Self::KeenTemporalLevel
            | Self::KeenTemporalMinCount
            | Self::KeenSummaryLevel
            | Self::OffSummaryLevel
            | Self::RegionClass
            | Self::ClassAddress
            | Self::ClassWord
            | Self::ReferencePixel
            | Self::StorePixel
            | Self::ScoreIndex
            | Self::Region
            | Self::AnyScore
            | Self::DisplacementX
            | Self::DisplacementY
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
            | Self::ClassWrite
            | Self::ClassCommit
            | Self::ClassPending
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

/// The condition under which the value of an output has a meaning. Otherwise the value is undefined
/// and is not compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OutputQualifier {
    /// The value has a meaning at every clock.
    Always,
    /// The value has a meaning while the port of this role is 1. If both ports have a value per
    /// lane, the condition holds lane by lane. If only the port of this role has, one lane with 1
    /// is enough.
    WhileSet(PortRole),
}

/// A port with `lanes` values of `width` bits, lane 0 in the lowest bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Name of the port in the Verilog.
    pub name: String,
    /// Direction of the port, seen from the core.
    pub direction: PortDirection,
    /// The meaning of the port.
    pub role: PortRole,
    /// Width of one lane in bits.
    pub width: u32,
    /// Number of lanes: 1, the number of regions of a pipelined RCM, or the number of lanes of a
    /// serial array.
    pub lanes: u32,
    /// True if the port has a value per lane, also in an array with only one lane.
    pub per_lane: bool,
    /// The condition under which the value has a meaning. It is [`OutputQualifier::Always`] for an
    /// input.
    pub qualifier: OutputQualifier,
    /// Documentation of the port in one line.
    pub doc: String,
}

impl Port {
    /// Returns the width of the whole port in bits.
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.width * self.lanes
    }

    /// Makes a port with one value, which has a meaning at every clock.
    pub(crate) fn scalar(direction: PortDirection, role: PortRole, width: u32, doc: &str) -> Self {
        Self {
            name: port_name(role),
            direction,
            role,
            width,
            lanes: 1,
            per_lane: false,
            qualifier: OutputQualifier::Always,
            doc: doc.to_owned(),
        }
    }
}

/// Returns the input that marks the first pixel or word of a frame. It is the same for every
/// organization. Returns `None` for a design without `hardware.sync`.
pub(crate) fn sync_input(design: &Design) -> Option<Port> {
    let doc = "pixel_i begins a frame; only with valid_i";
    let port = || Port::scalar(PortDirection::Input, PortRole::StartOfFrame, 1, doc);
    design.has_frame_sync().then(port)
}

/// Returns the output that reports a pixel or word that fits no frame, or `None` for a design
/// without `hardware.sync`.
pub(crate) fn sync_output(design: &Design) -> Option<Port> {
    let doc = "the input at this edge does not fit into a frame";
    let port = || Port::scalar(PortDirection::Output, PortRole::SyncError, 1, doc);
    design.has_frame_sync().then(port)
}

/// Returns the ports of a decision, which are the same for every organization. `whose` names the
/// region in the documentation of its means, such as "the region's".
pub(crate) fn decision_ports(design: &Design, whose: &str) -> Vec<Port> {
    let mut list = Vec::new();
    let mut add = |role, doc: &str| {
        let doc = format!("{doc}; 0 unless decision_valid_o");
        list.push(Port::scalar(PortDirection::Output, role, 1, &doc));
    };
    add(PortRole::Srs, "spatial relevance");
    add(PortRole::Trs, "temporal relevance");
    add(PortRole::Active, "SRS and TRS");
    if design.periphery().is_some() {
        add(PortRole::Summary, &format!("{whose} means will leave"));
    }
    list
}

/// Returns the input with the class of a region, or `None` for a design without zones.
pub(crate) fn class_input(design: &Design) -> Option<Port> {
    let doc = "class of the region: 0 normal, 1 off, 2 keen, 3 always";
    let port = || Port::scalar(PortDirection::Input, PortRole::RegionClass, 2, doc);
    design.zones().map(|_| port())
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
        PortRole::KeenLevel(kind) => format!("keen_{kind}_level_i"),
        PortRole::KeenMinScore(kind) => format!("keen_{kind}_min_i"),
        PortRole::KeenTemporalLevel => "keen_temporal_level_i".to_owned(),
        PortRole::KeenTemporalMinCount => "keen_temporal_min_i".to_owned(),
        PortRole::KeenSummaryLevel => "keen_summary_level_i".to_owned(),
        PortRole::OffSummaryLevel => "off_summary_level_i".to_owned(),
        PortRole::RegionClass => "zone_i".to_owned(),
        PortRole::ClassWrite => "zone_write_i".to_owned(),
        PortRole::ClassAddress => "zone_address_i".to_owned(),
        PortRole::ClassWord => "zone_word_i".to_owned(),
        PortRole::ClassCommit => "zone_commit_i".to_owned(),
        PortRole::ClassPending => "zone_pending_o".to_owned(),
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
        PortRole::DisplacementX => "displacement_x_o".to_owned(),
        PortRole::DisplacementY => "displacement_y_o".to_owned(),
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
