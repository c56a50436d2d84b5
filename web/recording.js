// SPDX-License-Identifier: MIT OR Apache-2.0
// Region events, recorded by the engine from a frame on, and kept for the download when that ends.

import { at, bytes, download, say } from "./elements.js";

export class Recording {
  on = false;
  #kept = ""; #camera;

  /** `camera` gives the camera of now. */
  constructor(camera) { this.#camera = camera; }

  /** Begins to record every region of every frame. */
  begin() {
    this.#told(() => {
      this.#camera().record(true);
      this.on = true;
      return "recording";
    });
  }

  /** Ends that, where it goes on, and keeps what was recorded. */
  end() {
    if (!this.on) return;
    this.on = false;
    this.#told(() => {
      this.#kept = this.#camera().events();
      this.#camera().record(false);
      return `events.csv has ${bytes(this.#kept.length)}`;
    });
  }

  /** Says how much is recorded; a full recording has ended by itself. */
  grew({ frames, bytes: size, full }) {
    say("recorded", `${frames} frames, ${bytes(size)}${full ? ", which is all that is kept; download it" : ""}`);
  }

  download() {
    this.#told(() => {
      const text = this.on ? this.#camera().events() : this.#kept;
      download("events.csv", "text/csv", text);
      return `events.csv has ${bytes(text.length)}`;
    });
  }

  /** Does something, and says what came of it or why it was refused. */
  #told(act) {
    let text;
    try { text = act(); } catch (error) { text = error.message; }
    say("recorded", text);
    at("record").setAttribute("aria-pressed", this.on);
    at("download").disabled = !this.on && !this.#kept;
  }
}
