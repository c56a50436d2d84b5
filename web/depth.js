// SPDX-License-Identifier: MIT OR Apache-2.0
// A configuration at another depth: thresholds in grey levels go with it, by the rule of crates/camera/src/depth.rs, so that the
// page does what `--set frame.pixel_bits=5` does. A test compares the two.

/** The exponent of a grey level in each unit of a score. */
const POWERS = new Map([["pixels of a region", 0], ["grey levels", 1], ["squared grey levels", 2]]);

/** Returns the configuration with `bits` per pixel; `features` are those of `engine.describe()`. */
export function withDepth(config, bits, features) {
  const scaled = structuredClone(config), oldBits = config.frame.pixel_bits;
  const level = value => Math.floor(value * 2 ** (bits - oldBits));
  const score = (value, power) => power ? Math.ceil(value * 1e9 * 2 ** (power * (bits - oldBits))) / 1e9 : value;
  scaled.frame.pixel_bits = bits;
  const { keen = {}, off_level } = scaled.zones ?? {};
  if (typeof off_level === "number") scaled.zones.off_level = level(off_level);
  const keenParts = [...keen.spatial ?? [], keen.temporal ?? {}, keen.periphery ?? {}];
  for (const part of [...scaled.spatial, scaled.temporal, scaled.periphery ?? {}, ...keenParts]) {
    if (typeof part.level === "number") part.level = level(part.level);
    const unit = features.find(({ feature }) => feature === part.feature)?.unit;
    if (unit && typeof part.min_score === "number") part.min_score = score(part.min_score, POWERS.get(unit));
  }
  return scaled;
}
