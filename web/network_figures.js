// SPDX-License-Identifier: MIT OR Apache-2.0
// The results of a network: those of the last frame, and sums since the beginning.

import { byId, make, percent, setText } from "./elements.js";

/** The number of results over which means are shown. */
const RECENT = 20;

export class NetworkFigures {
  #sums; #recent; #shownTime = 0;

  constructor() { this.reset(); }

  /** Resets the figures. */
  reset() {
    this.#sums = { frames: 0, whole: 0, kept: 0, seen: 0, added: 0, same: 0, agreement: 0 };
    this.#recent = [];
    byId("network-figures").replaceChildren();
    setText("network-now", "");
  }

  /** Adds the results for a frame and for the receiver's screen, and their time in ms. */
  add({ found, classes, agreement }, ms, now) {
    const sums = this.#sums;
    sums.frames++;
    for (const key of ["whole", "kept", "seen", "added"]) sums[key] += found?.[key] ?? 0;
    sums.same += classes?.same_share ?? 0;
    sums.agreement += agreement;
    this.#recent = [...this.#recent.slice(1 - RECENT), { ms, now }];
  }

  /** Shows the results of the last frame, which is `before` frames older than the shown one. */
  show(result, before) {
    const age = before === 0 ? "the frame shown" : `${before} frame${before === 1 ? "" : "s"} before the one shown`;
    setText("network-now", `Frame ${result.number}, ${age}: ${describeResult(result)}.`);
    byId("network-now").classList.toggle("quiet", before > 0);
    if (this.#shownTime === this.#recent.at(-1)?.now) return;
    this.#shownTime = this.#recent.at(-1)?.now;
    byId("network-figures").replaceChildren(...[...this.#counts(result), ...this.#speed()].map(([name, value]) =>
      make("div", {}, make("dt", { textContent: name }), make("dd", { textContent: value }))));
  }

  #counts({ found, classes }) {
    const { frames, whole, kept, added, same, agreement } = this.#sums;
    const share = (part, all) => all ? `${part} (${percent(part / all)})` : part;
    if (found) return [["found in whole frames", whole], ["of these kept", share(kept, whole)], ["added", added], ["frames compared", frames]];
    if (classes) return [["same class", share(Math.round(same), frames)], ["frames compared", frames]];
    return [["agreement", percent(agreement / frames)], ["frames compared", frames]];
  }

  #speed() {
    const recent = this.#recent, mean = recent.reduce((sum, { ms }) => sum + ms, 0) / recent.length;
    const seconds = (recent.at(-1).now - recent[0].now) / 1000;
    return [["compared per second", seconds > 0 ? ((recent.length - 1) / seconds).toFixed(1) : "–"], ["ms per picture", (mean / 2).toFixed(1)]];
  }

  /** The sums, for tests. */
  get sums() { return { ...this.#sums }; }
}

/** Describes the results for a frame. */
function describeResult({ found, classes, class: both, same_places, agreement, relative_rms }) {
  if (found) return `${found.whole} found, ${found.kept} kept, ${found.whole - found.kept} lost, ${found.added} added`;
  const margin = value => value?.toPrecision(3) ?? "no number";
  if (classes) return `class ${both[0]}, by ${margin(classes.whole_margin)}; to the receiver class ${both[1]}, class ${both[0]} ${classes.seen_margin < 0 ? "behind" : "ahead"} by ${margin(classes.seen_margin && Math.abs(classes.seen_margin))}`;
  if (same_places !== null) return `the same class at ${percent(same_places)} of the places`;
  return `outputs agree by ${percent(agreement)}, relative RMS error ${relative_rms?.toPrecision(3) ?? "not a number"}`;
}
