// SPDX-License-Identifier: MIT OR Apache-2.0
// Configurations as values: { frame: {...}, spatial: [{...}, ...], ... }, as the engine gives them. What a key may be is the
// engine's business.

/** The value of one key in TOML; of what a camera has, that is the same as in JSON. */
export function valueOf(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new Error(`\`${text}\` is no value; write 8, true or "edge"`);
  }
}

/** The TOML of a configuration. */
export function writeToml(config) {
  const given = table => Object.entries(table).filter(([, value]) => value !== null && value !== undefined);
  const lines = table => given(table).map(([key, value]) => `${key} = ${JSON.stringify(value)}\n`).join("");
  const part = ([name, value]) => Array.isArray(value)
    ? value.map(table => `[[${name}]]\n${lines(table)}`).join("\n")
    : `[${name}]\n${lines(value)}`;
  return given(config).map(part).join("\n");
}

/** Every key with its value, dotted as overrides name them: `spatial.0.level`. */
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

/** The value of a dotted key, if there is one. */
export const getKey = (config, key) => key.split(".").reduce((table, name) => table?.[name], config);

/** Another configuration, in which a dotted key has this value. */
export function withKey(config, key, value) {
  const made = structuredClone(config), path = key.split("."), last = path.pop();
  let table = made;
  for (const [place, name] of path.entries()) table = table[name] ??= /^\d+$/.test(path[place + 1] ?? "") ? [] : {};
  table[last] = value;
  return made;
}
