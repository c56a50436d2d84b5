// SPDX-License-Identifier: MIT OR Apache-2.0
// Records region events in the engine, and keeps them for the download when the recording ends.

import { at, bytes, download, say } from "./elements.js";

export class Recording {
  on = false;
  #kept = ""; #camera;

  /** `camera` returns the current camera. */
  constructor(camera) { this.#camera = camera; }

  /** Starts to record every region of every frame. */
  begin() {
    this.#told(() => {
      this.#camera().record(true);
      this.on = true;
      return "recording";
    });
  }

  /** Ends a running recording, and keeps it. */
  end() {
    if (!this.on) return;
    this.on = false;
    this.#told(() => {
      this.#kept = this.#camera().events();
      this.#camera().record(false);
      return `events.csv has ${bytes(this.#kept.length)}`;
    });
  }

  /** Shows the size of the recording. A full recording has ended by itself. */
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

  /** Runs an action, and shows its result or the reason of a refusal. */
  #told(act) {
    let text;
    try { text = act(); } catch (error) { text = error.message; }
    say("recorded", text);
    at("record").setAttribute("aria-pressed", this.on);
    at("download").disabled = !this.on && !this.#kept;
  }
}
