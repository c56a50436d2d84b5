// SPDX-License-Identifier: MIT OR Apache-2.0
//! PSNR and SSIM from their definitions, pixel by pixel.

use foveate_camera::Camera;
use foveate_measure::FidelityFigures;

use crate::naive::MadeUpFrame;
use crate::results::greys;

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.iter().map(|_| 1.0).sum::<f64>()
}

/// Returns the SSIM of one window from its pixels, by mean, variance and covariance.
fn window_ssim(a: &[f64], b: &[f64], peak: f64) -> f64 {
    let n: f64 = a.iter().map(|_| 1.0).sum();
    let (ma, mb) = (mean(a), mean(b));
    let products = |x: &[f64], mx: f64, y: &[f64], my: f64| {
        mean(&x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).collect::<Vec<_>>())
    };
    let variances = products(a, ma, a, ma) + products(b, mb, b, mb);
    let covariance = products(a, ma, b, mb);
    let c1 = (0.0001 * peak * peak * n + 0.5).floor() / (n * n);
    let c2 = (0.0009 * peak * peak * n * (n - 1.0).max(1.0) + 0.5).floor() / (n * n);
    let all = (ma * ma + mb * mb + c1) * (variances + c2);
    if all == 0.0 { 1.0 } else { (2.0 * ma * mb + c1) * (2.0 * covariance + c2) / all }
}

fn ssim(a: &[f64], b: &[f64], camera: &Camera) -> f64 {
    let (width, height) = (camera.width() as usize, camera.height() as usize);
    let peak = f64::from(camera.pixel_max());
    if width < 8 || height < 8 {
        return window_ssim(a, b, peak);
    }
    let mut windows = Vec::new();
    for top in (0..=height - 8).step_by(4) {
        for left in (0..=width - 8).step_by(4) {
            let window = |plane: &[f64]| -> Vec<f64> {
                (0..64).map(|at| plane[(top + at / 8) * width + left + at % 8]).collect()
            };
            windows.push(window_ssim(&window(a), &window(b), peak));
        }
    }
    mean(&windows)
}

/// Checks the PSNR and SSIM of both comparisons; `shown` are the screens at the depth of the ideal.
pub(crate) fn check_pictures(
    figures: &FidelityFigures,
    frames: &[MadeUpFrame],
    shown: &[Vec<u16>],
    ideal_camera: &Camera,
) {
    let rendered = |frame: &MadeUpFrame| frame.ideal.rendered.clone();
    let input = |frame: &MadeUpFrame| greys(&frame.input);
    let rendered: Vec<_> = frames.iter().map(rendered).collect();
    let input: Vec<_> = frames.iter().map(input).collect();
    check(figures.psnr_ideal, figures.ssim_ideal, (&rendered, shown), ideal_camera);
    check(figures.psnr_input, figures.ssim_input, (&input, shown), ideal_camera);
}

fn check(
    psnr: Option<f64>,
    found: f64,
    (other, shown): (&[Vec<f64>], &[Vec<u16>]),
    ideal_camera: &Camera,
) {
    let peak = f64::from(ideal_camera.pixel_max());
    let (mut squares, mut ssim_values) = (Vec::new(), Vec::new());
    for (other, shown) in other.iter().zip(shown) {
        let shown = greys(shown);
        ssim_values.push(ssim(&shown, other, ideal_camera));
        squares.extend(shown.iter().zip(other).map(|(a, b)| (a - b) * (a - b)));
    }
    let mse = mean(&squares);
    let expected = (mse > 0.0).then(|| 10.0 * (peak * peak / mse).log10());
    assert_eq!(psnr.is_some(), expected.is_some());
    assert!((psnr.unwrap_or(0.0) - expected.unwrap_or(0.0)).abs() < 1e-9);
    assert!((found - mean(&ssim_values)).abs() < 1e-9, "{found} {}", mean(&ssim_values));
}
