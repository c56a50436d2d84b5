// SPDX-License-Identifier: MIT OR Apache-2.0
// The sent data over time: current figures, two charts, and the sums since the beginning.

import { byId, bytes, make, percent, setText } from "./elements.js";
import { PIXEL_EVENT_BYTES } from "./pixel_camera.js";

const HISTORY = 300;
/** The ends of the chart of bytes, as powers of ten of the share of raw video. */
const MIN_POWER = -3.5, MAX_POWER = 1.2;
const SVG = "http://www.w3.org/2000/svg";

/** A chart of lines whose values are heights from 0 to 1; `marks` are heights with their texts. */
class Chart {
  #lines;
  constructor(place, classes, marks) {
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", `0 0 ${HISTORY - 1} 100`);
    svg.setAttribute("preserveAspectRatio", "none");
    const path = (name, line = "") => {
      const made = document.createElementNS(SVG, "path");
      made.setAttribute("class", name);
      made.setAttribute("d", line);
      svg.append(made);
      return made;
    };
    for (const [height, , name] of marks) path(name ?? "mark", `M0 ${100 - 100 * height}H${HISTORY}`);
    this.#lines = classes.map(name => path(name));
    place.replaceChildren(svg, ...marks.filter(([, text]) => text).map(([height, text]) => {
      const label = make("span", { textContent: text });
      label.style.top = `${100 - 100 * height}%`;
      return label;
    }));
  }
  /** The newest value is the last. */
  show(series) {
    for (const [place, values] of series.entries()) {
      const point = (value, x) => `${HISTORY - values.length + x} ${(99 - 98 * value).toFixed(1)}`;
      this.#lines[place].setAttribute("d", values.length > 1 ? `M${values.map(point).join("L")}` : "");
    }
  }
}

/** The time in ms over which the large figure is averaged. */
const HEADLINE_MS = 1000;

/** The share of the bytes of raw video over the last second, as a large figure. The first frame is left out, because all of it is new. */
export class Headline {
  #id; #entries = []; #isFirst = true;
  constructor(id) { this.#id = id; }

  reset() {
    this.#entries = [];
    this.#isFirst = true;
  }

  add(count, now) {
    if (this.#isFirst) {
      this.#isFirst = false;
      return;
    }
    this.#entries.push({ count, now });
    this.#entries = this.#entries.filter(entry => entry.now > now - HEADLINE_MS);
  }

  show(rawBytes) {
    const { length } = this.#entries, sum = this.#entries.reduce((total, { count }) => total + count, 0);
    const share = length ? sum / length / rawBytes : 0;
    setText(this.#id, length ? percent(share) : "–");
    const times = share > 0 ? 1 / share : 0;
    setText(`${this.#id}-times`, times >= 1.5 ? `: ${times.toFixed(times < 10 ? 1 : 0)} times less` : "");
  }
}

export class Figures {
  #history = []; #sums; #paintTime = 0; #isChanged = false; #facts = null; #headline = new Headline("headline");
  #regions = new Chart(byId("regions-chart"), ["k6", "k5", "k4"], [[1, "100 %"], [0.5, "50 %"]]);
  #bytes = new Chart(byId("bytes-chart"), ["k1", "k4"],
    [[height(10), "1000 %"], [height(1), "100 %", "rest"], [height(0.1), "10 %"], [height(0.01), "1 %"], [height(0.001), "0.1 %"]]);

  constructor() { this.reset(null); }

  /** Resets the figures, for another camera or another source. */
  reset(facts) {
    this.#facts = facts;
    this.#history = [];
    this.#headline.reset();
    this.#sums = { frames: 0, us: 0, camera: 0, pixels: 0 };
    this.#isChanged = false;
  }

  /** Adds a frame: the results of the engine, the events of a pixel camera, its time, and its computing time in ms. */
  add(sent, events, time_us, cost, now) {
    this.#isChanged = true;
    this.#headline.add(sent.bits / 8, now);
    const last = this.#history.at(-1), sums = this.#sums;
    const elapsed = last && time_us > last.time_us ? Math.min(time_us - last.time_us, 1e6) : 1e6 / 30;
    sums.frames++;
    sums.us += elapsed;
    sums.camera += sent.bits / 8;
    sums.pixels += events * PIXEL_EVENT_BYTES;
    this.#history.push({ ...sent, events, time_us, cost, now });
    if (this.#history.length > HISTORY) this.#history.shift();
  }

  /** Shows new values, at most ten times a second. */
  paint(now) {
    if (!this.#isChanged || now - this.#paintTime < 100) return;
    this.#isChanged = false;
    this.#paintTime = now;
    const { columns, rows, width, height: lines } = this.#facts, regionCount = columns * rows, rawBytes = width * lines, history = this.#history;
    const newest = history.at(-1);
    const recent = history.filter(entry => entry.now > newest.now - 2000);
    const seconds = (newest.now - recent[0].now) / 1000;
    setText("number", newest.number);
    setText("rate", seconds > 0 ? ((recent.length - 1) / seconds).toFixed(0) : "–");
    setText("cost", (recent.reduce((sum, entry) => sum + entry.cost, 0) / recent.length).toFixed(1));
    setText("active", percent(newest.active / regionCount));
    setText("share", percent(newest.bits / 8 / rawBytes));
    this.#headline.show(rawBytes);
    const share = name => history.map(entry => entry[name] / regionCount);
    this.#regions.show([share("trs"), share("srs"), share("active")]);
    this.#bytes.show([history.map(entry => height(entry.events * PIXEL_EVENT_BYTES / rawBytes)), history.map(entry => height(entry.bits / 8 / rawBytes))]);
    this.#totals(rawBytes);
  }

  #totals(frame) {
    const { frames, us, camera, pixels } = this.#sums, raw = frames * frame;
    const row = (name, count) => make("tr", {}, make("th", { scope: "row", textContent: name }),
      ...[bytes(count), percent(count / raw), bytes(count / us * 1e6)].map(textContent => make("td", { textContent })));
    byId("totals").replaceChildren(row("raw video", raw), row("pixel events", pixels), row("region camera", camera));
  }

  /** The sums, for tests. */
  get sums() { return { ...this.#sums }; }
}

/** Returns the height of a share of raw video in the chart of bytes. */
function height(share) {
  const power = Math.log10(Math.max(share, 1e-9));
  return Math.min(Math.max((power - MIN_POWER) / (MAX_POWER - MIN_POWER), 0), 1);
}
