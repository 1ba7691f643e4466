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
    input.closest("label").hidden = value === undefined; // a table in place of a curve
    if (value === undefined) continue;
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
  drop.note = "";
  choose({scene: target.value, text: null, files: {}, set: {}, ...first});
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

async function write_address() {
  const {hash, beyond} = await address();
  by_id("link_said").textContent = beyond
    ? `The link leaves out your own string: it has ${(beyond / 1024).toFixed(0)} kB, and a link ` +
      "holds 8 kB. Keep the files."
    : "";
  try {
    history.replaceState(null, "", hash);
  } catch {
    /* a page inside a page has no address */
  }
}
let settle = () => {},
  settling = Promise.resolve();
const settled = () => settling;
function show_state(exact) {
  if (!client.list) return show_controls(); // begin() shows the state
  write_address();
  settle();
  settling = new Promise(resolve => {
    settle = resolve;
  });
  show_controls();
  clear_answers("computing …");
  send_state(exact);
}

// Removes all numbers, which belong to the old state.
function clear_answers(title, why = "") {
  const string = JSON.stringify([scene_text(), state.set, state.files]);
  if (why || string !== chart.string) Object.assign(chart, {points: [], own: [], whole: false});
  Object.assign(chart, {string, why, timed: false});
  shown.verdict = shown.words = null;
  by_id("go_on").hidden = true;
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
    if (!kept) Object.assign(chart, {points: [], whole: false, timed: false});
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
    const again = !message.whole && (sound.playing || sound.wanted === "scheme");
    if (again) stop_sound();
    new_sound("scheme", buffer_of(message));
    sound.cost = message.cost;
    by_id("hear").disabled = !sound.buffers.scheme;
    if (again) play_sound("scheme");
    show_run();
  },
  reference({picture, verdict: newest, last, can_go_on}) {
    if (sound.buffers.reference && newest.heard.estimated !== shown.verdict?.heard.estimated)
      delete sound.buffers.reference;
    shown.reference = picture;
    shown.verdict = newest;
    by_id("go_on").hidden = !(last && can_go_on);
    new_pictures();
    show_run();
    mark_sound();
    if (last) settle();
  },
  words(message) {
    shown.words = message;
    show_run();
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
    if (received.has("motion")) clear_answers("No estimate of this string can be made", why);
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
const scheme_name = () => {
  const {scheme, compliance} = state;
  return label_of({scheme, compliance: options_of(scheme, compliance).length ? compliance : ""});
};

// The title after the name of the run: the waveform's error over the longest window that is known;
// without one, how far the third octaves are apart.
function sentence_of(v) {
  const estimate = v.estimated
      ? `, by an estimate${v.recorded ? "" : " from the scheme's own runs"}`
      : "",
    over = ` over the first ${1e3 * (v.window ?? window_seconds)} ms`,
    after = shown.scene.free_from ? " after the pluck" : "";
  if (!v.window) {
    const {words} = shown;
    const follows =
      v.horizon < v.known_for
        ? `, follows the waveform within 10 % for ${time_text(v.horizon)}`
        : "";
    return words
      ? ` sounds within ${decibels(words.run.octaves + 1.5 * words.known.octaves)} of the string ` +
          `in third octaves${follows}, by an estimate`
      : ": the waveform cannot be judged";
  }
  const error = error_text(v);
  return (
    ` is ${error === "not known" ? "more than 100 %" : error.replace("\u2264", "at most")} wrong` +
    `${over}${after}${estimate}` +
    (sound.cost ? `, and ${two_digits(1 / sound.cost)} times faster than real time` : "")
  );
}

// How it sounds, in words. What the coarser of the two runs of the estimate differs by as well is
// not told from nothing.
const decibels = x => `${x.toFixed(1)} dB`;
function amount_of(x, known, unit, places, {wrong, right}) {
  const uncertain = Math.max(1.5 * Math.abs(known), 10 ** -places);
  if (!Number.isFinite(x + uncertain)) return "";
  return Math.abs(x) > uncertain
    ? wrong(`${Math.abs(x).toFixed(places)} ${unit}`, x > 0)
    : right(`${(Math.abs(x) + uncertain).toFixed(places)} ${unit}`);
}
// Third octaves at and above a frequency, against the loudness of the whole [dB].
function brightness({bands, louder}, above) {
  const of = bands.filter(([centre]) => centre > 0.9 * above);
  return of.reduce((sum, [, level]) => sum + level, 0) / of.length - louder;
}
function heard_words({run, known, seconds, finer}) {
  const corners = [500, 1000, 2000, 5000].filter(
      c => run.bands.filter(([centre]) => centre > 0.9 * c).length > 1,
    ),
    size = c => Math.abs(brightness(run, c)),
    corner = corners.reduce((a, b) => (size(b) > size(a) ? b : a), corners[0]),
    above = `above ${corner / 1000} kHz`;
  const parts = [
    corner &&
      amount_of(brightness(run, corner), brightness(known, corner), "dB", 1, {
        wrong: (text, more) => `is ${text} too ${more ? "bright" : "dull"} ${above}`,
        right: text => `is as bright ${above} as it should be, to ${text}`,
      }),
    run.decay !== null &&
      amount_of(100 * run.decay, 100 * known.decay, "%", 0, {
        wrong: (text, more) => `decays ${text} too ${more ? "fast" : "slowly"}`,
        right: text => `decays right to ${text}`,
      }),
    // A motion that stretching does not explain has no pitch to compare.
    run.left * run.apart < 0.5 &&
      amount_of(run.cents, known.cents, "cents", 1, {
        wrong: (text, more) => `is ${text} ${more ? "sharp" : "flat"}`,
        right: text => `is in tune to ${text}`,
      }),
  ].filter(Boolean);
  return (
    `It ${parts.join(", ")}. Over ${two_digits(seconds)} s, an estimate: beside ` +
    `${finer.scheme.replaceAll("_", " ")} at ${finer.rate / 1e3} kHz.`
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
  if (shown.words) say([drop.note, heard_words(shown.words)].filter(Boolean).join(" "));
  show_take();
  if (v) {
    const agree =
      v.horizon < window_seconds * 0.999 ? time_text(v.horizon) : `all ${1e3 * window_seconds} ms`;
    facts.push(
      ["error of the force on the nut", percent(v.error)],
      ["agrees within 10 % for", agree],
      [
        v.estimated ? "estimated by" : "reference",
        `${v.reference}, ${v.modes} modes, uncertain by ${percent(v.uncertainty)}`,
      ],
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
  ["WebAssembly", "Worker", "CompressionStream", "DecompressionStream"].filter(
    name => !(name in window),
  );
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
  by_id("go_on").onclick = () => {
    by_id("go_on").hidden = true;
    start_worker();
    send_state("on");
  };
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
  by_id("take_part").ontoggle = by_id("take_choice").onchange = show_take;
  by_id("take_copy").onclick = async () => {
    await navigator.clipboard?.writeText(by_id("take_text").textContent).catch(() => {});
    by_id("take_copy").textContent = "copied";
  };
  by_id("apply").onclick = () => choose({text: by_id("text").value, set: {}});
  by_id("own_text").value = own_example;
  by_id("own_run").onclick = judge_own;
  by_id("copy").onclick = async () => {
    await write_address();
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
  window.onhashchange = async () => {
    await read_address(location.hash);
    show_state();
    take_step();
  };
}

async function begin() {
  if (lacking().length)
    return without_the_module(`This browser has no ${lacking().join(" and no ")}`);
  await read_address(location.hash || window.jvari_address || "");
  fill_choices();
  watch_controls();
  watch_grips();
  watch_map();
  watch_files();
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) by_id("paused").click();
  try {
    client.module = await WebAssembly.compile(await gunzipped(by_id("module").textContent));
    client.solutions = JSON.parse(new TextDecoder().decode(await gunzipped(packed_solutions)));
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
