// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of a core's inputs and outputs to records.

use crate::layout::Layout;
use foveate_design::{Design, FeatureKind, PortRole};
use foveate_model::{CoreInput, CycleModel};

/// A converter of the inputs of a core, and of the outputs of its model, to records.
#[derive(Clone, Debug)]
pub struct Codec {
    /// The features of the design, in their order.
    kinds: Vec<FeatureKind>,
    /// The values of one port.
    values: Vec<u64>,
}

impl Codec {
    /// Creates the codec of a design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        Self { kinds: design.kinds(), values: Vec::new() }
    }

    /// Writes the inputs at an edge into a record.
    pub fn inputs(&mut self, layout: &Layout, input: &CoreInput<'_>, record: &mut [u8]) {
        for field in layout.fields() {
            self.values.clear();
            self.apply(field.port.role, input);
            field.set_values(record, &self.values);
        }
    }

    /// Writes the outputs after an edge into a record.
    pub fn outputs(&mut self, layout: &Layout, model: &dyn CycleModel, record: &mut [u8]) {
        for field in layout.fields() {
            self.values.clear();
            model.show(field.port.role, &mut self.values);
            field.set_values(record, &self.values);
        }
    }

    /// Appends the values of the input with this role.
    fn apply(&mut self, role: PortRole, input: &CoreInput<'_>) {
        let place = |kind| {
            let place = self.kinds.iter().position(|&own| own == kind);
            place.expect("a port is of a feature of the design")
        };
        let thresholds = input.thresholds;
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
            PortRole::Pixel => return self.apply_pixels(input.pixels),
            PortRole::ReferencePixel => return self.apply_pixels(input.reference_pixels),
            // The role is an output, or the clock, which is in no record.
            _ => return,
        };
        self.values.push(value);
    }

    fn apply_pixels(&mut self, pixels: &[u16]) {
        self.values.extend(pixels.iter().map(|&pixel| u64::from(pixel)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::Config;
    use foveate_model::rcm;

    fn design(organization: &str) -> Design {
        let toml = format!("[hardware]\norganization = \"{organization}\"\n");
        Config::from_toml(&toml).unwrap().validate().unwrap()
    }

    /// A port that the model does not know must not be taken for a port that is 0.
    #[test]
    #[should_panic(expected = "ready_o: a value for each place")]
    fn a_port_that_the_model_does_not_answer_is_noticed() {
        let layout = Layout::outputs(&design("serial").rcm_ports());
        let core = rcm(&design("pipelined"));
        Codec::new(&design("serial")).outputs(&layout, &*core, &mut layout.record());
    }
}
