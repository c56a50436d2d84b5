// SPDX-License-Identifier: MIT OR Apache-2.0
// The three pictures side by side as one picture, which is saved as PNG or recorded as video.

import { byId, bytes, download, setText } from "./elements.js";

/** The gap between pictures as a share of their width. */
const GAP = 0.02;
/** The smallest height of the saved pictures. */
const MIN_HEIGHT = 240;
const VIDEO_TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

export class Capture {
  #layers; #canvas = document.createElement("canvas"); #context = this.#canvas.getContext("2d"); #recorder = null; #size = "";

  /** `layers()` returns the canvases of each picture, the lowest first. */
  constructor(layers) { this.#layers = layers; }

  get isFilming() { return this.#recorder !== null; }

  /** Draws the pictures. Returns the size of the result. */
  #draw() {
    const pictures = this.#layers(), [{ width, height }] = pictures[0];
    const scale = Math.max(1, Math.ceil(MIN_HEIGHT / height)), [w, h] = [width * scale, height * scale], gap = Math.ceil(GAP * w);
    // Codecs want even sides.
    const size = { width: 2 * Math.ceil((3 * w + 2 * gap) / 2), height: 2 * Math.ceil(h / 2) };
    if (this.#canvas.width !== size.width || this.#canvas.height !== size.height) Object.assign(this.#canvas, size);
    this.#context.imageSmoothingEnabled = false;
    for (const [place, canvases] of pictures.entries())
      for (const canvas of canvases) this.#context.drawImage(canvas, place * (w + gap), 0, w, h);
    return `${size.width}x${size.height}`;
  }

  async savePicture() {
    this.#draw();
    const blob = await new Promise(done => this.#canvas.toBlob(done, "image/png"));
    if (blob) this.#offer("foveate.png", blob); else setText("saved", "the browser makes no PNG of pictures of this size; choose a smaller size");
  }

  /** Starts to record a video, or ends it. */
  film() {
    if (this.isFilming) {
      this.#recorder.stop();
      return;
    }
    const type = globalThis.MediaRecorder && VIDEO_TYPES.find(own => MediaRecorder.isTypeSupported(own));
    if (!type) {
      setText("saved", "this browser records no video; `foveate simulate --rendered mp4 --overlay=mp4` does");
      return;
    }
    this.#size = this.#draw();
    const parts = [], recorder = this.#recorder = new MediaRecorder(this.#canvas.captureStream(), { mimeType: type });
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => {
      this.#recorder = null;
      byId("film").setAttribute("aria-pressed", false);
      this.#offer(`foveate.${type.startsWith("video/mp4") ? "mp4" : "webm"}`, new Blob(parts, { type }));
    };
    recorder.onerror = ({ error }) => setText("saved", `the recording ended: ${error?.message ?? "the browser gives no reason"}`);
    recorder.start();
    byId("film").setAttribute("aria-pressed", true);
    setText("saved", "recording; press the button again to end it");
  }

  /** Adds the shown frame to a running recording. A frame of another size ends it. */
  frameShown() {
    if (!this.isFilming) return;
    if (this.#layers()[0][0].width && this.#draw() !== this.#size) this.#recorder.stop();
  }

  #offer(name, blob) {
    download(name, blob);
    setText("saved", `${name} has ${bytes(blob.size)}`);
  }
}
