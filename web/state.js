// State of the page, also kept in the address: the scene, the changes to the scene, the scheme, the
// tour.
const state = {
  scene: "tanpura_c3_release",
  text: null,
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
  Sitar: "sitar_c5",
  Guitar: "guitar_over_fret",
  Bass: "slap_bass",
  Piano: "prepared_piano",
};
const window_seconds = 0.05,
  heard_seconds = 1,
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
const longest_address = 20000; // [characters]; a longer scene stays out of the address

function address() {
  const words = new URLSearchParams();
  for (const name of Object.keys(plain)) if (state[name]) words.set(name, state[name]);
  for (const [key, value] of Object.entries(state.set)) words.set(`set.${key}`, value);
  if (state.text !== null && state.text.length < longest_address) words.set("text", state.text);
  return `#${words}`;
}

// Clamps to 32-bit integers: larger numbers would wrap round in the core. The core refuses the
// largest integer.
const whole_modes = modes => Math.max(0, Math.min(Math.round(Number(modes) || 0), 2 ** 31 - 1));

function read_address(hash) {
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
  state.text = words.get("text");
  state.set = Object.fromEntries(
    [...words]
      .filter(([name]) => name.startsWith("set."))
      .map(([name, value]) => [name.slice(4), value]),
  );
}

// ---- Handles: a name, the key in the scene, a unit, the value in the scene (undefined: none), a
// range, and whether the range is logarithmic.

const point_of = s => (s.barrier[0]?.shape === "lumped" ? s.barrier[0] : undefined),
  pulled = s => (s.start?.shape === "triangle" ? s.start.position : undefined),
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
