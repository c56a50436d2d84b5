// SPDX-License-Identifier: MIT OR Apache-2.0
// The three screens of the page, the region that is chosen in them, and strokes of a brush for zones.

import { CLASSES, classesOf } from "./zones.js";

/** The kinds of regions by their byte (bit 0 SRS, bit 1 TRS, above them the result: 0 sent, 1 held, 2 black, 3 means), with the colour of
 *  their outlines. The first kind that applies holds. */
const KINDS = [
  ["sent", "--k4", byte => byte >> 2 === 0],
  ["average sent", "--k2", byte => byte >> 2 === 3],
  ["relevant, unchanged", "--k5", byte => (byte & 3) === 1],
  ["changed, irrelevant", "--k6", byte => (byte & 3) === 2],
];
/** The keys of the legend without outlines, with the class of their mark. */
const SHADES = [["not dimmed: all pixels sent", "bright"], ["tinted: only averages sent", "k2"], ["dark: not sent", "dim"]];
/** The opacities of the colour of an average that is sent, and of the shade over regions that are not sent. */
const AVERAGE_ALPHA = 120, DARK_ALPHA = 185;
/** The width of an outline as a share of the side of a region. */
const OUTLINE_WIDTH = 0.12;
const PARTS = ["input", "decisions", "receiver"];
/** The pixels of the picture of arrows per side of a region, at least. */
const ARROW_CELL = 24;
/** The pixels of the picture of outlines per side of a region, at least. */
const OUTLINE_CELL = 16;
/** The opacity of arrows of regions for which `flow` does not vote. */
const FAINT = 0.3;
const ARROWS = new Map([["ArrowLeft", [-1, 0]], ["ArrowRight", [1, 0]], ["ArrowUp", [0, -1]], ["ArrowDown", [0, 1]]]);
/** Returns a grey pixel as a word of ImageData. */
const GREY = Uint32Array.from({ length: 256 }, (_, value) => (0xFF000000 | value * 0x010101) >>> 0);

/** Returns a colour of the style as a word of ImageData. */
function colourWord(name, alpha) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const [red, green, blue] = [1, 3, 5].map(place => parseInt(text.slice(place, place + 2), 16));
  return (alpha << 24 | blue << 16 | green << 8 | red) >>> 0;
}

/** Returns the radius of the search for displacements, if the camera has one. */
const radiusOf = ({ config: { spatial } }) => spatial.map(({ radius }) => radius).find(Boolean);

/** Adds an arrow from a point by an offset, with a head of that width, to a path. */
function addArrow(path, x, y, dx, dy, width) {
  const length = Math.hypot(dx, dy), base = length - Math.min(1.1 * width, 0.75 * length);
  const at = (along, across) => [x + (dx * along - dy * across) / length, y + (dy * along + dx * across) / length];
  const [half, shaft] = [width / 2, width / 8];
  const corners = [[0, -shaft], [base, -shaft], [base, -half], [length, 0], [base, half], [base, shaft], [0, shaft]];
  for (const [place, [along, across]] of corners.entries()) path[place ? "lineTo" : "moveTo"](...at(along, across));
  path.closePath();
}

/** Sets the size of a view, which is a canvas with the pixels of its picture. */
export function resizeView(view, width, height) {
  Object.assign(view.canvas, { width, height });
  view.data = new ImageData(width, height);
  view.words = new Uint32Array(view.data.data.buffer);
}

/** Shows grey pixels in a view. */
export function paintGrey({ context, words, data }, pixels) {
  for (let place = 0; place < words.length; place++) words[place] = GREY[pixels[place]];
  context.putImageData(data, 0, 0);
}

export class Screens {
  #facts = null; #chosen = null; #views = {}; #tints; #classTints; #overlay; #zones; #arrows; #outlines; #outlineKinds; #hasOutlines = false; #isCompared = false; #choose; #painter; #painted = null;

  /** `choose` is called with a region when the user chooses one. A `painter` whose brush is on gets the strokes. */
  constructor(choose, painter) {
    this.#choose = choose;
    this.#painter = painter;
    for (const id of PARTS) {
      const place = document.getElementById(id), canvas = document.createElement("canvas"), cursor = document.createElement("div");
      cursor.className = "cursor";
      cursor.hidden = true;
      place.append(canvas, cursor);
      Object.assign(place, { tabIndex: 0, role: "application" });
      place.onclick = event => this.#chooseAt(event, place);
      this.#addBrush(place);
      place.onkeydown = event => this.#handleKey(event);
      this.#views[id] = { place, canvas, cursor, context: canvas.getContext("2d") };
    }
    this.#overlay = document.createElement("canvas").getContext("2d");
    this.#zones = document.createElement("canvas").getContext("2d");
    this.#arrows = document.createElement("canvas").getContext("2d");
    this.#arrows.canvas.className = "arrows";
    this.#outlines = document.createElement("canvas").getContext("2d");
    this.#outlines.canvas.className = "outlines";
    this.#views.decisions.canvas.after(this.#outlines.canvas, this.#arrows.canvas);
    this.recolour();
    const legend = document.getElementById("legend");
    const addKey = (className, name, colour) => {
      const mark = document.createElement("i"), key = document.createElement("span");
      mark.className = colour;
      key.className = `key ${className}`;
      key.append(mark, name);
      legend.append(key);
    };
    for (const [name, colour] of SHADES) addKey("shade", name, colour);
    for (const [name, colour] of KINDS) addKey("outline", name, colour.slice(2));
    addKey("", "chosen region", "chosen");
    this.showOutlines(false);
    const key = document.createElement("span");
    Object.assign(key, { className: "key", id: "moved-key", hidden: true, textContent: "\u2192 moved" });
    legend.append(key);
  }

  /** Reads the colours of the style again. */
  recolour() {
    const average = colourWord("--k2", AVERAGE_ALPHA), dark = (DARK_ALPHA << 24) >>> 0;
    this.#tints = Uint32Array.from({ length: 16 }, (_, byte) => [0, dark, dark, average][byte >> 2]);
    this.#outlineKinds = Int8Array.from({ length: 16 }, (_, byte) => KINDS.findIndex(([, , applies]) => applies(byte)));
    this.#classTints = Uint32Array.from(CLASSES, ({ colour, alpha }) => colour ? colourWord(colour, alpha) : 0);
    if (this.#facts) this.showZones(this.#facts);
  }

  /** Shows the classes of the regions of a camera on the picture of what it sees. */
  showZones(facts) {
    this.#facts = facts;
    const canvas = this.#zones.canvas, hasZones = Boolean(facts.config.zones?.classes?.length);
    Object.assign(canvas, { width: hasZones ? facts.columns : 1, height: hasZones ? facts.rows : 1 });
    if (!hasZones) return;
    const data = new ImageData(facts.columns, facts.rows), words = new Uint32Array(data.data.buffer);
    for (const [region, code] of classesOf(facts).entries()) words[region] = this.#classTints[code];
    this.#zones.putImageData(data, 0, 0);
  }

  /** Sets the sizes to the frames and the grid of a camera. */
  resize(facts) {
    const centre = this.#centreOfChosen();
    this.#facts = facts;
    const { width, height, columns, rows } = facts;
    for (const view of Object.values(this.#views)) {
      resizeView(view, width, height);
    }
    const radius = radiusOf(facts), scale = Math.max(1, Math.ceil(ARROW_CELL / facts.side));
    Object.assign(this.#arrows.canvas, { hidden: !radius, width: radius ? width * scale : 1, height: radius ? height * scale : 1 });
    document.getElementById("moved-key").hidden = !radius;
    const outlineScale = Math.max(1, Math.ceil(OUTLINE_CELL / facts.side));
    Object.assign(this.#outlines.canvas, { width: width * outlineScale, height: height * outlineScale });
    Object.assign(this.#overlay.canvas, { width: columns, height: rows });
    this.#overlay.data = new ImageData(columns, rows);
    this.#overlay.words = new Uint32Array(this.#overlay.data.data.buffer);
    this.showZones(facts);
    // The region at the same place of the picture stays chosen.
    const place = (share, length, count) => Math.min(Math.floor(share * length / facts.side), count - 1);
    if (centre) this.choose(place(centre.x, width, columns), place(centre.y, height, rows));
    this.#label();
  }

  /** Returns the centre of the chosen region as shares of the width and the height of the frame. */
  #centreOfChosen() {
    if (!this.#chosen || !this.#facts) return null;
    const { width, height, side } = this.#facts, { x, y } = this.#chosen;
    const share = (index, length) => Math.min((index + 0.5) * side / length, 0.999999);
    return { x: share(x, width), y: share(y, height) };
  }

  /** Shows the last frame of the camera. */
  paint(camera) {
    const { input, decisions, receiver } = this.#views, { columns, rows, side } = this.#facts;
    paintGrey(input, camera.input);
    paintGrey(receiver, this.#isCompared ? camera.input : camera.screen);
    const { words, data } = this.#overlay, regions = camera.regions;
    for (let region = 0; region < words.length; region++) words[region] = this.#tints[regions[region] & 15];
    this.#overlay.putImageData(data, 0, 0);
    decisions.context.putImageData(input.data, 0, 0);
    // The last column and row of regions may reach beyond the frame.
    for (const [{ context }, { canvas }] of [[decisions, this.#overlay], [input, this.#zones]]) {
      context.imageSmoothingEnabled = false;
      context.drawImage(canvas, 0, 0, columns * side, rows * side);
    }
    this.#paintArrows(camera.displacements);
    if (this.#hasOutlines) this.#paintOutlines(regions);
  }

  /** Shows what the camera sees in the place of what the receiver sees, or stops to do so. */
  compare(on, camera) {
    this.#isCompared = on;
    document.getElementById("receiver-title").textContent = on ? "The camera sees" : "The receiver sees";
    if (camera) this.paint(camera);
  }

  /** Turns the outlines of the kinds of regions on or off. */
  showOutlines(on, camera) {
    this.#hasOutlines = on;
    this.#outlines.canvas.hidden = !on;
    for (const key of document.querySelectorAll("#legend .outline")) key.hidden = !on;
    for (const key of document.querySelectorAll("#legend .shade")) key.hidden = on;
    if (camera) this.paint(camera);
  }

  /** Returns the canvases of the three pictures, with the layers above each. */
  get layers() {
    const { input, decisions, receiver } = this.#views;
    return [[input.canvas], [decisions.canvas, this.#outlines.canvas, this.#arrows.canvas].filter(({ hidden }) => !hidden), [receiver.canvas]];
  }

  /** Draws a line between regions of different kinds, on the side of each that has a colour. */
  #paintOutlines(regions) {
    const context = this.#outlines, { columns, rows, side, width } = this.#facts, cell = side * context.canvas.width / width;
    context.clearRect(0, 0, context.canvas.width, context.canvas.height);
    const paths = KINDS.map(() => new Path2D()), thickness = Math.max(1, OUTLINE_WIDTH * cell);
    const kindAt = (x, y) => x < 0 || y < 0 || x >= columns || y >= rows ? -1 : this.#outlineKinds[regions[y * columns + x] & 15];
    for (let y = 0; y < rows; y++) {
      for (let x = 0; x < columns; x++) {
        const kind = kindAt(x, y);
        if (kind < 0) continue;
        const path = paths[kind], [left, top] = [x * cell, y * cell];
        if (kindAt(x, y - 1) !== kind) path.rect(left, top, cell, thickness);
        if (kindAt(x, y + 1) !== kind) path.rect(left, top + cell - thickness, cell, thickness);
        if (kindAt(x - 1, y) !== kind) path.rect(left, top, thickness, cell);
        if (kindAt(x + 1, y) !== kind) path.rect(left + cell - thickness, top, thickness, cell);
      }
    }
    for (const [kind, path] of paths.entries()) {
      context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(KINDS[kind][1]).trim();
      context.fill(path);
    }
  }

  /** Draws an arrow from the centre of each region whose content has moved, faint where `flow` does not vote. Its length is in proportion to
   *  the displacement, and the longest reaches into the next region. */
  #paintArrows(displacements) {
    const radius = radiusOf(this.#facts), context = this.#arrows;
    if (!radius) return;
    const { columns, side, width } = this.#facts, cell = side * context.canvas.width / width;
    context.clearRect(0, 0, context.canvas.width, context.canvas.height);
    const paths = [new Path2D(), new Path2D()], pixel = 1.2 * cell / (radius + 1);
    for (let region = 0; 3 * region < displacements.length; region++) {
      const [dx, dy, vote] = displacements.subarray(3 * region, 3 * region + 3);
      if (!dx && !dy) continue;
      const x = (region % columns + 0.5) * cell, y = (Math.floor(region / columns) + 0.5) * cell;
      addArrow(paths[vote], x, y, dx * pixel, dy * pixel, 0.36 * Math.min(cell, 48));
    }
    Object.assign(context, { strokeStyle: "#101010", fillStyle: "#fff", lineWidth: Math.min(cell, 48) / 10, lineJoin: "round" });
    for (const [vote, path] of paths.entries()) {
      context.globalAlpha = vote ? 1 : FAINT;
      context.stroke(path);
      context.fill(path);
    }
  }

  /** Chooses a region and outlines it. */
  choose(x, y) {
    this.#chosen = { x, y };
    const { width, height, side } = this.#facts;
    for (const { cursor } of Object.values(this.#views)) {
      cursor.hidden = false;
      Object.assign(cursor.style, { left: `${100 * x * side / width}%`, top: `${100 * y * side / height}%`,
        width: `${100 * side / width}%`, height: `${100 * side / height}%` });
    }
    this.#label();
  }

  get chosen() { return this.#chosen; }

  #label() {
    const { columns, rows } = this.#facts, region = this.#chosen;
    const regionText = region ? `region ${region.x},${region.y} is chosen` : "no region is chosen";
    for (const { place } of Object.values(this.#views)) {
      const title = place.closest("figure").querySelector("figcaption").textContent;
      place.setAttribute("aria-label", `${title}; ${columns} by ${rows} regions, ${regionText}; arrow keys choose one`);
    }
  }

  /** Returns the region under the pointer. */
  #regionAt(event, place) {
    const { width, height, side } = this.#facts, box = place.getBoundingClientRect();
    const regionIndex = (offset, length, size) => Math.floor(Math.min(Math.max(offset / length, 0), 0.999999) * size / side);
    return { x: regionIndex(event.clientX - box.left, box.width, width), y: regionIndex(event.clientY - box.top, box.height, height) };
  }

  #chooseAt(event, place) {
    if (!this.#facts || this.#painter.isOn) return;
    const { x, y } = this.#regionAt(event, place);
    this.choose(x, y);
    this.#choose(this.#chosen);
  }

  /** Gives the strokes of the pointer to the painter while its brush is on. */
  #addBrush(place) {
    const paint = event => {
      const region = this.#regionAt(event, place);
      this.#painter.stroke(this.#painted ?? region, region);
      this.#painted = region;
    };
    const end = () => {
      if (!this.#painted) return;
      this.#painted = null;
      this.#painter.end();
    };
    place.onpointerdown = event => {
      if (!this.#facts || !this.#painter.isOn || event.button !== 0) return;
      event.preventDefault();
      place.focus();
      place.setPointerCapture(event.pointerId);
      paint(event);
    };
    place.onpointermove = event => { if (this.#painted) paint(event); };
    place.onpointerup = place.onpointercancel = end;
    // A finger that paints does not scroll.
    place.addEventListener("touchstart", event => { if (this.#painter.isOn) event.preventDefault(); }, { passive: false });
  }

  #handleKey(event) {
    if (event.key === "Enter" && this.#chosen && this.#painter.isOn) {
      event.preventDefault();
      this.#painter.stroke(this.#chosen, this.#chosen);
      this.#painter.end();
      return;
    }
    const move = ARROWS.get(event.key);
    if (!move || !this.#facts) return;
    event.preventDefault();
    const { columns, rows } = this.#facts, distance = event.shiftKey ? 8 : 1;
    const start = this.#chosen ?? { x: columns >> 1, y: rows >> 1 };
    const within = (value, count) => Math.min(Math.max(value, 0), count - 1);
    const first = !this.#chosen;
    this.choose(within(start.x + (first ? 0 : move[0] * distance), columns), within(start.y + (first ? 0 : move[1] * distance), rows));
    this.#choose(this.#chosen);
  }
}
