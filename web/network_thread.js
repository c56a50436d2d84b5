// SPDX-License-Identifier: MIT OR Apache-2.0
// The page's side of the thread in which a network runs (network_worker.js): it sends questions, and waits for the answer to each.

const FAULT = "the network stopped its engine; most likely it takes more memory than a page has, 4 GiB. Take a smaller network, or a smaller size";

const BLOCKED = "the browser starts no thread for the network; allow workers for this page, or open it by `foveate live`";

export class NetworkThread {
  #worker; #link; #pending = new Map(); #count = 0;

  /** `text` is the script of the thread. */
  constructor(text) {
    this.#link = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    try {
      this.#worker = new Worker(this.#link);
    } catch (error) {
      throw new Error(`${BLOCKED} (${error.message})`);
    }
    this.#worker.onmessage = ({ data: { id, refused, fault, ...answer } }) => {
      const { resolve, reject } = this.#pending.get(id);
      this.#pending.delete(id);
      if (refused !== undefined) reject(new Error(fault ? FAULT : refused)); else resolve(answer);
    };
    this.#worker.onerror = event => {
      event.preventDefault();
      for (const { reject } of this.#pending.values()) reject(new Error(`the network's thread does not start (${event.message || "refused by the browser"})`));
      this.#pending.clear();
    };
  }

  /** Asks the thread, and returns its answer. Buffers of `transferred` are moved to the thread. */
  ask(kind, question, transferred = []) {
    const id = this.#count++;
    return new Promise((resolve, reject) => {
      this.#pending.set(id, { resolve, reject });
      this.#worker.postMessage({ id, kind, ...question }, transferred);
    });
  }

  /** Ends the thread; open questions are never answered. */
  end() {
    this.#worker.terminate();
    URL.revokeObjectURL(this.#link);
  }
}
