// SPDX-License-Identifier: MIT OR Apache-2.0
// Records region events in the engine, and keeps them for the download when the recording ends.

import { byId, bytes, download, setText } from "./elements.js";

export class Recording {
  on = false;
  #text = ""; #camera;

  /** `camera` returns the current camera. */
  constructor(camera) { this.#camera = camera; }

  /** Starts to record every region of every frame. */
  begin() {
    this.#runAndShow(() => {
      this.#camera().record(true);
      this.on = true;
      return "recording";
    });
  }

  /** Ends a running recording, and keeps it. */
  end() {
    if (!this.on) return;
    this.on = false;
    this.#runAndShow(() => {
      this.#text = this.#camera().events();
      this.#camera().record(false);
      return `events.csv has ${bytes(this.#text.length)}`;
    });
  }

  /** Shows the size of the recording. A full recording has ended by itself. */
  showSize({ frames, bytes: size, full }) {
    setText("recorded", `${frames} frames, ${bytes(size)}${full ? ", which is all that is kept; download it" : ""}`);
  }

  download() {
    this.#runAndShow(() => {
      const text = this.on ? this.#camera().events() : this.#text;
      download("events.csv", new Blob([text], { type: "text/csv" }));
      return `events.csv has ${bytes(text.length)}`;
    });
  }

  /** Runs an action, and shows its result or the reason of a refusal. */
  #runAndShow(act) {
    let text;
    try { text = act(); } catch (error) { text = error.message; }
    setText("recorded", text);
    byId("record").setAttribute("aria-pressed", this.on);
    byId("download").disabled = !this.on && !this.#text;
  }
}
