// Each effect switched on or off by hand or left to what it weighs, with the reason why it is not simulated.

const TECHNIQUE = "backlight";

export function start({ settings, connection }) {
  const fieldsets = [...document.querySelectorAll(".effect")];
  const technique = document.getElementById("technique");
  let reasons = {};
  let whenOn = "auto"; // what the technique was when it was last not off

  function show() {
    technique.checked = settings.effect(TECHNIQUE) !== "off";
    if (technique.checked) whenOn = settings.effect(TECHNIQUE);
    for (const fieldset of fieldsets) {
      const state = settings.effect(fieldset.dataset.effect);
      fieldset.querySelector(`input[value=${state}]`).checked = true;
      fieldset.classList.toggle("changed", state !== "auto");
    }
  }

  // In words beside each, as the last picture was drawn.
  function tell() {
    for (const fieldset of fieldsets) {
      const { effect } = fieldset.dataset;
      const reason = reasons[effect];
      const words = reason === undefined ? "" : reason ? `left out: ${reason}` : "simulated";
      const place = fieldset.querySelector(".reason");
      if (place.textContent !== words) place.textContent = words;
      fieldset.classList.toggle("idle", Boolean(reason));
    }
  }

  technique.addEventListener("change", () => settings.setEffect(TECHNIQUE, technique.checked ? whenOn : "off"));
  for (const fieldset of fieldsets) {
    fieldset.addEventListener("change", ({ target }) => settings.setEffect(fieldset.dataset.effect, target.value));
  }
  settings.addEventListener("change", show);
  connection.addEventListener("frame", ({ detail: { header } }) => {
    reasons = header.reasons;
    tell();
  });
  show();
}
