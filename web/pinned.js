// SPDX-License-Identifier: MIT OR Apache-2.0
// A second camera beside the one that the controls change: it gets the same frames, and shows its receiver and its share of the bytes.

import { byId } from "./elements.js";
import { Headline } from "./figures.js";
import { paintGrey, resizeView } from "./screens.js";

export class PinnedCamera {
  #camera = null; #toml = ""; #view; #headline = new Headline("pinned-headline");

  constructor() {
    const canvas = document.createElement("canvas");
    byId("pinned-screen").append(canvas);
    this.#view = { canvas, context: canvas.getContext("2d") };
  }

  get isOn() { return this.#camera !== null; }

  /** Takes a camera of this TOML, which `make(toml, width, height)` makes. */
  pin(toml, make, { width, height }) {
    this.release();
    this.#camera = make(toml, width, height);
    this.#toml = toml;
    resizeView(this.#view, width, height);
    this.#headline.reset();
    this.#show(true);
  }

  /** Makes the same camera for frames of another size. */
  resize(make, size) {
    if (!this.isOn || (size.width === this.#camera.facts.width && size.height === this.#camera.facts.height)) return;
    this.pin(this.#toml.replace(/^(width|height) = .*$/gm, ""), make, size);
  }

  release() {
    this.#camera?.free();
    this.#camera = null;
    this.#show(false);
  }

  #show(on) {
    for (const id of ["pinned", "pinned-result", "unpin"]) byId(id).hidden = !on;
  }

  /** Forgets all frames. */
  reset() {
    this.#camera?.reset();
    this.#headline.reset();
  }

  /** Shows a frame, as the camera beside it gets it. A repeated first frame of a clip does not count. */
  step(frame, time_us, isRepeated, now) {
    if (!this.isOn) return;
    const sent = frame.rgba ? this.#camera.stepRgba(frame.rgba, time_us) : this.#camera.step(frame.grey, time_us);
    const { screen, facts: { width, height } } = this.#camera;
    paintGrey(this.#view, screen);
    if (!isRepeated) this.#headline.add(sent.bits / 8, now);
    this.#headline.show(width * height);
  }
}
