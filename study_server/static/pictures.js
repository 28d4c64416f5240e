// A picture is fetched by the hash in its name, measured, hashed and decoded before anybody sees it.
import { sha256 } from "/static/sha256.js";

export class Damaged extends Error {}

const FIRST_BYTE_MS = 15_000;
const STALLED_MS = 5_000; // between two pieces of a picture; however slowly they come, it is waited for
const IDLE_MS = 1_000; // a picture that is due waits for one under way only if a piece of it came this lately

const fetched = new Map(); // url -> {image: promise of a decoded <img>, transfer}

// The decoded picture of `facts` {url, sha256, bytes, width, height}; asked for once until that fails.
export function picture(facts) {
  if (!fetched.has(facts.url)) {
    const transfer = new Transfer();
    const image = load(facts, "default", transfer).catch(() => load(facts, "reload", transfer)); // past a damaged cache
    fetched.set(facts.url, { image, transfer });
    image.catch(() => fetched.delete(facts.url));
  }
  return fetched.get(facts.url).image;
}

// The same for a picture that somebody waits for: a transfer that was begun beforehand and stands still is begun anew.
export function duePicture(facts) {
  if (!fetched.has(facts.url)) return picture(facts);
  fetched.get(facts.url).transfer.hurry();
  return picture(facts).catch(() => picture(facts)); // what failed was begun for another moment
}

// Forget all but these urls: a long study would fill the memory.
export function keepOnly(urls) {
  for (const url of fetched.keys()) if (!urls.has(url)) forget(url);
}

function forget(url) {
  fetched.get(url).image.then((image) => URL.revokeObjectURL(image.src), () => {});
  fetched.delete(url);
}

// Ends a fetch of which nothing comes any more.
class Transfer {
  #abort = new AbortController();
  #latest = performance.now();
  #timer;

  begin() {
    this.#abort = new AbortController();
    this.progress(FIRST_BYTE_MS);
    return this.#abort.signal;
  }

  progress(patience = STALLED_MS) {
    clearTimeout(this.#timer);
    this.#latest = performance.now();
    this.#timer = setTimeout(() => this.#abort.abort(), patience);
  }

  hurry() {
    if (performance.now() - this.#latest > IDLE_MS) this.#abort.abort();
  }

  end() {
    clearTimeout(this.#timer);
  }
}

async function load(facts, cache, transfer) {
  const data = await bytes(facts, cache, transfer);
  const hash = await sha256(data);
  if (hash !== facts.sha256) throw new Damaged(`SHA-256 is ${hash}`);
  const image = new Image();
  image.src = URL.createObjectURL(new Blob([data], { type: "image/png" }));
  await image.decode();
  if (image.naturalWidth !== facts.width || image.naturalHeight !== facts.height) throw new Damaged("wrong size");
  image.dataset.sha256 = hash;
  return image;
}

async function bytes(facts, cache, transfer) {
  try {
    const response = await fetch(facts.url, { cache, signal: transfer.begin() });
    if (!response.ok) throw new Damaged(`status ${response.status}`);
    const data = new Uint8Array(facts.bytes);
    let length = 0;
    for (const reader = response.body.getReader(); ; ) {
      const { done, value } = await reader.read();
      if (done) break;
      transfer.progress();
      if (length + value.length > facts.bytes) throw new Damaged(`more than ${facts.bytes} bytes`);
      data.set(value, length);
      length += value.length;
    }
    if (length !== facts.bytes) throw new Damaged(`${length} bytes instead of ${facts.bytes}`);
    return data.buffer;
  } finally {
    transfer.end();
  }
}
