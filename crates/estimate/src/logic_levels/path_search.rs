// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the longest path of a graph, net by net in the order in which signals arrive.

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
    let arrives = |net: u32| arrivals[net as usize];
    let mut latest = None;
    for end in &graph.ends {
        let longer = |arrival: &SignalArrival| {
            latest.is_none_or(|(weight, _)| length(arrival.weight) > length(weight))
        };
        if let Some(arrival) = arrives(end.net).filter(longer) {
            latest = Some((arrival.weight, end));
        }
    }
    let Some((weight, end)) = latest else { return Ok((LogicPath::default(), 0)) };
    let (mut through, mut net) = (Vec::new(), end.net);
    while let Some(by) = arrives(net).and_then(|arrival| arrival.arc) {
        through.extend(graph.arcs[by].cell.map(str::to_owned));
        net = graph.arcs[by].from;
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
    let mut waiting = vec![0_u32; graph.net_count()];
    graph.arcs.iter().for_each(|arc| waiting[arc.to as usize] += 1);
    let nets = 0..u32::try_from(graph.net_count()).expect("the graph numbers its nets in 32 bits");
    let mut ready: Vec<u32> = nets.clone().filter(|&net| waiting[net as usize] == 0).collect();
    while let Some(net) = ready.pop() {
        for by in leaving(net) {
            let arc = &graph.arcs[by];
            if let Some(SignalArrival { weight, .. }) = arrivals[net as usize] {
                let arrival = SignalArrival { weight: weight.plus(arc.weight), arc: Some(by) };
                keep_later(&mut arrivals[arc.to as usize], arrival, length);
            }
            waiting[arc.to as usize] -= 1;
            if waiting[arc.to as usize] == 0 {
                ready.push(arc.to);
            }
        }
    }
    match nets.into_iter().find(|&net| waiting[net as usize] > 0) {
        None => Ok(arrivals),
        Some(net) => {
            Err(EstimateError::CombinationalLoop { nets: combinational_loop(graph, &waiting, net) })
        }
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

/// Returns the nets of a loop upstream of a waiting net. Every waiting net has a waiting
/// predecessor, so a search backwards must come around.
fn combinational_loop(graph: &NetGraph<'_>, waiting: &[u32], mut net: u32) -> String {
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
