// SPDX-License-Identifier: MIT OR Apache-2.0
// All settings as the fragment of a link: `#source=scene:street&size=640x480&preset=fovea&region.size=16`. Keys are those of the
// configuration, with what differs from the preset; values are TOML. Features differ as a whole, because they are numbered.

import { keysOf, valueOf, withKey } from "./toml.js";

const OWN = ["source", "size", "preset"];
/** Settings of the network, as in `foveate infer`; its file stays on the computer where it was opened. */
const NETWORK = ["framing", "mean", "scale", "detect"];
/** The largest number of characters of a fragment. */
const LONGEST = 8192;
const isFeature = key => key.startsWith("spatial.");

/** Returns the fragment without `#`. `preset` is the configuration of that preset. */
export function writeLink(own, preset, config, network) {
  const before = keysOf(preset), now = keysOf(config);
  const differs = key => before.get(key) !== now.get(key);
  const features = [...before.keys(), ...now.keys()].some(key => isFeature(key) && differs(key));
  const changed = [...now].filter(([key]) => isFeature(key) ? features : differs(key));
  const wished = Object.entries(network).filter(([, value]) => value !== null).map(([key, value]) => [`network.${key}`, value]);
  const pairs = [...OWN.filter(key => own[key]).map(key => [key, own[key]]), ...wished, ...changed.map(([key, value]) => [key, JSON.stringify(value)])];
  return pairs.map(([key, value]) => `${key}=${encodeURIComponent(value).replace(/%3A/gi, ":")}`).join("&");
}

/** Returns the content of a fragment: `own`, the settings of a `network`, and a function from the preset's configuration to the link's. */
export function readLink(fragment) {
  const own = {}, network = {}, changed = [], keys = new Set();
  if (fragment.length > LONGEST) throw new Error(`the link's settings have ${fragment.length} characters; at most ${LONGEST} are read`);
  for (const pair of fragment.replace(/^#/, "").split("&").filter(Boolean)) {
    const [key, ...rest] = pair.split("=");
    if (keys.has(key)) throw new Error(`the link sets \`${key}\` twice; give it once`);
    keys.add(key);
    const value = decoded(key, rest.join("="));
    const [, of] = key.match(/^network\.(.+)$/) ?? [];
    if (OWN.includes(key)) own[key] = value;
    else if (NETWORK.includes(of)) network[of] = value;
    else if (of === undefined && /^[a-z_]+(\.\d+)?\.[a-z_]+$/.test(key)) changed.push([key, valueOf(value)]);
    else throw new Error(`the link's \`${key}\` is not a setting; settings are source, size, preset, those of the network and keys of the configuration`);
  }
  const apply = preset => {
    const start = changed.some(([key]) => isFeature(key)) ? { ...preset, spatial: [] } : preset;
    return changed.reduce((config, [key, value]) => keyed(config, key, value), start);
  };
  return { own, network, apply };
}

function decoded(key, text) {
  try {
    return decodeURIComponent(text);
  } catch {
    throw new Error(`the link's \`${key}\` has a % that begins no character; a % itself is written %25`);
  }
}

function keyed(config, key, value) {
  try {
    return withKey(config, key, value);
  } catch (error) {
    throw new Error(`\`${key}\`: ${error.message}`);
  }
}

/** The link to hand on of a page at `location` with that fragment. A page that this computer serves has a secret address, which is of no use
 *  elsewhere: the fragment alone is handed on. */
export function linkToHandOn({ protocol, hostname, href }, fragment) {
  const isHere = /^https?:$/.test(protocol) && /^(.+\.)?localhost$|^127\.|^\[::1\]$/.test(hostname);
  return isHere ? fragment : href.replace(/#.*$/, "") + fragment;
}
