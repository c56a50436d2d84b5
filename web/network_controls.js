// SPDX-License-Identifier: MIT OR Apache-2.0
// The settings of a network, which are options of `foveate infer`. Values that the engine guesses are shown, and can be changed.

import { byId, make } from "./elements.js";

/** Common ranges of pixels, with their mean and scale. */
const RANGES = [["0 to 1", "0", "1"], ["0 to 255", "0", "1/255"], ["-1 to 1", "0.5", "0.5"], ["(x - 127) / 128", "127/255", "128/255"],
  ["as in torchvision", "0.485,0.456,0.406", "0.229,0.224,0.225"]];
const HEADS = ["yolox", "yolov5", "yolov8", "ssd", "yunet", "fastestdet"];
const option = (value, textContent) => make("option", { value, textContent });

export class NetworkControls {
  #wish; #facts = null;

  /** `wish` is called with the changed settings of {framing, mean, scale, detect}. */
  constructor(wish) {
    this.#wish = wish;
    byId("range").append(...RANGES.map(([name], place) => option(place, name)), option("", "other"));
    byId("range").onchange = ({ target: { value } }) => {
      if (value === "") return byId("mean").focus();
      const [, mean, scale] = RANGES[value];
      return wish({ mean, scale });
    };
    for (const key of ["mean", "scale"]) byId(key).onchange = ({ target: { value } }) => wish({ [key]: value.replaceAll(" ", "") || null });
    byId("framing").onchange = byId("framing-size").onchange = () => {
      const size = byId("framing-size").value.trim();
      wish({ framing: byId("framing").value + (size && `=${size}`) });
    };
    byId("detect").onchange = ({ target: { value } }) => wish({ detect: value === "likely" ? null : value === "none" ? "" : value });
    byId("score").onchange = byId("overlap").onchange = () => wish({ detect: `${this.#facts.head},score=${byId("score").value},overlap=${byId("overlap").value}` });
  }

  /** Shows the settings in use, or the requested ones if the network was refused. */
  show(facts, wishes) {
    this.#facts = facts;
    const { mean, scale, head, likely, fits } = facts ?? { ...wishes, fits: HEADS };
    const wished = wishes.detect === null ? "likely" : wishes.detect === "" ? "none" : wishes.detect.split(",")[0];
    const known = fits.includes(wished) || ["likely", "none"].includes(wished) ? fits : [wished, ...fits];
    byId("detect").replaceChildren(option("likely", facts ? `likely: ${likely ?? "none"}` : "likely"), option("none", "none"), ...known.map(name => option(name, name)));
    byId("detect").value = wished;
    const place = RANGES.findIndex(([, ...own]) => own[0] === mean && own[1] === scale);
    byId("range").value = place < 0 ? "" : place;
    byId("mean").value = mean ?? "";
    byId("scale").value = scale ?? "";
    const [way, size] = wishes.framing.split("=");
    byId("framing").value = way;
    byId("framing-size").value = size ?? "";
    for (const key of ["score", "overlap"]) {
      byId(key).disabled = !head;
      byId(key).value = head ? Number(facts[key].toFixed(3)) : "";
    }
  }
}
