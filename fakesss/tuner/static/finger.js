// A finger that comes down on a slider may have come to scroll the page: nothing changes until it has moved sideways or is
// lifted again. If the page scrolls, the browser takes the pointer away.

const SLOP_PX = 6; // a finger trembles by less

// `take` gets a place on the slider, `leave` has it shown where it was, `settle` ends the gesture.
export function slide(slider, { take, leave, settle }) {
  let from = null; // where a finger came down of which it is not yet clear what it does
  let offered = null;

  const decide = () => {
    from = null;
    if (offered !== null) take(offered);
  };
  slider.addEventListener("pointerdown", ({ pointerType, clientX }) => {
    from = pointerType === "mouse" ? null : clientX;
    offered = null;
  });
  slider.addEventListener("input", () => {
    offered = slider.valueAsNumber;
    if (from === null) take(offered);
    else leave();
  });
  slider.addEventListener("pointermove", ({ clientX }) => {
    if (from !== null && Math.abs(clientX - from) > SLOP_PX) decide();
  });
  slider.addEventListener("pointerup", () => {
    if (from === null) return;
    decide();
    settle();
  });
  slider.addEventListener("pointercancel", () => {
    from = null;
    settle();
  });
  slider.addEventListener("change", settle);
}
