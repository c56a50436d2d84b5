// SPDX-License-Identifier: MIT OR Apache-2.0
// The thread of the page's network, with an engine of its own. The page asks {id, kind, ...}, one question at a time, and gets {id, ...} with
// the results, or {id, refused, fault} with a message. After a fault the thread answers no more.

import { Engine } from "./engine.js";

let engine;
const KINDS = new Map(Object.entries({
  begin: async ({ module, file }) => {
    engine = await Engine.load(module);
    engine.takeNetwork(new Uint8Array(file));
  },
  open: ({ wishes, width, height, bits }) => ({ facts: engine.openNetwork(wishes, width, height, bits) }),
  look: ({ planes }) => {
    const start = performance.now(), result = engine.look(new Uint8Array(planes));
    return { result, ms: performance.now() - start };
  },
}));

self.onmessage = async ({ data: { id, kind, ...question } }) => {
  try {
    self.postMessage({ id, ...await KINDS.get(kind)(question) });
  } catch (error) {
    self.postMessage({ id, refused: error.message, fault: error.fault ?? false });
  }
};
