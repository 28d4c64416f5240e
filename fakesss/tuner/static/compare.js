// Pictures beside each other and in each other's place: undo, the setting before, pins, the difference.
import * as difference from "./difference.js";
import { differing, inWords } from "./differing.js";
import * as history from "./history.js";
import { Peek } from "./peek.js";
import { Pictures } from "./pictures.js";
import { Pins } from "./pins.js";
import { setPressable } from "./pressable.js";

export function start(context) {
  const { settings, stage } = context;
  const pictures = new Pictures(context);
  const button = document.getElementById("previous");
  history.start(context);
  new Peek(context, pictures, button, "b", () => before(settings, stage.view));
  const show = () => setPressable(button, settings.canUndo);
  settings.addEventListener("change", show);
  show();
  difference.start(context, pictures, new Pins(context, pictures));
}

function before(settings, view) {
  const { previous, current } = settings;
  if (!previous) return null;
  const words = inWords(differing(settings, [previous, current]), previous);
  return { settings: previous, view, caption: `The setting before: ${words}` };
}
