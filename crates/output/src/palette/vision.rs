// SPDX-License-Identifier: MIT OR Apache-2.0
//! Simulates how colours appear without one kind of cone.

use super::Colour;

/// A colour vision as a matrix on linear RGB.
pub type VisionMatrix = [[f64; 3]; 3];

/// The matrices of protanopia, deuteranopia and tritanopia (Machado et al. 2009).
pub const VISIONS: [VisionMatrix; 3] = [
    [
        [0.152_286, 1.052_583, -0.204_868],
        [0.114_503, 0.786_281, 0.099_216],
        [-0.003_882, -0.048_116, 1.051_998],
    ],
    [
        [0.367_322, 0.860_646, -0.227_968],
        [0.280_085, 0.672_501, 0.047_413],
        [-0.011_820, 0.042_940, 0.968_881],
    ],
    [
        [1.255_528, -0.076_749, -0.178_779],
        [-0.078_411, 0.930_809, 0.147_602],
        [0.004_733, 0.691_367, 0.303_900],
    ],
];

/// Returns how a colour appears, with values from 0 to 255.
#[must_use]
pub fn simulated_colour(colour: Colour, vision: VisionMatrix) -> [f64; 3] {
    let linear = colour.map(|value| (f64::from(value) / 255.0).powf(2.2));
    vision.map(|row| {
        let sum: f64 = row.iter().zip(linear).map(|(factor, value)| factor * value).sum();
        255.0 * sum.clamp(0.0, 1.0).powf(1.0 / 2.2)
    })
}

/// Returns the distance of two colours as they appear, in RGB; that of black and white is 442.
#[must_use]
pub fn distance(first: Colour, second: Colour, vision: VisionMatrix) -> f64 {
    let pairs = simulated_colour(first, vision).into_iter().zip(simulated_colour(second, vision));
    pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn red_and_green_are_alike_only_for_some() {
        let [red, green] = [[200, 80, 0], [120, 110, 0]];
        let [_, without_green, without_blue] = VISIONS;
        assert!(distance(red, green, without_green) < 40.0);
        assert!(distance(red, green, without_blue) > 80.0);
    }
}
