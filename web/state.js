// What the page shows, as one value that also stands in the address: the scene, what was changed of
// it, the scheme, the tour.
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
const window_seconds = 0.05,
  heard_seconds = 1,
  rates = [1, 2, 4, 8, 16].map(k => 44100 * k);
// What is run and judged: so long after the pluck.
const run_seconds = () => (shown.scene?.free_from ?? 0) + window_seconds;
// Where the string is drawn, as parts of its length: closer towards x = 0, where the bridges are.
const shape_points = Array.from({length: 95}, (_, k) => ((k + 1) / 96) ** 1.5);

const scene_text = () => state.text ?? library[state.scene];
const overrides_of = set => Object.entries(set).map(([key, value]) => `${key}=${value}`);

// ---- The address.

const plain = {
  scene: String,
  scheme: String,
  rate: Number,
  modes: Number,
  compliance: String,
  tour: String,
  step: Number,
};
const longest_address = 20000; // a scene's text that is longer stays out of it

function address() {
  const words = new URLSearchParams();
  for (const name of Object.keys(plain)) if (state[name]) words.set(name, state[name]);
  for (const [key, value] of Object.entries(state.set)) words.set(`set.${key}`, value);
  if (state.text !== null && state.text.length < longest_address) words.set("text", state.text);
  return `#${words}`;
}

// What does not fit a 32-bit integer would wrap round in the core, which refuses the largest one.
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

// ---- Handles: keys of the scene with a range. `of` finds the value in what the scene says;
// undefined: it has none.

const point_of = s => (s.barrier[0]?.shape === "lumped" ? s.barrier[0] : undefined);
const corner_of = s => (s.start?.shape === "triangle" ? s.start : undefined);
const handles = [
  {
    id: "bridge_height",
    key: "string.0.barrier.0.height",
    label: "bridge height",
    unit: "mm",
    times: 1e3,
    of: s => point_of(s)?.height,
    range: v => [v - 2e-3, v + 2e-3],
  },
  {
    id: "bridge_position",
    key: "string.0.barrier.0.position",
    label: "bridge position",
    unit: "mm",
    times: 1e3,
    of: s => point_of(s)?.position,
    range: (v, s) => [0.3 * v, Math.min(4 * v, 0.9 * s.length)],
  },
  {
    id: "bridge_stiffness",
    key: "string.0.barrier.0.stiffness",
    label: "bridge stiffness",
    unit: "",
    log: true,
    of: s => s.barrier[0]?.stiffness,
    range: v => [v / 1e3, v * 100],
  },
  {
    id: "thread_position",
    key: "string.0.thread.position",
    label: "thread position",
    unit: "mm",
    times: 1e3,
    of: s => s.thread?.position,
    range: (v, s) => [0.3 * v, Math.min(3 * v, 0.5 * s.length)],
  },
  {
    id: "pluck_position",
    key: "string.0.pluck.position",
    label: "pluck position",
    unit: "mm",
    times: 1e3,
    of: s => s.pluck?.position,
    range: (v, s) => [0.1 * s.length, 0.9 * s.length],
  },
  {
    id: "pluck_strength",
    key: "string.0.pluck.amplitude",
    label: "pluck strength",
    unit: "N",
    times: 1,
    of: s => s.pluck?.amplitude,
    range: v => [0.1 * v, 3 * v],
  },
  {
    id: "corner_position",
    key: "string.0.start.position",
    label: "release position",
    unit: "mm",
    times: 1e3,
    of: s => corner_of(s)?.position,
    range: (v, s) => [0.05 * s.length, 0.95 * s.length],
  },
  {
    id: "start_amplitude",
    key: "string.0.start.amplitude",
    label: "release height",
    unit: "mm",
    times: 1e3,
    of: s => s.start?.amplitude,
    range: v => [0.1 * v, 3 * v],
  },
  {
    id: "tension",
    key: "string.0.tension",
    label: "tension",
    unit: "N",
    times: 1,
    of: s => s.tension,
    range: v => [0.5 * v, 2 * v],
  },
  {
    id: "bending",
    key: "string.0.bending_stiffness",
    label: "bending stiffness",
    unit: "N m²",
    log: true,
    of: s => s.bending_stiffness || undefined,
    range: v => [v / 10, v * 10],
  },
];
const digits = x => Number(x.toPrecision(4));
const shown_value = (h, v) =>
  h.log ? digits(v).toExponential(2).replace("e+", "e") : String(digits(v * (h.times ?? 1)));
