// What a control is for, at the foot of the panel: for the one under the pointer, else the one that has the focus. The same
// words describe the control to a screen reader (aria-describedby).

const GENERAL =
  "Point at a name to read what it does. Arrow keys step, with Shift ten times as far; a double-click on a name or slider resets.";

export function start() {
  const hint = document.getElementById("hint");
  const panel = document.getElementById("panel");
  let pointed = null;

  const tipOf = (element) => element?.closest?.("#panel .control")?.querySelector(".tip")?.textContent;
  const show = () => {
    const tip = tipOf(pointed) ?? tipOf(document.activeElement);
    hint.textContent = tip ?? GENERAL;
    hint.classList.toggle("general", !tip);
  };

  panel.addEventListener("pointerover", ({ target }) => {
    pointed = target;
    show();
  });
  panel.addEventListener("pointerleave", () => {
    pointed = null;
    show();
  });
  panel.addEventListener("focusin", show);
  panel.addEventListener("focusout", show);
  show();
}
