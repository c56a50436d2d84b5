// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of a core's inputs and outputs to records.

use crate::layout::RecordLayout;
use foveate_camera::FeatureKind;
use foveate_design::{Design, PortRole};
use foveate_model::{CoreInput, CycleModel};

/// A converter of the inputs of a core, and of the outputs of its model, to records.
#[derive(Clone, Debug)]
pub struct RecordCodec {
    /// The features of the design, in their order.
    kinds: Vec<FeatureKind>,
    /// The values of one port.
    values: Vec<u64>,
}

impl RecordCodec {
    /// Creates the codec of a design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        Self { kinds: design.feature_kinds(), values: Vec::new() }
    }

    /// Writes the inputs at an edge into a record.
    pub fn encode_inputs(
        &mut self,
        layout: &RecordLayout,
        input: &CoreInput<'_>,
        record: &mut [u8],
    ) {
        for field in layout.fields() {
            self.values.clear();
            self.push_input_values(field.port.role, input);
            field.set_values(record, &self.values);
        }
    }

    /// Writes the outputs after an edge into a record.
    pub fn encode_outputs(
        &mut self,
        layout: &RecordLayout,
        model: &dyn CycleModel,
        record: &mut [u8],
    ) {
        for field in layout.fields() {
            self.values.clear();
            model.append_output(field.port.role, &mut self.values);
            field.set_values(record, &self.values);
        }
    }

    /// Appends the values of the input with this role.
    fn push_input_values(&mut self, role: PortRole, input: &CoreInput<'_>) {
        let place = |kind| {
            let place = self.kinds.iter().position(|&own| own == kind);
            place.expect("a port is of a feature of the design")
        };
        let thresholds = input.thresholds;
        let keen = input.zones.map_or(thresholds, |zones| zones.keen);
        let map = input.class_map();
        let value = match role {
            PortRole::Reset => input.reset.into(),
            PortRole::Valid => input.valid.into(),
            PortRole::StartOfFrame => input.sof.into(),
            PortRole::Border => input.border.into(),
            PortRole::ReferenceValid => input.reference_valid.into(),
            PortRole::ForwardReady => input.forward_ready.into(),
            PortRole::Level(kind) => thresholds.level[place(kind)].into(),
            PortRole::MinScore(kind) => thresholds.min_score[place(kind)],
            PortRole::TemporalLevel => thresholds.temporal_level.into(),
            PortRole::TemporalMinCount => thresholds.temporal_min_count.into(),
            PortRole::SummaryLevel => thresholds.summary_level.into(),
            PortRole::KeenLevel(kind) => keen.level[place(kind)].into(),
            PortRole::KeenMinScore(kind) => keen.min_score[place(kind)],
            PortRole::KeenTemporalLevel => keen.temporal_level.into(),
            PortRole::KeenTemporalMinCount => keen.temporal_min_count.into(),
            PortRole::KeenSummaryLevel => keen.summary_level.into(),
            PortRole::OffSummaryLevel => {
                input.zones.map_or(thresholds.summary_level, |zones| zones.off_summary_level).into()
            }
            PortRole::RegionClass => return self.push_classes(input),
            PortRole::ClassWrite => map.write.into(),
            PortRole::ClassAddress => map.address.into(),
            PortRole::ClassWord => map.word.into(),
            PortRole::ClassCommit => map.commit.into(),
            PortRole::Pixel => return self.push_pixels(input.pixels),
            PortRole::ReferencePixel => return self.push_pixels(input.reference_pixels),
            // The role is an output, or the clock, which is in no record.
            _ => return,
        };
        self.values.push(value);
    }

    /// Appends the codes of the classes of all lanes. There are as many lanes as pixels.
    fn push_classes(&mut self, input: &CoreInput<'_>) {
        match input.zones {
            Some(zones) => {
                self.values.extend(zones.classes.iter().map(|class| u64::from(class.code())));
            }
            None => self.values.extend(input.pixels.iter().map(|_| 0)),
        }
    }

    fn push_pixels(&mut self, pixels: &[u16]) {
        self.values.extend(pixels.iter().map(|&pixel| u64::from(pixel)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;
    use foveate_model::rcm_model;

    fn design(organization: &str) -> Design {
        let toml = format!("[hardware]\norganization = \"{organization}\"\n");
        DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
    }

    /// A port that the model does not know must not be taken for a port that is 0.
    #[test]
    #[should_panic(expected = "ready_o: a value for each place")]
    fn a_port_that_the_model_does_not_answer_is_noticed() {
        let layout = RecordLayout::outputs(&design("serial").rcm_ports());
        let core = rcm_model(&design("pipelined"));
        RecordCodec::new(&design("serial")).encode_outputs(
            &layout,
            &*core,
            &mut layout.zero_record(),
        );
    }
}
