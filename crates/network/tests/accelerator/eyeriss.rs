// SPDX-License-Identifier: MIT OR Apache-2.0
//! The documentation shows the results of the model for the chip, and their magnitude is right.

#[path = "../../examples/eyeriss/networks.rs"]
mod networks;
#[path = "../../examples/eyeriss/table.rs"]
mod table;

use foveate_network::accelerator::Layer;

#[test]
fn the_documentation_shows_the_table() {
    let page = include_str!("../../../../docs/accelerators.md");
    let table = table::totals_table().unwrap();
    assert!(page.contains(&table), "docs/accelerators.md should hold this table:\n{table}");
}

#[test]
fn every_figure_has_the_magnitude_of_the_measurement() {
    let table = table::totals_table().unwrap();
    for row in table.lines().skip(2) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        for ratio in [cells[5], cells[7]] {
            let ratio: f64 = ratio.parse().unwrap();
            assert!((1.0 / 3.5..3.5).contains(&ratio), "{row}");
        }
    }
}

/// The sizes are those of Eyeriss, ISSCC 2016: 666 million MACs and 2.3 million weights in AlexNet,
/// 15.3 billion and 14.7 million in VGG-16.
#[test]
fn the_networks_have_the_published_sizes() {
    for (network, macs, weights) in [
        (networks::alexnet().unwrap(), 0.666e9, 2.3e6),
        (networks::vgg16().unwrap(), 15.3e9, 14.7e6),
    ] {
        let sum =
            |size: fn(&Layer) -> u64| -> u64 { network.layers.iter().map(|(_, l)| size(l)).sum() };
        let assert_near = |found: u64, published: f64| {
            #[allow(clippy::cast_precision_loss, reason = "a ratio")]
            let ratio = found as f64 / published;
            assert!((0.98..1.02).contains(&ratio), "{}: {found} and {published}", network.name);
        };
        assert_near(sum(Layer::macs) / network.images, macs);
        assert_near(sum(Layer::weights), weights);
    }
    assert_eq!(table::layers_table().unwrap().lines().count(), 2 + 5 + 13);
}
