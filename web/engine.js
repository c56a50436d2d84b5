// SPDX-License-Identifier: MIT OR Apache-2.0
// The engine of foveate.wasm for a page. Only this file uses its exports (engine/src/exports.rs).
//
//   const engine = await Engine.load(bytes);             // an ArrayBuffer of foveate.wasm
//   const camera = engine.configure(toml, width, height);
//   const sent = camera.stepRgba(context.getImageData(0, 0, width, height).data);
//   paint(camera.screen);
//
// A refused call throws an Error with the project's own message. Arrays of a camera are views into the memory of the engine:
// they are valid until the next call of any camera or of the engine. Copy them to keep them.

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** The engine: its tables, scenes, cameras and networks. */
export class Engine {
  #exports;
  #described;

  /** Loads the engine from the bytes of foveate.wasm, or from the `module` of another engine, which may be in another thread. */
  static async load(bytes) {
    try {
      const module = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
      const { exports } = await WebAssembly.instantiate(module, {});
      return new Engine(exports, module);
    } catch (error) {
      throw new Error(`foveate.wasm cannot be used here: ${error.message}; a browser of 2023 or later has what it needs (WebAssembly with SIMD)`);
    }
  }

  constructor(exports, module) {
    this.#exports = exports;
    /** The compiled module, from which other engines can be made. */
    this.module = module;
  }

  /** Returns {version, presets, scenes, keys, features, limits}, the choices of a page from the tables of the project. */
  describe() {
    if (this.#described === undefined) {
      this.call("foveate_describe");
      this.#described = JSON.parse(this.text());
    }
    return this.#described;
  }

  /** Makes a camera of a configuration for frames of this size. */
  configure(toml, width, height) {
    this.put(encoder.encode(toml));
    const handle = this.call("foveate_configure", whole(width, "width"), whole(height, "height"));
    return new Camera(this, handle, JSON.parse(this.text()));
  }

  /** Returns a copy of a frame of a built-in scene as 8-bit grey; after the last frame comes the first. `side` is that of a region,
   *  which some scenes are made for. */
  scene(name, width, height, number, side = 8) {
    this.put(encoder.encode(name));
    this.call("foveate_scene", whole(width, "width"), whole(height, "height"), whole(side, "side"), whole(number, "number"));
    return this.bytes().slice();
  }

  /** Gives the engine the bytes of an ONNX file. */
  takeNetwork(bytes) {
    this.put(bytes);
    this.call("foveate_network_file");
  }

  /** Makes the network of the file for frames of this size and depth. `wishes` are {name, framing, mean, scale, detect} in the words of
   *  `foveate infer`; what is left out of the last three is guessed, and an empty `detect` is none. {input, outputs, macs, fits, likely, head,
   *  score, overlap, classes, framing, mean, scale, options}. */
  openNetwork(wishes, width, height, bits) {
    this.put(encoder.encode(JSON.stringify(wishes)));
    this.call("foveate_network_open", whole(width, "width"), whole(height, "height"), whole(bits, "bits"));
    return JSON.parse(this.text());
  }

  /** Returns the outputs of the network for a frame and for the receiver's screen, which follow each other as `camera.pixels` and `camera.rendered`
   *  have them: {agreement, relative_rms, found, whole, seen, classes, class, same_places}. */
  look(planes) {
    this.put(planes);
    this.call("foveate_network_look");
    return JSON.parse(this.text());
  }

  // The methods below are for Camera only.

  /** Calls an export. Returns its number, or throws its message as an Error. */
  call(name, ...values) {
    let answer;
    try {
      answer = this.#exports[name](...values);
    } catch (error) {
      throw Object.assign(new Error(`the engine stopped at a fault of its own (${error.message}); reload the page`), { fault: true });
    }
    if (answer < 0) throw new Error(this.text());
    return answer;
  }

  /** Copies bytes into the memory of the engine. */
  put(bytes) {
    const place = this.#exports.foveate_input(bytes.length);
    if (place === 0) {
      const most = this.describe().limits.network_bytes;
      throw new Error(`${bytes.length} bytes are more than the engine takes at once, which are ${most}`);
    }
    new Uint8Array(this.#exports.memory.buffer, place, bytes.length).set(bytes);
  }

  /** Returns the last answer as bytes. */
  bytes() {
    return new Uint8Array(this.#exports.memory.buffer, this.#exports.foveate_pointer(), this.#exports.foveate_length());
  }

  text() {
    return decoder.decode(this.bytes());
  }

  /** Returns the last answer as numbers of eight bytes. */
  longs() {
    return new BigUint64Array(this.#exports.memory.buffer, this.#exports.foveate_pointer(), this.#exports.foveate_length() / 8);
  }
}

/** A camera: it takes frames, and returns the results of the last one. */
class Camera {
  #engine;
  #handle;
  #facts;

  constructor(engine, handle, facts) {
    this.#engine = engine;
    this.#handle = handle;
    this.#facts = Object.freeze(facts);
  }

  /** {toml, config, fingerprint, width, height, columns, rows, side, bits, features, organization, raw_bits_per_frame, bounds}. */
  get facts() {
    return this.#facts;
  }

  /** Sets the class of every region from the next frame on: 0 normal, 1 off, 2 keen, 3 always. The camera must have zones. `facts` change. */
  setClasses(codes) {
    this.#engine.put(codes);
    this.#call("foveate_classes");
    this.#facts = Object.freeze(JSON.parse(this.#engine.text()));
  }

  /** Takes a frame of 8-bit grey, with its time in microseconds since the first; without times, 30 frames per second.
   *  {number, active, actions, bits, skipped, srs, trs, recording}; recording is null, or {frames, bytes, full}. */
  step(grey, timeUs = -1) {
    return this.#step("foveate_step_grey", grey, timeUs);
  }

  /** Takes a frame in the format of a canvas, four bytes per pixel. */
  stepRgba(data, timeUs = -1) {
    return this.#step("foveate_step_rgba", data, timeUs);
  }

  #step(name, frame, timeUs) {
    this.#engine.put(frame);
    this.#call(name, timeUs);
    return JSON.parse(this.#engine.text());
  }

  #call(name, ...values) {
    return this.#engine.call(name, this.#handle, ...values);
  }

  #bytes(name) {
    this.#call(name);
    return this.#engine.bytes();
  }

  /** The last frame as the camera saw it, as 8-bit grey. */
  get input() {
    return this.#bytes("foveate_seen");
  }

  /** The receiver's screen after the last frame, as 8-bit grey. */
  get screen() {
    return this.#bytes("foveate_screen");
  }

  /** The last frame as the camera saw it, at its depth: one byte per pixel up to 8 bits, else two, the lower first. */
  get pixels() {
    return this.#bytes("foveate_pixels");
  }

  /** The receiver's screen after the last frame, in the same form. */
  get rendered() {
    return this.#bytes("foveate_rendered");
  }

  /** A byte per region: bit 0 SRS, bit 1 TRS, above them 0 forward, 1 hold, 2 blank, 3 summarize. */
  get regions() {
    return this.#bytes("foveate_regions");
  }

  /** Three signed bytes per region: columns to the right and rows down by which its content has moved, and 1 if `flow` votes. Empty without `flow`. */
  get displacements() {
    const bytes = this.#bytes("foveate_displacements");
    return new Int8Array(bytes.buffer, bytes.byteOffset, bytes.length);
  }

  /** Returns the scores of feature `index`, a BigUint64Array by region. */
  scores(index) {
    this.#call("foveate_scores", whole(index, "feature"));
    return this.#engine.longs();
  }

  /** Why the region in column x and row y of the last frame was sent or not: {json, text}, as `foveate explain` says it of a frame
   *  of that name. */
  explain(x, y, name = "page") {
    this.#engine.put(encoder.encode(name));
    this.#call("foveate_explain", whole(x, "column"), whole(y, "row"));
    return JSON.parse(this.#engine.text());
  }

  /** Begins to record every frame, with a row per region or, with `onlyActive`, per region that sends something; `false` ends
   *  it, and forgets what was recorded. A recording ends by itself at limits.recording_bytes of describe(). */
  record(on = true, onlyActive = false) {
    this.#call("foveate_record", on ? (onlyActive ? 2 : 1) : 0);
  }

  /** Returns the recording in the form of events.csv of `foveate simulate`. */
  events() {
    this.#call("foveate_events");
    return this.#engine.text();
  }

  /** The hash of the last frame's results, 16 hexadecimal digits (crates/engine/src/digest.rs). */
  hash() {
    this.#call("foveate_hash");
    return this.#engine.text();
  }

  /** Resets the camera; a recording begins anew. */
  reset() {
    this.#call("foveate_reset");
  }

  /** Frees the camera. Every later call throws. */
  free() {
    this.#call("foveate_free");
    this.#handle = 0xffffffff;
  }
}

/** Checks a number that WebAssembly would otherwise truncate. */
function whole(value, name) {
  if (Number.isInteger(value) && value >= 0 && value <= 0xffffffff) return value;
  throw new Error(`the ${name} ${value} is refused; it must be a whole number from 0 on`);
}
