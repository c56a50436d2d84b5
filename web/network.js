// SPDX-License-Identifier: MIT OR Apache-2.0
// A network that runs on the page's frames: on each as the camera sees it, and on the receiver's screen. It runs in a thread of its own and
// takes the newest frame whenever it is idle, so that the screens never wait for it.

import { Boxes } from "./boxes.js";
import { className } from "./class_names.js";
import { asPath, at, copy, plain, say } from "./elements.js";
import { NetworkControls } from "./network_controls.js";
import { NetworkFigures } from "./network_figures.js";
import { NetworkThread } from "./network_thread.js";

/** Settings without choices of mean, scale and detections, which are then guessed. */
const GUESSED = { framing: "letterbox", mean: null, scale: null, detect: null };

export class NetworkView {
  #module; #camera; #source; #told;
  #thread = null; #file = null; #facts = null; #wishes = { ...GUESSED };
  /** Answers to questions before the last change of network, settings or camera are ignored. */
  #ticket = 0;
  /** `is` says whether the camera still has the shown frame. */
  #shown = { id: 0, number: 0, is: false }; #looked = null; #looking = false; #opened = "";
  #boxes = new Boxes(); #figures = new NetworkFigures(); #controls;

  /** `module` is the compiled engine. `camera` gives the camera of now, `source` its source as a command has it. `told` is called when a wish has changed. */
  constructor(module, { camera, source, told }) {
    this.#module = module;
    this.#camera = camera;
    this.#source = source;
    this.#told = told;
    this.#controls = new NetworkControls(wishes => this.#wish(wishes));
    at("open-network").onclick = () => at("network-file").click();
    at("network-file").onchange = event => { if (event.target.files.length) this.open(event.target.files[0]); event.target.value = ""; };
    at("close-network").onclick = () => this.close();
    at("copy-command").onclick = () => copy(at("network-command").textContent, "the command", "copied-command");
  }

  /** The settings that differ from the initial ones. */
  get wishes() {
    return Object.fromEntries(Object.entries(this.#wishes).filter(([key, value]) => value !== GUESSED[key]));
  }

  /** Takes settings for the network that is opened next, or for the open one. */
  set wishes(wishes) {
    const made = { ...GUESSED, ...wishes };
    if (JSON.stringify(made) === JSON.stringify(this.#wishes)) return;
    this.#wishes = made;
    if (this.#thread) this.#make();
  }

  /** Opens a file. The network before it and its settings are dropped. */
  async open(file) {
    if (this.#file) this.#wishes = { ...GUESSED };
    this.close();
    this.#file = file.name;
    const ticket = ++this.#ticket;
    this.#refused();
    say("network-status", `reading ${file.name}`);
    const thread = this.#thread = new NetworkThread(at("network-worker").textContent);
    at("close-network").hidden = false;
    at("network-hint").hidden = true;
    try {
      const bytes = await file.arrayBuffer();
      await thread.ask("begin", { module: this.#module, file: bytes }, [bytes]);
    } catch (error) {
      if (ticket === this.#ticket) this.#fail(error.message);
      return;
    }
    if (ticket === this.#ticket) await this.#make();
  }

  /** Ends the network. */
  close() {
    this.#ticket++;
    this.#thread?.end();
    this.#thread = this.#facts = null;
    this.#looking = false;
    this.#opened = "";
    this.#nothing();
    this.#refused();
    at("network-open").hidden = at("close-network").hidden = true;
    at("network-hint").hidden = false;
    say("network-status", "");
  }

  /** Makes the network of the file for the current camera. */
  async #make() {
    const { width, height, bits } = this.#camera().facts, ticket = ++this.#ticket, thread = this.#thread;
    this.#opened = `${width}x${height}x${bits}`;
    this.#facts = null;
    this.#nothing();
    this.#refused();
    try {
      const { facts } = await thread.ask("open", { wishes: { name: this.#file, ...this.#wishes }, width, height, bits });
      if (ticket !== this.#ticket) return;
      this.#facts = facts;
    } catch (error) {
      if (ticket === this.#ticket) this.#fail(error.message);
    }
    if (ticket !== this.#ticket) return;
    this.#show();
    this.#told();
    this.#look();
  }

  #wish(wishes) {
    Object.assign(this.#wishes, wishes);
    this.#make();
  }

  /** Called when the camera was replaced or reset. */
  restart() {
    this.#shown.is = false;
    if (!this.#thread) return;
    const { width, height, bits } = this.#camera().facts;
    if (this.#opened && this.#opened !== `${width}x${height}x${bits}`) this.#make();
    else if (this.#facts) {
      this.#ticket++;
      this.#nothing();
      this.#command();
    }
  }

  /** Called when another frame is shown, which has this number. */
  seen(number) {
    this.#shown = { id: this.#shown.id + 1, number, is: true };
    if (!this.#facts) return;
    this.#look();
    this.#mark();
  }

  /** Runs the network on the current frame, if it is idle and has not had this frame. */
  async #look() {
    const { id, number, is } = this.#shown, ticket = this.#ticket;
    if (!this.#facts || this.#looking || !is || this.#looked?.id === id) return;
    const camera = this.#camera(), { length } = camera.pixels;
    const planes = new Uint8Array(2 * length);
    planes.set(camera.pixels);
    planes.set(camera.rendered, length);
    this.#looking = true;
    const thread = this.#thread;
    try {
      const { looked, ms } = await thread.ask("look", { planes: planes.buffer }, [planes.buffer]);
      if (thread !== this.#thread) return;
      this.#looking = false;
      if (ticket === this.#ticket) this.#found({ id, number, ...looked }, ms);
    } catch (error) {
      if (thread !== this.#thread) return;
      this.#looking = false;
      if (ticket === this.#ticket) {
        this.#facts = null;
        this.#fail(error.message);
        return;
      }
    }
    this.#look();
  }

  #found(looked, ms) {
    this.#looked = looked;
    this.#figures.add(looked, ms, performance.now());
    if (this.#facts.head) this.#boxes.show(looked, this.#camera().facts, number => className(this.#facts, number));
    this.#mark();
  }

  /** Shows to which frame the boxes belong. */
  #mark() {
    const looked = this.#looked;
    if (!looked) return;
    const before = this.#shown.id - looked.id;
    this.#boxes.older(before > 0);
    this.#figures.show(looked, before);
  }

  /** Resets the results. */
  #nothing() {
    this.#looked = null;
    this.#boxes.clear();
    this.#figures.reset();
  }

  #show() {
    at("network-open").hidden = false;
    this.#controls.show(this.#facts, this.#wishes);
    this.#command();
    at("network-keys").hidden = !this.#facts?.head;
    if (!this.#facts) return;
    const { input, macs, head } = this.#facts;
    const kind = head ? `detections of ${head}` : "no detector: its outputs are compared";
    say("network-status", `${this.#file}: ${input.width}x${input.height} pixels, ${(macs / 1e6).toFixed(0)} million multiplications, ${kind}`);
  }

  /** Returns the command that does the same with the copied TOML. */
  #command() {
    say("copied-command", "");
    const { options } = this.#facts ?? {};
    at("network-command").hidden = at("copy-command").disabled = !options;
    if (!options) return;
    const word = text => /^[\w.:/=,-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
    say("network-command", `foveate infer ${word(asPath(this.#file))} ${this.#source().map(word).join(" ")} -o out --config camera.toml ${options}`);
  }

  #fail(message) {
    say("network-status", "");
    this.#refused(message);
  }

  #refused(message) {
    at("network-refused").hidden = !message;
    at("network-refused").textContent = message ? plain(message) : "";
  }

  /** The results, for tests. */
  get looked() { return this.#looked; }
  get facts() { return this.#facts; }
  get shown() { return this.#shown; }
  get sums() { return this.#figures.sums; }
}
