// What the colours of an intermediate mean, beside the picture and never over it. The caption says the same in words.

const WIDTH = 176; // of the colour scale, in CSS pixels
const HEIGHT = 10;

export function start({ stage }) {
  const place = Object.assign(document.createElement("p"), { id: "legend", ariaHidden: "true", hidden: true });
  document.getElementById("view").after(place); // in a line that is there anyway: the picture stays where it is
  let shown = null;
  for (const event of ["frame", "show", "live"]) stage.addEventListener(event, show);

  function show({ detail }) {
    shown = detail?.header ? (detail.header.legend ?? null) : shown;
    place.hidden = !(shown?.scale || shown?.marks.length) || !stage.isLive;
    const text = JSON.stringify(shown);
    if (!shown || place.dataset.shown === text) return; // while something moves most frames have the same
    place.dataset.shown = text;
    place.replaceChildren(...(shown.scale ? scale(shown.scale) : []), ...shown.marks.map(mark));
  }
}

function scale({ colours, low, high }) {
  const ramp = canvas(WIDTH, HEIGHT, (drawing, width) => {
    const gradient = drawing.createLinearGradient(0, 0, width, 0);
    colours.forEach((colour, stop) => gradient.addColorStop(stop / (colours.length - 1), colour));
    return gradient;
  });
  return [words(low), ramp, words(high)];
}

function mark({ colour, label }) {
  const entry = document.createElement("span");
  entry.className = "mark";
  entry.append(canvas(HEIGHT, HEIGHT, () => colour), label);
  return entry;
}

function canvas(width, height, fill) {
  const made = Object.assign(document.createElement("canvas"), { width, height });
  const drawing = made.getContext("2d");
  drawing.fillStyle = fill(drawing, width);
  drawing.fillRect(0, 0, width, height);
  return made;
}

function words(text) {
  const made = document.createElement("span");
  made.textContent = text;
  return made;
}
