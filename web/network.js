// SPDX-License-Identifier: MIT OR Apache-2.0
// A network that runs on the page's frames: on each as the camera sees it, and on the receiver's screen. It runs in a thread of its own and
// takes the newest frame whenever it is idle, so that the screens never wait for it.

import { Boxes } from "./boxes.js";
import { className } from "./class_names.js";
import { asPath, byId, bytes, copy, setText, withoutBackticks } from "./elements.js";
import { NetworkControls } from "./network_controls.js";
import { NetworkFigures } from "./network_figures.js";
import { NetworkThread } from "./network_thread.js";

/** The largest file that the engine takes. */
const MAX_FILE_BYTES = 2 * 2 ** 30;
/** Settings without choices of mean, scale and detections, which are then guessed. */
const GUESSED = { framing: "letterbox", mean: null, scale: null, detect: null };

export class NetworkView {
  #module; #camera; #source; #onchange;
  #thread = null; #file = null; #facts = null; #wishes = { ...GUESSED };
  /** Answers to questions before the last change of network, settings or camera are ignored. */
  #ticket = 0;
  /** The shown frame; `isCurrent` says whether the camera still has it. */
  #shown = { id: 0, number: 0, isCurrent: false }; #result = null; #isRunning = false; #openedSize = "";
  #boxes = new Boxes(); #figures = new NetworkFigures(); #controls;

  /** `module` is the compiled engine. `camera` returns the current camera, `source` its source as a command has it. `onchange` is called when a
   *  setting has changed. */
  constructor(module, { camera, source, onchange }) {
    this.#module = module;
    this.#camera = camera;
    this.#source = source;
    this.#onchange = onchange;
    this.#controls = new NetworkControls(wishes => this.#changeSettings(wishes));
    byId("open-network").onclick = () => byId("network-file").click();
    byId("network-file").onchange = event => { if (event.target.files.length) this.open(event.target.files[0]); event.target.value = ""; };
    byId("close-network").onclick = () => this.close();
    byId("copy-command").onclick = () => copy(byId("network-command").textContent, "the command", "copied-command");
  }

  /** The settings that differ from the initial ones. */
  get wishes() {
    return Object.fromEntries(Object.entries(this.#wishes).filter(([key, value]) => value !== GUESSED[key]));
  }

  /** Takes settings for the network that is opened next, or for the open one. */
  set wishes(wishes) {
    const settings = { ...GUESSED, ...wishes };
    if (JSON.stringify(settings) === JSON.stringify(this.#wishes)) return;
    this.#wishes = settings;
    if (this.#thread) this.#openNetwork();
  }

  /** Opens a file. The network before it and its settings are dropped. */
  async open(file) {
    if (this.#file) this.#wishes = { ...GUESSED };
    this.close();
    this.#file = file.name;
    const ticket = ++this.#ticket;
    this.#showRefusal();
    setText("network-status", `reading ${file.name}`);
    byId("close-network").hidden = false;
    byId("network-hint").hidden = true;
    this.#showCancel(true);
    try {
      if (file.size > MAX_FILE_BYTES) throw new Error(`${file.name} has ${bytes(file.size)}, and a network on this page has at most 2 GiB; \`foveate infer\` runs in a terminal`);
      const thread = this.#thread = new NetworkThread(byId("network-worker").textContent);
      const content = await file.arrayBuffer();
      await thread.ask("begin", { module: this.#module, file: content }, [content]);
    } catch (error) {
      if (ticket === this.#ticket) this.#fail(error.message);
      return;
    }
    if (ticket === this.#ticket) await this.#openNetwork();
  }

  /** Ends the network. */
  close() {
    this.#ticket++;
    this.#thread?.end();
    this.#thread = this.#facts = null;
    this.#isRunning = false;
    this.#openedSize = "";
    this.#clearResults();
    this.#showRefusal();
    byId("network-open").hidden = byId("close-network").hidden = true;
    byId("network-hint").hidden = false;
    setText("network-status", "");
  }

  /** Makes the network of the file for the current camera. */
  async #openNetwork() {
    const { width, height, bits } = this.#camera().facts, ticket = ++this.#ticket, thread = this.#thread;
    this.#showCancel(true);
    this.#openedSize = `${width}x${height}x${bits}`;
    this.#facts = null;
    this.#clearResults();
    this.#showRefusal();
    try {
      const { facts } = await thread.ask("open", { wishes: { name: this.#file, ...this.#wishes }, width, height, bits });
      if (ticket !== this.#ticket) return;
      this.#facts = facts;
    } catch (error) {
      if (ticket === this.#ticket) this.#fail(error.message);
    }
    if (ticket !== this.#ticket) return;
    this.#showCancel(false);
    this.#show();
    this.#onchange();
    this.#runNetwork();
  }

  #changeSettings(wishes) {
    Object.assign(this.#wishes, wishes);
    this.#openNetwork();
  }

  /** Called when the camera was replaced or reset. */
  restart() {
    this.#shown.isCurrent = false;
    if (!this.#thread) return;
    const { width, height, bits } = this.#camera().facts;
    if (this.#openedSize && this.#openedSize !== `${width}x${height}x${bits}`) this.#openNetwork();
    else if (this.#facts) {
      this.#ticket++;
      this.#clearResults();
      this.#command();
    }
  }

  /** Called when another frame is shown, which has this number. */
  frameShown(number) {
    this.#shown = { id: this.#shown.id + 1, number, isCurrent: true };
    if (!this.#facts) return;
    this.#runNetwork();
    this.#markAge();
  }

  /** Runs the network on the current frame, if it is idle and has not had this frame. */
  async #runNetwork() {
    const { id, number, isCurrent } = this.#shown, ticket = this.#ticket;
    if (!this.#facts || this.#isRunning || !isCurrent || this.#result?.id === id) return;
    const camera = this.#camera(), { length } = camera.pixels;
    const planes = new Uint8Array(2 * length);
    planes.set(camera.pixels);
    planes.set(camera.rendered, length);
    this.#isRunning = true;
    const thread = this.#thread;
    try {
      const { result, ms } = await thread.ask("look", { planes: planes.buffer }, [planes.buffer]);
      if (thread !== this.#thread) return;
      this.#isRunning = false;
      if (ticket === this.#ticket) this.#showResult({ id, number, ...result }, ms);
    } catch (error) {
      if (thread !== this.#thread) return;
      this.#isRunning = false;
      if (ticket === this.#ticket) {
        this.#facts = null;
        this.#fail(error.message);
        return;
      }
    }
    this.#runNetwork();
  }

  #showResult(result, ms) {
    this.#result = result;
    this.#figures.add(result, ms, performance.now());
    if (this.#facts.head) this.#boxes.show(result, this.#camera().facts, number => className(this.#facts, number));
    this.#markAge();
  }

  /** Shows to which frame the boxes belong. */
  #markAge() {
    const result = this.#result;
    if (!result) return;
    const framesBehind = this.#shown.id - result.id;
    this.#boxes.markOlder(framesBehind > 0);
    this.#figures.show(result, framesBehind);
  }

  /** Resets the results. */
  #clearResults() {
    this.#result = null;
    this.#boxes.clear();
    this.#figures.reset();
  }

  #show() {
    byId("network-open").hidden = false;
    this.#controls.show(this.#facts, this.#wishes);
    this.#command();
    byId("network-keys").hidden = !this.#facts?.head;
    if (!this.#facts) return;
    const { input, macs, head } = this.#facts;
    const kind = head ? `detections of ${head}` : "not a detector, so its outputs are compared";
    setText("network-status", `${this.#file}: ${input.width}x${input.height} pixels, ${(macs / 1e6).toFixed(0)} million multiplications, ${kind}`);
  }

  /** Returns the command that does the same with the copied TOML. */
  #command() {
    setText("copied-command", "");
    const { options } = this.#facts ?? {};
    byId("network-command").hidden = byId("copy-command").disabled = !options;
    if (!options) return;
    const word = text => /^[\w.:/=,-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
    setText("network-command", `foveate infer ${word(asPath(this.#file))} ${this.#source().map(word).join(" ")} -o out --config camera.toml ${options}`);
  }

  /** Names the button that ends the network: it cancels one that is not open yet. */
  #showCancel(isOpening) {
    setText("close-network", isOpening ? "Cancel" : "Close it");
  }

  #fail(message) {
    this.#showCancel(false);
    setText("network-status", "");
    this.#showRefusal(message);
  }

  #showRefusal(message) {
    byId("network-refused").hidden = !message;
    byId("network-refused").textContent = message ? withoutBackticks(message) : "";
  }

  /** The results, for tests. */
  get result() { return this.#result; }
  get facts() { return this.#facts; }
  get shown() { return this.#shown; }
  get sums() { return this.#figures.sums; }
}
