// SPDX-License-Identifier: MIT OR Apache-2.0
// The page's side of the thread in which a network runs (network_worker.js): it sends questions, and waits for the answer to each.

const FAULT = "the network stopped its engine; most likely it takes more memory than a page has, 4 GiB. Take a smaller network, or a smaller size";

export class NetworkThread {
  #worker; #link; #waiting = new Map(); #count = 0;

  /** `text` is the script of the thread. */
  constructor(text) {
    this.#link = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    this.#worker = new Worker(this.#link);
    this.#worker.onmessage = ({ data: { id, refused, fault, ...answer } }) => {
      const { done, refuse } = this.#waiting.get(id);
      this.#waiting.delete(id);
      if (refused !== undefined) refuse(new Error(fault ? FAULT : refused)); else done(answer);
    };
    this.#worker.onerror = event => {
      event.preventDefault();
      for (const { refuse } of this.#waiting.values()) refuse(new Error(`the network's thread does not start (${event.message || "refused by the browser"})`));
      this.#waiting.clear();
    };
  }

  /** Asks the thread, and returns its answer. Buffers of `given` are transferred to the thread. */
  ask(kind, asked, given = []) {
    const id = this.#count++;
    return new Promise((done, refuse) => {
      this.#waiting.set(id, { done, refuse });
      this.#worker.postMessage({ id, kind, ...asked }, given);
    });
  }

  /** Ends the thread; open questions are never answered. */
  end() {
    this.#worker.terminate();
    URL.revokeObjectURL(this.#link);
  }
}
