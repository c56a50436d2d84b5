// SPDX-License-Identifier: MIT OR Apache-2.0
// Zones: the classes of regions, which are painted on the pictures. In a configuration they are rows of digits, and in a link runs of letters.

import { make } from "./elements.js";
import { getKey, withKey } from "./toml.js";

/** The classes by number: name, letter in links, the colour on the picture with its opacity, and what the class does. */
export const CLASSES = [
  { name: "normal", letter: "n", help: "the thresholds of the camera" },
  { name: "off", letter: "o", colour: "--veil", alpha: 190, help: "never relevant: nothing is sent, or only means" },
  { name: "keen", letter: "k", colour: "--k0", alpha: 110, help: "thresholds of its own, which appear below" },
  { name: "always", letter: "a", colour: "--k1", alpha: 110, help: "relevant in every frame, so sent whenever it changes" },
];
const BRUSHES = [1, 3, 5, 9];
/** More regions than any frame of the page has. */
const MAX_REGIONS = 1 << 20;

/** Returns the rows of the map of a configuration, none if it has no map. */
export const mapOf = config => config.zones?.classes ?? [];

/** Returns the number of the class of every region of a camera, row by row. */
export function classesOf({ config, columns, rows }) {
  const text = mapOf(config).join("");
  return Uint8Array.from({ length: columns * rows }, (_, region) => Number(text[region] ?? 0));
}

/** Returns the configuration with a map, fitted to the grid of a frame of this size: each region has the class that the map has at its centre. */
export function withFittingMap(config, map, width, height) {
  const side = config.region?.size, [columns, rows] = [Math.ceil(width / side), Math.ceil(height / side)];
  if (!config.zones || !map.length || !(columns * rows >= 1 && columns * rows <= MAX_REGIONS)) return config;
  const at = (index, count, of) => Math.floor((index + 0.5) * of / count);
  const row = y => Array.from({ length: columns }, (_, x) => map[y][at(x, columns, map[y].length)]).join("");
  const classes = Array.from({ length: rows }, (_, y) => row(at(y, rows, map.length)));
  return { ...config, zones: { ...config.zones, classes } };
}

/** Returns the rows of a map as the text of a link, such as `80x60:n812o9n3979`. */
export function textOfMap(rows) {
  const runs = [...rows.join("").matchAll(/(\d)\1*/g)].map(([run, digit]) => CLASSES[digit].letter + run.length);
  return rows.length ? `${rows[0].length}x${rows.length}:${runs.join("")}` : "";
}

/** Returns the rows of the map of a link. */
export function mapOfText(text) {
  if (text === "") return [];
  const [, width, height, runs] = /^(\d{1,5})x(\d{1,5}):((?:[noka]\d{1,7})+)$/.exec(text) ?? [];
  const parts = [...(runs ?? "").matchAll(/([noka])(\d+)/g)].map(([, letter, count]) => [letter, Number(count)]);
  const total = parts.reduce((sum, [, count]) => sum + count, 0), columns = Number(width);
  if (!runs || total > MAX_REGIONS || columns < 1 || Number(height) < 1 || total !== columns * Number(height))
    throw new Error(`\`${text.slice(0, 40)}\` is not a map; write runs of n (normal), o (off), k (keen) and a (always), as in 4x2:n5o3`);
  const digits = parts.map(([letter, count]) => String(CLASSES.findIndex(own => own.letter === letter)).repeat(count)).join("");
  return digits.match(new RegExp(`.{${columns}}`, "g"));
}

/** Returns a configuration without the keen thresholds of features that it does not have. */
export function withoutOtherFeatures(config) {
  const spatial = config.zones?.keen?.spatial;
  if (!spatial) return config;
  const own = spatial.filter(({ feature }) => config.spatial.some(entry => entry.feature === feature));
  return { ...config, zones: { ...config.zones, keen: { ...config.zones.keen, spatial: own } } };
}

/** The keys of keen thresholds, with the camera's key that each replaces. On the page a feature has its name in place of its number. */
const KEEN_KEY = /^zones\.keen\.spatial\.([a-z]+)\.([a-z_]+)$/;

/** Returns the key of the camera that holds where a key of zones is left out; any other key is returned as it is. */
export function replacedKey(config, key) {
  const [, feature, name] = KEEN_KEY.exec(key) ?? [];
  if (feature) return `spatial.${config.spatial.findIndex(entry => entry.feature === feature)}.${name}`;
  return key === "zones.off_level" ? "periphery.level" : key.replace(/^zones\.keen\./, "");
}

/** Returns the value that holds for a key, which may be one of zones. */
export function heldValue(config, key) {
  const [, feature, name] = KEEN_KEY.exec(key) ?? [];
  const own = feature ? config.zones.keen?.spatial?.find(entry => entry.feature === feature)?.[name] : getKey(config, key);
  return own ?? getKey(config, replacedKey(config, key));
}

/** Returns a configuration with another value of a key, which may be one of zones. */
export function withHeldValue(config, key, value) {
  const [, feature, name] = KEEN_KEY.exec(key) ?? [];
  if (!feature) return withKey(config, key, value);
  const entries = config.zones.keen?.spatial ?? [], known = entries.findIndex(entry => entry.feature === feature);
  const path = `zones.keen.spatial.${known < 0 ? entries.length : known}`;
  return withKey(withKey(config, `${path}.feature`, feature), `${path}.${name}`, value);
}

/** The buttons that choose a class to paint, and the strokes on the pictures. */
export class ZonePainter {
  #buttons; #size; #clear; #hint; #actions; #code = null; #codes = null; #paintedColumns = 0; #facts = null;

  /** `apply(codes)` gives the camera a class per region; `end()` follows a stroke; `clear()` takes all zones away. */
  constructor(place, { apply, end, clear }) {
    this.#actions = { apply, end };
    this.#buttons = [1, 2, 3, 0].map(code => {
      const { name, help, colour } = CLASSES[code];
      const button = make("button", { title: help, ariaPressed: "false" }, ...(colour ? [make("i", { className: colour.slice(2) })] : []), name);
      button.dataset.zone = name;
      button.onclick = () => this.#choose(this.#code === code ? null : code);
      return { button, code };
    });
    this.#size = make("select", {}, ...BRUSHES.map(side => make("option", { value: side, textContent: side === 1 ? "1 region" : `${side}x${side} regions` })));
    this.#size.value = 3;
    this.#clear = make("button", { id: "clear-zones", textContent: "Clear", hidden: true });
    this.#clear.onclick = () => { this.#choose(null); clear(); };
    this.#hint = make("span", { className: "quiet", role: "status" });
    place.append("Paint zones ", make("span", { className: "group" }, ...this.#buttons.map(({ button }) => button)),
      make("label", {}, "Brush ", this.#size), this.#clear, this.#hint);
    this.#choose(null);
  }

  #choose(code) {
    this.#code = code;
    for (const own of this.#buttons) own.button.ariaPressed = String(own.code === code);
    this.#hint.textContent = code === null ? "" : `${CLASSES[code].name}: ${CLASSES[code].help}. Draw on a picture, or press Enter on a chosen region.`;
  }

  /** Shows whether a camera has zones. */
  show(facts) {
    this.#facts = facts;
    this.#clear.hidden = !facts.config.zones;
  }

  get isOn() { return this.#code !== null; }

  /** Paints regions from one to another, each { x, y }, and gives the camera the map before its next frame. */
  stroke(from, to) {
    const { columns, rows } = this.#facts, reach = Number(this.#size.value) >> 1;
    const isScheduled = this.#codes !== null;
    this.#codes ??= classesOf(this.#facts);
    this.#paintedColumns = columns;
    const steps = Math.max(Math.abs(to.x - from.x), Math.abs(to.y - from.y), 1);
    for (let step = 0; step <= steps; step++) {
      const at = (start, end) => Math.round(start + (end - start) * step / steps);
      const [x, y] = [at(from.x, to.x), at(from.y, to.y)];
      for (let row = Math.max(y - reach, 0); row <= Math.min(y + reach, rows - 1); row++)
        this.#codes.fill(this.#code, row * columns + Math.max(x - reach, 0), row * columns + Math.min(x + reach + 1, columns));
    }
    if (!isScheduled) requestAnimationFrame(() => this.#apply());
  }

  #apply() {
    const codes = this.#codes;
    this.#codes = null;
    // Another camera has replaced the painted one meanwhile.
    const { columns, rows } = this.#facts;
    if (codes?.length === columns * rows && this.#paintedColumns === columns) this.#actions.apply(codes);
  }

  /** Ends a stroke. */
  end() {
    if (this.#codes) this.#apply();
    this.#actions.end();
  }
}
