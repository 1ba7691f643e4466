// The first screen: a sentence with two handles (measure and tolerance), the consequences, the
// chart with a line to drag, the ranking, and the commands for the cheapest run.
const answer = {}; // {scene, error, within, found}

const bold = text => text.split("*").map((part, k) => (k % 2 ? element("strong", {}, part) : part));
const note = text => element("p", {className: "soft small"}, text);
const card = (id, title, ...parts) =>
  element("section", {id, className: "card", ariaLabel: title}, element("h2", {}, title), ...parts);

function bar_of({best: {c, cost}, scheme}, k, [first], most) {
  const name = element("strong", {}, scheme_words(scheme)),
    words = option_words(c),
    place = [words && modes_words(c) ? words + ":" : words, modes_words(c), rate_words(c)],
    bar = element("i", {className: cost > most ? "broken" : ""}),
    text = time_text(cost) + (k ? ` \u00b7 ${times_words(cost / first.best.cost)}` : "");
  bar.style.width = `calc(${Math.min(1, cost / most)} * (100% - 160px))`;
  const row = element(
    "li",
    {className: k ? "" : "winner"},
    name,
    element("small", {}, place.filter(Boolean).join(" ")),
  );
  row.append(element("br"), sample_of(looks_of([variant(c)]).get(variant(c))), bar, text);
  row.dataset.n = c.n;
  return row;
}
const in_ranking = 8;
function ranking_of({ranking, unpriced, error, within}) {
  const met = ranking.filter(r => r.best),
    shown = met.slice(0, in_ranking),
    rest = ranking.filter(r => !r.best),
    tolerance = error_text(within, error),
    most = Math.min(8 * shown[0]?.best.cost, Math.max(...shown.map(r => r.best.cost))),
    nearest = r => "best " + quoted(r.nearest.c, error),
    in_words = r => (r.best ? "" : r.open ? "perhaps not within it, " : "not within it, ");
  const sentences = [
    ["Dearer", met.slice(in_ranking), r => times_words(r.best.cost / met[0].best.cost)],
    ["No cost measured", unpriced, r => in_words(r) + nearest(r)],
    [`Not known whether within ${tolerance}`, rest.filter(r => r.open), nearest],
    [`Never within ${tolerance}`, rest.filter(r => !r.open), nearest],
  ];
  return [
    shown.length ? note("Computing time for one second of sound. Bars start at 0.") : "",
    element("ol", {className: "ranking"}, ...shown.map((r, k) => bar_of(r, k, met, most))),
    ...sentences
      .filter(([, list]) => list.length)
      .map(([what, list, of]) =>
        note(`${what}: ${list.map(r => `${scheme_words(r.scheme)} (${of(r)})`).join("; ")}.`),
      ),
  ];
}

// Quotes a word for a shell, and a text for C++ and Python: the texts come from a record that
// somebody else wrote, and readers paste the commands.
const shell_word = text =>
  /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
const literal = text => JSON.stringify(text);

// Commands that repeat the cheapest run: {shell, "C++", Python}.
function commands(c) {
  const {asked_as = c.scene ?? page.title, set = []} = page.manifest?.scene ?? {},
    changed = [
      ...set,
      ...swept_keys().flatMap(key => (is_blank(c[key]) ? [] : [`${key}=${c[key]}`])),
    ],
    options = options_of(c),
    rate = c.rate > 0 ? c.rate : 0,
    modes = c.modes > 0 && !(c.fact_grid_intervals > 0) ? c.modes : 0,
    pairs = (...[open, between, close]) =>
      options
        .map(([name, value]) => open + literal(name) + between + literal(value) + close)
        .join(", ");
  const shell = [
    `jvari run ${shell_word(asked_as)} --scheme ${shell_word(c.scheme)}`,
    [rate && `--rate ${rate}`, modes && `--modes ${modes}`].filter(Boolean).join(" "),
    ...options.map(([name, value]) => `--option ${shell_word(`${name}=${value}`)}`),
    ...changed.map(text => `--set ${shell_word(text)}`),
    "--out string.wav",
  ];
  if (!page.schemes.some(([name]) => name === c.scheme)) return {};
  const all = {shell: shell.filter(Boolean).join(" \\\n    ")};
  if (changed.length) return all;
  all["C++"] = `const auto scene = jvari::read_scene(${literal(asked_as)});
const auto all = jvari::schemes();
const auto found = std::ranges::find(
    all, std::string(${literal(c.scheme)}), &jvari::Descriptor::name);
const auto voice = jvari::make_scheme(*found, scene, {
    .sample_rate = ${rate}, .tap_rate = 44100, .modes = ${modes},
    .options = {${pairs("{", ", ", "}")}}});
voice->advance(block);  // allocates nothing: docs/host.md`;
  all.Python = `run = jvari.run(${literal(asked_as)}, ${literal(c.scheme)},
    rate=${rate}, modes=${modes}, options={${pairs("", ": ", "")}})`;
  return all;
}
function take_it() {
  const code = element("pre", {tabIndex: 0, role: "region", ariaLabel: "the command"}),
    tabs = element("p", {className: "tabs"}),
    button = (text, onclick) => element("button", {type: "button", onclick}, text);
  const section = card("take", "Take it", tabs, code),
    copy = button("copy", async () => {
      await navigator.clipboard?.writeText(code.textContent).catch(() => {});
      copy.textContent = "copied";
    });
  answer.take = chosen => {
    const all = answer.found.best ? commands(answer.found.best.c) : {},
      choices = Object.keys(all).map(name => button(name, () => answer.take(name)));
    section.hidden = !choices.length;
    code.textContent = all[chosen] ?? all.shell ?? "";
    choices.forEach(b => b.setAttribute("aria-pressed", all[b.textContent] === code.textContent));
    copy.textContent = "copy";
    tabs.replaceChildren(...choices, copy);
  };
  return section;
}

// Groups of the first handle; errors of the headline's tap stand first in each, those of other taps
// in the last.
const groups = ["waveform", "loudness in bands", "other"],
  group_of = ({measure, tap}) =>
    ["waveform", "bands", "other"].indexOf(tap ? "other" : measure_of(measure)[4]);

// Builds the first screen. `section`: the chart's section, `heard`: cards with sounds.
function answer_of(section, heard) {
  const sub = element("p", {className: "sub"}),
    measure = element("select", {ariaLabel: "what is to be kept"}),
    typed = element("input", {id: "typed", size: 7, autocomplete: "off"}),
    hint = element("button", {type: "button", className: "hint"}),
    tolerance = element("label", {htmlFor: "within", className: "handle", title: "drag it"}),
    ending = element("span"),
    slider = element("input", {type: "range", id: "within", max: 1000, ariaLabel: "tolerance"}),
    tag = element("span", {className: "tag", ariaHidden: "true"}),
    lists = element("div"),
    ranking = card("ranking", "The cheapest run of each scheme", lists);
  let drawn = null, // the drawn chart: {view, frame, names, label}
    later = 0,
    errors = [],
    rows = [],
    ends = null;
  const at = t => (1000 * Math.log(t / ends.from)) / Math.log(ends.to / ends.from),
    of = x => ends.from * (ends.to / ends.from) ** (x / 1000),
    plot = () =>
      drawn.frame.querySelector(".mark-group.role-frame .background").getBoundingClientRect(),
    in_chart = event => drawn.view.scale("y").invert(event.clientY - plot().top);
  function place_tag() {
    const frame = drawn.frame.getBoundingClientRect();
    tag.style.left = `${plot().left - frame.left}px`;
    tag.style.top = `${plot().top - frame.top + drawn.view.scale("y")(answer.within)}px`;
  }
  function show() {
    const {error, within, scene} = answer,
      found = (answer.found = answer_at(rows, error, within)),
      text = error_text(within, error),
      best = found.best?.c;
    tolerance.textContent = text;
    tag.textContent = text + " \u2195";
    slider.value = at(within);
    slider.ariaValueText = text;
    if (document.activeElement !== typed) typed.value = text;
    hint_at(best);
    ending.textContent = finding_of(found);
    document.title = `${scene.replaceAll("_", " ")}: within ${text}${finding_of(found)}`;
    sub.replaceChildren(...bold(consequences(found, rows).join(" ")));
    ranking.firstChild.textContent = `The cheapest run of each scheme within ${text}`;
    lists.replaceChildren(...ranking_of(found));
    answer.take();
    player.prefer?.(best);
    if (!drawn) return;
    if (best?.line && !drawn.names.includes(best.line)) return drawn.draw();
    drawn.view.signal("within", within).signal("best", best?.n ?? null);
    drawn.view.signal("winner", best?.line || null);
    drawn.label();
    drawn.view.runAsync();
    place_tag();
  }
  function set(t) {
    answer.within = Number(Math.min(ends.to, Math.max(ends.from, t)).toPrecision(2));
    clearTimeout(later);
    const in_address = answer.within === ends.first ? null : answer.within;
    later = setTimeout(() => choose("within", in_address), 200);
    show();
  }
  // Drags a handle by the pointer. `value(move, from)`: tolerance for a move from a start.
  function draggable(handle, value) {
    handle.onpointerdown = event => {
      const from = {x: event.clientX, at: at(answer.within)};
      handle.setPointerCapture(event.pointerId);
      handle.onpointermove = move => set(value(move, from));
      event.preventDefault();
    };
    handle.onpointerup = handle.onpointercancel = () => (handle.onpointermove = null);
  }
  // Takes "0.3", "0.3 %" and "2 dB" alike: the unit is the measure's.
  typed.onchange = () => {
    const x = parseFloat(typed.value.replace(",", ".")) * (is_percent(answer.error) ? 0.01 : 1);
    if (x > 0) set(x);
    typed.value = error_text(answer.within, answer.error);
  };
  // The first error that some run keeps within its first tolerance.
  const kept = () =>
    errors.findIndex(e => answer_at(rows, e.column, tolerances(rows, e.column).first).best);
  function first_error() {
    const headline = errors.findIndex(e => e.column === errors_in(rows)[0].column),
      {column} = errors[headline];
    if (answer_at(rows, column, tolerances(rows, column).first).best) return headline;
    const k = kept();
    return k < 0 ? headline : k;
  }
  function hint_at(best) {
    const k = best ? -1 : kept();
    hint.hidden = k < 0 || k === measure.selectedIndex;
    if (hint.hidden) return;
    const {column} = errors[k];
    hint.textContent =
      `${spoken_error(errors[k], rows)} can be kept within ` +
      error_text(tolerances(rows, column).first, column);
    hint.onclick = () => {
      measure.selectedIndex = k;
      return measure.onchange();
    };
  }
  slider.oninput = () => set(of(Number(slider.value)));
  draggable(tolerance, (event, from) => of(from.at + 2 * (event.clientX - from.x)));
  draggable(tag, in_chart);

  function begin(wanted) {
    answer.error = errors[measure.selectedIndex].column;
    ends = tolerances(rows, answer.error);
    answer.within = wanted >= ends.from && wanted <= ends.to ? wanted : ends.first;
    show();
  }
  function fill(scene) {
    answer.scene = report.judged.includes(scene) ? scene : report.judged[0];
    rows = of_scene(cells(), answer.scene);
    const value = (c, column) => c.errors[column]?.value; // lists a tap equal to the headline once
    errors = errors_in(rows)
      .filter(e => !e.tap || !rows.every(c => Object.is(value(c, e.column), value(c, e.measure))))
      .sort((a, b) => group_of(a) - group_of(b));
    measure.replaceChildren(
      ...groups.map((label, k) =>
        element(
          "optgroup",
          {label},
          ...errors.filter(e => group_of(e) === k).map(e => new Option(spoken_error(e, rows))),
        ),
      ),
    );
    // Opens on the headline, or where no run keeps that, on what can be kept.
    const wanted = errors.findIndex(e => e.column === view.get("measure"));
    measure.selectedIndex = wanted >= 0 ? wanted : first_error();
    const {certificate, headline} = scene_facts(rows),
      {date, cpu, suite} = page.manifest ?? {};
    const facts = [
      suite && `record ${suite}`,
      date && new Date(date).toLocaleDateString("en-GB", {dateStyle: "medium", timeZone: "UTC"}),
      cpu && `one core of ${cpu}`,
      certificate >= 0
        ? `reference known to ${error_text(certificate, headline)}`
        : "how wrong the reference may be is not known",
    ];
    document
      .getElementById("about")
      .replaceChildren(
        element("strong", {}, answer.scene.replaceAll("_", " ")),
        element("span", {}, facts.filter(Boolean).join(" \u00b7 ")),
      );
    begin(Number(view.get("within") ?? NaN));
  }
  measure.onchange = async () => {
    const k = measure.selectedIndex;
    choose("measure", k === first_error() ? null : errors[k].column);
    choose("within", null);
    begin(NaN);
    await drawn?.draw();
  };
  const take = take_it();
  on_scene.push(fill);
  dark.addEventListener("change", show);
  document.querySelector("h1").replaceChildren("To keep ", measure, " within ", tolerance, ending);
  fill(scene_shown());
  const chart = {
    ...section.charts[0],
    chosen: () => {
      const {measure: measure_field, tap: tap_field} = errors[measure.selectedIndex];
      return {measure_field, tap_field, within: answer.within};
    },
    seen: shown => {
      drawn = {...shown, draw};
      drawn.frame.append(tag);
      draggable(drawn.frame.querySelector("svg"), in_chart);
      new ResizeObserver(place_tag).observe(drawn.frame);
    },
  };
  const {parts, draw} = chart_of(chart, section.id),
    key_to_it =
      "Down: more accurate. Left: cheaper. Filled: within the line. Dashed: matched; dotted: as " +
      "published.";
  drawings.push({id: section.id, draw});
  const first = card(section.id, section.heading, note(key_to_it), ...parts);
  const row = element(
    "p",
    {className: "typed"},
    slider,
    element("label", {}, "type it ", typed),
    hint,
  );
  return [sub, row, first, ranking, ...heard, take];
}
