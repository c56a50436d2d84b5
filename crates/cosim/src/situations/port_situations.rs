// SPDX-License-Identifier: MIT OR Apache-2.0
//! The situations of an array, or of its unit alone, on plain ports.

use super::occurrence::Occurrences;
use foveate_camera::{Neighborhood, ReferencePolicy, VoteCombination};
use foveate_design::{Design, Hardware, RasterTiming, ThresholdSource};
use foveate_emit::Top;

/// The counts from the ports since the first clock.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct PortSituationCounts {
    /// The number of decisions of active regions; `held` and `irrelevant` count the others.
    pub(super) active: u64,
    pub(super) held: u64,
    pub(super) irrelevant: u64,
    /// The number of held regions whose count in the next frame shows a valid reference.
    pub(super) reference_kept: u64,
    /// The number of regions that are active, then irrelevant, then active.
    pub(super) reference_dropped: u64,
    /// The number of decisions in which all pixels count and the minimum is above that.
    pub(super) minimum_above: u64,
    pub(super) reset_within: u64,
    pub(super) reset_while_leaving: u64,
    pub(super) back_to_back: u64,
    pub(super) gap_within: u64,
    pub(super) refused: u64,
    pub(super) flush_cut: u64,
    pub(super) flush_ended: u64,
    pub(super) threshold_changed: u64,
    pub(super) summary_sent: u64,
    pub(super) summary_kept: u64,
    pub(super) summary_renewed: u64,
    pub(super) summary_active_summary: u64,
    pub(super) summary_held_irrelevant: u64,
    pub(super) summary_reset_summary: u64,
    pub(super) mean_waits: u64,
    pub(super) inner_mean_waits: u64,
    pub(super) gap_before_means: u64,
    pub(super) reset_at_mean: u64,
    pub(super) mean_beside_reference: u64,
    pub(super) pixel_waits: u64,
    pub(super) lost_whole: u64,
    pub(super) lost_within: u64,
    pub(super) lost_decided: u64,
    pub(super) lost_summary_again: u64,
    pub(super) too_few: u64,
    pub(super) too_many: u64,
    pub(super) no_start: u64,
    pub(super) whole_behind_error: u64,
    pub(super) underrun: u64,
    /// The number of regions whose displacement is not 0.
    pub(super) moved: u64,
    /// The number of regions that moved as far as `flow` searches, in both directions.
    pub(super) moved_far: u64,
    /// The number of regions of a class, or of those in a written word.
    pub(super) class_off: u64,
    pub(super) class_keen: u64,
    pub(super) class_always: u64,
    /// The number of regions of a pipelined array that have another class than in the frame before.
    pub(super) class_changed: u64,
    /// The number of commits of maps; `commit_while_pending` counts those without effect.
    pub(super) map_within_frame: u64,
    pub(super) map_between_frames: u64,
    pub(super) commit_while_pending: u64,
    pub(super) word_while_pending: u64,
}

/// A situation: its name, the designs and modules that can have it, and its count.
struct PortSituation {
    name: &'static str,
    is_possible: fn(&Design, Top) -> bool,
    count: fn(&PortSituationCounts) -> u64,
}

const fn situation(
    name: &'static str,
    is_possible: fn(&Design, Top) -> bool,
    count: fn(&PortSituationCounts) -> u64,
) -> PortSituation {
    PortSituation { name, is_possible, count }
}

const SITUATIONS: &[PortSituation] = &[
    situation("a region is active", |_, _| true, |facts| facts.active),
    situation("a region is held", |design, _| can_hold(design), |facts| facts.held),
    situation(
        "a region is irrelevant",
        |design, _| can_be_irrelevant(design),
        |facts| facts.irrelevant,
    ),
    situation(
        "a held region is compared with its reference again",
        |design, _| keeps_references(design) && can_hold(design),
        |facts| facts.reference_kept,
    ),
    situation(
        "a region is active, irrelevant and active again",
        |design, _| drops_references(design),
        |facts| facts.reference_dropped,
    ),
    situation(
        "all pixels of a region count, and the minimum is above that",
        |design, _| is_runtime(design) && largest_min_count(design) > design.region_pixels(),
        |facts| facts.minimum_above,
    ),
    situation("a reset comes within a frame", |_, _| true, |facts| facts.reset_within),
    situation(
        "a reset comes while pixels leave",
        |design, _| forwards_pixels(design),
        |facts| facts.reset_while_leaving,
    ),
    situation("a frame follows at once", |_, _| true, |facts| facts.back_to_back),
    situation("pixels pause within a frame", |_, _| true, |facts| facts.gap_within),
    situation(
        "a pixel is offered while none is taken",
        |design, _| can_refuse_pixels(design),
        |facts| facts.refused,
    ),
    situation("a frame cuts a flush", |design, _| has_flush(design), |facts| facts.flush_cut),
    situation("a flush ends", |design, _| has_flush(design), |facts| facts.flush_ended),
    situation(
        "a threshold changes between two frames",
        |design, _| is_runtime(design),
        |facts| facts.threshold_changed,
    ),
    situation("a summary is sent", |design, _| sends_means(design), |facts| facts.summary_sent),
    situation(
        "a summary stays on the screen",
        |design, _| sends_means(design),
        |facts| facts.summary_kept,
    ),
    situation(
        "a summary is sent again while one is shown",
        |design, _| sends_means(design),
        |facts| facts.summary_renewed,
    ),
    situation(
        "a summary, pixels, a summary",
        |design, _| sends_means(design),
        |facts| facts.summary_active_summary,
    ),
    situation(
        "a region is held while its summary is shown, and is irrelevant again",
        |design, _| sends_means(design) && is_runtime(design),
        |facts| facts.summary_held_irrelevant,
    ),
    situation(
        "a reset comes while a summary is shown, and the same frame follows",
        |design, _| sends_means(design),
        |facts| facts.summary_reset_summary,
    ),
    situation(
        "pixels pause while means are on their way",
        |design, _| sends_means(design) && is_pipelined(design),
        |facts| facts.gap_before_means,
    ),
    situation(
        "a mean waits for the sink",
        |design, _| sends_means(design) && has_sink(design),
        |facts| facts.mean_waits,
    ),
    situation(
        "a mean waits for the sink before others of its region",
        |design, _| sends_means(design) && has_sink(design) && has_blocks(design),
        |facts| facts.inner_mean_waits,
    ),
    situation(
        "a reset comes while a mean leaves",
        |design, _| sends_means(design) && has_sink(design),
        |facts| facts.reset_at_mean,
    ),
    situation(
        "means leave beside a held region, which is compared with its reference again",
        |design, _| {
            sends_means(design)
                && has_sink(design)
                && can_hold(design)
                && keeps_references(design)
                && design.columns() > 1
        },
        |facts| facts.mean_beside_reference,
    ),
    situation(
        "a pixel waits for the sink",
        |design, _| has_sink(design),
        |facts| facts.pixel_waits,
    ),
    situation(
        "a region is lost as a whole",
        |design, _| can_lose(design),
        |facts| facts.lost_whole,
    ),
    situation(
        "a region is lost in the middle",
        |design, _| can_lose(design),
        |facts| facts.lost_within,
    ),
    situation(
        "a region is decided behind its loss",
        |design, _| can_lose(design),
        |facts| facts.lost_decided,
    ),
    situation(
        "a summary is sent behind the loss of its region",
        |design, _| can_lose(design) && sends_means(design),
        |facts| facts.lost_summary_again,
    ),
    situation("a frame has too few pixels", has_frame_sync, |facts| facts.too_few),
    situation("a frame has too many pixels", has_frame_sync, |facts| facts.too_many),
    situation("a frame has no start", has_frame_sync, |facts| facts.no_start),
    situation("a frame is decided behind a damaged one", has_frame_sync, |facts| {
        facts.whole_behind_error
    }),
    situation(
        "a reference is missing",
        |design, _| is_stored_outside(design),
        |facts| facts.underrun,
    ),
    situation(
        "a region has moved",
        |design, _| design.displacement_feature().is_some(),
        |facts| facts.moved,
    ),
    situation(
        "a region has moved as far as possible in both directions",
        |design, _| design.displacement_feature().is_some(),
        |facts| facts.moved_far,
    ),
    situation("a region is off", |design, _| has_zones(design), |facts| facts.class_off),
    situation("a region is keen", |design, _| has_zones(design), |facts| facts.class_keen),
    situation(
        "a region is always relevant",
        |design, _| has_zones(design),
        |facts| facts.class_always,
    ),
    situation(
        "the class of a region changes from one frame to the next",
        |design, _| has_zones(design) && is_pipelined(design),
        |facts| facts.class_changed,
    ),
    situation(
        "a map of classes is committed within a frame",
        |design, _| design.has_class_memory(),
        |facts| facts.map_within_frame,
    ),
    situation(
        "a map of classes is committed between two frames",
        |design, _| design.has_class_memory(),
        |facts| facts.map_between_frames,
    ),
    situation(
        "a word of classes comes while a map waits",
        |design, _| design.has_class_memory(),
        |facts| facts.word_while_pending,
    ),
    situation(
        "a commit comes while a map waits",
        |design, _| design.has_class_memory(),
        |facts| facts.commit_while_pending,
    ),
];

impl PortSituationCounts {
    /// Returns the count of each situation that `design` can have at the module `top`.
    pub(super) fn occurrences(&self, design: &Design, top: Top) -> Occurrences {
        let mut all = Occurrences::default();
        for situation in SITUATIONS.iter().filter(|own| (own.is_possible)(design, top)) {
            all.add(situation.name, (situation.count)(self));
        }
        all
    }
}

fn is_runtime(design: &Design) -> bool {
    match design.threshold_source() {
        ThresholdSource::Runtime => true,
        ThresholdSource::Constant => false,
    }
}

/// Returns true if a region can be relevant without a change.
pub(crate) fn can_hold(design: &Design) -> bool {
    is_runtime(design) || design.temporal().min_count > 0
}

/// Returns the largest value of the port for the minimum of changed pixels.
pub(crate) fn largest_min_count(design: &Design) -> u32 {
    u32::MAX >> (u32::BITS - design.count_bits())
}

pub(crate) fn can_be_irrelevant(design: &Design) -> bool {
    let mut votes = design.features().iter().map(|feature| feature.min_score() == 0);
    let always = match design.combine() {
        VoteCombination::Any => votes.any(|vote| vote),
        VoteCombination::All => votes.all(|vote| vote),
    };
    is_runtime(design) || !always
}

fn has_zones(design: &Design) -> bool {
    design.zones().is_some()
}

fn sends_means(design: &Design) -> bool {
    design.periphery().is_some() && can_be_irrelevant(design)
}

fn has_blocks(design: &Design) -> bool {
    design.periphery().is_some_and(|periphery| periphery.blocks > 1)
}

fn keeps_references(design: &Design) -> bool {
    match design.temporal().reference {
        ReferencePolicy::LastSent => true,
        ReferencePolicy::Previous => false,
    }
}

/// Returns true if a region that is irrelevant loses its reference.
fn drops_references(design: &Design) -> bool {
    use foveate_camera::IrrelevantRendering::{Hold, Mean, Zero};
    let blanks = match design.irrelevant() {
        Zero | Mean => true,
        Hold => false,
    };
    keeps_references(design) && blanks && can_be_irrelevant(design)
}

fn is_pipelined(design: &Design) -> bool {
    match design.hardware() {
        Hardware::Pipelined(_) => true,
        Hardware::Serial(_) | Hardware::Raster(_) => false,
    }
}

/// Returns true if the core takes no pixel at times.
fn can_refuse_pixels(design: &Design) -> bool {
    !is_pipelined(design)
}

/// Returns the number of windows that flush behind a frame.
pub(super) fn flushed_windows(design: &Design) -> u64 {
    let windows = [design.filter().has_window(), design.has_feature_window()];
    match design.neighborhood() {
        Neighborhood::Isolated if is_pipelined(design) => windows.map(u64::from).iter().sum(),
        Neighborhood::Isolated | Neighborhood::Shared => 0,
    }
}

fn has_flush(design: &Design) -> bool {
    flushed_windows(design) > 0
}

/// Returns true if pixels leave the core.
fn forwards_pixels(design: &Design) -> bool {
    match design.hardware() {
        Hardware::Pipelined(_) | Hardware::Serial(_) => true,
        Hardware::Raster(own) => {
            RasterTiming::from_design(design.with_hardware(own)).has_forwarding
        }
    }
}

/// Returns true if a sink takes what leaves, and may stall.
pub(crate) fn has_sink(design: &Design) -> bool {
    match design.hardware() {
        Hardware::Pipelined(_) | Hardware::Serial(_) => false,
        Hardware::Raster(_) => forwards_pixels(design),
    }
}

/// Returns true if a sink that stalls loses regions.
pub(crate) fn can_lose(design: &Design) -> bool {
    has_sink(design) && design.timing().departure().buffered_rows.is_some()
}

fn is_stored_outside(design: &Design) -> bool {
    match design.hardware() {
        Hardware::Pipelined(_) | Hardware::Serial(_) => false,
        Hardware::Raster(own) => design.with_hardware(own).has_external_store(),
    }
}

/// Returns true if the module synchronizes to the start of a frame.
fn has_frame_sync(design: &Design, top: Top) -> bool {
    use foveate_design::PortRole;
    top.ports(design).iter().any(|port| port.role == PortRole::SyncError)
}
