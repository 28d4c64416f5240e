// A rectangle that is made as large as a bank card held to the screen.
const LONG_MM = 85.6;  // ISO/IEC 7810, size ID-1
const SHORT_MM = 53.98;
const CORNER_MM = 3.18;
const LYING_FROM_PX = 560;  // in a narrower room the card stands upright, so that one of a phone's width fits

// Gives a function of what is to be sent: of the participant's word ("none": no card) or the rectangle's size.
export function card(check) {
  const slider = check.querySelector("input[type=range]");  // the long side, CSS px
  const room = check.querySelector("#room");
  const rectangle = check.querySelector("#rectangle");
  const corner = check.querySelector("#corner");
  const longest = Number(slider.max);
  let moved = false;
  let lying = true;
  let dragged = null;

  const draw = () => {
    const perMm = slider.value / LONG_MM;
    rectangle.style.width = `${(lying ? LONG_MM : SHORT_MM) * perMm}px`;
    rectangle.style.height = `${(lying ? SHORT_MM : LONG_MM) * perMm}px`;
    rectangle.style.borderRadius = `${CORNER_MM * perMm}px`;
  };
  // Never so large that the page would have to be scrolled sideways.
  const fit = () => {
    if (!room.clientWidth) return;
    lying = room.clientWidth >= LYING_FROM_PX;
    slider.max = Math.min(longest, Math.floor(lying ? room.clientWidth : (room.clientWidth * LONG_MM) / SHORT_MM));
    draw();
  };
  new ResizeObserver(fit).observe(room);
  slider.addEventListener("input", () => {
    moved = true;
    draw();
  });

  corner.addEventListener("pointerdown", (event) => {
    corner.setPointerCapture(event.pointerId);
    dragged = { x: event.clientX, long: Number(slider.value) };
  });
  corner.addEventListener("pointermove", (event) => {
    if (!dragged) return;
    slider.value = Math.round(dragged.long + (event.clientX - dragged.x) * (lying ? 1 : LONG_MM / SHORT_MM));
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  for (const end of ["pointerup", "pointercancel"]) corner.addEventListener(end, () => (dragged = null));

  return (word) => {
    const measured = !word && moved;
    return {
      card: word ?? (moved ? "measured" : "unmoved"),
      px_per_mm: measured ? (slider.value / LONG_MM).toFixed(4) : "",
    };
  };
}
