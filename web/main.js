// Puts the page together: controls, answers from the worker, keys.
function element(name, properties = {}, ...inside) {
  const node = Object.assign(document.createElement(name), properties);
  if (properties.scope) node.setAttribute("scope", properties.scope);
  node.append(...inside);
  return node;
}
const by_id = id => document.getElementById(id);
const say = text => {
  by_id("said").textContent = text;
};
const failed = text =>
  say(`Something broke in the page: ${text}. Reload it, and please report the address.`);

// ---- Controls.

function fill_choices() {
  by_id("instruments").append(
    ...Object.entries(instruments).map(([name, scene]) =>
      element("button", {type: "button", value: scene, onclick: choose_scene}, name),
    ),
  );
  by_id("scene").replaceChildren(
    ...Object.keys(library).map(name => element("option", {value: name}, name)),
    element("option", {value: "", hidden: true}, "a text of your own"),
  );
  by_id("tour_choice").append(
    ...Object.entries(tours).map(([value, {title}]) => element("option", {value}, title)),
  );
  by_id("rate").replaceChildren(...rates.map(r => element("option", {value: r}, `${r / 1e3} kHz`)));
}

function fill_schemes() {
  const {able} = shown.scene,
    option = ({name}) => element("option", {value: name, disabled: !able.includes(name)}, name),
    group = (label, list) => element("optgroup", {label}, ...list.map(option)),
    of_control = wanted => client.list.schemes.filter(d => d.control === wanted);
  by_id("scheme").replaceChildren(
    group("schemes (grey: not this string)", of_control(false)),
    group("controls, known to be wrong somewhere", of_control(true)),
  );
  by_id("scheme").value = state.scheme;
  by_id("scheme_note").textContent = descriptor(state.scheme)?.source ?? "";
  by_id("compliance").disabled = options_of(state.scheme, "own").length === 0;
}

// Scene and string without changes by the user: the handles take their ranges from the string.
let base = {scene: null, string: null};
async function fill_handles() {
  const key = state.text ?? state.scene;
  if (base.scene !== key) {
    base = {
      scene: key,
      string: (await ask("scene", {text: scene_text(), overrides: []})).string[0],
    };
    by_id("handles").replaceChildren(
      ...handles.filter(h => Number.isFinite(h.of(base.string))).map(handle_row),
    );
  }
  for (const h of handles) {
    const input = by_id(`handle_${h.id}`),
      value = h.of(shown.scene.string[0]);
    if (!input) continue;
    if (document.activeElement !== input || film.dragged)
      input.value = h.log ? Math.log10(value) : value;
    input.setAttribute("aria-valuetext", `${shown_value(h, value)} ${h.unit}`);
    by_id(`value_${h.id}`).textContent = `${shown_value(h, value)} ${h.unit}`;
  }
}
function handle_row(h) {
  const value = h.of(base.string),
    [from, to] = h.range(value, base.string),
    of = x => (h.log ? Math.log10(x) : x),
    label = h.id
      .replace("_", " ")
      .replace("bridge", called("bridge_force", "bridge"))
      .replace("thread", called("thread_force", "thread"));
  const input = element("input", {
    type: "range",
    id: `handle_${h.id}`,
    min: of(from),
    max: of(to),
    step: (of(to) - of(from)) / 400,
  });
  input.value = of(value);
  input.oninput = () => move_handle(h.id, h.log ? 10 ** input.value : Number(input.value), false);
  return element(
    "label",
    {className: "handle"},
    element("span", {}, label),
    input,
    element("output", {id: `value_${h.id}`}),
  );
}
function move_handle(id, value) {
  const h = handles.find(one => one.id === id),
    [from, to] =
      base.string && h.of(base.string) !== undefined
        ? h.range(h.of(base.string), base.string)
        : [value, value];
  state.set[h.key] = String(Number(Math.min(to, Math.max(from, value)).toPrecision(7)));
  changed();
}

function show_controls() {
  by_id("scene").value = state.text === null ? state.scene : "";
  for (const button of by_id("instruments").children)
    button.setAttribute("aria-pressed", String(button.value === by_id("scene").value));
  by_id("rate").value = state.rate;
  by_id("modes").value = state.modes || "";
  by_id("compliance").value = state.compliance;
  by_id("text").value = scene_text();
  if (client.list && shown.scene) fill_schemes();
}

// Changes the string and returns to the first scheme, if able to run the scene (`shows.scene`).
function choose_scene({target}) {
  state.tour = "";
  take_step();
  const first = {scheme: "modal_two_point", compliance: "own", modes: 0};
  choose({scene: target.value, text: null, set: {}, ...first});
}
function choose(more) {
  Object.assign(state, more);
  if (more.scheme || more.scene) map.around = undefined;
  changed();
}
let frame = 0;
function changed() {
  // Shows only the last of many changes in one frame.
  if (by_id("auto_sound").checked) sound.wanted = "scheme";
  if (state.tour)
    (++take_step.count,
      (by_id("tour_number").textContent =
        "You changed the string. Back and next go on with the tour's."));
  frame ||= requestAnimationFrame(() => {
    frame = 0;
    show_state();
  });
}

let settle = () => {},
  settling = Promise.resolve();
const settled = () => settling;
function show_state() {
  try {
    history.replaceState(null, "", address());
  } catch {
    /* a page inside a page has no address */
  }
  settle();
  settling = new Promise(resolve => {
    settle = resolve;
  });
  show_controls();
  clear_answers("computing …");
  send_state();
}

// Removes all numbers, which belong to the old state.
function clear_answers(title, why = "") {
  const string = JSON.stringify([scene_text(), state.set]);
  if (why || string !== chart.string) Object.assign(chart, {points: [], own: [], whole: false});
  Object.assign(chart, {string, why, timed: false});
  shown.verdict = null;
  sound.cost = 0;
  by_id("title").textContent = title;
  say(why);
  by_id("facts").replaceChildren();
  draw_chart();
  if (why) settle();
}

// ---- Answers from the worker.

const shows = {
  scene({scene, cells, kept}) {
    const new_string = JSON.stringify(scene.string) !== JSON.stringify(shown.scene?.string);
    shown.scene = scene;
    if (new_string) forget_motion();
    by_id("about").textContent =
      `${scene.name}: ` +
      (scene.string.length > 1 ? `the first of ${scene.string.length} strings, ` : "") +
      `${scene.string[0].pitch.toFixed(1)} Hz (${scene.string[0].note}). ${scene.source}.`;
    fill_handles();
    chart.cells = cells;
    if (!kept) Object.assign(chart, {points: [], whole: false});
    draw_chart();
    // Takes another scheme if the chosen scheme cannot run the string.
    const able = first_able();
    if (!scene.able.includes(state.scheme) && able) {
      Object.assign(state, {scheme: able, compliance: "own", modes: 0});
      return show_state();
    }
    fill_schemes();
  },
  motion({picture}) {
    shown.motion = picture;
    film.at = Math.min(film.at, picture.rows - 1);
    new_pictures();
    sound.drawn = performance.now();
    show_run();
    if (by_id("map_part").open) fill_map();
  },
  sound(message) {
    const again = sound.playing || sound.wanted === "scheme";
    stop_sound();
    sound.buffers.scheme = buffer_of(message);
    sound.cost = message.cost;
    by_id("hear").disabled = !sound.buffers.scheme;
    if (again) play_sound("scheme");
    show_run();
  },
  reference({picture, verdict: newest}) {
    shown.reference = picture;
    shown.verdict = newest;
    new_pictures();
    show_run();
    mark_sound();
    settle();
  },
  unreferenced() {
    clear_answers(
      "No exact solution of this string is in the page",
      `The page has closed forms alone. ${ask_the_program()}`,
    );
  },
  late() {
    clear_answers(
      `No exact solution of this string within ${late_seconds} s`,
      `A browser takes longer for it. ${ask_the_program()}`,
    );
  },
  point({point}) {
    chart.points.push(point);
    draw_chart();
  },
  charted({kept}) {
    chart.done = performance.now();
    chart.whole = true;
    chart.timed = kept;
    draw_chart();
  },
  timed({costs, last}) {
    for (const p of chart.points)
      Object.assign(
        p,
        costs.find(
          c => c.scheme === p.scheme && c.compliance === p.compliance && c.rate === p.rate,
        ),
      );
    chart.timed = last;
    draw_chart();
  },
  refused({why}) {
    const {received} = client;
    if (!received.has("motion")) (forget_motion(), stop_sound());
    if (received.has("motion")) clear_answers("The exact solution of this string is refused", why);
    else if (!received.has("scene")) clear_answers("This text is not a scene", why);
    else clear_answers(`${scheme_name()} does not take this string`, why);
  },
};
function forget_motion() {
  shown.motion = shown.reference = null;
  sound.buffers = {};
  by_id("hear").disabled = true;
  draw_picture();
}
const ask_the_program = () =>
  "The program takes its time, or another reference: jvari compare " +
  `${state.text === null ? state.scene : "FILE"}.`;
const scheme_name = () => {
  const {scheme, compliance} = state;
  return label_of({scheme, compliance: options_of(scheme, compliance).length ? compliance : ""});
};

function sentence_of(v) {
  const over = ` over the first ${1e3 * window_seconds} ms`,
    after = shown.scene.free_from ? " after the pluck" : "",
    error = error_text(v);
  if (error === "not known")
    return (
      " cannot be judged here: the exact solution is itself uncertain by " + percent(v.uncertainty)
    );
  if (error.endsWith("?"))
    return ` is ${percent(v.error)} from an exact solution of unknown uncertainty,${over}` + after;
  return (
    ` is ${error.replace("\u2264", "at most")} wrong${over}${after}` +
    (sound.cost ? `, and ${two_digits(1 / sound.cost)} times faster than real time` : "")
  );
}

function show_run() {
  const {motion, verdict: v} = shown,
    facts = [],
    run = `${scheme_name()} at ${state.rate / 1e3} kHz`;
  if (!motion) return;
  if (motion.outcome !== "ok")
    by_id("title").textContent =
      `${run}: ${motion.outcome.replace("_", " ")} at step ${motion.step}`;
  else if (v) by_id("title").textContent = run + sentence_of(v);
  if (v) {
    const agree =
      v.horizon < window_seconds * 0.999 ? time_text(v.horizon) : `all ${1e3 * window_seconds} ms`;
    facts.push(
      ["error of the force on the nut", percent(v.error)],
      ["agrees within 10 % for", agree],
      ["reference", `${v.reference}, ${v.modes} modes, uncertain by ${percent(v.uncertainty)}`],
    );
  }
  if (Number.isFinite(motion.residual))
    facts.push(["energy not accounted for", motion.residual.toExponential(1)]);
  if (sound.cost) facts.push(["time per second, in this browser", time_text(sound.cost)]);
  facts.push(["state", `${motion.dofs} numbers`]);
  for (const f of motion.facts.slice(0, 12))
    facts.push([f.name.replaceAll("_", " "), `${digits(f.value)} ${f.unit}`]);
  by_id("facts").replaceChildren(
    ...facts.flatMap(([term, value]) => [element("dt", {}, term), element("dd", {}, value)]),
  );
}

// ---- Begin.

const lacking = () =>
  ["WebAssembly", "Worker", "DecompressionStream"].filter(name => !(name in window));
function without_the_module(why) {
  by_id("title").textContent = "The string in the page needs a newer browser";
  say(`${why}. The program itself runs without one: ./demo`);
  for (const part of document.querySelectorAll("#stage, #hear, #live, .bar label, .bar .tools"))
    part.hidden = true;
}

function watch_controls() {
  by_id("scene").onchange = choose_scene;
  by_id("scheme").onchange = e => choose({scheme: e.target.value});
  by_id("compliance").onchange = e => choose({compliance: e.target.value});
  by_id("rate").onchange = e => choose({rate: Number(e.target.value)});
  by_id("modes").onchange = e => choose({modes: whole_modes(e.target.value)});
  by_id("undo").onclick = () => choose({set: {}});
  by_id("hear").onclick = toggle_sound;
  by_id("stop").onclick = () => stop_sound();
  for (const id of ["paused", "zoomed"])
    by_id(id).onclick = () => {
      by_id(id).setAttribute("aria-pressed", String((film[id] = !film[id])));
      draw_picture();
    };
  by_id("slowed").onchange = e => (film.slowed = Number(e.target.value));
  by_id("tour_choice").onchange = () => {
    Object.assign(state, {tour: by_id("tour_choice").value, step: 0});
    take_step();
  };
  by_id("tour_back").onclick = () => walk(-1);
  by_id("tour_next").onclick = () => (state.tour ? walk(1) : by_id("tour_choice").onchange());
  by_id("tour_end").onclick = () => {
    state.tour = "";
    take_step();
    show_state();
    by_id("tour_next").focus();
  };
  by_id("apply").onclick = () => choose({text: by_id("text").value, set: {}});
  by_id("own_text").value = own_example;
  by_id("own_run").onclick = judge_own;
  by_id("copy").onclick = async () => {
    await navigator.clipboard?.writeText(location.href).catch(() => {});
    by_id("copy").textContent = "copied";
  };
  document.onkeydown = e => {
    const typed = e.target.matches("input, select, textarea, button, summary");
    if (typed || e.ctrlKey || e.metaKey || e.altKey) return;
    if (e.key === " ") (toggle_sound(), e.preventDefault());
    else if (e.key === "Escape") stop_sound();
  };
  window.onresize = () => {
    draw_picture();
    draw_chart();
    if (by_id("map_part").open) draw_map();
  };
  window.onhashchange = () => {
    read_address(location.hash);
    show_state();
    take_step();
  };
}

async function begin() {
  if (lacking().length)
    return without_the_module(`This browser has no ${lacking().join(" and no ")}`);
  read_address(location.hash || window.jvari_address || "");
  fill_choices();
  watch_controls();
  watch_grips();
  watch_map();
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) by_id("paused").click();
  try {
    client.module = await unpacked(by_id("module").textContent);
    await start_worker();
  } catch (error) {
    return without_the_module(`This browser cannot start the module (${error.message})`);
  }
  if (!client.list.schemes.some(d => d.name === state.scheme)) state.scheme = "modal_two_point";
  show_state();
  take_step();
  requestAnimationFrame(film_frame);
}
begin();
