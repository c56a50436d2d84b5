// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network frame by frame, and recomputes only what may have changed.

use crate::compare::{copy, moved};
use crate::element::{Element, typed};
use crate::form::Form;
use crate::mask::Mask;
use crate::moment::Moment;
use crate::network::Network;
use crate::operator::Job;
use crate::tensor::Tensor;
use crate::values::{Number, Values};
use std::time::Duration;

/// The positions that are computed for each frame after the first. The first frame is always
/// computed densely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// Every position is computed.
    Dense,
    /// Every output whose window holds an input that may have changed is computed. Results are
    /// equal to [`Mode::Dense`] bit for bit.
    Exact,
    /// Computes what [`Mode::Exact`] does, but an output that is equal to its kept value does not
    /// count as changed. Results are equal to [`Mode::Dense`] bit for bit.
    Compare,
    /// A position keeps the values that it passed on last while each of its new values is within
    /// this limit of them. Integers are compared as the real numbers that they stand for if their
    /// scale is known, and as integers otherwise.
    Truncate(f32),
    /// In every tensor only the positions are computed that lie under a changed part of the frame.
    /// Results are wrong at the borders of these parts.
    Fixed,
}

/// The work of a node for a frame, in positions of its output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// The positions whose windows hold a change.
    pub needed: usize,
    /// The positions that were computed.
    pub scheduled: usize,
    /// The positions that were passed on as changed.
    pub changed: usize,
}

/// The state of a network between frames: all tensors of the last frame.
#[derive(Clone, Debug)]
pub struct Executor<'a> {
    network: &'a Network,
    mode: Mode,
    /// The difference beyond which a value counts as changed, by tensor. Without a limit, every
    /// computed value counts as changed.
    limits: Vec<Option<f32>>,
    /// All tensors, with the values that were passed on.
    kept: Vec<Tensor>,
    /// The changed positions of each tensor.
    masks: Vec<Mask>,
    /// The positions at which each node was computed.
    wanted: Vec<Mask>,
    work: Vec<Work>,
    /// The buffer for the output of a node before it is compared, one for each type of values.
    fresh: [Values; Element::ALL.len()],
    has_begun: bool,
    /// The time of the last step in the operator of each node.
    computing: Vec<Duration>,
    /// The time of the last step outside of operators.
    overhead: Duration,
}

impl<'a> Executor<'a> {
    /// Returns an executor that has seen no frame.
    #[must_use]
    pub fn new(network: &'a Network, mode: Mode) -> Self {
        let forms = || (0..=network.nodes().len()).map(|value| network.form(value));
        let limit = match mode {
            Mode::Dense | Mode::Exact | Mode::Fixed => None,
            Mode::Compare => Some(0.0),
            Mode::Truncate(limit) => Some(limit),
        };
        let is_compared = limit.is_some() || mode == Mode::Fixed;
        let fresh = |element| {
            let own = forms().filter(|form| is_compared && form.encoding().element == element);
            Values::zeros(element, own.map(Form::elements).max().unwrap_or(0))
        };
        let mut limits: Vec<_> = forms().map(|_| limit).collect();
        // The limit of the frame is 0: its changes are never truncated.
        limits[0] = limit.map(|_| 0.0);
        Self {
            network,
            mode,
            limits,
            kept: forms().map(|form| Tensor::zeros(form.clone())).collect(),
            masks: forms().map(|form| Mask::empty(form.height(), form.width())).collect(),
            wanted: forms().skip(1).map(|form| Mask::empty(form.height(), form.width())).collect(),
            work: vec![Work::default(); network.nodes().len()],
            fresh: Element::ALL.map(fresh),
            has_begun: false,
            computing: vec![Duration::ZERO; network.nodes().len()],
            overhead: Duration::ZERO,
        }
    }

    /// Returns an executor in [`Mode::Truncate`] with a separate limit for each node.
    ///
    /// # Panics
    /// Panics if the number of limits is not the number of nodes.
    #[must_use]
    pub fn truncating(network: &'a Network, limits: &[f32]) -> Self {
        assert_eq!(limits.len(), network.nodes().len(), "a limit per node");
        let mut executor = Self::new(network, Mode::Truncate(0.0));
        for (own, &limit) in executor.limits[1..].iter_mut().zip(limits) {
            *own = Some(limit);
        }
        executor
    }

    /// Runs the network on the next frame, which differs from the previous one at most at the
    /// positions `changed`. Returns the work of every node.
    ///
    /// # Panics
    /// Panics if `picture` or `changed` does not have the size of the network's input.
    pub fn step(&mut self, picture: &[f32], changed: &Mask) -> &[Work] {
        let input = self.network.input();
        assert_eq!(picture.len(), input.elements(), "a picture has as many values as the input");
        assert_eq!(
            (changed.height(), changed.width()),
            (input.height(), input.width()),
            "a bit per position"
        );
        let start = Moment::now();
        self.accept(picture, changed);
        // The loop runs inside the thread pool, so that an operator need not wait until a thread
        // has taken over its work.
        rayon::scope(|_| (0..self.work.len()).for_each(|node| self.run(node, changed)));
        self.has_begun = true;
        self.overhead = start.elapsed().saturating_sub(self.computing.iter().sum());
        &self.work
    }

    /// The time of the last step outside of operators: masks, comparisons and copies.
    #[must_use]
    pub fn overhead(&self) -> Duration {
        self.overhead
    }

    /// The time of the last step in the operator of a node.
    #[must_use]
    pub fn time(&self, node: usize) -> Duration {
        self.computing[node]
    }

    /// Returns each input of a node with its positions that the needed outputs of the last frame
    /// depend on.
    pub fn seen(&self, node: usize) -> impl Iterator<Item = (usize, Mask)> {
        let place = &self.network.nodes()[node];
        place.inputs().iter().map(move |&value| {
            let form = self.network.form(value);
            (value, place.operator.seen(&self.wanted[node], form))
        })
    }

    /// The tensor `value` as it was passed on.
    #[must_use]
    pub fn value(&self, value: usize) -> &Tensor {
        &self.kept[value]
    }

    /// The changed positions of the tensor `value`.
    #[must_use]
    pub fn mask(&self, value: usize) -> &Mask {
        &self.masks[value]
    }

    /// The positions at which the output of a node was needed for the last frame.
    #[must_use]
    pub fn wanted(&self, node: usize) -> &Mask {
        &self.wanted[node]
    }

    /// The difference from the value that was passed on last beyond which a value counts as
    /// changed, in the modes that compare.
    #[must_use]
    pub fn limit(&self, value: usize) -> Option<f32> {
        self.limits[value]
    }

    /// Returns true if this frame is computed densely.
    fn is_whole(&self) -> bool {
        !self.has_begun || self.mode == Mode::Dense
    }

    /// The limit of the tensor `value` for this frame. The first frame has none, because it is not
    /// compared.
    fn compared(&self, value: usize) -> Option<f32> {
        self.limit(value).filter(|_| self.has_begun)
    }

    /// Stores the frame and its changed positions.
    fn accept(&mut self, picture: &[f32], changed: &Mask) {
        let kept = &self.kept[0];
        self.masks[0] = match self.compared(0) {
            _ if self.is_whole() => Mask::full(changed.height(), changed.width()),
            Some(limit) => moved(kept.form(), kept.values(), picture, changed, limit),
            None => changed.clone(),
        };
        let form = self.network.input();
        copy(form, picture, f32::of_mut(self.kept[0].stored_mut()), &self.masks[0]);
    }

    /// Returns the positions of a node's output that are to be computed.
    fn wanting(&self, node: usize, camera: &Mask) -> Mask {
        let is_under = self.network.lies_under_picture(node + 1);
        let (node, form) = (&self.network.nodes()[node], self.network.form(node + 1));
        if self.is_whole() {
            return Mask::full(form.height(), form.width());
        }
        // If rows were merged into one axis or reduced away, the positions have no place in the
        // frame.
        if self.mode == Mode::Fixed && is_under {
            return camera.under(form.height(), form.width());
        }
        let source = |&value: &usize| (self.network.form(value), &self.masks[value]);
        node.operator.spread(&node.inputs().iter().map(source).collect::<Vec<_>>(), form)
    }

    fn run(&mut self, node: usize, camera: &Mask) {
        let (at, limit) = (self.wanting(node, camera), self.compared(node + 1));
        self.wanted[node].clone_from(&at);
        let place = &self.network.nodes()[node];
        let form = self.network.form(node + 1);
        let (needed, scheduled) = (at.count(), place.operator.scheduled(&at));
        let (before, rest) = self.kept.split_at_mut(node + 1);
        let inputs: Vec<&Tensor> = place.inputs().iter().map(|&value| &before[value]).collect();
        let kept = &mut rest[0];
        let computing = &mut self.computing[node];
        let mut compute = |output: &mut Values| {
            let start = Moment::now();
            if !at.is_empty() {
                place.operator.compute(Job { inputs: &inputs, form, output, at: &at });
            }
            *computing = start.elapsed();
        };
        // Outside of the needed positions an operator may write only the values that a dense
        // computation would write. Those are in the kept tensor already, unless an input differs
        // from that of a dense computation.
        let in_place = limit.is_none() && (self.mode != Mode::Fixed || !self.has_begun);
        let changed = if in_place {
            compute(kept.stored_mut());
            at
        } else {
            let fresh = &mut self.fresh[form.encoding().element as usize];
            compute(fresh);
            typed!(form.encoding().element, T => {
                let (fresh, kept) = (T::of(fresh), T::of_mut(kept.stored_mut()));
                let changed = match limit {
                    Some(limit) => moved(form, kept, fresh, &at, limit),
                    None => at,
                };
                copy(form, fresh, kept, &changed);
                changed
            })
        };
        self.work[node] = Work { needed, scheduled, changed: changed.count() };
        self.masks[node + 1] = changed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;
    use crate::mask::Window;
    use crate::operator::{Operator, same_position};
    use std::sync::Arc;

    /// A 3x3 window that moves by two rows and columns, with a padding of 1.
    const WINDOW: Window = Window { kernel: 3, stride: 2, dilation: 1, before: 1, after: 1 };

    /// The function of a test operator, on floating-point values of one channel.
    #[derive(Clone, Copy, Debug)]
    enum Kind {
        /// The weighted sum of a [`WINDOW`], in which each tap has a different weight.
        Window,
        /// The value multiplied by 0.
        Zero,
        /// The sum of both inputs.
        Sum,
    }

    impl Kind {
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
                        let row = WINDOW.input(y, tap / 3, form.height())?;
                        let column = WINDOW.input(x, tap % 3, form.width())?;
                        Some(value(0, column, row) * [1., 2., 3., 4., 5., 6., 7., 8., 9.][tap])
                    });
                    taps.sum()
                }
            }
        }
    }

    /// A fault in the way a change spreads.
    #[derive(Clone, Copy, Debug)]
    enum Fault {
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
    struct Faulty {
        kind: Kind,
        fault: Fault,
    }

    impl Operator for Faulty {
        fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
            let halved = Form::features(vec![1, 1, 12, 12]);
            Ok(if matches!(self.kind, Kind::Window) { halved } else { inputs[0].clone() })
        }

        fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
            let (height, width) = (output.height(), output.width());
            let through = |window| inputs[0].1.through(window, window, height, width);
            match (self.kind, self.fault) {
                (_, Fault::Padding) => through(Window { before: WINDOW.before - 1, ..WINDOW }),
                (_, Fault::Phase) => through(Window { before: WINDOW.before + 1, ..WINDOW }),
                (_, Fault::Kernel) => through(Window { kernel: WINDOW.kernel - 1, ..WINDOW }),
                (_, Fault::MissedUnion) => same_position(&inputs[..1], output),
                (Kind::Window, Fault::None) => through(WINDOW),
                (Kind::Zero | Kind::Sum, Fault::None) => same_position(inputs, output),
            }
        }

        fn compute(&self, job: Job<'_>) {
            let width = job.form.width();
            for (place, output) in
                f32::of_mut(job.output)[..job.form.places()].iter_mut().enumerate()
            {
                let (x, y) = (place % width, place / width);
                if job.at.contains(x, y) {
                    *output = self.kind.at(job.inputs, x, y);
                }
            }
        }
    }

    /// Returns a network of windows with stride 2 and the sum of two branches. The first window and
    /// the sum have the given faults. The first branch never changes.
    fn network(in_window: Fault, in_sum: Fault) -> Network {
        let mut network = Network::new(Form::features(vec![1, 1, 24, 24]), Layout::Nchw).unwrap();
        let mut push = |kind, fault, inputs| {
            let (name, operator) = (format!("{kind:?}"), Arc::new(Faulty { kind, fault }));
            network.push(&name, &name, operator, inputs).unwrap()
        };
        let first = push(Kind::Window, in_window, vec![0]);
        let none = push(Kind::Zero, Fault::None, vec![first]);
        let second = push(Kind::Window, Fault::None, vec![0]);
        push(Kind::Sum, in_sum, vec![none, second]);
        network
    }

    /// Returns true if all tensors are equal to those of a dense computation after a single changed
    /// pixel, for every pixel of the diagonal.
    fn is_exact(network: &Network) -> bool {
        (0..24).all(|at| {
            let mut picture = vec![0.5; 24 * 24];
            let (mut dense, mut exact) =
                (Executor::new(network, Mode::Dense), Executor::new(network, Mode::Compare));
            dense.step(&picture, &Mask::full(24, 24));
            exact.step(&picture, &Mask::full(24, 24));
            picture[at * 25] = 0.75;
            let changed = Mask::from_fn(24, 24, |x, y| (x, y) == (at, at));
            dense.step(&picture, &changed);
            exact.step(&picture, &changed);
            (0..=network.nodes().len())
                .all(|value| dense.value(value).differences(exact.value(value)).is_empty())
        })
    }

    #[test]
    fn planted_faults_are_caught() {
        assert!(is_exact(&network(Fault::None, Fault::None)));
        for fault in [Fault::Padding, Fault::Phase, Fault::Kernel] {
            assert!(!is_exact(&network(fault, Fault::None)), "{fault:?}");
        }
        assert!(!is_exact(&network(Fault::None, Fault::MissedUnion)));
    }
}
