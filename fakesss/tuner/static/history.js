// Undo and redo, by button and by key.

const TYPED = "input:not([type]), input[type=text], input[type=number], input[type=search], textarea, select, [contenteditable]";

export function start({ settings }) {
  const undo = document.getElementById("undo");
  const redo = document.getElementById("redo");
  const show = () => {
    undo.disabled = !settings.canUndo;
    redo.disabled = !settings.canRedo;
  };
  undo.addEventListener("click", () => settings.undo());
  redo.addEventListener("click", () => settings.redo());
  addEventListener("keydown", (event) => {
    const key = event.key?.toLowerCase(); // what a browser fills in by itself has none
    if (!(event.ctrlKey || event.metaKey) || event.altKey || !["z", "y"].includes(key) || isTyping(event)) return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) settings.redo();
    else settings.undo();
  });
  settings.addEventListener("change", show);
  show();
}

// Whether a key belongs to the field that has the focus (text has an undo of its own, letters choose in a list), or a
// dialog is open.
export function isTyping({ target }) {
  return (target instanceof Element && target.matches(TYPED)) || document.querySelector("dialog[open]") !== null;
}
