// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables on Eyeriss in `docs/accelerators.md`, in Markdown.

use super::networks::{PublishedNetwork, alexnet, vgg16};
use foveate_network::accelerator::{Accelerator, Dataflow, LayerCost, MappingObjective};
use std::fmt::Write;

type TableError = Box<dyn std::error::Error>;

/// A figure of a whole network: its name, its digits after the point, the measured value and the
/// values of the model.
struct NetworkFigure {
    name: &'static str,
    digits: usize,
    chip: f64,
    model: [f64; 2],
}

/// Returns the table of each figure of the chip, and of the model with either objective of a
/// mapping.
pub(crate) fn totals_table() -> Result<String, TableError> {
    let mut table =
        "| network | figure | chip | least DRAM | ratio | least energy x delay | ratio |\n\
                     | --- | --- | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    for network in [alexnet()?, vgg16()?] {
        for figure in network_figures(&network)? {
            let NetworkFigure { name, digits, chip, model: [dram, delay] } = figure;
            let (first, second) = (dram / chip, delay / chip);
            writeln!(
                table,
                "| {} | {name} | {chip} | {dram:.digits$} | {first:.2} | {delay:.digits$} | {second:.2} |",
                network.name
            )?;
        }
    }
    Ok(table)
}

/// Returns the table of each layer of the model with the mapping of the preset.
pub(crate) fn layers_table() -> Result<String, TableError> {
    let accelerator = Accelerator::from_preset("eyeriss")?;
    let mut table = "| layer | ms per image | utilization | DRAM accesses per MAC |\n| --- | ---: | ---: | ---: |\n".to_owned();
    for network in [alexnet()?, vgg16()?] {
        for ((name, _), cost) in network.layers.iter().zip(costs(&accelerator, &network)?) {
            let milliseconds = 1e3 / images_per_second(&accelerator, &network, &cost);
            let (share, accesses) = (cost.utilization(&accelerator), accesses_per_mac(&cost));
            let network = network.name;
            writeln!(
                table,
                "| {network} {name} | {milliseconds:.2} | {share:.2} | {accesses:.4} |"
            )?;
        }
    }
    Ok(table)
}

fn network_figures(network: &PublishedNetwork) -> Result<[NetworkFigure; 3], TableError> {
    let mut models = Vec::new();
    for mapping in [MappingObjective::LeastDram, MappingObjective::LeastEnergyDelay] {
        let accelerator = with_mapping(mapping)?;
        let cost: LayerCost = costs(&accelerator, network)?.into_iter().sum();
        let milliwatts = 1e-9 * cost.energy.chip() / accelerator.seconds(cost.cycles);
        models.push([
            images_per_second(&accelerator, network, &cost),
            accesses_per_mac(&cost),
            milliwatts,
        ]);
    }
    let model = |figure: usize| [models[0][figure], models[1][figure]];
    Ok([
        NetworkFigure {
            name: "frames/s",
            digits: 2,
            chip: network.frames_per_second,
            model: model(0),
        },
        NetworkFigure {
            name: "DRAM accesses per MAC",
            digits: 4,
            chip: network.accesses_per_mac,
            model: model(1),
        },
        NetworkFigure {
            name: "power of the chip, mW",
            digits: 0,
            chip: network.milliwatts,
            model: model(2),
        },
    ])
}

fn with_mapping(mapping: MappingObjective) -> Result<Accelerator, TableError> {
    let mut accelerator = Accelerator::from_preset("eyeriss")?;
    let Dataflow::RowStationary(array) = &mut accelerator.array else {
        return Err("the preset `eyeriss` is not row-stationary".into());
    };
    array.mapping = mapping;
    Ok(accelerator)
}

fn costs(
    accelerator: &Accelerator,
    network: &PublishedNetwork,
) -> Result<Vec<LayerCost>, TableError> {
    let layers = network.layers.iter();
    layers.map(|(_, layer)| Ok(accelerator.plan(layer.clone())?.whole_cost())).collect()
}

#[allow(clippy::cast_precision_loss, reason = "a mean")]
fn images_per_second(
    accelerator: &Accelerator,
    network: &PublishedNetwork,
    cost: &LayerCost,
) -> f64 {
    network.images as f64 / accelerator.seconds(cost.cycles)
}

#[allow(clippy::cast_precision_loss, reason = "a mean")]
fn accesses_per_mac(cost: &LayerCost) -> f64 {
    cost.dram.access_count() as f64 / cost.macs as f64
}
