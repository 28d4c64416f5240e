// Undo and redo, by button and by key.
import { differing, inWords } from "./differing.js";
import { setPressable } from "./pressable.js";

const TYPED = "input:not([type]), input[type=text], input[type=number], input[type=search], textarea, select";

let touched = null; // the field whose text was changed by hand and not taken since, and what stood there before

export function start({ settings }) {
  const undo = document.getElementById("undo");
  const redo = document.getElementById("redo");
  const show = () => {
    setPressable(undo, settings.canUndo);
    setPressable(redo, settings.canRedo);
  };
  undo.addEventListener("click", () => back(settings));
  redo.addEventListener("click", () => forth(settings));
  addEventListener("keydown", (event) => {
    const key = event.key?.toLowerCase(); // what a browser fills in by itself has none
    if (!(event.ctrlKey || event.metaKey) || event.altKey || !["z", "y"].includes(key) || hasUndo(event.target)) return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) forth(settings);
    else back(settings);
  });
  settings.addEventListener("change", show);
  show();
  watchTyping();
}

// Whether a letter or digit belongs to the field that has the focus (letters choose in a list), or a dialog is open.
export function isTyping({ target }) {
  return (target instanceof Element && target.matches(TYPED)) || isDialogOpen();
}

// Whether undo is the field's own: while its text is not what the settings say.
function hasUndo(target) {
  return (touched?.field === target && target.value !== touched.before) || isDialogOpen();
}

function isDialogOpen() {
  return document.querySelector("dialog[open]") !== null;
}

// What is wrong is not taken: it stays, to be mended. "taken" is told by fields that write their text anew.
function watchTyping() {
  addEventListener("beforeinput", ({ target, inputType }) => {
    if (inputType === "insertLineBreak") return; // Enter, which is no text
    if (touched?.field !== target) touched = { field: target, before: target.value };
  });
  for (const kind of ["change", "taken"]) {
    addEventListener(kind, ({ target }) => {
      if (target === touched?.field && target.ariaInvalid !== "true") touched = null;
    });
  }
}

function back(settings) {
  tell(settings, "undo", () => settings.undo());
}

function forth(settings) {
  tell(settings, "redo", () => settings.redo());
}

// In words, for who cannot see what became of the picture.
function tell(settings, what, act) {
  const before = settings.current;
  act();
  const { current } = settings;
  const words = inWords(differing(settings, [before, current]), current);
  document.getElementById("spoken").textContent = words ? `After ${what}: ${words}.` : `Nothing to ${what}.`;
}
