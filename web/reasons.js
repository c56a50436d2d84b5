// SPDX-License-Identifier: MIT OR Apache-2.0
// Shows why a region was sent or not: the explanation of the model, in words and in small pictures of its pixels.

import { make } from "./elements.js";

/** The side of a small picture in pixels. */
const SIDE = 128;

/** Shows an explanation { json, text } of the engine. */
export function showReasons(place, { json, text }) {
  const open = place.querySelector("details")?.open ?? false;
  const { region, rule, trs } = json, ofClass = json.class ? `, class ${json.class}` : "";
  const words = [...json.spatial.map(feature), relevance(json), change(json),
    `${trs ? "Changed" : "Unchanged"} (TRS is ${Number(trs)}).`, ...summary(json)];
  const inside = `pixels ${region.x0} to ${region.x0 + region.size - 1} by ${region.y0} to ${region.y0 + region.size - 1}`;
  place.replaceChildren(
    make("p", {}, make("strong", { textContent: `Region ${region.x},${region.y}` }), ` of ${region.columns} x ${region.rows}, ${inside}${ofClass}, frame ${json.frame}.`),
    make("p", {}, make("strong", { textContent: sentence(rule) })),
    make("ul", {}, ...words.map(textContent => make("li", { textContent }))),
    make("div", { className: "grids" }, ...grids(json)),
    make("details", { open }, make("summary", { textContent: "As foveate explain prints it" }), make("pre", { textContent: text, tabIndex: 0 })));
}

const sentence = text => `${text.replace(/^TRS any, SRS 0: |^TRS \d, SRS \d: /, "").replace(/^./, letter => letter.toUpperCase())}.`;

function feature({ feature, level, mean, mean_fraction_bits, parts, displacements, displacement, score, min_score, unit, vote }) {
  const perPixel = value => unit > 1 ? `${(value / unit).toFixed(2)} per pixel` : value;
  let title = `${feature}: ${perPixel(score)}`;
  if (parts) {
    const grey = Number((mean / 2 ** mean_fraction_bits).toFixed(2));
    title = `${feature}: ${parts.count_above} pixels above and ${parts.count_below} below the mean ${grey} by more than ${level}`;
  } else if (displacements) {
    const { right, below, below_right, below_left } = displacements;
    title += `, the smallest of ${[right, below, below_right, below_left].map(perPixel).join(", ")}`;
  } else if (displacement) {
    title += `, ${movement(displacement)}`;
  } else if (level !== undefined) title = `${feature}: ${score} pixels above level ${level}`;
  return `${title}; ${perPixel(min_score)} needed: ${vote ? "votes" : "does not vote"}.`;
}

/** Says whether a region is relevant, and what decides that: its class or its votes. */
function relevance({ srs, combine, class: name }) {
  const votes = combine === "any" ? "one vote is enough" : "all votes are needed";
  const ofClass = new Map([["keen", `${votes}, at the thresholds of the class keen`],
    ...["off", "always"].map(own => [own, `the class ${own} decides, whatever the votes are`])]);
  return `${srs ? "Relevant" : "Not relevant"} (SRS is ${Number(srs)}): ${ofClass.get(name) ?? votes}.`;
}

/** Says by how much the content of a region has moved, and the mean errors without and with the movement. */
function movement({ dx, dy, differences }) {
  if (!differences) return "with nothing to compare with yet";
  const part = (shift, unit, [back, forth]) => shift ? [`${Math.abs(shift)} ${unit}${Math.abs(shift) > 1 ? "s" : ""} ${shift < 0 ? back : forth}`] : [];
  const parts = [...part(dx, "column", ["to the left", "to the right"]), ...part(dy, "row", ["up", "down"])];
  const error = ({ sum, pixels }) => (sum / pixels).toFixed(2), still = error(differences.still);
  return parts.length ? `because the content has moved by ${parts.join(" and ")}: mean error ${still} as it stands, ${error(differences.displaced)} moved`
    : `because the content has not moved: mean error ${still}`;
}

function change({ temporal: { against, reference, level, count, min_count } }) {
  if (!reference) return `Nothing to compare with yet (${against}): every pixel counts as changed.`;
  return `${count} pixels differ by more than ${level} from ${against === "previous" ? "the previous frame" : "what was sent last"}; ${min_count} needed.`;
}

function summary({ summary: means }) {
  if (!means) return [];
  const list = rows => rows.flat().join(", ");
  const shown = means.shown ? `the screen showed ${list(means.shown)}` : "the screen showed none";
  return [`Means ${list(means.means)}; ${shown}; sent again above ${means.level}.`];
}

function grids(json) {
  const maxValue = 2 ** json.pixel_bits - 1, { temporal } = json;
  const pictures = [grid("pixels", json.raw, maxValue)];
  if (json.filter !== "none") pictures.push(grid(`after ${json.filter}`, json.denoised, maxValue));
  for (const { feature, hits, parts } of json.spatial) {
    if (hits) pictures.push(grid(`${feature}: what counts`, json.denoised, maxValue, hits, "--k5"));
    for (const side of ["above", "below"])
      if (parts) pictures.push(grid(`${feature}: ${side} the mean`, json.denoised, maxValue, parts[side], "--k5"));
  }
  if (temporal.reference) pictures.push(grid(`reference, ${temporal.against}: what changed`, temporal.reference, maxValue, temporal.hits, "--k6"));
  return pictures;
}

/** Makes a picture of pixels in which hits are marked. */
function grid(title, rows, maxValue, hits, colour) {
  const count = rows.length, cell = Math.max(1, Math.floor(SIDE / count));
  const canvas = make("canvas", { width: cell * count, height: cell * count });
  const context = canvas.getContext("2d");
  const mark = colour && getComputedStyle(document.documentElement).getPropertyValue(colour).trim();
  for (const [y, row] of rows.entries())
    for (const [x, value] of row.entries()) {
      const grey = Math.round(255 * value / maxValue);
      context.fillStyle = `rgb(${grey},${grey},${grey})`;
      context.fillRect(x * cell, y * cell, cell, cell);
      if (!hits?.[y][x]) continue;
      context.fillStyle = mark;
      context.globalAlpha = 0.8;
      context.fillRect(x * cell + (cell >> 3), y * cell + (cell >> 3), Math.max(1, cell - (cell >> 2)), Math.max(1, cell - (cell >> 2)));
      context.globalAlpha = 1;
    }
  const counted = hits ? `, ${hits.flat().filter(Boolean).length} of ${count * count} marked` : "";
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${title}, ${count} by ${count} pixels${counted}`);
  return make("figure", {}, make("figcaption", { textContent: title }), canvas);
}
