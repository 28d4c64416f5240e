// SHA-256 as lower-case hex. Browsers offer crypto.subtle only on HTTPS and localhost; in a laboratory's plain HTTP
// network the same function is computed here (FIPS 180-4, sections 4.1.2, 5.3.3 and 6.2), so the check always happens.

export async function sha256(buffer) {
  const digest = crypto.subtle ? await crypto.subtle.digest("SHA-256", buffer) : await plainSha256(buffer);
  return Array.from(new Uint8Array(digest), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

const SLICE = 1 << 17; // bytes
const PRIMES = firstPrimes(64);
const K = Uint32Array.from(PRIMES, (prime) => fraction(Math.cbrt(prime)));  // 4.2.2
const H0 = Uint32Array.from(PRIMES.slice(0, 8), (prime) => fraction(Math.sqrt(prime)));  // 5.3.3

// The digest of an ArrayBuffer, without the browser's help; in slices of a few milliseconds, between which keys are heard.
export async function plainSha256(buffer) {
  const state = H0.slice();
  const words = new Uint32Array(64);
  const blocks = new DataView(padded(buffer).buffer);
  for (let at = 0; at < blocks.byteLength; at += 64) {
    compress(state, words, blocks, at);
    if (at % SLICE === SLICE - 64) await new Promise((resolve) => setTimeout(resolve));
  }
  const digest = new DataView(new ArrayBuffer(32));
  state.forEach((word, i) => digest.setUint32(4 * i, word));
  return digest.buffer;
}

function padded(buffer) {  // 5.1.1
  const length = buffer.byteLength;
  const bytes = new Uint8Array(Math.ceil((length + 9) / 64) * 64);
  bytes.set(new Uint8Array(buffer));
  bytes[length] = 0x80;
  new DataView(bytes.buffer).setBigUint64(bytes.length - 8, BigInt(length) * 8n);
  return bytes;
}

function compress(state, w, blocks, at) {  // 6.2.2
  for (let t = 0; t < 16; t++) w[t] = blocks.getUint32(at + 4 * t);
  for (let t = 16; t < 64; t++) {
    const s0 = rotr(w[t - 15], 7) ^ rotr(w[t - 15], 18) ^ (w[t - 15] >>> 3);
    const s1 = rotr(w[t - 2], 17) ^ rotr(w[t - 2], 19) ^ (w[t - 2] >>> 10);
    w[t] = w[t - 16] + s0 + w[t - 7] + s1;
  }
  let [a, b, c, d, e, f, g, h] = state;
  for (let t = 0; t < 64; t++) {
    const t1 = (h + (rotr(e, 6) ^ rotr(e, 11) ^ rotr(e, 25)) + ((e & f) ^ (~e & g)) + K[t] + w[t]) | 0;
    const t2 = ((rotr(a, 2) ^ rotr(a, 13) ^ rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) | 0;
    [h, g, f, e, d, c, b, a] = [g, f, e, (d + t1) | 0, c, b, a, (t1 + t2) | 0];
  }
  [a, b, c, d, e, f, g, h].forEach((word, i) => (state[i] += word));
}

function rotr(word, n) {
  return (word >>> n) | (word << (32 - n));
}

function fraction(x) {  // the first 32 bits after the point
  return Math.floor((x - Math.floor(x)) * 2 ** 32);
}

function firstPrimes(n) {
  const primes = [];
  for (let i = 2; primes.length < n; i++) if (primes.every((prime) => i % prime)) primes.push(i);
  return primes;
}
