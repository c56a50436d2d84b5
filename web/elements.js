// SPDX-License-Identifier: MIT OR Apache-2.0
// Finds elements of the page by id, and makes new ones.

export const at = id => document.getElementById(id);

/** Makes an element with properties and children. */
export function make(name, properties = {}, ...inside) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...inside);
  return made;
}

/** Makes nodes of a message, which has backticks around names, as in a terminal. */
export const plain = text => String(text).replaceAll("`", "");

/** Sets a text, if it has changed. */
export function say(id, text) {
  const place = at(id), now = plain(text);
  if (place.textContent !== now) place.textContent = now;
}

/** Returns the name of a file as a path that no program takes for an option. */
export const asPath = name => name.startsWith("-") ? `./${name}` : name;

/** Formats a number of bytes for people. */
export function bytes(count) {
  for (const [unit, size] of [["GB", 1e9], ["MB", 1e6], ["kB", 1e3]])
    if (count >= size) return `${(count / size).toFixed(count >= 100 * size ? 0 : 1)} ${unit}`;
  return `${Math.round(count)} B`;
}

/** Formats a share in percent. */
export const percent = share => `${(100 * share).toFixed(share < 0.1 ? 2 : share < 10 ? 1 : 0)} %`;

/** Offers a text as a download. */
export function download(name, type, text) {
  const link = URL.createObjectURL(new Blob([text], { type }));
  make("a", { href: link, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(link), 10_000);
}

/** Copies a text, and reports that in an element. */
export async function copy(text, what, id = "copied") {
  try {
    await navigator.clipboard.writeText(text);
    say(id, `${what} is in the clipboard`);
  } catch {
    // Without permission for the clipboard, the old way remains.
    const area = make("textarea", { value: text });
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    say(id, done ? `${what} is in the clipboard` : `the browser refuses its clipboard; ${what} is: ${text}`);
  }
}
