// SPDX-License-Identifier: MIT OR Apache-2.0
// Draws the boxes of a network over two of the screens: those that it found in the whole frame and in the receiver's screen.

import { at, make } from "./elements.js";

export class Boxes {
  #places;

  constructor() {
    this.#places = ["input", "receiver"].map(id => {
      const place = make("div", { className: "boxes", ariaHidden: "true" });
      at(id).append(place);
      return place;
    });
  }

  /** Shows the detections in a frame of this size; `name` returns the name of a class. */
  show({ whole, seen }, { width, height }, name) {
    for (const [place, found, odd] of [[this.#places[0], whole, "lost"], [this.#places[1], seen, "added"]])
      // Boxes without a partner are drawn above the others.
      place.replaceChildren(...[...found].sort((a, b) => b.both - a.both).map(one => box(one, width, height, name(one.class), one.both ? "kept" : odd)));
  }

  /** Marks all boxes as belonging to an older frame than the shown one, or to this frame. */
  older(on) {
    for (const place of this.#places) place.classList.toggle("older", on);
  }

  clear() {
    for (const place of this.#places) place.replaceChildren();
  }
}

function box({ rect: [x0, y0, x1, y1], score }, width, height, name, kind) {
  const text = `${name} ${score.toFixed(2)}${kind === "kept" ? "" : ` ${kind}`}`;
  // There is no room for a name above the screen, and names of small boxes would cover each other.
  const room = y0 < height / 12 ? " low" : "", size = x1 - x0 < width / 16 ? " small" : "";
  const made = make("div", { className: `box ${kind}${room}${size}` }, make("span", { textContent: text }));
  const share = (part, whole) => `${100 * part / whole}%`;
  Object.assign(made.style, { left: share(x0, width), top: share(y0, height), width: share(x1 - x0, width), height: share(y1 - y0, height) });
  return made;
}
