// SPDX-License-Identifier: MIT OR Apache-2.0
// The page: one source, one camera, and the display of both.

import { Capture } from "./capture.js";
import { Engine } from "./engine.js";
import { engineOfText } from "./engine_text.js";
import { Controls } from "./controls.js";
import { withDepth } from "./depth.js";
import { asPath, byId, copy, make, setText, withoutBackticks } from "./elements.js";
import { Figures } from "./figures.js";
import { showHardware } from "./hardware.js";
import { isMapTooFine, linkToShare, readLink, writeLink } from "./link.js";
import { withFittingMeans } from "./means.js";
import { NetworkView } from "./network.js";
import { withOrganization } from "./organization.js";
import { PinnedCamera } from "./pinned.js";
import { PixelCamera } from "./pixel_camera.js";
import { showReasons } from "./reasons.js";
import { Recording } from "./recording.js";
import { Screens } from "./screens.js";
import { Clip, Computer, Pictures, Scene, Webcam } from "./sources.js";
import { writeToml } from "./toml.js";
import { ZonePainter, mapOf, withFittingMap, withHeldValue, withoutOtherFeatures } from "./zones.js";

const SIZES = ["160x120", "224x224", "320x240", "640x480", "1280x720"];
const DEFAULT_SIZE = "640x480";
const START = { source: "scene:street", size: "", preset: "fovea" };
/** Time in ms after which a running clip is explained again, if that takes less than a frame. */
const EXPLAIN_MS = 500, EXPLAIN_COST = 25;

const frames_path = document.documentElement.dataset.frames;
let engine, tables, presets, hardwareTable;
let settings = { ...START };
let camera = null, config = null, source = null, pixels = null, files = [];
/** The map of zones as it was painted or read. The map of `config` is always fitted from this one, so that it is not rounded again and again. */
let paintedMap = [];
let paused = matchMedia("(prefers-reduced-motion: reduce)").matches;
/** The last chosen number of means per side. */
let means = 1;
/** The hardware before a feature that it does not support was turned on. It returns with the features that it supports. */
let replacedHardware = null;
let speed = 1, isStepRequested = false, startTime = null, lastExplanation = { at: 0, cost: 0 };
/** The last two frames, which are shown again to a changed camera while the source is stopped. */
let last = [];
let screens, figures, controls, network, zones, pinned, capture;
const recording = new Recording(() => camera);

// The last error, until the next try.
function notice(text) {
  byId("notice").hidden = !text;
  setText("notice", text ?? "");
}

// --- The camera

/** Returns a configuration without its frame size, which the page sets. */
function withoutSize({ frame: { width, height, ...frame }, ...rest }) {
  return { frame, ...rest };
}

function sizeOf() {
  const natural = source?.natural;
  const [width, height] = settings.size ? settings.size.split("x").map(Number)
    : natural ? [natural.width, natural.height] : DEFAULT_SIZE.split("x").map(Number);
  return { width, height };
}

/** Returns a function that makes the camera of a configuration and a map of zones for frames of a size, to which it fits the map. */
const makerOf = (ownConfig, map) => ({ width, height }) =>
  engine.configure(writeToml(withFittingMap(ownConfig, map, width, height)), width, height);

/** Makes the camera of a configuration and a map of zones, and the kept camera for frames of the same size, or throws the engine's message and
 *  leaves both cameras as they were. */
function configure(wantedConfig, map = paintedMap) {
  const newCamera = makerOf(wantedConfig, map)(sizeOf());
  try {
    pinned.resize(newCamera.facts);
  } catch (error) {
    newCamera.free();
    throw error;
  }
  recording.end();
  camera?.free();
  camera = newCamera;
  config = withoutSize(newCamera.facts.config);
  paintedMap = map;
  means = config.periphery?.blocks ?? means;
  begin();
  screens.resize(camera.facts);
  zones.show(camera.facts);
  controls.show(camera.facts, settings.preset);
  showHardware(byId("area"), hardwareTable, camera.facts, tables.features);
  setText("status", describe());
  storeLink();
  if (paused) repeatFrames();
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
  pinned.reset();
  pixels = new PixelCamera(camera.facts.bits);
  startTime = null;
}

/** Returns the message of a refusal, or nothing. */
function messageOf(change) {
  try {
    change();
    return undefined;
  } catch (error) {
    return error.message;
  }
}

/** Returns the message of a refused wish of the user, or nothing. After a success, the message of an earlier try is gone. */
function messageOfWish(change) {
  const message = messageOf(change);
  if (!message) notice();
  return message;
}

function changeKey(key, value) {
  return messageOfWish(() => {
    const oldMeans = means;
    configure(withChange(key, value));
    if (key === "region.size") means = oldMeans;
  });
}

/** Returns the configuration with another value of a key, and with the changes that follow from it. */
function withChange(key, value) {
  if (key === "frame.pixel_bits" && Number.isInteger(value) && value > 0) return withDepth(config, value, tables.features);
  const wish = withHeldValue(config, key, value);
  // The number of means that the last side did not allow returns with a side that it divides.
  if (key === "region.size" && wish.periphery) wish.periphery.blocks = means;
  return withFittingMeans(wish, [key]);
}

function toggleFeature(feature, on) {
  const others = config.spatial.filter(one => one.feature !== feature);
  const order = tables.features.map(one => one.feature);
  const added = { feature };
  // All features of a camera use one mean.
  if (tables.features[order.indexOf(feature)].mean_fraction_bits !== undefined)
    added.mean_fraction_bits = others.find(one => (one.mean_fraction_bits ?? null) !== null)?.mean_fraction_bits;
  const spatial = on ? [...others, added].sort((a, b) => order.indexOf(a.feature) - order.indexOf(b.feature)) : others;
  if (!spatial.length) return `a camera needs a feature; turn another on first, then ${feature} off`;
  return messageOfWish(() => {
    const { hardware } = config, wish = withOrganization(withoutOtherFeatures({ ...config, spatial }), tables.features, replacedHardware);
    configure(wish);
    if (wish.hardware === replacedHardware) replacedHardware = null;
    else if (wish.hardware !== hardware) replacedHardware = hardware;
  });
}

function presetConfig(name) {
  const preset = presets.find(preset => preset.name === name);
  if (!preset) throw new Error(`there is no preset \`${name}\`; presets are ${presets.map(preset => preset.name).join(", ")}`);
  return preset.config;
}

function choosePreset(name) {
  return messageOfWish(() => {
    const previous = settings.preset;
    settings.preset = name;
    try {
      // The painted map stays.
      const wish = presetConfig(name);
      if (paintedMap.length) configure({ ...wish, zones: { classes: paintedMap } });
      else configure(wish, mapOf(wish));
      replacedHardware = null;
    } catch (error) {
      settings.preset = previous;
      throw error;
    }
  });
}

// --- Zones

/** Gives the camera the class of every region. A camera without zones gets some first. */
function applyZones(codes) {
  notice(messageOf(() => {
    if (!config.zones) configure({ ...config, zones: {} });
    camera.setClasses(codes);
    config = withoutSize(camera.facts.config);
    paintedMap = mapOf(config);
    zones.show(camera.facts);
    screens.showZones(camera.facts);
    if (last.length) screens.paint(camera);
    setText("status", describe());
    storeLink();
  }));
}

/** Shows the last frames with the new map while the source is stopped. */
function endStroke() {
  if (!paused || !last.length) return;
  begin();
  repeatFrames();
}

function clearZones() {
  const { zones: gone, ...others } = config;
  notice(messageOf(() => configure(others, [])));
}

// --- The source

function makeSource(name) {
  if (name === "webcam") return new Webcam();
  if (name === "computer" && frames_path) return new Computer(frames_path);
  if (name === "files" && files.length) return sourceOfFiles(files);
  const scene = tables.scenes.find(scene => `scene:${scene.name}` === name);
  if (scene) return new Scene(engine, scene, () => camera.facts.side);
  throw new Error(`there is no source \`${name}\` here; choose one in the list`);
}

function sourceOfFiles(files) {
  const isPicture = file => file.type.startsWith("image/");
  if (files.every(isPicture)) return new Pictures(files);
  if (files.length > 1) throw new Error(`${files.length} files are not one clip; give one clip, or only pictures`);
  const [file] = files;
  // Browsers know few types of clips by name. The browser itself reports whether it decodes one.
  if (/^(text|application\/(pdf|zip|json))/.test(file.type)) throw new Error(`${file.name} is neither a clip nor a picture`);
  return new Clip(file);
}

/** Shows what the source says, if it is no error. */
function showSourceStatus(text = "") {
  setText("source-status", text);
}

let tickets = 0;
/** Changes the source. If it does not open, the old one stays. */
async function choose(name) {
  const previous = settings.source, ticket = ++tickets;
  // The map of a link is not yet fitted to the frames of the source that opens; a link stored now would lose parts of it.
  clearTimeout(linkTimer);
  notice();
  setText("status", name === "webcam" ? "waiting for the camera" : "opening");
  let newSource;
  try {
    newSource = makeSource(name);
    await newSource.open(settings.size ? sizeOf() : undefined);
  } catch (error) {
    newSource?.close();
    if (ticket !== tickets) return false;
    notice(error.message);
    byId("source").value = source ? previous : "";
    setText("status", camera ? describe() : "");
    if (camera) storeLink();
    return false;
  }
  // Another source was chosen while this one opened.
  if (ticket !== tickets) {
    newSource.close();
    return false;
  }
  source?.close();
  source = newSource;
  source.onend = (text, isError = true) => { if (source === newSource) (isError ? notice : showSourceStatus)(text); };
  showSourceStatus();
  byId("loop-label").hidden = source.loops === undefined;
  if (source.loops !== undefined) source.loops = byId("loop").checked;
  settings.source = name;
  last = [];
  byId("source").value = name;
  byId("speed").disabled = !source.slow;
  source.speed(speed);
  source.run(!paused);
  if (config) notice(messageOf(() => configure(config)));
  // A stopped page shows the first frame.
  if (paused) isStepRequested = true;
  return true;
}

async function openFiles(list) {
  const previous = files;
  files = [...list];
  if (!files.length) return;
  const option = byId("source").querySelector("[value=files]");
  if (!await choose("files")) {
    files = previous;
    return;
  }
  option.hidden = false;
  option.textContent = files.length > 1 ? `${files.length} pictures` : files[0].name;
}

/** Takes a dropped file: a network, or else a source. */
function openDropped(list) {
  const [networks, others] = [true, false].map(is => list.filter(({ name }) => /\.onnx$/i.test(name) === is));
  if (networks.length) network.open(networks[0]);
  if (others.length) openFiles(others);
}

// --- Frames

function step(frame) {
  const start = performance.now(), isRepeated = Boolean(frame.fresh && figures.sums.frames);
  if (isRepeated) {
    recording.end();
    forget();
  }
  startTime ??= frame.time_us;
  const time = Math.max(frame.time_us - startTime, 0);
  const sent = frame.rgba ? camera.stepRgba(frame.rgba, time) : camera.step(frame.grey, time);
  if (sent.recording) recording.showSize(sent.recording);
  const events = pixels.step(camera.input);
  screens.paint(camera);
  const now = performance.now();
  // In the first frame of a further pass everything is new, which is no property of the camera.
  if (!isRepeated) figures.add(sent, events, frame.time_us, now - start, now);
  setText("difference", `The receiver's picture differs by ${meanDifference(camera.input, camera.screen).toFixed(1)} of 255 grey levels on average.`);
  pinned.step(frame, time, isRepeated, now);
  capture.frameShown();
  network.frameShown(sent.number);
  chooseRegion();
  explain(now);
}

/** Returns the mean difference of the pixels of two pictures. */
function meanDifference(one, other) {
  let sum = 0;
  for (let place = 0; place < one.length; place++) sum += Math.abs(one[place] - other[place]);
  return sum / one.length;
}

/** Chooses a region before the user has chosen one: the one that was sent nearest to the centre, or the one at the centre. */
function chooseRegion() {
  if (screens.chosen || (!paused && figures.sums.frames < 3)) return;
  const { columns, rows } = camera.facts, { regions } = camera, centre = [columns >> 1, rows >> 1];
  const distance = region => Math.hypot(region % columns - centre[0], Math.floor(region / columns) - centre[1]);
  const isSent = region => !paused && regions[region] >> 2 === 0;
  let best = centre[1] * columns + centre[0], bestDistance = Infinity;
  for (let region = 0; region < regions.length; region++) {
    if (!isSent(region) || distance(region) >= bestDistance) continue;
    best = region;
    bestDistance = distance(region);
  }
  screens.choose(best % columns, Math.floor(best / columns));
}

/** Shows the last frames again to a changed camera. */
function repeatFrames() {
  for (const frame of last) step({ ...frame, fresh: false });
}

async function run() {
  for (;;) {
    const now = await new Promise(requestAnimationFrame);
    figures.paint(now);
    if (!source || !camera || (paused && !isStepRequested)) continue;
    const from = source, { width, height } = camera.facts;
    try {
      const frame = paused ? await from.step(width, height) : await from.take(width, height, now);
      if (!frame) continue;
      isStepRequested = false;
      // Another source or size may have been chosen meanwhile.
      if (from !== source || width !== camera.facts.width || height !== camera.facts.height) continue;
      if (frame.fresh) last = [];
      last = [...last.slice(-1), frame];
      step(frame);
    } catch (error) {
      isStepRequested = false;
      pause(true);
      notice(error.message);
    }
  }
}

function pause(on) {
  paused = on;
  setText("pause-name", on ? "Play" : "Pause");
  setText("source-status", "");
  source?.run(!on);
}

function stepOnce() {
  if (!paused) pause(true);
  isStepRequested = true;
}

async function reset() {
  notice();
  showSourceStatus();
  last = [];
  const wasRecording = recording.on;
  recording.end();
  await source?.restart().catch(error => notice(error.message));
  if (!camera) return;
  begin();
  if (wasRecording) recording.begin();
  if (paused) isStepRequested = true;
}

// --- One region

function explain(now, asked = false) {
  const region = screens.chosen;
  if (!region || !last.length) return;
  if (!paused && !asked && (now - lastExplanation.at < EXPLAIN_MS || lastExplanation.cost > EXPLAIN_COST)) return;
  const start = performance.now();
  const message = messageOf(() => showReasons(byId("reasons"), camera.explain(region.x, region.y, settings.source)));
  if (message) byId("reasons").replaceChildren(make("p", { className: "refused", textContent: withoutBackticks(message) }));
  lastExplanation = { at: now, cost: performance.now() - start };
}

// --- Downloads, commands and links

/** Returns the source in the form of an input of `foveate infer`. */
function inputsOfCommand() {
  if (settings.source.startsWith("scene:")) return [settings.source];
  const names = settings.source === "files" ? files.map(({ name }) => asPath(name)) : ["clip.mp4"];
  return settings.size ? [...names, "--resize", settings.size] : names;
}

function link() {
  const { source: from, size, preset } = settings;
  // Files stay on this computer.
  return `#${writeLink({ source: from === "files" ? "" : from, size, preset }, presetConfig(preset), config, network.wishes)}`;
}

let linkTimer = 0;
function storeLink() {
  clearTimeout(linkTimer);
  linkTimer = setTimeout(() => history.replaceState(null, "", link()), 200);
}

/** Takes the settings of the link. Wrong settings are reported, and have their initial values. */
async function fromLink() {
  let wish = readLink("");
  const linkError = messageOf(() => {
    wish = readLink(location.hash);
    presetConfig(wish.pageSettings.preset ?? START.preset);
    if (wish.pageSettings.size && !/^\d+x\d+$/.test(wish.pageSettings.size)) throw new Error(`the link's size \`${wish.pageSettings.size}\` is not valid; write it as 640x480`);
  });
  network.wishes = linkError ? {} : wish.network;
  settings = { ...START, source: frames_path ? "computer" : START.source, ...(linkError ? {} : wish.pageSettings) };
  showSizes();
  const preset = presetConfig(settings.preset), from = settings.source;
  // The camera must exist before a source gives it frames.
  const cameraError = messageOf(() => {
    const linked = linkError ? preset : wish.apply(preset);
    configure(linked, mapOf(linked));
  });
  if (cameraError) {
    settings.size = "";
    showSizes();
    configure(preset, mapOf(preset));
  }
  let message = linkError ?? (cameraError && `the link is refused: ${cameraError}`);
  if (!await choose(from) && !source) {
    message ??= byId("notice").textContent;
    await choose(frames_path && from !== "computer" ? "computer" : START.source);
  }
  if (message) notice(message);
}

function showSizes() {
  const options = [["", "original"], ...[...new Set([...SIZES, settings.size].filter(Boolean))].map(size => [size, size])];
  byId("size").replaceChildren(...options.map(([value, textContent]) => make("option", { value, textContent })));
  byId("size").value = settings.size;
}

// --- The page itself

function addListeners() {
  const option = (value, textContent, more) => make("option", { value, textContent, ...more });
  byId("source").append(
    ...(frames_path ? [option("computer", "this computer")] : []), option("webcam", "webcam"), option("files", "files", { hidden: true }),
    make("optgroup", { label: "scenes" }, ...tables.scenes.map(scene => option(`scene:${scene.name}`, scene.name, { title: scene.summary }))));
  byId("source").onchange = event => choose(event.target.value);
  byId("size").onchange = event => {
    const before = settings.size, oldFrames = last;
    settings.size = event.target.value;
    last = [];
    const message = messageOf(() => configure(config));
    notice(message);
    if (message) {
      byId("size").value = settings.size = before;
      last = oldFrames;
    }
    // A camera source is asked for frames of that size.
    else if (settings.source === "webcam") choose("webcam");
    else if (paused) isStepRequested = true;
  };
  byId("open").onclick = () => byId("files").click();
  byId("files").onchange = event => { openFiles(event.target.files); event.target.value = ""; };
  byId("pause").onclick = () => pause(!paused);
  byId("step").onclick = stepOnce;
  byId("reset").onclick = reset;
  byId("speed").onchange = event => { speed = Number(event.target.value); source?.speed(speed); };
  byId("copy-toml").onclick = () => copy(camera.facts.toml, "the TOML");
  byId("copy-link").onclick = () => {
    if (isMapTooFine(config)) notice("the map of zones is too fine for a link, and is left out; the TOML has it");
    const text = linkToShare(location, link());
    copy(text, text.startsWith("#") ? "the part of the link behind its secret address" : "the link");
  };
  const compare = on => {
    byId("compare").setAttribute("aria-pressed", on);
    screens.compare(on, last.length ? camera : null);
  };
  const button = byId("compare");
  button.onpointerdown = event => { button.setPointerCapture(event.pointerId); compare(true); };
  button.onpointerup = button.onpointercancel = button.onblur = () => compare(false);
  button.onkeydown = event => { if (event.key === " " || event.key === "Enter") { event.preventDefault(); compare(true); } };
  button.onkeyup = () => compare(false);
  addEventListener("keyup", event => { if (event.key === "c") compare(false); });
  byId("outlines").onchange = event => screens.showOutlines(event.target.checked, last.length ? camera : null);
  byId("pin").onclick = () => notice(messageOf(() => {
    pinned.pin(makerOf(config, paintedMap), camera.facts);
    begin();
    if (paused) repeatFrames();
  }));
  byId("unpin").onclick = () => pinned.release();
  byId("save-picture").onclick = () => capture.savePicture();
  byId("film").onclick = () => capture.film();
  byId("loop").onchange = event => { if (source?.loops !== undefined) source.loops = event.target.checked; };
  byId("record").onclick = () => { if (recording.on) recording.end(); else recording.begin(); };
  byId("download").onclick = () => recording.download();
  addEventListener("hashchange", () => { if (location.hash !== link()) fromLink(); });
  const actions = new Map([[" ", () => pause(!paused)], ["s", stepOnce], ["r", reset], ["c", () => compare(true)]]);
  document.onkeydown = event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select, textarea")) return;
    // The space bar belongs to the button with the focus.
    if (event.key === " " && event.target.matches("button, summary")) return;
    const action = actions.get(event.key);
    if (!action) return;
    event.preventDefault();
    action();
  };
  const drop = on => event => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    byId("drop").hidden = !on;
  };
  addEventListener("dragover", drop(true));
  addEventListener("dragleave", drop(false));
  addEventListener("drop", event => { drop(false)(event); if (event.dataTransfer?.files.length) openDropped([...event.dataTransfer.files]); });
  matchMedia("(prefers-color-scheme: dark)").onchange = () => {
    screens.recolour();
    if (last.length) screens.paint(camera);
  };
  pause(paused);
}

async function start() {
  byId("late").remove();
  engine = await Engine.load(await engineOfText(byId("wasm").textContent));
  byId("wasm").remove();
  tables = engine.describe();
  hardwareTable = JSON.parse(byId("hardware-table").textContent);
  // A preset with every key, but without a frame size.
  presets = tables.presets.map(({ name, summary, toml }) => {
    const made = engine.configure(toml.replace(/^(width|height) = .*$/gm, ""), 64, 64);
    const { config } = made.facts;
    made.free();
    return { name, summary, config: withoutSize(config) };
  });
  zones = new ZonePainter(byId("zones"), { apply: applyZones, end: endStroke, clear: clearZones });
  screens = new Screens(() => explain(performance.now(), true), zones);
  figures = new Figures();
  pinned = new PinnedCamera();
  capture = new Capture(() => screens.layers);
  network = new NetworkView(engine.module, { camera: () => camera, source: inputsOfCommand, onchange: storeLink });
  controls = new Controls({ all: byId("controls"), key: byId("key-controls"), preset: byId("preset") }, tables, { presets, change: changeKey, toggle: toggleFeature, preset: choosePreset });
  addListeners();
  await fromLink();
  if (paused) showSourceStatus("paused, because your computer asks for less motion; press Play");
  // For tests and for users of the console.
  window.foveate = { engine, get camera() { return camera; }, get config() { return config; }, get sums() { return figures.sums; },
    get source() { return source; }, network };
  run();
}

start().catch(error => {
  notice(error.message);
  setText("status", "the engine did not start");
});
