// SPDX-License-Identifier: MIT OR Apache-2.0
// All settings as the fragment of a link: `#source=scene:street&size=640x480&preset=fovea&region.size=16`. Keys are those of the
// configuration, with what differs from the preset; values are TOML. Features differ as a whole, because they are numbered, and so does
// the hardware with another organization, because each organization has keys of its own.

import { withFittingMeans } from "./means.js";
import { keysOf, valueOf, withKey } from "./toml.js";
import { mapOf, mapOfText, textOfMap } from "./zones.js";

const PAGE_KEYS = ["source", "size", "preset"];
/** Settings of the network, as in `foveate infer`; its file stays on the computer where it was opened. */
const NETWORK = ["framing", "mean", "scale", "detect"];
/** The largest number of characters of a fragment. */
const MAX_CHARACTERS = 8192;
const isFeature = key => key.startsWith("spatial.");
const isHardware = key => key.startsWith("hardware.");
const ORGANIZATION_KEY = "hardware.organization";
/** The map of zones, which is one text in place of a key for each row. */
const MAP_KEY = "zones.classes";

/** The largest number of characters of a map in a link, which leaves room for the other settings. */
const MAX_MAP = 6000;

/** Returns whether the map of a configuration is too long for a link, because neighboring regions have different classes. */
export const isMapTooFine = config => textOfMap(mapOf(config)).length > MAX_MAP;

/** Returns a configuration with the map of its zones as a text, which is empty if it is too long for a link. */
function withMapText(config) {
  if (!config.zones) return config;
  return { ...config, zones: { ...config.zones, classes: isMapTooFine(config) ? "" : textOfMap(mapOf(config)) } };
}

/** Returns the fragment without `#`. `preset` is the configuration of that preset. */
export function writeLink(pageSettings, preset, config, network) {
  const presetValues = keysOf(preset), values = keysOf(withMapText(config));
  const differs = key => presetValues.get(key) !== values.get(key);
  const features = [...presetValues.keys(), ...values.keys()].some(key => isFeature(key) && differs(key));
  const hardware = differs(ORGANIZATION_KEY);
  const changed = [...values].filter(([key]) => isFeature(key) ? features : hardware && isHardware(key) || differs(key));
  const networkPairs = Object.entries(network).filter(([, value]) => value !== null).map(([key, value]) => [`network.${key}`, value]);
  const pairs = [...PAGE_KEYS.filter(key => pageSettings[key]).map(key => [key, pageSettings[key]]), ...networkPairs, ...changed.map(([key, value]) => [key, JSON.stringify(value)])];
  return pairs.map(([key, value]) => `${key}=${encodeURIComponent(value).replace(/%3A/gi, ":")}`).join("&");
}

/** Returns the content of a fragment: the settings of the page, the settings of a `network`, and a function from the preset's configuration to the link's. */
export function readLink(fragment) {
  const pageSettings = {}, network = {}, changed = [], keys = new Set();
  if (fragment.length > MAX_CHARACTERS) throw new Error(`the link's settings have ${fragment.length} characters; at most ${MAX_CHARACTERS} are read`);
  for (const pair of fragment.replace(/^#/, "").split("&").filter(Boolean)) {
    const [key, ...rest] = pair.split("=");
    if (keys.has(key)) throw new Error(`the link sets \`${key}\` twice; give it once`);
    keys.add(key);
    const value = decodeValue(key, rest.join("="));
    const [, networkKey] = key.match(/^network\.(.+)$/) ?? [];
    if (PAGE_KEYS.includes(key)) pageSettings[key] = value;
    else if (NETWORK.includes(networkKey)) network[networkKey] = value;
    else if (networkKey === undefined && /^[a-z_]+((\.\d+)?\.[a-z_]+)+$/.test(key)) changed.push([key, valueOf(value)]);
    else throw new Error(`the link's \`${key}\` is not a setting; settings are source, size, preset, those of the network and keys of the configuration`);
  }
  const apply = preset => {
    const start = { ...preset };
    if (changed.some(([key]) => isFeature(key))) start.spatial = [];
    if (changed.some(([key]) => key === ORGANIZATION_KEY)) start.hardware = {};
    return withFittingMeans(changed.reduce((config, [key, value]) => setKey(config, key, value), start), changed.map(([key]) => key));
  };
  return { pageSettings, network, apply };
}

function decodeValue(key, text) {
  try {
    return decodeURIComponent(text);
  } catch {
    throw new Error(`the link's \`${key}\` has a % that begins no character; a % itself is written %25`);
  }
}

function setKey(config, key, value) {
  try {
    return withKey(config, key, key === MAP_KEY ? mapOfText(String(value)) : value);
  } catch (error) {
    throw new Error(`\`${key}\`: ${error.message}`);
  }
}

/** Returns the link to share of a page at `location` with that fragment. A page that this computer serves has a secret address, which is of
 *  no use elsewhere, so only the fragment is shared. */
export function linkToShare({ protocol, hostname, href }, fragment) {
  const isHere = /^https?:$/.test(protocol) && /^(.+\.)?localhost$|^127\.|^\[::1\]$/.test(hostname);
  return isHere ? fragment : href.replace(/#.*$/, "") + fragment;
}
