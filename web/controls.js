// SPDX-License-Identifier: MIT OR Apache-2.0
// The controls of a camera: a row for each key, with the range or the choices that the engine gives. A value that the engine
// refuses stays in its row, with the engine's message below it, and the camera stays as it was.

import { make, withoutBackticks } from "./elements.js";
import { getKey } from "./toml.js";
import { heldValue, replacedKey } from "./zones.js";

/** Keys by group, with their names on the page. Keys of features follow from the features. */
const GROUPS = [
  ["Regions", [["region.neighborhood", "Windows"], ["denoise.filter", "Filter"], ["frame.pixel_bits", "Bits per pixel"]]],
  ["Relevant", "features"],
  ["Changed", [["temporal.min_count", "Least count"], ["temporal.reference", "Reference"]]],
  ["What the receiver sees", [["render.irrelevant", "Irrelevant"], ["periphery.blocks", "Means a side"], ["periphery.level", "Level of means"],
    ["render.payload", "Payload"]]],
  ["Zones", "zones"],
];
/** The two keys beside the pictures. */
const KEY_ROWS = [["region.size", "Region size"], ["temporal.level", "Change needed"]];
/** A line of help for each key, without the name of a feature. */
const HELP = new Map(Object.entries({
  "region.size": "pixels per side of a square region, which is sent as a whole",
  "region.neighborhood": "isolated: windows end at the edge of a region; shared: they reach into its neighbours",
  "denoise.filter": "is applied before anything is decided",
  "frame.pixel_bits": "depth of a pixel; thresholds follow it",
  "temporal.level": "grey levels, above which a pixel counts as changed",
  "temporal.min_count": "changed pixels from which on a region has changed (TRS)",
  "temporal.reference": "a region is compared with the last frame, or with what the receiver has",
  "render.irrelevant": "what the receiver shows where nothing is relevant: black, the last picture, or averages",
  "periphery.blocks": "averages per side of a region that is not relevant",
  "periphery.level": "an average is sent again when it differs by more than this",
  "render.payload": "pixels are sent after the filter, or raw",
  "decision.combine": "one feature is enough for a region to be relevant (SRS), or all are needed",
  level: "a pixel counts above this",
  min_score: "from this score on, the feature finds the region relevant (SRS)",
  mean_fraction_bits: "binary places of the mean of a region",
  radius: "the largest movement that is searched for, in pixels",
}));
const OF_FEATURE = [["level", "Level"], ["min_score", "Least score"], ["mean_fraction_bits", "Mean bits"], ["radius", "Radius"]];

export class Controls {
  #place; #keyPlace; #presetPlace; #tables; #actions; #rows = new Map(); #shape = "";

  /** `change(key, value)` returns nothing, or the message of a refusal, and so does `toggle(feature, on)`. */
  constructor({ all, key, preset: presetPlace }, tables, { presets, change, toggle, preset }) {
    this.#place = all;
    this.#keyPlace = key;
    this.#presetPlace = presetPlace;
    this.#tables = tables;
    this.#actions = { change, toggle, preset };
    this.presets = presets;
  }

  /** Shows a camera of the preset `name`. */
  show(facts, name) {
    const keys = this.#groups(facts).map(([title, rows]) => [title, rows.map(([key]) => key)]);
    const shape = JSON.stringify(keys);
    if (shape !== this.#shape) this.#build(facts);
    this.#shape = shape;
    for (const row of this.#rows.values()) row.show(facts, name);
  }

  #groups(facts) {
    const rangeOf = key => facts.bounds[key] ?? this.#tables.keys.find(own => own.key === key && own.kind !== "text");
    const isShown = ([key]) => getKey(facts.config, key) !== undefined && getKey(facts.config, key) !== null && rangeOf(key);
    const special = { features: () => this.#features(facts), zones: () => this.#zones(facts) };
    return GROUPS.map(([title, rows]) => [title, typeof rows === "string" ? special[rows]() : rows.filter(isShown)]);
  }

  /** Makes a row for each threshold of keen regions, and for the levels of means. */
  #zones({ config }) {
    if (!config.zones) return [];
    const ofFeature = config.spatial.flatMap(entry => OF_FEATURE.slice(0, 2).filter(([name]) => (entry[name] ?? null) !== null)
      .map(([name, title]) => [`zones.keen.spatial.${entry.feature}.${name}`, `Keen ${title.toLowerCase()}`, entry.feature]));
    const ofMeans = config.periphery ? [["zones.keen.periphery.level", "Keen means"], ["zones.off_level", "Means of off"]] : [];
    return [...ofFeature, ["zones.keen.temporal.level", "Keen change"], ...ofMeans];
  }

  /** Makes a row to turn each feature on or off, and below it the rows of its keys. */
  #features({ config }) {
    const rows = this.#tables.features.flatMap(({ feature }) => {
      const number = config.spatial.findIndex(entry => entry.feature === feature);
      const keys = OF_FEATURE.filter(([name]) => number >= 0 && (config.spatial[number][name] ?? null) !== null);
      const featureRows = keys.map(([name, title]) => [`spatial.${number}.${name}`, title, feature]);
      return [[`feature.${feature}`, feature], ...featureRows];
    });
    return config.spatial.length > 1 ? [...rows, ["decision.combine", "Votes"]] : rows;
  }

  /** Makes a row with the key of the configuration and its values. */
  #help(key, feature) {
    const plain = key.replace(/\.\d+\./, ".").replace(`.${feature}.`, "."), { takes } = this.#tables.keys.find(own => own.key === plain);
    const unit = key.endsWith("min_score") ? `, in ${this.#tables.features.find(own => own.feature === feature).unit}` : "";
    return `${key}: ${takes}${unit}`;
  }

  #build(facts) {
    const focused = document.activeElement?.closest?.("[data-key]")?.dataset.key;
    this.#rows.clear();
    this.#rows.set("preset", this.#preset());
    const groups = this.#groups(facts).filter(([, rows]) => rows.length).map(([title, rows]) => {
      const elements = rows.map(([key, name, feature]) => {
        const row = key.startsWith("feature.") ? this.#feature(name) : this.#key(key, name, facts, feature);
        this.#rows.set(key, row);
        return row.element;
      });
      return make("fieldset", {}, make("legend", { textContent: title }), ...elements);
    });
    const keyRows = KEY_ROWS.map(([key, name]) => {
      const row = this.#key(key, name, facts);
      this.#rows.set(key, row);
      return row.element;
    });
    this.#presetPlace.replaceChildren(this.#rows.get("preset").element);
    this.#keyPlace.replaceChildren(...keyRows);
    this.#place.replaceChildren(...groups);
    if (focused) document.querySelector(`[data-key="${focused}"]`)?.querySelector("input, select")?.focus();
  }

  #preset() {
    const select = make("select", { ariaLabel: "Preset" }, ...this.presets.map(({ name }) => make("option", { textContent: name })));
    const summary = make("p", { className: "quiet" });
    const row = line("preset", "Preset", select);
    select.onchange = () => row.showMessage(this.#actions.preset(select.value));
    row.element.append(summary);
    summary.style.gridColumn = "1 / -1";
    return { ...row, show: (facts, name) => {
      row.showMessage();
      select.value = name;
      summary.textContent = this.presets.find(own => own.name === name)?.summary ?? "";
    } };
  }

  #feature(name) {
    const box = make("input", { type: "checkbox" });
    const element = make("div", { className: "feature" }, make("label", {}, box, name));
    element.dataset.key = `feature.${name}`;
    const row = refusable(element);
    addHelp(row, this.#tables.features.find(own => own.feature === name).summary);
    box.onchange = () => {
      const message = this.#actions.toggle(name, box.checked);
      if (message) box.checked = !box.checked;
      row.showMessage(message);
    };
    return { ...row, show: facts => {
      row.showMessage();
      box.checked = facts.features.includes(name);
    } };
  }

  #key(key, name, facts, feature) {
    const rangeOf = own => own.bounds[key] ?? own.bounds[replacedKey(own.config, key)] ?? this.#tables.keys.find(known => known.key === key);
    const title = feature ? `${name}, ${feature}` : name;
    const row = rangeOf(facts).kind === "choice" ? choice(key, name, title) : number(key, name, title);
    if (feature) row.element.classList.add("indented");
    row.element.title = this.#help(key, feature);
    addHelp(row, HELP.get(replacedKey(facts.config, key)) ?? HELP.get(key.split(".").at(-1)));
    row.onchange(value => row.showMessage(this.#actions.change(key, value)));
    return { ...row, show: own => {
      row.showMessage();
      row.set(heldValue(own.config, key), rangeOf(own));
    } };
  }
}

/** Adds a visible line of help to a row, which its fields refer to. */
function addHelp({ element }, text) {
  if (!text) return;
  const id = `help-${element.dataset.key.replaceAll(".", "-")}`;
  element.append(make("p", { className: "help", id, textContent: text }));
  for (const field of element.querySelectorAll("input, select")) field.setAttribute("aria-describedby", id);
}

/** Shows a message below an element. */
function refusable(element) {
  const message = make("p", { className: "refused", role: "alert", hidden: true });
  element.append(message);
  const showMessage = text => {
    message.hidden = !text;
    message.textContent = text ? withoutBackticks(text) : "";
  };
  return { element, showMessage };
}

function line(key, name, ...fields) {
  const element = make("div", { className: "control" }, make("span", { textContent: name }), ...fields);
  element.dataset.key = key;
  return refusable(element);
}

function choice(key, name, title) {
  const select = make("select", { ariaLabel: title });
  const row = line(key, name, select);
  const set = (value, { choices }) => {
    if (select.options.length !== choices.length || [...select.options].some((own, place) => own.value !== String(choices[place])))
      select.replaceChildren(...choices.map(one => make("option", { textContent: one })));
    select.value = value;
  };
  // A number must stay a number.
  const onchange = then => { select.onchange = () => then(/^\d+$/.test(select.value) ? Number(select.value) : select.value); };
  return { ...row, set, onchange };
}

function number(key, name, title) {
  const slider = make("input", { type: "range", ariaLabel: title }), box = make("input", { type: "number", ariaLabel: `${title}, as a number` });
  const row = line(key, name, slider, box);
  const set = (value, { kind, min, max }) => {
    const step = kind === "decimal" ? "any" : 1;
    Object.assign(box, { min, max, step });
    Object.assign(slider, { min, max, step });
    if (slider.value !== String(value)) slider.value = value;
    if (document.activeElement !== box || Number(box.value) !== value) box.value = value;
  };
  const rounded = () => slider.step === "any" ? Number(Number(slider.value).toPrecision(3)) : Number(slider.value);
  const onchange = then => {
    slider.oninput = () => { box.value = rounded(); then(rounded()); };
    box.onchange = () => then(box.value.trim() === "" ? NaN : Number(box.value));
  };
  return { ...row, set, onchange };
}
