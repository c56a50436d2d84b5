// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the longest path of a graph. A net is visited after all nets from which arcs lead to it,
//! so that its latest arrival is known.

use super::graph::NetGraph;
use super::path::{LogicPath, PathWeight};
use crate::error::EstimateError;

/// The latest arrival of a signal at a net.
#[derive(Clone, Copy)]
struct SignalArrival {
    weight: PathWeight,
    /// The arc that the signal comes through; `None` if it starts at this net.
    arc: Option<usize>,
}

/// A function that returns the length of a path for comparisons.
pub(super) type PathLength = fn(PathWeight) -> (u32, u32);

/// Returns the longest path and its time in picoseconds; of several paths, the first in the order
/// of the netlist. A module without any path has a path without levels and ends.
///
/// # Errors
/// Fails if there is a combinational loop.
pub(super) fn longest_path(
    graph: &NetGraph<'_>,
    length: PathLength,
) -> Result<(LogicPath, u32), EstimateError> {
    let arrivals = arrivals(graph, length)?;
    let arrival_at = |net: u32| arrivals[net as usize];
    let mut latest = None;
    for end in &graph.ends {
        let is_longer = |arrival: &SignalArrival| {
            latest.is_none_or(|(weight, _)| length(arrival.weight) > length(weight))
        };
        if let Some(arrival) = arrival_at(end.net).filter(is_longer) {
            latest = Some((arrival.weight, end));
        }
    }
    let Some((weight, end)) = latest else { return Ok((LogicPath::default(), 0)) };
    let (mut through, mut net) = (Vec::new(), end.net);
    while let Some(arc) = arrival_at(net).and_then(|arrival| arrival.arc) {
        through.extend(graph.arcs[arc].cell.map(str::to_owned));
        net = graph.arcs[arc].from;
    }
    through.reverse();
    let to = graph.name(end.named_net);
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

fn arrivals(
    graph: &NetGraph<'_>,
    length: PathLength,
) -> Result<Vec<Option<SignalArrival>>, EstimateError> {
    let mut arrivals = vec![None; graph.net_count()];
    for start in &graph.starts {
        let arrival = SignalArrival { weight: start.weight, arc: None };
        keep_later(&mut arrivals[start.net as usize], arrival, length);
    }
    // The arcs that leave a net are a range of the sorted list.
    let mut order: Vec<usize> = (0..graph.arcs.len()).collect();
    order.sort_by_key(|&arc| graph.arcs[arc].from);
    let leaving = |net: u32| {
        let from = |arc: &usize| graph.arcs[*arc].from;
        let first = order.partition_point(|arc| from(arc) < net);
        let last = order.partition_point(|arc| from(arc) <= net);
        order[first..last].iter().copied()
    };
    let mut pending_arcs = vec![0_u32; graph.net_count()];
    graph.arcs.iter().for_each(|arc| pending_arcs[arc.to as usize] += 1);
    let nets = 0..u32::try_from(graph.net_count()).expect("the graph numbers its nets in 32 bits");
    let mut ready: Vec<u32> = nets.clone().filter(|&net| pending_arcs[net as usize] == 0).collect();
    while let Some(net) = ready.pop() {
        for arc_index in leaving(net) {
            let arc = &graph.arcs[arc_index];
            if let Some(SignalArrival { weight, .. }) = arrivals[net as usize] {
                let arrival =
                    SignalArrival { weight: weight.plus(arc.weight), arc: Some(arc_index) };
                keep_later(&mut arrivals[arc.to as usize], arrival, length);
            }
            pending_arcs[arc.to as usize] -= 1;
            if pending_arcs[arc.to as usize] == 0 {
                ready.push(arc.to);
            }
        }
    }
    match nets.into_iter().find(|&net| pending_arcs[net as usize] > 0) {
        None => Ok(arrivals),
        Some(net) => Err(EstimateError::CombinationalLoop {
            nets: combinational_loop(graph, &pending_arcs, net),
        }),
    }
}

/// Keeps the later of two arrivals. For equal weights, an arrival through an arc is kept, because
/// it says more than a start.
fn keep_later(slot: &mut Option<SignalArrival>, arrival: SignalArrival, length: PathLength) {
    let order = |arrival: SignalArrival| (length(arrival.weight), arrival.arc.is_some());
    if slot.is_none_or(|earlier| order(arrival) > order(earlier)) {
        *slot = Some(arrival);
    }
}

/// Returns the nets of a loop. `net` has an arc that was never visited, which comes from another
/// such net, and so on backwards, so that the search must meet a net for the second time.
fn combinational_loop(graph: &NetGraph<'_>, pending_arcs: &[u32], mut net: u32) -> String {
    let mut visited = Vec::new();
    while !visited.contains(&net) {
        visited.push(net);
        let predecessor =
            graph.arcs.iter().find(|arc| arc.to == net && pending_arcs[arc.from as usize] > 0);
        net = predecessor.expect("a net that waits has one before it that does").from;
    }
    let loop_nets = visited.iter().skip_while(|&&other| other != net);
    let mut names: Vec<String> = loop_nets.map(|&net| format!("`{}`", graph.name(net))).collect();
    names.reverse();
    names.join(", ")
}
