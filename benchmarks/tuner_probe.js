// Put into the tuner's page before its own scripts: when inputs happened, wishes left, frames came and were on the canvas.
// The page knows nothing of it, so its own book-keeping is not believed. Times are performance.now's milliseconds.

(() => {
  const probe = { inputs: [], sent: [], frames: [], ends: [] };
  window.probe = probe;

  for (const kind of ["pointermove", "wheel", "keydown"]) {
    addEventListener(kind, (event) => probe.inputs.push({ at: first(event), heard: performance.now() }), { capture: true, passive: true });
  }
  addEventListener("pointerup", ({ timeStamp }) => probe.ends.push(timeStamp), { capture: true });

  // of several movements that the browser reports at once the first: it has waited longest
  function first(event) {
    return event.getCoalescedEvents?.()[0]?.timeStamp ?? event.timeStamp;
  }

  window.WebSocket = class extends WebSocket {
    constructor(...address) {
      super(...address);
      this.addEventListener("message", ({ data }) => typeof data === "string" || came(data)); // before the page's own
    }

    send(text) {
      const { number, moving } = JSON.parse(text);
      probe.sent.push({ number, moving, at: performance.now() });
      super.send(text);
    }
  };

  function came(data) {
    const at = performance.now();
    const length = new DataView(data).getUint32(0, true);
    const { number, moving, times, width, height, stand_in } = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    probe.frames.push({ number, moving, times, width, height, stand_in, bytes: data.byteLength, came: at, shown: null });
  }

  const draw = CanvasRenderingContext2D.prototype.drawImage;
  CanvasRenderingContext2D.prototype.drawImage = function (...given) {
    draw.apply(this, given);
    // the next may be here while this one is decoded
    const frame = this.canvas.id === "picture" && probe.frames.find(({ shown }) => shown === null);
    if (frame) frame.shown = performance.now();
  };
})();
