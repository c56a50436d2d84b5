// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network: operators in topological order, so that each comes after those whose outputs it
//! takes.

use super::tensor::{InputLayout, MAX_AXES, TensorForm, checked_element_count};
use crate::element::Encoding;
use crate::error::NetworkError;
use crate::mask::Mask;
use crate::operator::{Operator, ProductKind};
use std::sync::Arc;

const MAX_TENSOR_VALUES: usize = 1 << 28;
/// The largest number of values of all tensors together, which a run keeps in memory.
const MAX_KEPT_VALUES: usize = 1 << 30;
/// The largest number of bytes of the weights of all nodes.
const MAX_WEIGHT_BYTES: u64 = 1 << 32;

/// A network whose shapes are known. Tensor 0 is its input, tensor `i + 1` is the output of node
/// `i`.
#[derive(Clone, Debug)]
pub struct Network {
    layout: InputLayout,
    forms: Vec<TensorForm>,
    /// The rows and columns of each tensor whose positions are those of the frame, either as two
    /// axes or flattened into one.
    frame_grids: Vec<Option<(usize, usize)>>,
    nodes: Vec<NetworkNode>,
    outputs: Vec<usize>,
    /// The names of the outputs in the model.
    output_names: Vec<String>,
    /// The names of weights that hold infinite values or NaN, with the number of such values.
    non_finite_weights: Vec<(String, usize)>,
    /// The number of values of all tensors.
    kept_values: usize,
    weight_bytes: u64,
}

/// An operator with its place in the network.
#[derive(Clone, Debug)]
pub struct NetworkNode {
    name: String,
    operator_name: String,
    pub(crate) operator: Arc<dyn Operator>,
    inputs: Vec<usize>,
    /// The positions that are computed for a complete output.
    scheduled_positions: usize,
}

impl NetworkNode {
    /// The name in the model, or a name made from the operator if the model gives none.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The name of the operator.
    #[must_use]
    pub fn operator_name(&self) -> &str {
        &self.operator_name
    }

    /// The numbers of the tensors that the node takes.
    #[must_use]
    pub fn inputs(&self) -> &[usize] {
        &self.inputs
    }

    /// The kind of sums of products that the node computes.
    #[must_use]
    pub fn products(&self) -> ProductKind {
        self.operator.products()
    }

    /// The bytes of the node's weights.
    #[must_use]
    pub fn weight_bytes(&self) -> u64 {
        self.operator.weight_bytes()
    }
}

impl Network {
    /// Returns a network that has only an input so far.
    pub(crate) fn new(input: TensorForm, layout: InputLayout) -> Result<Self, NetworkError> {
        check_size(&input).map_err(NetworkError::InvalidNetwork)?;
        let kept = input.element_count();
        Ok(Self {
            layout,
            frame_grids: vec![Some((input.height(), input.width()))],
            forms: vec![input],
            nodes: Vec::new(),
            outputs: Vec::new(),
            output_names: Vec::new(),
            non_finite_weights: Vec::new(),
            kept_values: kept,
            weight_bytes: 0,
        })
    }

    /// Adds a node, and returns the number of its output tensor.
    pub(crate) fn push(
        &mut self,
        name: &str,
        kind: &str,
        operator: Arc<dyn Operator>,
        inputs: Vec<usize>,
    ) -> Result<usize, NetworkError> {
        let forms: Vec<&TensorForm> = inputs.iter().map(|&value| &self.forms[value]).collect();
        let encodings: Vec<Encoding> = forms.iter().map(|form| form.encoding()).collect();
        let form = operator
            .encoding(&encodings)
            .and_then(|encoding| Ok(operator.form(&forms)?.with_encoding(encoding)))
            .and_then(|form| check_size(&form).map(|()| form));
        let problem = |problem| NetworkError::InvalidNode {
            node: name.to_owned(),
            operator: kind.to_owned(),
            problem,
        };
        let form = form.map_err(problem)?;
        self.kept_values = self.kept_values.saturating_add(form.element_count());
        if self.kept_values > MAX_KEPT_VALUES {
            return Err(problem(format!(
                "all tensors up to here have more than {MAX_KEPT_VALUES} values"
            )));
        }
        self.weight_bytes = self.weight_bytes.saturating_add(operator.weight_bytes());
        if self.weight_bytes > MAX_WEIGHT_BYTES {
            return Err(problem("all weights up to here have more than 4 GiB".to_owned()));
        }
        let scheduled = operator.scheduled_positions(&Mask::full(form.height(), form.width()));
        self.frame_grids.push(self.frame_grid(&form, &inputs));
        self.forms.push(form);
        let (name, kind) = (name.to_owned(), kind.to_owned());
        self.nodes.push(NetworkNode {
            name,
            operator_name: kind,
            operator,
            inputs,
            scheduled_positions: scheduled,
        });
        Ok(self.nodes.len())
    }

    /// The rows and columns of the frame to which the positions of a tensor made of these inputs
    /// belong.
    fn frame_grid(&self, form: &TensorForm, inputs: &[usize]) -> Option<(usize, usize)> {
        let own_grid = (form.height(), form.width());
        let inherited_grid = |&value: &usize| match (
            form.position_axes().len(),
            self.forms[value].position_axes().len(),
        ) {
            (2, 2) => self.frame_grids[value].map(|_| own_grid),
            // A flattened axis becomes rows and columns again if their numbers are those of before.
            (2, _) => self.frame_grids[value].filter(|&grid| grid == own_grid),
            (1, _) => self.frame_grids[value]
                .filter(|&(height, width)| height * width == form.position_count()),
            _ => None,
        };
        inputs.iter().find_map(inherited_grid)
    }

    /// Returns true if the tensor has rows and columns of positions that belong to those of the
    /// frame.
    pub(crate) fn is_aligned_with_frame(&self, value: usize) -> bool {
        self.frame_grids[value].is_some() && self.forms[value].position_axes().len() == 2
    }

    /// Sets the outputs with their names, and the weights that are not finite.
    pub(crate) fn set_outputs(
        &mut self,
        outputs: Vec<(String, usize)>,
        not_finite: Vec<(String, usize)>,
    ) {
        (self.output_names, self.outputs) = outputs.into_iter().unzip();
        self.non_finite_weights = not_finite;
    }

    /// Replaces the operator of the last node by one with the same inputs and the same form.
    pub(crate) fn replace_last(&mut self, kind: &str, operator: Arc<dyn Operator>) {
        let last = self.nodes.last_mut().expect("there is a node to replace");
        last.operator = operator;
        kind.clone_into(&mut last.operator_name);
    }

    /// Removes the last node. No other node may take its output.
    pub(crate) fn remove_last(&mut self) {
        let (node, form) = (self.nodes.pop(), self.forms.pop());
        self.frame_grids.pop();
        self.kept_values -= form.map_or(0, |form| form.element_count());
        self.weight_bytes -= node.map_or(0, |node| node.weight_bytes());
    }

    /// The nodes in order.
    #[must_use]
    pub fn nodes(&self) -> &[NetworkNode] {
        &self.nodes
    }

    /// The layout in which the model takes its input. The network itself always takes the channels
    /// first.
    #[must_use]
    pub fn layout(&self) -> InputLayout {
        self.layout
    }

    /// The form of the input.
    #[must_use]
    pub fn input(&self) -> &TensorForm {
        &self.forms[0]
    }

    /// The form of a tensor.
    #[must_use]
    pub fn form(&self, value: usize) -> &TensorForm {
        &self.forms[value]
    }

    /// The numbers of the tensors that are outputs of the network.
    #[must_use]
    pub fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    /// The names of the outputs in the model, in the order of [`Network::outputs`].
    #[must_use]
    pub fn output_names(&self) -> &[String] {
        &self.output_names
    }

    /// The weights that hold infinite values or NaN: the name in the model, and the number of such
    /// values.
    #[must_use]
    pub fn non_finite_weights(&self) -> &[(String, usize)] {
        &self.non_finite_weights
    }

    /// The multiply-accumulate operations of a node for a complete frame.
    #[must_use]
    pub fn macs(&self, node: usize) -> u64 {
        let (node, form) = (&self.nodes[node], &self.forms[node + 1]);
        let macs_per_value = match node.products() {
            ProductKind::None | ProductKind::NoComputation => 0,
            ProductKind::Transposed { inputs } | ProductKind::Matrix { inputs } => inputs,
            ProductKind::Convolution { rows, columns, groups } => {
                self.forms[node.inputs[0]].shape()[1] / groups * rows.kernel * columns.kernel
            }
        };
        (form.element_count() * macs_per_value) as u64
    }

    /// The multiply-accumulate operations of all nodes for a complete frame.
    #[must_use]
    pub fn total_macs(&self) -> u64 {
        (0..self.nodes.len()).map(|node| self.macs(node)).sum()
    }

    /// The bytes of the weights of all nodes.
    #[must_use]
    pub fn weight_bytes(&self) -> u64 {
        self.weight_bytes
    }

    /// The positions that are computed for a complete output of a node. Blocks are computed as a
    /// whole, so there may be more than the output has.
    #[must_use]
    pub fn scheduled_positions(&self, node: usize) -> usize {
        self.nodes[node].scheduled_positions
    }

    /// The bytes of all tensors of a frame, which are kept from frame to frame.
    #[must_use]
    pub fn kept_bytes(&self) -> u64 {
        self.forms.iter().map(TensorForm::bytes).sum()
    }
}

/// Fails if a tensor is empty, has too many axes or has too many values.
fn check_size(form: &TensorForm) -> Result<(), String> {
    if form.shape().len() > MAX_AXES {
        return Err(format!("a tensor has {} axes, more than {MAX_AXES}", form.shape().len()));
    }
    match checked_element_count(form.shape()) {
        Some(1..=MAX_TENSOR_VALUES) => Ok(()),
        Some(0) => Err(format!("a tensor is empty: {}", form.describe())),
        _ => Err(format!("a tensor has more than {MAX_TENSOR_VALUES} values: {}", form.describe())),
    }
}
