// The WebSocket: wishes out, frames in. Never more than one wish is under way; of those made meanwhile only the newest is.
// It leaves as soon as the frame before is here, so that the next is drawn while this one is decoded.

const AGAIN_MS = [500, 1000, 2000, 4000]; // after the connection is lost, and each time that it could not be made again

export class Connection extends EventTarget {
  #socket = null;
  #tries = 0; // that failed, one after the other
  #number = 0;
  #waiting = null; // the newest wish that has not been sent
  #underway = null; // {number, asked, wish}: sent, its frame not yet here
  #landed = new Set(); // numbers of frames that are here and not yet shown: two at most
  #last = null; // the last wish, to be made again by a new connection

  constructor() {
    super();
    this.#open();
  }

  // `wish` is {settings, view, moving}; `asked` the time stamp of the input that made it (performance.now's clock).
  wish(wish, asked = performance.now()) {
    // a wish that waits keeps its time: latency counts from the first input that the picture answers
    this.#waiting = { wish, asked: this.#waiting?.asked ?? asked };
    this.#last = wish;
    this.#send();
  }

  // The frame of the wish `number` is on the screen, or will never be.
  shown(number) {
    this.#landed.delete(number);
    this.#send();
  }

  get isOpen() {
    return this.#socket.readyState === WebSocket.OPEN;
  }

  #open() {
    const address = new URL("socket", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    address.hash = "";
    this.#socket = new WebSocket(address);
    this.#socket.binaryType = "arraybuffer";
    this.#socket.onopen = () => {
      this.#tries = 0;
      this.#underway = null;
      if (!this.#waiting && this.#last) this.#waiting = { wish: { ...this.#last, moving: false }, asked: performance.now() };
      this.#tell("open");
      this.#send();
    };
    this.#socket.onmessage = ({ data }) => this.#receive(data);
    this.#socket.onclose = () => {
      this.#tell("lost", { tries: this.#tries });
      setTimeout(() => this.#open(), AGAIN_MS[Math.min(this.#tries++, AGAIN_MS.length - 1)]);
    };
  }

  #send() {
    if (!this.isOpen || this.#underway || this.#landed.size > 1 || !this.#waiting) return;
    const { wish, asked } = this.#waiting;
    this.#waiting = null;
    this.#underway = { number: ++this.#number, asked, wish };
    this.#socket.send(JSON.stringify({ number: this.#number, ...wish }));
  }

  #receive(data) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      this.#tell("message", message);
      if (message.number === undefined || message.number !== this.#underway?.number) return;
      this.#underway = null; // there will be no frame of it
      this.#send();
      return;
    }
    const length = new DataView(data).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    if (header.number !== this.#underway?.number) return;
    const { asked, wish } = this.#underway;
    this.#underway = null;
    this.#landed.add(header.number);
    this.#send();
    const image = new Blob([new Uint8Array(data, 4 + length)], { type: header.type });
    this.#tell("frame", { header, image, asked, wish });
  }

  #tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }
}
