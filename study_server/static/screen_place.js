// Which check it is and what was answered, kept in this tab over a reload. Where storage is blocked a reload begins anew.
const key = `fakesss-screen ${location.pathname}`;

const inputs = (form) => [...form.querySelectorAll("input")];

export function keep(form, at) {
  const state = inputs(form).map(({ name, value, checked, disabled, dataset }) => [name, value, checked, disabled, dataset.moved]);
  try {
    sessionStorage.setItem(key, JSON.stringify({ at, ratio: devicePixelRatio, state }));
  } catch {
    // blocked or full
  }
}

// The check to begin with, its inputs as they were; 0 if nothing is known, or if the card was held to another zoom.
export function restored(form) {
  try {
    const { at, ratio, state } = JSON.parse(sessionStorage.getItem(key));
    const fields = inputs(form);
    if (ratio !== devicePixelRatio || state.length !== fields.length) return 0;
    fields.forEach((input, i) => {
      const [name, value, checked, disabled, moved] = state[i];
      Object.assign(input, { name, value, checked, disabled });
      if (moved) input.dispatchEvent(new Event("input", { bubbles: true }));
    });
    return at;
  } catch {
    return 0;
  }
}
