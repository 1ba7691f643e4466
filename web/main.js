// The page put together: controls, what the worker answers, keys.
function element(name, properties = {}, ...inside) {
  const made = Object.assign(document.createElement(name), properties);
  if (properties.scope) made.setAttribute("scope", properties.scope);
  made.append(...inside);
  return made;
}
const by_id = id => document.getElementById(id);
const say = text => {
  by_id("said").textContent = text;
};
const failed = text =>
  say(`Something broke in the page: ${text}. Reload it, and please report the address.`);

// ---- Controls.

function fill_choices() {
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
  const able = new Set(shown.scene.able),
    group = (label, list) => {
      const made = element("optgroup", {label});
      made.append(
        ...list.map(d =>
          element(
            "option",
            {value: d.name, disabled: !able.has(d.name)},
            d.name + (able.has(d.name) ? "" : " (not this scene)"),
          ),
        ),
      );
      return made;
    };
  by_id("scheme").replaceChildren(
    group(
      "schemes",
      client.list.schemes.filter(d => !d.control),
    ),
    group(
      "controls, known to be wrong somewhere",
      client.list.schemes.filter(d => d.control),
    ),
  );
  by_id("scheme").value = state.scheme;
  by_id("scheme_note").textContent = descriptor(state.scheme)?.source ?? "";
  by_id("compliance").disabled = options_of(state.scheme, "own").length === 0;
}

// of the scene as it is in the library: ranges of the handles are taken from it
let base = {scene: null, string: null};
async function fill_handles() {
  const key = state.text ?? state.scene;
  if (base.scene !== key) {
    base = {
      scene: key,
      string: (await ask("scene", {text: scene_text(), overrides: []})).string[0],
    };
    by_id("handles").replaceChildren(
      ...handles.filter(h => h.of(base.string) !== undefined).map(handle_row),
    );
  }
  for (const h of handles) {
    const input = by_id(`handle_${h.id}`),
      value = h.of(shown.scene.string[0]);
    if (!input || value === undefined) continue;
    if (document.activeElement !== input || film.dragged)
      input.value = h.log ? Math.log10(value) : value;
    input.setAttribute("aria-valuetext", `${shown_value(h, value)} ${h.unit}`);
    by_id(`value_${h.id}`).textContent = `${shown_value(h, value)} ${h.unit}`;
  }
}
function handle_row(h) {
  const value = h.of(base.string),
    [from, to] = h.range(value, base.string),
    of = x => (h.log ? Math.log10(x) : x);
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
    element("span", {}, h.label),
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
  by_id("rate").value = state.rate;
  by_id("modes").value = state.modes || "";
  by_id("compliance").value = state.compliance;
  by_id("text").value = scene_text();
  if (client.list && shown.scene) fill_schemes();
}

function choose(more) {
  Object.assign(state, more);
  if (more.scheme || more.scene) map.around = undefined;
  changed();
}
let frame = 0;
function changed() {
  // of many in one frame, the last
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
  send_state();
}

// ---- What the worker answers.

const shows = {
  scene({scene}) {
    const new_string = JSON.stringify(scene.string) !== JSON.stringify(shown.scene?.string);
    shown.scene = scene;
    if (new_string)
      ((shown.reference = shown.verdict = null),
        (sound.buffers.reference = null),
        (chart.own = []));
    chart.coming = [];
    chart.timed = false;
    say("");
    fill_schemes();
    fill_handles();
    by_id("about").textContent =
      `${scene.name}: ` +
      (scene.string.length > 1 ? `the first of ${scene.string.length} strings, ` : "") +
      `${scene.string[0].pitch.toFixed(1)} Hz (${scene.string[0].note}). ${scene.source}.`;
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
    sound.buffers.scheme = buffer_of(message);
    sound.cost = message.cost;
    by_id("hear_scheme").disabled = by_id("hear_reference").disabled = false;
    if (sound.wanted === "scheme") play_sound("scheme");
    show_run();
  },
  reference({picture, verdict: told}) {
    shown.reference = picture;
    shown.verdict = told;
    new_pictures();
    show_run();
    settle();
  },
  unreferenced() {
    shown.reference = shown.verdict = null;
    by_id("title").textContent = `No exact solution of this scene is in the page`;
    say(
      "Its reference needs SUNDIALS, which the page leaves out. The program has it: jvari " +
        `compare ${state.scene}`,
    );
    chart.points = [];
    draw_chart(true);
    settle();
  },
  point({point}) {
    chart.coming.push(point);
    const whole = chart_cells().length;
    if (chart.coming.length > 3 || chart.points.length === 0)
      chart.points = chart.coming.concat(chart.points.slice(chart.coming.length, whole));
    draw_chart(false);
  },
  charted() {
    chart.points = chart.coming;
    chart.done = performance.now();
    draw_chart(true);
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
    draw_chart(true);
  },
  refused({why}) {
    say(why);
    by_id("title").textContent = "The scheme or the scene refuses";
    settle();
  },
};

function show_run() {
  const {motion, verdict: v} = shown,
    facts = [];
  const name = label_of({
    scheme: state.scheme,
    compliance: options_of(state.scheme, state.compliance).length ? state.compliance : "",
  });
  if (!motion) return;
  if (motion.outcome !== "ok")
    by_id("title").textContent =
      `${name} at ${state.rate / 1e3} kHz: ${motion.outcome.replace("_", " ")} at step ` +
      `${motion.step}`;
  else if (v)
    by_id("title").textContent =
      `${name} at ${state.rate / 1e3} kHz is ${percent(v.error)} wrong over the first ` +
      `${1e3 * window_seconds} ms${shown.scene.free_from ? " after the pluck" : ""}` +
      (sound.cost
        ? `, and ${digits(1 / sound.cost).toPrecision(2) * 1} times faster than real time`
        : "");
  if (v)
    facts.push(
      ["error of the force on the nut", percent(v.error)],
      [
        "agrees within 10 % for",
        v.horizon >= window_seconds * 0.999
          ? `all ${1e3 * window_seconds} ms`
          : time_text(v.horizon),
      ],
      [
        "reference",
        `${v.reference}, ${v.modes} modes, ` +
          (Number.isFinite(v.uncertainty)
            ? `known to ${percent(v.uncertainty)}`
            : "its uncertainty is not known"),
      ],
    );
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
  say(
    `${why}: below are two recorded sounds of a tanpura string, and the rest needs a newer ` +
      "browser, or the program (./demo).",
  );
  by_id("recorded").hidden = false;
  for (const part of document.querySelectorAll("#live, .bar label, .bar button"))
    part.hidden = true;
}

function watch_controls() {
  by_id("scene").onchange = e => {
    state.tour = "";
    take_step();
    choose({
      scene: e.target.value,
      text: null,
      set: {},
      scheme: "modal_two_point",
      compliance: "own",
      modes: 0,
    });
  };
  by_id("scheme").onchange = e => choose({scheme: e.target.value});
  by_id("compliance").onchange = e => choose({compliance: e.target.value});
  by_id("rate").onchange = e => choose({rate: Number(e.target.value)});
  by_id("modes").onchange = e => choose({modes: whole_modes(e.target.value)});
  by_id("undo").onclick = () => choose({set: {}});
  by_id("hear_scheme").onclick = () => toggle_sound("scheme");
  by_id("hear_reference").onclick = () => toggle_sound("reference");
  by_id("film").onclick = () => {
    film.playing = !film.playing;
    by_id("film").textContent = film.playing ? "pause" : "move";
    by_id("film").setAttribute("aria-pressed", String(!film.playing));
  };
  by_id("zoom").onclick = () => {
    film.zoomed = !film.zoomed;
    by_id("zoom").setAttribute("aria-pressed", String(film.zoomed));
    draw_picture();
  };
  by_id("slowed").onchange = e => {
    film.slowed = Number(e.target.value);
  };
  by_id("tour_choice").onchange = e => {
    Object.assign(state, {tour: e.target.value, step: 0});
    take_step();
  };
  by_id("tour_back").onclick = () => walk(-1);
  by_id("tour_next").onclick = () => walk(1);
  by_id("tour_end").onclick = () => {
    state.tour = "";
    take_step();
    show_state();
    by_id("tour_choice").focus();
  };
  by_id("apply").onclick = () => choose({text: by_id("text").value, set: {}});
  by_id("own_text").value = own_example;
  by_id("own_run").onclick = judge_own;
  by_id("copy").onclick = async () => {
    await navigator.clipboard?.writeText(location.href).catch(() => {});
    by_id("copy").textContent = "copied";
  };
  document.onkeydown = e => {
    if (
      e.target.matches("input, select, textarea, button, summary") ||
      e.ctrlKey ||
      e.metaKey ||
      e.altKey
    )
      return;
    if (e.key === " " || e.key === "1") (toggle_sound("scheme"), e.preventDefault());
    else if (e.key === "2") toggle_sound("reference");
  };
  window.onresize = () => {
    draw_picture();
    draw_chart(true);
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
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) by_id("film").click();
  try {
    client.module = await unpacked(by_id("module").textContent);
    await start_worker();
  } catch (error) {
    return without_the_module(`This browser cannot start the module (${error.message})`);
  }
  if (!client.list.schemes.some(d => d.name === state.scheme)) state.scheme = "modal_two_point";
  show_state();
  if (state.tour) take_step();
  requestAnimationFrame(film_frame);
}
begin();
