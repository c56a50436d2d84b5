// SPDX-License-Identifier: MIT OR Apache-2.0
//! The longest path of a graph, net by net in the order in which signals arrive.

use super::graph::Graph;
use super::path::{LogicPath, Weight};
use crate::error::EstimateError;

/// How a signal arrives at a net at the latest.
#[derive(Clone, Copy)]
struct Arrival {
    weight: Weight,
    /// The arc by which it comes; it starts here if there is none.
    by: Option<usize>,
}

/// What tells which of two paths is longer.
pub(super) type Length = fn(Weight) -> (u32, u32);

/// The longest path and its time; of several the first in the order of the netlist. A module without any
/// path has one of no levels without ends.
///
/// # Errors
/// When logic runs in a circle.
pub(super) fn longest(
    graph: &Graph<'_>,
    length: Length,
) -> Result<(LogicPath, u32), EstimateError> {
    let arrivals = arrivals(graph, length)?;
    let arrives = |net: u32| arrivals[net as usize];
    let mut latest = None;
    for end in &graph.ends {
        let longer = |arrival: &Arrival| {
            latest.is_none_or(|(weight, _)| length(arrival.weight) > length(weight))
        };
        if let Some(arrival) = arrives(end.net).filter(longer) {
            latest = Some((arrival.weight, end));
        }
    }
    let Some((weight, end)) = latest else { return Ok((LogicPath::default(), 0)) };
    let (mut through, mut net) = (Vec::new(), end.net);
    while let Some(by) = arrives(net).and_then(|arrival| arrival.by) {
        through.extend(graph.arcs[by].cell.map(str::to_owned));
        net = graph.arcs[by].from;
    }
    through.reverse();
    let to = graph.name(end.named);
    let path = LogicPath {
        levels: weight.levels,
        carry4: weight.carry4,
        from: graph.name(net),
        to: match &end.pin {
            Some((cell, pin)) => format!("{to} ({cell}.{pin})"),
            None => to,
        },
        through,
    };
    Ok((path, weight.ps))
}

fn arrivals(graph: &Graph<'_>, length: Length) -> Result<Vec<Option<Arrival>>, EstimateError> {
    let mut arrivals = vec![None; graph.net_count()];
    for start in &graph.starts {
        let arrival = Arrival { weight: start.weight, by: None };
        delay(&mut arrivals[start.net as usize], arrival, length);
    }
    // Arcs by the net that they leave, as ranges of a list.
    let mut order: Vec<usize> = (0..graph.arcs.len()).collect();
    order.sort_by_key(|&arc| graph.arcs[arc].from);
    let leaving = |net: u32| {
        let from = |arc: &usize| graph.arcs[*arc].from;
        let first = order.partition_point(|arc| from(arc) < net);
        let last = order.partition_point(|arc| from(arc) <= net);
        order[first..last].iter().copied()
    };
    let mut waiting = vec![0_u32; graph.net_count()];
    graph.arcs.iter().for_each(|arc| waiting[arc.to as usize] += 1);
    let nets = 0..u32::try_from(graph.net_count()).expect("the graph numbers its nets in 32 bits");
    let mut ready: Vec<u32> = nets.clone().filter(|&net| waiting[net as usize] == 0).collect();
    while let Some(net) = ready.pop() {
        for by in leaving(net) {
            let arc = &graph.arcs[by];
            if let Some(Arrival { weight, .. }) = arrivals[net as usize] {
                let arrival = Arrival { weight: weight.plus(arc.weight), by: Some(by) };
                delay(&mut arrivals[arc.to as usize], arrival, length);
            }
            waiting[arc.to as usize] -= 1;
            if waiting[arc.to as usize] == 0 {
                ready.push(arc.to);
            }
        }
    }
    match nets.into_iter().find(|&net| waiting[net as usize] > 0) {
        None => Ok(arrivals),
        Some(net) => Err(EstimateError::Loop { nets: circle(graph, &waiting, net) }),
    }
}

/// Of arrivals with equal weight, one by an arc says more than one that starts here.
fn delay(slot: &mut Option<Arrival>, arrival: Arrival, length: Length) {
    let order = |arrival: Arrival| (length(arrival.weight), arrival.by.is_some());
    if slot.is_none_or(|earlier| order(arrival) > order(earlier)) {
        *slot = Some(arrival);
    }
}

/// The nets of a circle that is upstream of a net that waits: every net that waits has one before it
/// that does, so that going back must come around.
fn circle(graph: &Graph<'_>, waiting: &[u32], mut net: u32) -> String {
    let mut seen = Vec::new();
    while !seen.contains(&net) {
        seen.push(net);
        let before = graph.arcs.iter().find(|arc| arc.to == net && waiting[arc.from as usize] > 0);
        net = before.expect("a net that waits has one before it that does").from;
    }
    let around = seen.iter().skip_while(|&&other| other != net);
    let mut names: Vec<String> = around.map(|&net| format!("`{}`", graph.name(net))).collect();
    names.reverse();
    names.join(", ")
}
