// SPDX-License-Identifier: MIT OR Apache-2.0
// The page: one source, one camera, and the display of both.

import { Engine } from "./engine.js";
import { Controls } from "./controls.js";
import { withDepth } from "./depth.js";
import { asPath, at, copy, make, plain, say } from "./elements.js";
import { Figures } from "./figures.js";
import { showHardware } from "./hardware.js";
import { linkToHandOn, readLink, writeLink } from "./link.js";
import { NetworkView } from "./network.js";
import { PixelCamera } from "./pixel_camera.js";
import { showReasons } from "./reasons.js";
import { Recording } from "./recording.js";
import { Screens } from "./screens.js";
import { Clip, Computer, Pictures, Scene, Webcam } from "./sources.js";
import { withKey, writeToml } from "./toml.js";

const SIZES = ["160x120", "224x224", "320x240", "640x480", "1280x720"];
const DEFAULT_SIZE = "640x480";
const START = { source: "scene:street", size: "", preset: "fovea" };
/** Time in ms after which a running clip is explained again, if that takes less than a frame. */
const EXPLAIN_MS = 500, EXPLAIN_COST = 25;

const frames_path = document.documentElement.dataset.frames;
let engine, described, presets, table;
let own = { ...START };
let camera = null, config = null, source = null, pixels = null, files = [];
let paused = matchMedia("(prefers-reduced-motion: reduce)").matches;
/** The last chosen number of means per side. */
let means = 1;
let speed = 1, wanted = 0, began = null, explained = { at: 0, cost: 0 };
/** The last two frames, which are shown again to a changed camera while the source is stopped. */
let last = [];
let screens, figures, controls, network;
const recording = new Recording(() => camera);

// The last error, until the next try.
function notice(text) {
  at("notice").hidden = !text;
  say("notice", text ?? "");
}

// --- The camera

/** Returns a configuration without its frame size, which the page sets. */
function unsized({ frame: { width, height, ...frame }, ...rest }) {
  return { frame, ...rest };
}

function sizeOf() {
  const natural = source?.natural;
  const [width, height] = own.size ? own.size.split("x").map(Number)
    : natural ? [natural.width, natural.height] : DEFAULT_SIZE.split("x").map(Number);
  return { width, height };
}

/** Makes the camera of a configuration, or throws the engine's message and leaves the camera as it was. */
function configure(wish) {
  const { width, height } = sizeOf();
  const made = engine.configure(writeToml(wish), width, height);
  recording.end();
  camera?.free();
  camera = made;
  config = unsized(made.facts.config);
  means = config.periphery?.blocks ?? means;
  begin();
  screens.resize(camera.facts);
  controls.show(camera.facts, own.preset);
  showHardware(at("area"), table, camera.facts);
  say("status", describe());
  keepLink();
  if (paused) again();
}

function describe() {
  const { width, height, columns, rows, side, fingerprint } = camera.facts;
  return `${width}x${height} pixels, ${columns}x${rows} regions of ${side}x${side}, design ${fingerprint}`;
}

/** Prepares for the first frame of a camera. */
function begin() {
  forget();
  figures.reset(camera.facts);
  network.restart();
}

function forget() {
  camera.reset();
  pixels = new PixelCamera(camera.facts.bits);
  began = null;
}

/** Returns the message of a refusal, or nothing. */
function tried(change) {
  try {
    change();
    return undefined;
  } catch (error) {
    return error.message;
  }
}

function changed(key, value) {
  return tried(() => {
    const before = means;
    configure(wished(key, value));
    if (key === "region.size") means = before;
  });
}

/** Returns the configuration with another value of a key, and with the changes that follow from it. */
function wished(key, value) {
  if (key === "frame.pixel_bits" && Number.isInteger(value) && value > 0) return withDepth(config, value, described.features);
  const wish = withKey(config, key, value);
  // A camera without means has no periphery table.
  if (key === "render.irrelevant" && value !== "mean") delete wish.periphery;
  // If the number of means does not divide the new side, the engine chooses another. The old number returns with a side that it divides.
  if (key === "region.size" && wish.periphery) wish.periphery.blocks = value % means ? undefined : means;
  return wish;
}

function toggled(feature, on) {
  const others = config.spatial.filter(one => one.feature !== feature);
  const order = described.features.map(one => one.feature);
  const spatial = on ? [...others, { feature }].sort((a, b) => order.indexOf(a.feature) - order.indexOf(b.feature)) : others;
  if (!spatial.length) return `a camera needs a feature; turn another on first, then ${feature} off`;
  return tried(() => configure({ ...config, spatial }));
}

function presetConfig(name) {
  const found = presets.find(preset => preset.name === name);
  if (!found) throw new Error(`there is no preset \`${name}\`; presets are ${presets.map(preset => preset.name).join(", ")}`);
  return found.config;
}

function presetChosen(name) {
  return tried(() => {
    const before = own.preset;
    own.preset = name;
    try {
      configure(presetConfig(name));
    } catch (error) {
      own.preset = before;
      throw error;
    }
  });
}

// --- The source

function sourceNamed(name) {
  if (name === "webcam") return new Webcam();
  if (name === "computer" && frames_path) return new Computer(frames_path);
  if (name === "files" && files.length) return sourceOf(files);
  const scene = described.scenes.find(scene => `scene:${scene.name}` === name);
  if (scene) return new Scene(engine, scene, () => camera.facts.side);
  throw new Error(`there is no source \`${name}\` here; choose one in the list`);
}

function sourceOf(files) {
  const isPicture = file => file.type.startsWith("image/");
  if (files.every(isPicture)) return new Pictures(files);
  if (files.length > 1) throw new Error(`${files.length} files are no one clip; give one clip, or pictures alone`);
  const [file] = files;
  // Browsers know few types of clips by name. The browser itself reports whether it decodes one.
  if (/^(text|application\/(pdf|zip|json))/.test(file.type)) throw new Error(`${file.name} is neither a clip nor a picture`);
  return new Clip(file);
}

let tickets = 0;
/** Changes the source. If it does not open, the old one stays. */
async function choose(name) {
  const before = own.source, ticket = ++tickets;
  notice();
  say("status", name === "webcam" ? "waiting for the camera" : "opening");
  let made;
  try {
    made = sourceNamed(name);
    await made.open(own.size ? sizeOf() : undefined);
  } catch (error) {
    made?.close();
    if (ticket !== tickets) return false;
    notice(error.message);
    at("source").value = source ? before : "";
    say("status", camera ? describe() : "");
    return false;
  }
  // Another source was chosen while this one opened.
  if (ticket !== tickets) {
    made.close();
    return false;
  }
  source?.close();
  source = made;
  source.onend = text => { if (source === made) notice(text); };
  own.source = name;
  last = [];
  at("source").value = name;
  at("speed").disabled = !source.slow;
  source.speed(speed);
  source.run(!paused);
  if (config) notice(tried(() => configure(config)));
  // A stopped page shows the first frame.
  if (paused) wanted = 1;
  return true;
}

async function opened(list) {
  const before = files;
  files = [...list];
  if (!files.length) return;
  const option = at("source").querySelector("[value=files]");
  if (!await choose("files")) {
    files = before;
    return;
  }
  option.hidden = false;
  option.textContent = files.length > 1 ? `${files.length} pictures` : files[0].name;
}

/** Takes a dropped file: a network, or else a source. */
function dropped(list) {
  const [networks, others] = [true, false].map(is => list.filter(({ name }) => /\.onnx$/i.test(name) === is));
  if (networks.length) network.open(networks[0]);
  if (others.length) opened(others);
}

// --- Frames

function step(frame) {
  const start = performance.now();
  if (frame.fresh && figures.sums.frames) {
    recording.end();
    forget();
  }
  began ??= frame.time_us;
  const time = Math.max(frame.time_us - began, 0);
  const sent = frame.rgba ? camera.stepRgba(frame.rgba, time) : camera.step(frame.grey, time);
  if (sent.recording) recording.grew(sent.recording);
  const events = pixels.step(camera.input);
  screens.paint(camera);
  const now = performance.now();
  figures.add(sent, events, frame.time_us, now - start, now);
  network.seen(sent.number);
  explain(now);
}

/** Shows the last frames again to a changed camera. */
function again() {
  for (const frame of last) step({ ...frame, fresh: false });
}

async function run() {
  for (;;) {
    const now = await new Promise(requestAnimationFrame);
    figures.paint(now);
    if (!source || !camera || (paused && !wanted)) continue;
    const from = source, { width, height } = camera.facts;
    try {
      const frame = paused ? await from.step(width, height) : await from.take(width, height, now);
      if (!frame) continue;
      wanted = 0;
      // Another source or size may have been chosen meanwhile.
      if (from !== source || width !== camera.facts.width || height !== camera.facts.height) continue;
      if (frame.fresh) last = [];
      last = [...last.slice(-1), frame];
      step(frame);
    } catch (error) {
      wanted = 0;
      pause(true);
      notice(error.message);
    }
  }
}

function pause(on) {
  paused = on;
  at("pause").setAttribute("aria-pressed", on);
  source?.run(!on);
}

function stepOnce() {
  if (!paused) pause(true);
  wanted = 1;
}

async function reset() {
  notice();
  last = [];
  const again = recording.on;
  recording.end();
  await source?.restart().catch(error => notice(error.message));
  if (!camera) return;
  begin();
  if (again) recording.begin();
  if (paused) wanted = 1;
}

// --- One region

function explain(now, asked = false) {
  const region = screens.chosen;
  if (!region || !last.length) return;
  if (!paused && !asked && (now - explained.at < EXPLAIN_MS || explained.cost > EXPLAIN_COST)) return;
  const start = performance.now();
  const message = tried(() => showReasons(at("reasons"), camera.explain(region.x, region.y, own.source)));
  if (message) at("reasons").replaceChildren(make("p", { className: "refused", textContent: plain(message) }));
  explained = { at: now, cost: performance.now() - start };
}

// --- Downloads, commands and links

/** Returns the source in the form of an input of `foveate infer`. */
function inputsOfCommand() {
  if (own.source.startsWith("scene:")) return [own.source];
  const names = own.source === "files" ? files.map(({ name }) => asPath(name)) : ["clip.mp4"];
  return own.size ? [...names, "--resize", own.size] : names;
}

function link() {
  const { source: from, size, preset } = own;
  // Files stay on this computer.
  return `#${writeLink({ source: from === "files" ? "" : from, size, preset }, presetConfig(preset), config, network.wishes)}`;
}

let kept = 0;
function keepLink() {
  clearTimeout(kept);
  kept = setTimeout(() => history.replaceState(null, "", link()), 200);
}

/** Takes the settings of the link. Wrong settings are reported, and have their initial values. */
async function fromLink() {
  let wish = readLink("");
  const wrong = tried(() => {
    wish = readLink(location.hash);
    presetConfig(wish.own.preset ?? START.preset);
    if (wish.own.size && !/^\d+x\d+$/.test(wish.own.size)) throw new Error(`the link's size \`${wish.own.size}\` is none; write 640x480`);
  });
  network.wishes = wrong ? {} : wish.network;
  own = { ...START, source: frames_path ? "computer" : START.source, ...(wrong ? {} : wish.own) };
  showSizes();
  const preset = presetConfig(own.preset), from = own.source;
  // The camera must exist before a source gives it frames.
  const refused = tried(() => configure(wrong ? preset : wish.apply(preset)));
  if (refused) {
    own.size = "";
    showSizes();
    configure(preset);
  }
  let told = wrong ?? (refused && `the link is refused: ${refused}`);
  if (!await choose(from) && !source) {
    told ??= at("notice").textContent;
    await choose(frames_path && from !== "computer" ? "computer" : START.source);
  }
  if (told) notice(told);
}

function showSizes() {
  const options = [["", "as the source"], ...[...new Set([...SIZES, own.size].filter(Boolean))].map(size => [size, size])];
  at("size").replaceChildren(...options.map(([value, textContent]) => make("option", { value, textContent })));
  at("size").value = own.size;
}

// --- The page itself

function wire() {
  const option = (value, textContent, more) => make("option", { value, textContent, ...more });
  at("source").append(
    ...(frames_path ? [option("computer", "this computer")] : []), option("webcam", "webcam"), option("files", "files", { hidden: true }),
    make("optgroup", { label: "scenes" }, ...described.scenes.map(scene => option(`scene:${scene.name}`, scene.name, { title: scene.summary }))));
  at("source").onchange = event => choose(event.target.value);
  at("size").onchange = event => {
    const before = own.size;
    own.size = event.target.value;
    last = [];
    const message = tried(() => configure(config));
    notice(message);
    if (message) at("size").value = own.size = before;
    // A camera source is asked for frames of that size.
    else if (own.source === "webcam") choose("webcam");
    else if (paused) wanted = 1;
  };
  at("open").onclick = () => at("files").click();
  at("files").onchange = event => { opened(event.target.files); event.target.value = ""; };
  at("pause").onclick = () => pause(!paused);
  at("step").onclick = stepOnce;
  at("reset").onclick = reset;
  at("speed").onchange = event => { speed = Number(event.target.value); source?.speed(speed); };
  at("copy-toml").onclick = () => copy(camera.facts.toml, "the TOML");
  at("copy-link").onclick = () => {
    const text = linkToHandOn(location, link());
    copy(text, text.startsWith("#") ? "the part of the link behind its secret address" : "the link");
  };
  at("record").onclick = () => { if (recording.on) recording.end(); else recording.begin(); };
  at("download").onclick = () => recording.download();
  addEventListener("hashchange", () => { if (location.hash !== link()) fromLink(); });
  const acts = new Map([[" ", () => pause(!paused)], ["s", stepOnce], ["r", reset]]);
  document.onkeydown = event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select, textarea")) return;
    // The space bar belongs to the button with the focus.
    if (event.key === " " && event.target.matches("button, summary")) return;
    const act = acts.get(event.key);
    if (!act) return;
    event.preventDefault();
    act();
  };
  const drop = on => event => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    at("drop").hidden = !on;
  };
  addEventListener("dragover", drop(true));
  addEventListener("dragleave", drop(false));
  addEventListener("drop", event => { drop(false)(event); if (event.dataTransfer?.files.length) dropped([...event.dataTransfer.files]); });
  matchMedia("(prefers-color-scheme: dark)").onchange = () => {
    screens.recolour();
    if (last.length) screens.paint(camera);
  };
  pause(paused);
}

/** Returns the bytes of a base64 text that was compressed by gzip. */
async function unpacked(text) {
  const packed = Uint8Array.from(atob(text.trim()), letter => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  try {
    return await new Response(stream).arrayBuffer();
  } catch (error) {
    throw new Error(`the engine in this page is damaged (${error.message}); fetch or write the page again`);
  }
}

async function start() {
  engine = await Engine.load(await unpacked(at("wasm").textContent));
  at("wasm").remove();
  described = engine.describe();
  table = JSON.parse(at("hardware-table").textContent);
  // A preset with every key, but without a frame size.
  presets = described.presets.map(({ name, summary, toml }) => {
    const made = engine.configure(toml.replace(/^(width|height) = .*$/gm, ""), 64, 64);
    const { config } = made.facts;
    made.free();
    return { name, summary, config: unsized(config) };
  });
  screens = new Screens(() => explain(performance.now(), true));
  figures = new Figures();
  network = new NetworkView(engine.module, { camera: () => camera, source: inputsOfCommand, told: keepLink });
  controls = new Controls(at("controls"), described, { presets, change: changed, toggle: toggled, preset: presetChosen });
  wire();
  await fromLink();
  // For tests and for users of the console.
  window.foveate = { engine, get camera() { return camera; }, get config() { return config; }, get sums() { return figures.sums; },
    get source() { return source; }, network };
  run();
}

start().catch(error => {
  notice(error.message);
  say("status", "the engine did not start");
});
