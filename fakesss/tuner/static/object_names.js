// What an object is called: a file by its name, one that was brought to this tuner by the name that it came with.

const BROUGHT = new Map(); // scene path -> name; the path itself holds a hash of the content
const HASHED = /^([0-9a-f]{8})[0-9a-f]{56}(?=\.)/; // one of an earlier tuner, whose name nobody knows any more

export function learn(object, name) {
  BROUGHT.set(object, name);
}

export function titled(object) {
  return BROUGHT.get(object) ?? object.split(/[\\/]/).at(-1).replace(HASHED, "$1…");
}
