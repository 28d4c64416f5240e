// What the program takes for a field that is left empty, to be shown in its place. The twin of lines in fakesss/camera.py
// (View.of) and fakesss/shadow_maps.py (atlas); a test compares them.

const MARGIN = 1e-4; // radii; camera.SPHERE_MARGIN
const NEAREST = 1e-3; // radii; camera.NEAREST
const WIDEST = 60; // degrees; shadow_maps.WIDEST
const TEXELS = { perPixel: 4, largest: 4096, most: 8192, least: 16 };

// `value` gives a scene path's value, `faces` the mesh's number of triangles (0: not known yet).
export function fitted(path, value, faces) {
  const distance = () => value("camera.distance") ?? 1 / Math.sin(radians(value("camera.field_of_view")) / 2);
  const near = () => value("camera.near") ?? distance() - 1 - MARGIN;
  const fits = {
    "camera.distance": distance,
    "camera.near": () => Math.max(near(), NEAREST),
    "camera.far": () => Math.max(distance() + 1 + MARGIN, 2 * Math.max(near(), NEAREST)),
    "shadow.map_size": () => mapSize([mainLight(value), ...value("lights")], value("size")),
    "layers.faces": () => faces,
  };
  return fits[path]();
}

function mainLight(value) {
  return Object.fromEntries(["shadows", "kind", "distance", "cutoff"].map((field) => [field, value(`light.${field}`)]));
}

function mapSize(lights, size) {
  const maps = lights.filter(({ shadows }) => shadows).reduce((count, light) => count + mapsOf(light), 0);
  const columns = Math.max(Math.ceil(Math.sqrt(maps)), 1);
  const { perPixel, largest, most, least } = TEXELS;
  return Math.max(Math.min(perPixel * Math.max(...size), largest, Math.floor(most / columns)), least);
}

// A light that sees the object in a narrow enough cone needs one map, any other the six sides of a cube.
function mapsOf({ kind, distance, cutoff }) {
  if (kind === "directional") return 1;
  const sphere = distance > 1 ? (Math.asin(1 / distance) * 180) / Math.PI : 180;
  return Math.min(sphere, kind === "spot" ? cutoff : 180) <= WIDEST ? 1 : 6;
}

function radians(degrees) {
  return (degrees * Math.PI) / 180;
}
