// SPDX-License-Identifier: MIT OR Apache-2.0
// The keys of means of a configuration, after other keys have changed, by the rule of crates/camera/src/toml_text.rs, so that the page does
// what `--set 'render.irrelevant="hold"'` does on a preset with means.

/** Returns a configuration without what it says of means where that does not fit: all of it in a camera without means, and a number of means that
 *  does not divide the side of a region, in place of which the engine chooses another. Keys that were just set (`keys`) stay, and are an error. */
export function withFittingMeans(config, keys) {
  const { periphery, ...others } = withoutLevelsOfMeans(config, keys), { render, region } = config;
  const isNamed = name => keys.includes(`periphery.${name}`);
  if (!periphery) return others;
  if (render?.irrelevant !== "mean") {
    const named = Object.entries(periphery).filter(([name]) => isNamed(name));
    return named.length ? { ...others, periphery: Object.fromEntries(named) } : others;
  }
  const fits = isNamed("blocks") || region?.size % periphery.blocks === 0;
  return { ...others, periphery: fits ? periphery : { ...periphery, blocks: undefined } };
}

/** Returns a configuration without the levels that zones have for means, in a camera without means. */
function withoutLevelsOfMeans(config, keys) {
  const { render, zones } = config;
  if (!zones || render?.irrelevant === "mean" || keys.some(key => /^zones\.(off_level|keen\.periphery)/.test(key))) return config;
  const { off_level, keen, ...rest } = zones, { periphery, ...others } = keen ?? {};
  return { ...config, zones: { ...rest, keen: others } };
}
