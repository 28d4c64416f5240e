// When the picture of a trial was first shown, in this browser's storage: a reload begins no new reaction time. Where
// storage is blocked it does.
const key = (here) => `fakesss-shown ${here}`;

// The earlier showing of this trial, as `Stopwatch.kept` gave it; undefined if there was none, or none that is known.
export function earlierShowing(here, place) {
  try {
    const { trial, ...kept } = JSON.parse(localStorage.getItem(key(here)));
    return trial === place && Object.values(kept).every(Number.isFinite) ? kept : undefined;
  } catch {
    return undefined;
  }
}

export function keepShowing(here, place, kept) {
  try {
    localStorage.setItem(key(here), JSON.stringify({ trial: place, ...kept }));
  } catch {
    // blocked or full
  }
}

export function forgetShowing(here) {
  try {
    localStorage.removeItem(key(here));
  } catch {
    // blocked
  }
}
