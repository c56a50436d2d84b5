// SPDX-License-Identifier: MIT OR Apache-2.0
//! The region to which a differing value belongs.

use crate::comparison::PortDifference;
use crate::layout::RecordLayout;
use crate::level::CosimLevel;
use foveate_design::{BeatRegion, Design};

/// Returns the region of a difference, if the expected outputs of that clock show it. `first` is
/// the region of the caller's frame that goes through the only RPU or lane, if it is known.
pub(crate) fn region_of_difference(
    design: &Design,
    level: CosimLevel,
    layout: &RecordLayout,
    expected: &[u8],
    difference: &PortDifference,
    first: Option<u32>,
) -> Option<u32> {
    let in_array = region_in_array(design, layout, expected, difference);
    match level {
        CosimLevel::Rpu if design.unit().regions == 1 => first,
        CosimLevel::Rpu => Some(first? + in_array?),
        CosimLevel::Rcm { .. } | CosimLevel::Full => in_array,
    }
}

/// Returns the region in the simulated array. The stream of the port gives it, by its lane or by
/// the port that numbers the region of a beat.
fn region_in_array(
    design: &Design,
    layout: &RecordLayout,
    expected: &[u8],
    difference: &PortDifference,
) -> Option<u32> {
    let fields = layout.fields();
    let says = |role| {
        let field = fields.iter().find(|field| field.port.role == role)?;
        let mut lanes = layout.compared_lanes(field, expected);
        u32::try_from(field.get(expected, lanes.next()?)).ok()
    };
    let role = fields.iter().find(|field| field.port.name == difference.port)?.port.role;
    match design.rcm_interface().stream_with_port(role)?.region {
        BeatRegion::None => None,
        BeatRegion::Lane => Some(difference.lane),
        BeatRegion::Slot(slot) => Some(difference.lane * design.slots() + says(slot)?),
        BeatRegion::Number(region) => says(region),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::{DesignConfig, PortRole};

    fn design(hardware: &str) -> Design {
        let toml = format!(
            "[frame]\nwidth = 24\nheight = 16\n[hardware]\norganization = \"serial\"\n{hardware}"
        );
        DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
    }

    /// Returns the region of a difference at a port and lane, for a record with the given values.
    fn located_region(
        design: &Design,
        shown: &[(PortRole, u32, u64)],
        port: &str,
        lane: u32,
    ) -> Option<u32> {
        let layout = RecordLayout::outputs(&design.rcm_ports());
        let mut expected = layout.zero_record();
        for &(role, lane, value) in shown {
            let field = layout.fields().iter().find(|field| field.port.role == role).unwrap();
            field.set(&mut expected, lane, value);
        }
        let (port, expected_hex, got) = (port.to_owned(), String::new(), String::new());
        let difference = PortDifference { clock: 0, port, lane, expected: expected_hex, got };
        region_of_difference(design, CosimLevel::Full, &layout, &expected, &difference, None)
    }

    #[test]
    fn a_score_belongs_to_the_region_that_is_shown() {
        let design = design("");
        let shown = [(PortRole::ScoreValid, 0, 1), (PortRole::Region, 0, 4)];
        assert_eq!(located_region(&design, &shown, "score_o", 0), Some(4));
        assert_eq!(located_region(&design, &shown, "trs_o", 0), Some(4));
        assert_eq!(located_region(&design, &shown[1..], "score_valid_o", 0), None);
    }

    #[test]
    fn a_word_of_a_store_outside_belongs_to_no_region() {
        let toml = "[frame]\nwidth = 40\nheight = 16\n[hardware]\norganization = \"raster\"\n\
                    store = \"external\"\n";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let shown = [(PortRole::DecisionValid, 0, 1), (PortRole::Region, 0, 4)];
        assert_eq!(located_region(&design, &shown, "temporal_count_o", 0), Some(4));
        for port in ["reference_ready_o", "store_valid_o", "underrun_o"] {
            assert_eq!(located_region(&design, &shown, port, 0), None, "{port}");
        }
    }

    #[test]
    fn a_pixel_belongs_to_its_lane_and_slot_or_to_the_region_that_is_shown() {
        let plain = design("");
        assert_eq!(located_region(&plain, &[], "forward_valid_o", 5), Some(5));
        let folded = design("fold = 4\n");
        let shown = [(PortRole::ForwardValid, 0, 1), (PortRole::ForwardSlot, 0, 1)];
        assert_eq!(located_region(&folded, &shown, "forward_pixel_o", 1), Some(5));
        assert_eq!(located_region(&folded, &[], "forward_valid_o", 1), None);
        let raster = design("feed = \"raster\"\nfold = 4\n");
        let shown = [(PortRole::ForwardValid, 0, 1), (PortRole::ForwardRegion, 0, 3)];
        assert_eq!(located_region(&raster, &shown, "forward_pixel_o", 0), Some(3));
        assert_eq!(located_region(&raster, &shown, "forward_position_o", 0), Some(3));
    }
}
