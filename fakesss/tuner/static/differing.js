// In which values settings differ, in words.
import { titled } from "./object_names.js";
import { isSame } from "./settings.js";

// The scene paths and effects that are not the same in all of `several`.
export function differing(settings, several) {
  const paths = new Set(several.flatMap(({ changes }) => Object.keys(changes)));
  const fields = [...paths].flatMap((path) => (path === "lights" ? inLights(settings, several) : [path]));
  const effects = new Set(several.flatMap((one) => Object.keys(one.effects)));
  const values = [
    ...fields.map((path) => ({ name: named(path), of: (one) => settings.valueIn(one, path) })),
    ...[...effects].map((name) => ({ name, of: (one) => one.effects[name] ?? "auto" })),
  ];
  return values.filter(({ of }) => several.some((one) => !isSame(of(one), of(several[0]))));
}

// "backlight 0.8, camera azimuth 30" of one of those settings.
export function inWords(values, one) {
  return values.map(({ name, of }) => `${name} ${written(of(one))}`).join(", ");
}

// Field by field as long as all have as many lights.
function inLights(settings, several) {
  const [lights, ...others] = several.map((one) => settings.valueIn(one, "lights"));
  if (others.some(({ length }) => length !== lights.length)) return ["lights"];
  return lights.flatMap((light, number) => Object.keys(light).map((field) => `lights.${number}.${field}`));
}

function named(path) {
  const [group, ...rest] = path.replace(/^lights\.(\d+)\./, (_, number) => `light ${Number(number) + 2}.`).split(".");
  if (path === "lights") return "further lights";
  return (group === "material" ? rest : [group, ...rest]).join(" ").replaceAll("_", " ");
}

function written(value) {
  if (value === null) return "auto";
  if (typeof value === "boolean") return value ? "on" : "off";
  if (typeof value === "number") return String(Number(value.toPrecision(4))).replace("-", "−");
  if (!Array.isArray(value)) return titled(String(value));
  return value.some((part) => typeof part === "object") ? String(value.length) : `(${value.map(written).join(", ")})`;
}
