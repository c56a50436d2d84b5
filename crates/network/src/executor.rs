// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network frame by frame, and recomputes only what may have changed ([`Executor`]).

use super::optional_instant::OptionalInstant;
use super::tensor::TensorForm;
use crate::comparison::{changed_positions, copy_positions};
use crate::element::{ElementType, with_element_type};
use crate::mask::Mask;
use crate::network::Network;
use crate::operator::OperatorJob;
use crate::tensor::Tensor;
use crate::values::{TensorNumber, TensorValues};
use std::time::Duration;

/// The positions that are computed for each frame after the first. The first frame is always
/// computed densely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExecutionMode {
    /// Every position is computed.
    Dense,
    /// Every output whose window holds an input that may have changed is computed. Results are
    /// equal to [`ExecutionMode::Dense`] bit for bit.
    Exact,
    /// Computes what [`ExecutionMode::Exact`] does, but an output that is equal to its kept value
    /// does not count as changed. Results are equal to [`ExecutionMode::Dense`] bit for bit.
    Compare,
    /// A position keeps the values that it last passed on as long as each new value differs from
    /// them by at most this limit. Integers are compared as the real numbers that they stand for if
    /// their scale is known, and as integers otherwise.
    Truncate(f32),
    /// Only positions at a changed part of the frame are computed, in every tensor. Results are
    /// wrong at the borders of these parts.
    Fixed,
}

/// The work of a node for a frame, in positions of its output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeWork {
    /// The positions whose windows hold a change.
    pub needed_positions: usize,
    /// The positions that were computed.
    pub scheduled_positions: usize,
    /// The positions that were passed on as changed.
    pub changed_positions: usize,
}

/// The state of a network between frames: all tensors of the last frame.
#[derive(Clone, Debug)]
pub struct Executor<'a> {
    network: &'a Network,
    mode: ExecutionMode,
    /// The difference beyond which a value counts as changed, by tensor. Without a limit, every
    /// computed value counts as changed.
    change_limits: Vec<Option<f32>>,
    /// All tensors, with the values that were passed on.
    tensors: Vec<Tensor>,
    /// The changed positions of each tensor.
    change_masks: Vec<Mask>,
    /// The positions at which each node was computed.
    needed_masks: Vec<Mask>,
    work: Vec<NodeWork>,
    /// The buffer for the output of a node before it is compared, one for each type of values.
    scratch: [TensorValues; ElementType::ALL.len()],
    has_begun: bool,
    /// The time of the last step in the operator of each node.
    operator_times: Vec<Duration>,
    /// The time of the last step outside of operators.
    overhead: Duration,
}

impl<'a> Executor<'a> {
    /// Returns an executor that has not run on a frame yet.
    #[must_use]
    pub fn new(network: &'a Network, mode: ExecutionMode) -> Self {
        let forms = || (0..=network.nodes().len()).map(|value| network.form(value));
        let limit = match mode {
            ExecutionMode::Dense | ExecutionMode::Exact | ExecutionMode::Fixed => None,
            ExecutionMode::Compare => Some(0.0),
            ExecutionMode::Truncate(limit) => Some(limit),
        };
        let is_compared = limit.is_some() || mode == ExecutionMode::Fixed;
        let scratch_values = |element| {
            let compared_forms =
                forms().filter(|form| is_compared && form.encoding().element == element);
            TensorValues::zeros(
                element,
                compared_forms.map(TensorForm::element_count).max().unwrap_or(0),
            )
        };
        let mut change_limits: Vec<_> = forms().map(|_| limit).collect();
        // The limit of the frame is 0: its changes are never truncated.
        change_limits[0] = limit.map(|_| 0.0);
        Self {
            network,
            mode,
            change_limits,
            tensors: forms().map(|form| Tensor::zeros(form.clone())).collect(),
            change_masks: forms().map(|form| Mask::empty(form.height(), form.width())).collect(),
            needed_masks: forms()
                .skip(1)
                .map(|form| Mask::empty(form.height(), form.width()))
                .collect(),
            work: vec![NodeWork::default(); network.nodes().len()],
            scratch: ElementType::ALL.map(scratch_values),
            has_begun: false,
            operator_times: vec![Duration::ZERO; network.nodes().len()],
            overhead: Duration::ZERO,
        }
    }

    /// Returns an executor in [`ExecutionMode::Truncate`] with a separate limit for each node.
    ///
    /// # Panics
    /// Panics if the number of limits is not the number of nodes.
    #[must_use]
    pub fn with_limits(network: &'a Network, limits: &[f32]) -> Self {
        assert_eq!(limits.len(), network.nodes().len(), "a limit per node");
        let mut executor = Self::new(network, ExecutionMode::Truncate(0.0));
        for (change_limit, &limit) in executor.change_limits[1..].iter_mut().zip(limits) {
            *change_limit = Some(limit);
        }
        executor
    }

    /// Runs the network on the next frame, which differs from the previous one at most at the
    /// positions `changed`. Returns the work of every node.
    ///
    /// # Panics
    /// Panics if `picture` or `changed` does not have the size of the network's input.
    pub fn step(&mut self, picture: &[f32], changed: &Mask) -> &[NodeWork] {
        let input = self.network.input();
        assert_eq!(
            picture.len(),
            input.element_count(),
            "a picture has as many values as the input"
        );
        assert_eq!(
            (changed.height(), changed.width()),
            (input.height(), input.width()),
            "a bit per position"
        );
        let start = OptionalInstant::now();
        self.store_frame(picture, changed);
        // The loop runs inside the thread pool, so that an operator need not wait until a thread
        // has taken over its work.
        rayon::scope(|_| (0..self.work.len()).for_each(|node| self.run_node(node, changed)));
        self.has_begun = true;
        self.overhead = start.elapsed().saturating_sub(self.operator_times.iter().sum());
        &self.work
    }

    /// The time of the last step outside of operators: masks, comparisons and copies.
    #[must_use]
    pub fn overhead(&self) -> Duration {
        self.overhead
    }

    /// The time of the last step in the operator of a node.
    #[must_use]
    pub fn operator_time(&self, node: usize) -> Duration {
        self.operator_times[node]
    }

    /// Returns each input of a node with its positions that the needed outputs of the last frame
    /// depend on.
    pub fn needed_inputs(&self, node: usize) -> impl Iterator<Item = (usize, Mask)> {
        let network_node = &self.network.nodes()[node];
        network_node.inputs().iter().map(move |&value| {
            let form = self.network.form(value);
            (value, network_node.operator.needed_input(&self.needed_masks[node], form))
        })
    }

    /// The tensor `value` as it was passed on.
    #[must_use]
    pub fn tensor(&self, value: usize) -> &Tensor {
        &self.tensors[value]
    }

    /// The changed positions of the tensor `value`.
    #[must_use]
    pub fn change_mask(&self, value: usize) -> &Mask {
        &self.change_masks[value]
    }

    /// The positions at which the output of a node was needed for the last frame.
    #[must_use]
    pub fn needed_mask(&self, node: usize) -> &Mask {
        &self.needed_masks[node]
    }

    /// The difference from the value that was passed on last beyond which a value counts as
    /// changed, in the modes that compare.
    #[must_use]
    pub fn change_limit(&self, value: usize) -> Option<f32> {
        self.change_limits[value]
    }

    /// Returns true if this frame is computed densely.
    fn is_dense_frame(&self) -> bool {
        !self.has_begun || self.mode == ExecutionMode::Dense
    }

    /// The limit of the tensor `value` for this frame. The first frame has none, because it is not
    /// compared.
    fn comparison_limit(&self, value: usize) -> Option<f32> {
        self.change_limit(value).filter(|_| self.has_begun)
    }

    /// Stores the frame and its changed positions.
    fn store_frame(&mut self, picture: &[f32], changed: &Mask) {
        let kept = &self.tensors[0];
        self.change_masks[0] = match self.comparison_limit(0) {
            _ if self.is_dense_frame() => Mask::full(changed.height(), changed.width()),
            Some(limit) => changed_positions(kept.form(), kept.values(), picture, changed, limit),
            None => changed.clone(),
        };
        let form = self.network.input();
        copy_positions(
            form,
            picture,
            f32::slice_of_mut(self.tensors[0].values_mut()),
            &self.change_masks[0],
        );
    }

    /// Returns the positions of a node's output that are to be computed.
    fn positions_to_compute(&self, node: usize, frame_mask: &Mask) -> Mask {
        let is_aligned = self.network.is_aligned_with_frame(node + 1);
        let (node, form) = (&self.network.nodes()[node], self.network.form(node + 1));
        if self.is_dense_frame() {
            return Mask::full(form.height(), form.width());
        }
        // The positions have no place in the frame if its rows and columns were merged into one
        // axis or reduced away. Changes then spread as in the other modes.
        if self.mode == ExecutionMode::Fixed && is_aligned {
            return frame_mask.scaled_to(form.height(), form.width());
        }
        let form_and_changes =
            |&value: &usize| (self.network.form(value), &self.change_masks[value]);
        node.operator.spread(&node.inputs().iter().map(form_and_changes).collect::<Vec<_>>(), form)
    }

    fn run_node(&mut self, node: usize, frame_mask: &Mask) {
        let (positions, limit) =
            (self.positions_to_compute(node, frame_mask), self.comparison_limit(node + 1));
        self.needed_masks[node].clone_from(&positions);
        let network_node = &self.network.nodes()[node];
        let form = self.network.form(node + 1);
        let (needed, scheduled) =
            (positions.count(), network_node.operator.scheduled_positions(&positions));
        let (before, rest) = self.tensors.split_at_mut(node + 1);
        let inputs: Vec<&Tensor> =
            network_node.inputs().iter().map(|&value| &before[value]).collect();
        let kept = &mut rest[0];
        let operator_time = &mut self.operator_times[node];
        let mut compute = |output: &mut TensorValues| {
            let start = OptionalInstant::now();
            if !positions.is_empty() {
                network_node.operator.compute(OperatorJob {
                    inputs: &inputs,
                    form,
                    output,
                    positions: &positions,
                });
            }
            *operator_time = start.elapsed();
        };
        // Outside of the needed positions an operator may write only the values that a dense
        // computation would write. The kept tensor has these values already, unless an input
        // differs from that of a dense computation.
        let in_place = limit.is_none() && (self.mode != ExecutionMode::Fixed || !self.has_begun);
        let changed = if in_place {
            compute(kept.values_mut());
            positions
        } else {
            let computed = &mut self.scratch[form.encoding().element as usize];
            compute(computed);
            with_element_type!(form.encoding().element, T => {
                let (computed, kept) = (T::slice_of(computed), T::slice_of_mut(kept.values_mut()));
                let changed = match limit {
                    Some(limit) => changed_positions(form, kept, computed, &positions, limit),
                    None => positions,
                };
                copy_positions(form, computed, kept, &changed);
                changed
            })
        };
        self.work[node] = NodeWork {
            needed_positions: needed,
            scheduled_positions: scheduled,
            changed_positions: changed.count(),
        };
        self.change_masks[node + 1] = changed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mask::AxisWindow;
    use crate::operator::{Operator, position_union};
    use crate::tensor::InputLayout;
    use std::sync::Arc;

    /// A 3x3 window that moves by two rows and columns, with a padding of 1.
    const WINDOW: AxisWindow =
        AxisWindow { kernel: 3, stride: 2, dilation: 1, padding_before: 1, padding_after: 1 };

    /// The function of a test operator, on floating-point values of one channel.
    #[derive(Clone, Copy, Debug)]
    enum TestOperatorKind {
        /// The weighted sum of a [`WINDOW`], in which each tap has a different weight.
        Window,
        /// The value multiplied by 0.
        Zero,
        /// The sum of both inputs.
        Sum,
    }

    impl TestOperatorKind {
        fn at(self, inputs: &[&Tensor], x: usize, y: usize) -> f32 {
            let value = |input: usize, x, y| {
                let tensor = inputs[input];
                tensor.values::<f32>()[y * tensor.form().width() + x]
            };
            match self {
                Self::Zero => 0.0 * value(0, x, y),
                Self::Sum => value(0, x, y) + value(1, x, y),
                Self::Window => {
                    let form = inputs[0].form();
                    let taps = (0..9).filter_map(|tap| {
                        let row = WINDOW.input_index(y, tap / 3, form.height())?;
                        let column = WINDOW.input_index(x, tap % 3, form.width())?;
                        Some(value(0, column, row) * [1., 2., 3., 4., 5., 6., 7., 8., 9.][tap])
                    });
                    taps.sum()
                }
            }
        }
    }

    /// A fault in the way a change spreads.
    #[derive(Clone, Copy, Debug)]
    enum PlantedFault {
        None,
        /// The padding is too small by one.
        Padding,
        /// The windows begin one input too early.
        Phase,
        /// Only the first of several inputs counts.
        MissedUnion,
        /// The last tap of the window is missing.
        Kernel,
    }

    /// An operator that computes correctly, but may have a fault in its spread.
    #[derive(Debug)]
    struct FaultyOperator {
        kind: TestOperatorKind,
        fault: PlantedFault,
    }

    impl Operator for FaultyOperator {
        fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
            let halved = TensorForm::features(vec![1, 1, 12, 12]);
            Ok(if matches!(self.kind, TestOperatorKind::Window) {
                halved
            } else {
                inputs[0].clone()
            })
        }

        fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
            let (height, width) = (output.height(), output.width());
            let through = |window| inputs[0].1.outputs_through(window, window, height, width);
            match (self.kind, self.fault) {
                (_, PlantedFault::Padding) => {
                    through(AxisWindow { padding_before: WINDOW.padding_before - 1, ..WINDOW })
                }
                (_, PlantedFault::Phase) => {
                    through(AxisWindow { padding_before: WINDOW.padding_before + 1, ..WINDOW })
                }
                (_, PlantedFault::Kernel) => {
                    through(AxisWindow { kernel: WINDOW.kernel - 1, ..WINDOW })
                }
                (_, PlantedFault::MissedUnion) => position_union(&inputs[..1], output),
                (TestOperatorKind::Window, PlantedFault::None) => through(WINDOW),
                (TestOperatorKind::Zero | TestOperatorKind::Sum, PlantedFault::None) => {
                    position_union(inputs, output)
                }
            }
        }

        fn compute(&self, job: OperatorJob<'_>) {
            let width = job.form.width();
            for (place, output) in
                f32::slice_of_mut(job.output)[..job.form.position_count()].iter_mut().enumerate()
            {
                let (x, y) = (place % width, place / width);
                if job.positions.contains(x, y) {
                    *output = self.kind.at(job.inputs, x, y);
                }
            }
        }
    }

    /// Returns a network of windows with stride 2 and the sum of two branches. The first window and
    /// the sum have the given faults. The first branch never changes.
    fn two_branch_network(in_window: PlantedFault, in_sum: PlantedFault) -> Network {
        let mut network =
            Network::new(TensorForm::features(vec![1, 1, 24, 24]), InputLayout::Nchw).unwrap();
        let mut push = |kind, fault, inputs| {
            let (name, operator) = (format!("{kind:?}"), Arc::new(FaultyOperator { kind, fault }));
            network.push(&name, &name, operator, inputs).unwrap()
        };
        let first = push(TestOperatorKind::Window, in_window, vec![0]);
        let none = push(TestOperatorKind::Zero, PlantedFault::None, vec![first]);
        let second = push(TestOperatorKind::Window, PlantedFault::None, vec![0]);
        push(TestOperatorKind::Sum, in_sum, vec![none, second]);
        network
    }

    /// Returns true if all tensors are equal to those of a dense computation after a single changed
    /// pixel, for every pixel of the diagonal.
    fn is_exact(network: &Network) -> bool {
        (0..24).all(|at| {
            let mut picture = vec![0.5; 24 * 24];
            let (mut dense, mut exact) = (
                Executor::new(network, ExecutionMode::Dense),
                Executor::new(network, ExecutionMode::Compare),
            );
            dense.step(&picture, &Mask::full(24, 24));
            exact.step(&picture, &Mask::full(24, 24));
            picture[at * 25] = 0.75;
            let changed = Mask::from_fn(24, 24, |x, y| (x, y) == (at, at));
            dense.step(&picture, &changed);
            exact.step(&picture, &changed);
            (0..=network.nodes().len()).all(|value| {
                dense.tensor(value).differing_positions(exact.tensor(value)).is_empty()
            })
        })
    }

    #[test]
    fn planted_faults_are_caught() {
        assert!(is_exact(&two_branch_network(PlantedFault::None, PlantedFault::None)));
        for fault in [PlantedFault::Padding, PlantedFault::Phase, PlantedFault::Kernel] {
            assert!(!is_exact(&two_branch_network(fault, PlantedFault::None)), "{fault:?}");
        }
        assert!(!is_exact(&two_branch_network(PlantedFault::None, PlantedFault::MissedUnion)));
    }
}
