// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network: operators in an order in which each comes after those whose outputs it takes.

use crate::element::Encoding;
use crate::error::NetworkError;
use crate::form::{Form, MAX_AXES, elements_of};
use crate::layout::Layout;
use crate::mask::Mask;
use crate::operator::{Operator, Products};
use std::sync::Arc;

/// Values of the largest tensor.
const MAX_ELEMENTS: usize = 1 << 28;
/// Values of all tensors together, which a run keeps.
const MAX_KEPT: usize = 1 << 30;
/// Bytes of the weights of all nodes.
const MAX_WEIGHTS: u64 = 1 << 32;

/// A network whose shapes are known. Value 0 is its input, value `i + 1` the output of node `i`.
#[derive(Clone, Debug)]
pub struct Network {
    layout: Layout,
    forms: Vec<Form>,
    /// Of each value whose positions are those of the picture, in its rows or all in a row: their rows and columns.
    grids: Vec<Option<(usize, usize)>>,
    nodes: Vec<Node>,
    outputs: Vec<usize>,
    /// What the model calls them.
    output_names: Vec<String>,
    /// Names of weights that hold infinite values or such that are no numbers, and how many.
    not_finite: Vec<(String, usize)>,
    /// Values of all tensors.
    kept: usize,
    weight_bytes: u64,
}

/// An operator at its place.
#[derive(Clone, Debug)]
pub struct Node {
    name: String,
    kind: String,
    pub(crate) operator: Arc<dyn Operator>,
    inputs: Vec<usize>,
    /// Positions that are computed for a whole output.
    scheduled: usize,
}

impl Node {
    /// Its name in the model, or one made from its operator.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What its operator is called.
    #[must_use]
    pub fn kind(&self) -> &str {
        &self.kind
    }

    /// The values that it takes.
    #[must_use]
    pub fn inputs(&self) -> &[usize] {
        &self.inputs
    }

    /// The sums of products that it computes.
    #[must_use]
    pub fn products(&self) -> Products {
        self.operator.products()
    }

    /// Bytes of its weights.
    #[must_use]
    pub fn weight_bytes(&self) -> u64 {
        self.operator.weight_bytes()
    }
}

impl Network {
    /// A network that has only an input so far.
    pub(crate) fn new(input: Form, layout: Layout) -> Result<Self, NetworkError> {
        limit(&input).map_err(NetworkError::Network)?;
        let kept = input.elements();
        Ok(Self {
            layout,
            grids: vec![Some((input.height(), input.width()))],
            forms: vec![input],
            nodes: Vec::new(),
            outputs: Vec::new(),
            output_names: Vec::new(),
            not_finite: Vec::new(),
            kept,
            weight_bytes: 0,
        })
    }

    /// Adds a node, and returns its value.
    pub(crate) fn push(
        &mut self,
        name: &str,
        kind: &str,
        operator: Arc<dyn Operator>,
        inputs: Vec<usize>,
    ) -> Result<usize, NetworkError> {
        let forms: Vec<&Form> = inputs.iter().map(|&value| &self.forms[value]).collect();
        let encodings: Vec<Encoding> = forms.iter().map(|form| form.encoding()).collect();
        let form = operator
            .encoding(&encodings)
            .and_then(|encoding| Ok(operator.form(&forms)?.encoded(encoding)))
            .and_then(|form| limit(&form).map(|()| form));
        let problem = |problem| NetworkError::Node {
            node: name.to_owned(),
            operator: kind.to_owned(),
            problem,
        };
        let form = form.map_err(problem)?;
        self.kept = self.kept.saturating_add(form.elements());
        if self.kept > MAX_KEPT {
            return Err(problem(format!(
                "all tensors up to here have more than {MAX_KEPT} values"
            )));
        }
        self.weight_bytes = self.weight_bytes.saturating_add(operator.weight_bytes());
        if self.weight_bytes > MAX_WEIGHTS {
            return Err(problem("all weights up to here have more than 4 GiB".to_owned()));
        }
        let scheduled = operator.scheduled(&Mask::full(form.height(), form.width()));
        self.grids.push(self.grid(&form, &inputs));
        self.forms.push(form);
        let (name, kind) = (name.to_owned(), kind.to_owned());
        self.nodes.push(Node { name, kind, operator, inputs, scheduled });
        Ok(self.nodes.len())
    }

    /// The rows and columns of the picture that are the positions of what is made of these inputs.
    fn grid(&self, form: &Form, inputs: &[usize]) -> Option<(usize, usize)> {
        let own = (form.height(), form.width());
        let of = |&value: &usize| match (form.axes().len(), self.forms[value].axes().len()) {
            (2, 2) => self.grids[value].map(|_| own),
            // What stood in a row stands in rows again, if these are the same.
            (2, _) => self.grids[value].filter(|&grid| grid == own),
            (1, _) => self.grids[value].filter(|&(height, width)| height * width == form.places()),
            _ => None,
        };
        inputs.iter().find_map(of)
    }

    /// Whether the rows and columns of a value's positions lie under those of the picture.
    pub(crate) fn lies_under_picture(&self, value: usize) -> bool {
        self.grids[value].is_some() && self.forms[value].axes().len() == 2
    }

    /// Says which values are the outputs, with their names, and which weights are not finite.
    pub(crate) fn finish(
        &mut self,
        outputs: Vec<(String, usize)>,
        not_finite: Vec<(String, usize)>,
    ) {
        (self.output_names, self.outputs) = outputs.into_iter().unzip();
        self.not_finite = not_finite;
    }

    /// Lets the last node do something else with the same inputs and the same form.
    pub(crate) fn replace_last(&mut self, kind: &str, operator: Arc<dyn Operator>) {
        let last = self.nodes.last_mut().expect("there is a node to replace");
        last.operator = operator;
        kind.clone_into(&mut last.kind);
    }

    /// Takes the last node away, which no other takes.
    pub(crate) fn remove_last(&mut self) {
        let (node, form) = (self.nodes.pop(), self.forms.pop());
        self.grids.pop();
        self.kept -= form.map_or(0, |form| form.elements());
        self.weight_bytes -= node.map_or(0, |node| node.weight_bytes());
    }

    /// The nodes in order.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// In which layout the model takes its input; here its channels are always first.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// The form of the input.
    #[must_use]
    pub fn input(&self) -> &Form {
        &self.forms[0]
    }

    /// The form of a value.
    #[must_use]
    pub fn form(&self, value: usize) -> &Form {
        &self.forms[value]
    }

    /// The values that are outputs of the network.
    #[must_use]
    pub fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    /// What the model calls its outputs, in the same order.
    #[must_use]
    pub fn output_names(&self) -> &[String] {
        &self.output_names
    }

    /// The weights that hold infinite values or such that are no numbers, by their names in the model, with how many.
    #[must_use]
    pub fn not_finite(&self) -> &[(String, usize)] {
        &self.not_finite
    }

    /// Multiplications and additions of a node for a whole frame.
    #[must_use]
    pub fn macs(&self, node: usize) -> u64 {
        let (node, form) = (&self.nodes[node], &self.forms[node + 1]);
        let of_each = match node.products() {
            Products::None | Products::Renamed => 0,
            Products::Transposed { inputs } | Products::Matrix { inputs } => inputs,
            Products::Convolution { rows, columns, groups } => {
                self.forms[node.inputs[0]].shape()[1] / groups * rows.kernel * columns.kernel
            }
        };
        (form.elements() * of_each) as u64
    }

    /// Multiplications and additions of all nodes for a whole frame.
    #[must_use]
    pub fn total_macs(&self) -> u64 {
        (0..self.nodes.len()).map(|node| self.macs(node)).sum()
    }

    /// Bytes of the weights of all nodes.
    #[must_use]
    pub fn weight_bytes(&self) -> u64 {
        self.weight_bytes
    }

    /// Positions that are computed for a whole output of a node: whole blocks, so that there may be more than it has.
    #[must_use]
    pub fn scheduled(&self, node: usize) -> usize {
        self.nodes[node].scheduled
    }

    /// Bytes of all tensors of a frame, which are kept from frame to frame.
    #[must_use]
    pub fn kept_bytes(&self) -> u64 {
        self.forms.iter().map(Form::bytes).sum()
    }
}

/// Refuses a tensor that is too large.
fn limit(form: &Form) -> Result<(), String> {
    if form.shape().len() > MAX_AXES {
        return Err(format!("a tensor has {} axes, more than {MAX_AXES}", form.shape().len()));
    }
    match elements_of(form.shape()) {
        Some(1..=MAX_ELEMENTS) => Ok(()),
        Some(0) => Err(format!("a tensor is empty: {}", form.describe())),
        _ => Err(format!("a tensor has more than {MAX_ELEMENTS} values: {}", form.describe())),
    }
}
