// The panel's controls: each shown anew when anything changes.
import { KINDS } from "./control.js";
import { picked } from "./lights.js";
import { setPressable } from "./pressable.js";
import { isSame } from "./settings.js";

const SOURCE = /^tuner: /; // where the server's sentences place what is wrong

export function start({ settings, connection, start: facts }) {
  const elements = [...document.querySelectorAll(".control[data-kind]")];
  const controls = elements.map((element) => new KINDS[element.dataset.kind](element, settings));
  let faces = facts.base.layers.faces ?? 0;
  let isDue = false;

  const show = () => {
    isDue = false;
    for (const control of controls) control.show(faces);
  };
  const showSoon = () => {
    if (!isDue) requestAnimationFrame(show); // a drag brings many changes between two pictures of the screen
    isDue = true;
  };

  settings.addEventListener("change", showSoon);
  picked.addEventListener("pick", showSoon);
  document.getElementById("panel").addEventListener("chosen", show);
  connection.addEventListener("frame", ({ detail: { header } }) => {
    if (header.faces !== faces) showSoon();
    ({ faces } = header);
  });
  blame(controls, connection);
  resetting(controls, settings);
  show();
}

// What the server refuses though no field alone shows it to be wrong is said beside the field that its sentence names
// ("camera.near: ...", "camera: near 5 must be ..."), until a picture comes.
function blame(controls, connection) {
  let blamed = null;
  const acquit = () => {
    blamed?.tell("");
    blamed = null;
  };
  connection.addEventListener("frame", acquit);
  connection.addEventListener("message", ({ detail: { level, text } }) => {
    if (level !== "error") return;
    acquit();
    const isNamed = (name) => text.includes(`${name}:`) || text.includes(`${name} `);
    blamed = controls.find(({ path }) => isNamed(path) || isNamed(path.replace(/\.(?=[^.]*$)/, ": ")));
    blamed?.tell(text.replace(SOURCE, ""));
  });
}

function resetting(controls, settings) {
  const button = document.getElementById("reset-all");
  const show = () => setPressable(button, !isSame(settings.current, { changes: {}, effects: {} }));
  button.addEventListener("click", () => {
    for (const control of controls) control.forget();
    settings.reset();
  });
  settings.addEventListener("change", show);
  show();
}
