// SPDX-License-Identifier: MIT OR Apache-2.0
// The organization of the hardware. It must support every feature of the camera, although the page computes the same without it.

/** The keys of the hardware that every organization has. */
const COMMON_KEYS = ["sync", "thresholds"];

/** Returns the organizations that support all features of a configuration; `features` are those of `engine.describe()`. */
export function organizationsOf({ spatial }, features) {
  const listOf = name => features.find(({ feature }) => feature === name)?.organizations ?? [];
  const [first, ...others] = spatial.map(({ feature }) => listOf(feature));
  return (first ?? []).filter(name => others.every(list => list.includes(name)));
}

/** Returns the configuration in an organization that supports its features: in its own, in that of the `wanted` hardware, or in the
 *  first that does. The keys that only the replaced one has are gone. */
export function withOrganization(config, features, wanted) {
  const possible = organizationsOf(config, features);
  const isPossible = ({ organization }) => possible.includes(organization);
  if (wanted && isPossible(wanted)) return { ...config, hardware: wanted };
  if (!possible.length || isPossible(config.hardware)) return config;
  const common = Object.fromEntries(Object.entries(config.hardware).filter(([key]) => COMMON_KEYS.includes(key)));
  return { ...config, hardware: { organization: possible[0], ...common } };
}
