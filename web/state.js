// State of the page, also kept in the address: the scene, the changes to the scene, the scheme, the
// tour.
const state = {
  scene: "tanpura_c3_release",
  text: null,
  files: {}, // texts of the tables that were dropped on the page, by name
  set: {},
  scheme: "modal_two_point",
  rate: 44100,
  modes: 0,
  compliance: "own",
  tour: "",
  step: 0,
};
// Instruments at the head of the list of scenes.
const instruments = {
  Tanpura: "tanpura_c3_release",
  Sitar: "sitar_parabola",
  Guitar: "guitar_over_fret",
  Bass: "slap_bass",
  Piano: "prepared_piano",
};
const window_seconds = 0.05,
  heard_seconds = 4,
  rates = [1, 2, 4, 8, 16].map(k => 44100 * k);
// Length of a judged run: the pluck, and this window after the pluck [s].
const run_seconds = () => (shown.scene?.free_from ?? 0) + window_seconds;
// Points for drawing, as fractions of the length: denser towards x = 0, the end with the bridges.
const shape_points = Array.from({length: 95}, (_, k) => ((k + 1) / 96) ** 1.5);

const scene_text = () => state.text ?? library[state.scene];
const overrides_of = set => Object.entries(set).map(([key, value]) => `${key}=${value}`);

// ---- The address.

const texts = {scene: String, scheme: String, compliance: String, tour: String},
  plain = {...texts, rate: Number, modes: Number, step: Number};
const longest_address = 8192; // [characters]

const bytes_of = base64 => Uint8Array.from(atob(base64), c => c.charCodeAt(0));
async function through(bytes, stream) {
  const found = new Blob([bytes]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(found).arrayBuffer());
}
// A scene of the reader's own and its tables, compressed.
async function packed(value) {
  const text = new TextEncoder().encode(JSON.stringify(value)),
    bytes = await through(text, new CompressionStream("deflate-raw"));
  return btoa(Array.from(bytes, b => String.fromCharCode(b)).join(""))
    .replaceAll("+", "-")
    .replaceAll("/", "_")
    .replace(/=+$/, "");
}
async function unpacked_own(word) {
  const bytes = bytes_of(word.replaceAll("-", "+").replaceAll("_", "/")),
    plain = await through(bytes, new DecompressionStream("deflate-raw")),
    {text: scene = null, files = {}} = JSON.parse(new TextDecoder().decode(plain));
  return {text: scene && String(scene), files: texts_of(files)};
}
const texts_of = files =>
  Object.fromEntries(
    Object.entries(files).map(([name, text]) => [name.replace(/[^\w.-]/g, "_"), String(text)]),
  );

// The address, and its length if that is too long for the reader's own scene, which is then left
// out.
async function address() {
  const words = new URLSearchParams(),
    {text, files} = state;
  for (const name of Object.keys(plain)) if (state[name]) words.set(name, state[name]);
  for (const [key, value] of Object.entries(state.set)) words.set(`set.${key}`, value);
  if (text === null && !Object.keys(files).length) return {hash: `#${words}`, beyond: 0};
  const word = await packed({text, files}),
    length = `#${words}&own=${word}`.length;
  if (length > longest_address) return {hash: `#${words}`, beyond: length};
  words.set("own", word);
  return {hash: `#${words}`, beyond: 0};
}

// Clamps to 32-bit integers: larger numbers would wrap round in the core. The core refuses the
// largest integer.
const whole_modes = modes => Math.max(0, Math.min(Math.round(Number(modes) || 0), 2 ** 31 - 1));

async function read_address(hash) {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  for (const [name, as] of Object.entries(plain))
    if (words.has(name)) state[name] = as(words.get(name));
  if (!Object.hasOwn(library, state.scene)) state.scene = "tanpura_c3_release";
  if (!Object.hasOwn(tours, state.tour)) state.tour = "";
  for (const name of ["rate", "modes", "step"])
    if (!Number.isFinite(state[name])) state[name] = name === "rate" ? 44100 : 0;
  state.modes = whole_modes(state.modes);
  state.step = Math.round(state.step);
  if (state.compliance !== "matched") state.compliance = "own";
  Object.assign(state, {text: words.get("text"), files: {}});
  if (words.has("own"))
    Object.assign(state, await unpacked_own(words.get("own")).catch(() => ({})));
  state.set = Object.fromEntries(
    [...words]
      .filter(([name]) => name.startsWith("set."))
      .map(([name, value]) => [name.slice(4), value]),
  );
}

// ---- Handles: a name, the key in the scene, a unit, the value in the scene (undefined: none), a
// range, and whether the range is logarithmic.

const point_of = s => (s.barrier[0]?.shape === "lumped" ? s.barrier[0] : undefined),
  pulled = s => s.start?.position,
  within = (low, high) => (v, s) => [low * s.length, high * s.length],
  times = (low, high) => v => [low * v, high * v].sort((a, b) => a - b),
  near_end = (high, most) => (v, s) => [0.3 * v, Math.min(high * v, most * s.length)];
const handles = [
  ["bridge_height", "barrier.0.height", "mm", s => point_of(s)?.height, v => [v - 2e-3, v + 2e-3]],
  ["bridge_position", "barrier.0.position", "mm", s => point_of(s)?.position, near_end(4, 0.9)],
  [
    "bridge_stiffness",
    "barrier.0.stiffness",
    "",
    s => s.barrier[0]?.stiffness,
    times(1e-3, 100),
    1,
  ],
  [
    "bridge_curve",
    "barrier.0.coefficient",
    "1/m",
    s => s.barrier[0]?.coefficient,
    times(0.25, 4),
    1,
  ],
  ["thread_position", "thread.position", "mm", s => s.thread?.position, near_end(3, 0.5)],
  ["pluck_position", "pluck.position", "mm", s => s.pluck?.position, within(0.1, 0.9)],
  ["pluck_strength", "pluck.amplitude", "N", s => s.pluck?.amplitude, times(0.1, 3)],
  ["release_position", "start.position", "mm", pulled, within(0.05, 0.95)],
  ["release_height", "start.amplitude", "mm", s => s.start?.amplitude, times(0.1, 3)],
  ["tension", "tension", "N", s => s.tension, times(0.5, 2)],
  [
    "bending",
    "bending_stiffness",
    "N m²",
    s => s.bending_stiffness || undefined,
    times(0.1, 10),
    1,
  ],
].map(([id, key, unit, of, range, log]) => ({id, key: `string.0.${key}`, unit, of, range, log}));
const digits = x => Number(x.toPrecision(4));
const shown_value = (h, v) =>
  h.log
    ? digits(v).toExponential(2).replace("e+", "e")
    : String(digits(v * (h.unit === "mm" ? 1e3 : 1)));
