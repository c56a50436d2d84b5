// SPDX-License-Identifier: MIT OR Apache-2.0
// A second camera beside the one that the controls change: it gets the same frames, and shows its receiver and its share of the bytes.

import { byId } from "./elements.js";
import { Headline } from "./figures.js";
import { paintGrey, resizeView } from "./screens.js";

export class PinnedCamera {
  #camera = null; #make = null; #view; #headline = new Headline("pinned-headline");

  constructor() {
    const canvas = document.createElement("canvas");
    byId("pinned-screen").append(canvas);
    this.#view = { canvas, context: canvas.getContext("2d") };
  }

  get isOn() { return this.#camera !== null; }

  /** Takes the camera that `make(size)` makes for frames of a size { width, height }. If that throws, the old one stays. */
  pin(make, { width, height }) {
    const camera = make({ width, height });
    this.release();
    this.#camera = camera;
    this.#make = make;
    resizeView(this.#view, width, height);
    this.#headline.reset();
    this.#show(true);
  }

  /** Makes the same camera for frames of another size, or throws and leaves the old one. */
  resize(size) {
    if (!this.isOn || (size.width === this.#camera.facts.width && size.height === this.#camera.facts.height)) return;
    try {
      this.pin(this.#make, size);
    } catch (error) {
      throw new Error(`the kept camera: ${error.message}`);
    }
  }

  release() {
    this.#camera?.free();
    this.#camera = this.#make = null;
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
