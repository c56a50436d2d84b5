// SPDX-License-Identifier: MIT OR Apache-2.0
// Draws the boxes of a network over two of the screens: boxes of the whole frame over the input, boxes of the receiver's screen over that.

import { byId, make } from "./elements.js";

export class Boxes {
  #layers;

  constructor() {
    this.#layers = ["input", "receiver"].map(id => {
      const layer = make("div", { className: "boxes", ariaHidden: "true" });
      byId(id).append(layer);
      return layer;
    });
  }

  /** Shows the detections in a frame of this size; `name` returns the name of a class. */
  show({ whole, seen }, { width, height }, name) {
    for (const [layer, detections, unmatchedKind] of [[this.#layers[0], whole, "lost"], [this.#layers[1], seen, "added"]])
      // Boxes without a partner are drawn above the others.
      layer.replaceChildren(...[...detections].sort((a, b) => b.both - a.both).map(detection => box(detection, width, height, name(detection.class), detection.both ? "kept" : unmatchedKind)));
  }

  /** Marks all boxes as belonging to an older frame than the shown one, or to this frame. */
  markOlder(on) {
    for (const place of this.#layers) place.classList.toggle("older", on);
  }

  clear() {
    for (const layer of this.#layers) layer.replaceChildren();
  }
}

function box({ rect: [x0, y0, x1, y1], score }, width, height, name, kind) {
  const text = `${name} ${score.toFixed(2)}${kind === "kept" ? "" : ` ${kind}`}`;
  // There is no room for a name above the screen, and names of small boxes would cover each other.
  const position = y0 < height / 12 ? " low" : "", size = x1 - x0 < width / 16 ? " small" : "";
  const element = make("div", { className: `box ${kind}${position}${size}` }, make("span", { textContent: text }));
  const percentage = (part, whole) => `${100 * part / whole}%`;
  Object.assign(element.style, { left: percentage(x0, width), top: percentage(y0, height), width: percentage(x1 - x0, width), height: percentage(y1 - y0, height) });
  return element;
}
