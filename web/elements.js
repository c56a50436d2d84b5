// SPDX-License-Identifier: MIT OR Apache-2.0
// Finds elements of the page by id, and makes new ones.

export const byId = id => document.getElementById(id);

/** Makes an element with properties and children. */
export function make(name, properties = {}, ...children) {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
}

/** Returns a message without the backticks around names, which are for terminals. */
export const withoutBackticks = text => String(text).replaceAll("`", "");

/** Sets a text, if it has changed. */
export function setText(id, text) {
  const element = byId(id), newText = withoutBackticks(text);
  if (element.textContent !== newText) element.textContent = newText;
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

/** Offers a Blob as a download. */
export function download(name, blob) {
  const link = URL.createObjectURL(blob);
  make("a", { href: link, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(link), 10_000);
}

/** Copies a text, and reports that in an element. */
export async function copy(text, name, id = "copied") {
  try {
    await navigator.clipboard.writeText(text);
    setText(id, `${name} is in the clipboard`);
  } catch {
    // Without permission for the clipboard, only the older command remains.
    const area = make("textarea", { value: text });
    document.body.append(area);
    area.select();
    const isCopied = document.execCommand("copy");
    area.remove();
    setText(id, isCopied ? `${name} is in the clipboard` : `the browser refuses its clipboard; ${name} is: ${text}`);
  }
}
