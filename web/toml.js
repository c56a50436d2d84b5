// SPDX-License-Identifier: MIT OR Apache-2.0
// Configurations as values of the engine: { frame: {...}, spatial: [{...}, ...], ... }. The engine checks keys and values.

/** Parses the value of one key in TOML, which for values of a camera is the same as in JSON. Numbers must be exact in JavaScript. */
export function valueOf(text) {
  let value = null;
  try { value = JSON.parse(text); } catch { /* The text is not a value. */ }
  const isKept = Number.isInteger(value) ? Number.isSafeInteger(value) : Number.isFinite(value) || ["boolean", "string"].includes(typeof value);
  if (isKept) return value;
  throw new Error(`\`${text}\` is not a value; write 8, true or "edge"`);
}

/** Returns a table's own value, if it has one. Every object inherits `constructor` and `__proto__`, which are not keys. */
const ownOf = (table, name) => table !== null && typeof table === "object" && Object.hasOwn(table, name) ? table[name] : undefined;

/** Sets a table's own value of any name. A plain assignment to `__proto__` would change inherited values. */
function setOwn(table, name, value) {
  if (table === null || typeof table !== "object") throw new Error(`\`${name}\` is not a key of ${JSON.stringify(table)}, which is not a table`);
  if (Array.isArray(table) && !(String(Number(name)) === name && Number(name) <= table.length))
    throw new Error(`${name} is not one of 0 to ${table.length}, by which these tables are numbered`);
  Object.defineProperty(table, name, { value, writable: true, enumerable: true, configurable: true });
}

const definedEntries = table => Object.entries(table).filter(([, value]) => value !== null && value !== undefined);

/** Returns a value as TOML in one line. */
function valueText(value) {
  if (Array.isArray(value)) return `[${value.map(valueText).join(", ")}]`;
  if (typeof value !== "object") return JSON.stringify(value);
  return `{ ${definedEntries(value).map(([key, inner]) => `${key} = ${valueText(inner)}`).join(", ")} }`;
}

/** Returns the TOML of a configuration. */
export function writeToml(config) {
  const lines = table => definedEntries(table).map(([key, value]) => `${key} = ${valueText(value)}\n`).join("");
  const tableText = ([name, value]) => Array.isArray(value)
    ? value.map(table => `[[${name}]]\n${lines(table)}`).join("\n")
    : `[${name}]\n${lines(value)}`;
  return definedEntries(config).map(tableText).join("\n");
}

/** Returns every key with its value, dotted as in overrides: `spatial.0.level`. */
export function keysOf(config) {
  const keys = new Map();
  const walk = (path, value) => {
    if (value === null || value === undefined) return;
    if (typeof value === "object") for (const [name, inner] of Object.entries(value)) walk([...path, name], inner);
    else keys.set(path.join("."), value);
  };
  walk([], config);
  return keys;
}

/** Returns the value of a dotted key, if there is one. */
export const getKey = (config, key) => key.split(".").reduce(ownOf, config);

/** Returns another configuration, in which a dotted key has this value. */
export function withKey(config, key, value) {
  const changed = structuredClone(config), path = key.split("."), last = path.pop();
  let table = changed;
  for (const [place, name] of path.entries()) {
    if (ownOf(table, name) === undefined) setOwn(table, name, /^\d+$/.test(path[place + 1] ?? "") ? [] : {});
    table = ownOf(table, name);
  }
  setOwn(table, last, value);
  return changed;
}
