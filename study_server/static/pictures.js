// A picture is fetched by the hash in its name, measured, hashed and decoded before anybody sees it.
import { sha256 } from "/static/sha256.js";

export class Damaged extends Error {}

const fetched = new Map();  // url -> promise of a decoded <img>

// The decoded picture of `facts` {url, sha256, bytes}; the same promise for the same url until it fails.
export function picture(facts) {
  if (!fetched.has(facts.url)) {
    const coming = load(facts, "default").catch(() => load(facts, "reload"));  // a damaged cached copy is fetched anew
    fetched.set(facts.url, coming);
    coming.catch(() => fetched.delete(facts.url));
  }
  return fetched.get(facts.url);
}

async function load(facts, cache) {
  const response = await fetch(facts.url, { cache, signal: AbortSignal.timeout(60_000) });
  if (!response.ok) throw new Damaged(`status ${response.status}`);
  const data = await response.arrayBuffer();
  if (data.byteLength !== facts.bytes) throw new Damaged(`${data.byteLength} bytes instead of ${facts.bytes}`);
  const hash = await sha256(data);
  if (hash !== facts.sha256) throw new Damaged(`SHA-256 is ${hash}`);
  const image = new Image();
  image.alt = "The picture to judge";
  image.src = URL.createObjectURL(new Blob([data], { type: "image/png" }));
  await image.decode();
  if (image.naturalWidth !== facts.width || image.naturalHeight !== facts.height) throw new Damaged("wrong size");
  image.dataset.sha256 = hash;
  return image;
}
