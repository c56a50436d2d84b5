// SPDX-License-Identifier: MIT OR Apache-2.0
// The hardware area of the camera, from the table that scripts/figures/web_hardware.py writes with `foveate estimate`.

import { make } from "./elements.js";
import { organizationsOf } from "./organization.js";

/** The organization of the table. */
const TABLE_ORGANIZATION = "raster";
/** The regions per lane of an array that takes video row by row. */
const FOLD = 16;

/** The columns of the table that identify the camera of a row. */
function rowKey({ config }) {
  const { region, frame, denoise, spatial, temporal, render, periphery, zones } = config;
  const isInTable = !zones && frame.pixel_bits === 8 && region.neighborhood === "isolated" && spatial.length === 1 && !spatial[0].mean_fraction_bits
    && (render.payload === "denoised" || denoise.filter === "none");
  if (!isInTable) return null;
  const { irrelevant } = render;
  // Against the previous frame `hold` is built as `zero`.
  const rendering = irrelevant === "mean" ? `mean${periphery.blocks}` : temporal.reference === "previous" ? "zero" : irrelevant;
  return [region.size, spatial[0].feature, denoise.filter, temporal.reference, rendering].join();
}

/** Shows the hardware area of a camera; `features` are those of `engine.describe()`. */
export function showHardware(place, table, facts, features) {
  const [width, height] = table.frame, size = `${width}x${height}`;
  const possible = organizationsOf(facts.config, features);
  if (!possible.includes(TABLE_ORGANIZATION)) {
    showOther(place, [width, height], facts, features);
    return;
  }
  const design = table.designs.find(row => row.slice(0, 5).join() === rowKey(facts));
  const title = make("p", { textContent: `This camera as one raster core, which takes video of ${size} row by row.` });
  if (design) {
    const [lut, ff, ram, mhz, rate] = design.slice(5);
    const figures = [["LUT", lut], ["FF", ff], ["RAMB36", ram], ["MHz", mhz], ["frames/s", rate]];
    const list = figures.map(([name, value]) => make("div", {}, make("dt", { textContent: name }), make("dd", { textContent: value })));
    const note = make("p", { className: "quiet" }, make("small", { textContent: `${table.tool}; the clock is estimated from the netlist, 25 % either way. Thresholds are inputs of the core and change none of this.` }));
    place.replaceChildren(title, make("dl", {}, ...list), note);
  } else {
    const command = estimateCommand(`{organization="${TABLE_ORGANIZATION}",sync=true}`, [width, height], facts.config);
    place.replaceChildren(title, make("p", { textContent: "It is not in the table. With the copied TOML as camera.toml, this estimates it:" }), command);
  }
}

/** Says why a camera has no figures, and shows how to estimate an array whose lanes share regions. */
function showOther(place, frame, { organization, config }, features) {
  const isOther = ({ feature }) => !organizationsOf({ spatial: [{ feature }] }, features).includes(TABLE_ORGANIZATION);
  const names = config.spatial.filter(isOther).map(({ feature }) => feature).join(", ");
  const hardware = organization === "serial" ? `{organization="serial",feed="raster",fold=${FOLD}}` : `{organization="${organization}"}`;
  const title = `The figures of this page are those of a raster core, which does not compute ${names}. This camera is a ${organization} array.`;
  place.replaceChildren(make("p", { textContent: title }),
    make("p", { textContent: `With the copied TOML as camera.toml, this estimates it for video of ${frame.join("x")}, with ${FOLD} regions per lane:` }),
    estimateCommand(hardware, frame, config));
}

function estimateCommand(hardware, [width, height], { zones }) {
  // The map belongs to frames of another size, and costs nothing.
  const map = zones?.classes?.length ? ["'zones.classes=[]'"] : [];
  const keys = [`'hardware=${hardware}'`, `frame.width=${width}`, `frame.height=${height}`, ...map];
  return make("pre", { textContent: `foveate estimate --config camera.toml ${keys.map(key => `--set ${key}`).join(" ")}`, tabIndex: 0 });
}
