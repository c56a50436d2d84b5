// SPDX-License-Identifier: MIT OR Apache-2.0
// All settings as the fragment of a link: `#source=scene:street&size=640x480&preset=fovea&region.size=16`. Keys are those of the
// configuration, with what differs from the preset; values are TOML. Features differ as a whole, because they are numbered.

import { keysOf, valueOf, withKey } from "./toml.js";

const OWN = ["source", "size", "preset"];
/** Settings of the network, as of `foveate infer`; its file stays on the computer where it was opened. */
const NETWORK = ["framing", "mean", "scale", "detect"];
const isFeature = key => key.startsWith("spatial.");

/** The fragment, without `#`. `preset` is that preset's configuration. */
export function writeLink(own, preset, config, network) {
  const before = keysOf(preset), now = keysOf(config);
  const differs = key => before.get(key) !== now.get(key);
  const features = [...before.keys(), ...now.keys()].some(key => isFeature(key) && differs(key));
  const changed = [...now].filter(([key]) => isFeature(key) ? features : differs(key));
  const wished = Object.entries(network).filter(([, value]) => value !== null).map(([key, value]) => [`network.${key}`, value]);
  const pairs = [...OWN.filter(key => own[key]).map(key => [key, own[key]]), ...wished, ...changed.map(([key, value]) => [key, JSON.stringify(value)])];
  return pairs.map(([key, value]) => `${key}=${encodeURIComponent(value).replace(/%3A/gi, ":")}`).join("&");
}

/** What a fragment says: `own`, what is wished of a `network`, and a function from the configuration of the preset to that of the link. */
export function readLink(fragment) {
  const own = {}, network = {}, changed = [];
  for (const pair of fragment.replace(/^#/, "").split("&").filter(Boolean)) {
    const [key, ...rest] = pair.split("=");
    const value = decodeURIComponent(rest.join("="));
    const [, of] = key.match(/^network\.(.+)$/) ?? [];
    if (OWN.includes(key)) own[key] = value;
    else if (NETWORK.includes(of)) network[of] = value;
    else if (/^[a-z_]+(\.\d+)?\.[a-z_]+$/.test(key)) changed.push([key, valueOf(value)]);
    else throw new Error(`the link's \`${key}\` is not a setting; settings are source, size, preset and keys of the configuration`);
  }
  const apply = preset => {
    const start = changed.some(([key]) => isFeature(key)) ? { ...preset, spatial: [] } : preset;
    return changed.reduce((config, [key, value]) => withKey(config, key, value), start);
  };
  return { own, network, apply };
}
