// SPDX-License-Identifier: MIT OR Apache-2.0
// Reads the engine that the page holds as a text: the compressed foveate.wasm in base 85 (crates/boards/src/view/frame_player.rs).

const DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%()*+-.:;=?@[]^_{|}~";

/** Returns the bytes of a text in base 85, or nothing if it is none. Five digits are four bytes, and n + 1 digits at the end are n bytes. */
function bytesOfBase85(text) {
  const values = new Int16Array(128).fill(-1);
  for (const [value, digit] of [...DIGITS].entries()) values[digit.charCodeAt(0)] = value;
  const bytes = new Uint8Array(Math.ceil(text.length / 5) * 4), view = new DataView(bytes.buffer);
  for (let start = 0; start < text.length; start += 5) {
    let word = 0;
    for (let place = start; place < start + 5; place++) {
      const value = place < text.length ? values[text.charCodeAt(place)] ?? -1 : DIGITS.length - 1;
      if (value < 0) return undefined;
      word = 85 * word + value;
    }
    view.setUint32(start / 5 * 4, word);
  }
  return bytes.subarray(0, Math.floor(text.length * 4 / 5));
}

/** Returns the bytes of foveate.wasm. */
export async function engineOfText(text) {
  const damaged = reason => new Error(`the engine in this page is damaged (${reason}); fetch or write the page again`);
  const compressed = bytesOfBase85(text.trim());
  if (!("DecompressionStream" in globalThis)) throw new Error("this browser cannot unpack the engine; use a browser of 2023 or later");
  if (!compressed) throw damaged("a character is not of base 85");
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("gzip"));
  try {
    return await new Response(stream).arrayBuffer();
  } catch (error) {
    throw damaged(error.message);
  }
}
