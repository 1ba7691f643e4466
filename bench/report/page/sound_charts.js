// Pictures of sounds: a scheme's trace over the reference's with the difference, either 50 ms
// sample by sample from the liveliest moment of the reference, or the whole as minimum and maximum
// in each of 800 stretches; and spectrograms side by side on one scale.
const beginning = 0.05,
  stretches = 800; // [s]; for the whole sound
// {samples, rate, scale} by sound; scale: the tap's unit per sample value
const waves = new Map();
function wave_of(sound) {
  if (!waves.has(sound))
    waves.set(sound, {
      samples: integers(sound.samples),
      rate: sound.rate,
      scale: sound.peak / 32767,
    });
  return waves.get(sound);
}
// Sounds in the page with their rows in sounds.csv. `rate` belongs to the samples, `hertz` to the
// scheme.
let all_sounds = null;
function sounds() {
  if (all_sounds) return all_sounds;
  all_sounds = page.sounds.map(sound => {
    const row = records("sounds")[sound.row] ?? sound,
      reference = row.scheme === "reference";
    return Object.assign(Object.create(row), sound, {
      reference,
      hertz: row.rate,
      detail: reference ? "" : kilohertz(row.rate),
      name:
        row.what ||
        (reference ? `reference ${reference_name(row.problem)}` : (row.series ?? row.name)),
    });
  });
  return all_sounds;
}
const reference_name = problem =>
  page.manifest?.reference?.name ??
  cells().find(c => c.problem === problem && c.reference)?.reference ??
  "";

// Start of the lively part [s]: the first stretch of 10 ms with changes from sample to sample at
// least half as large as in the liveliest stretch. This skips the slow pull of a finger.
function lively_from({samples, rate}) {
  const length = Math.floor(0.01 * rate),
    changes = [];
  for (let from = 0; length > 0 && from + length < samples.length; from += length) {
    let sum = 0;
    for (let n = from; n < from + length; ++n) sum += (samples[n + 1] - samples[n]) ** 2;
    changes.push(sum);
  }
  return changes.length ? 0.01 * changes.findIndex(x => x >= 0.5 * Math.max(...changes)) : 0;
}
function outline_of({samples, rate, scale}) {
  // [{ms, low, high}]
  const count = Math.min(samples.length, stretches);
  return Array.from({length: count}, (_, k) => {
    const part = samples.slice(
      Math.floor((k * samples.length) / count),
      Math.floor(((k + 1) * samples.length) / count),
    );
    return {
      ms: (1000 * (k + 0.5) * samples.length) / rate / count,
      low: scale * Math.min(...part),
      high: scale * Math.max(...part),
    };
  });
}
const drawn_sounds = () => sounds().filter(s => !s.reference && s.quantity);
function wave_spec(choice, print) {
  const own = drawn_sounds().find(s => s.file === choice.sound_field),
    against = sounds().find(s => s.file === own.reference_file);
  const wave = wave_of(own),
    truth = against && wave_of(against),
    from = truth ? lively_from(truth) : 0,
    rows = [];
  const hue = looks_of([own.series]).get(own.series).colour,
    domain = truth ? ["reference", "scheme", "difference"] : ["scheme"],
    grey = families[control_family][2];
  const color = {
    field: "who",
    type: "nominal",
    scale: {domain, range: truth ? [grey, hue, ink[0]] : [hue]},
    legend: {
      title: null,
      symbolType: "stroke",
      symbolStrokeWidth: 3,
      ...(print && print_width() < 500 ? {orient: "bottom"} : {}),
    },
  };
  const title = {
      title: print ? `${page.title} ${own.tap}: ${own.name}${own.detail && ", " + own.detail}` : "",
      subtitle: "50 ms, with the difference",
    },
    y = quantity("value", {format: "~g", labelOverlap: false});
  const x = quantity("ms", {title: "time [ms]", grid: false}, {nice: false}),
    head = above(`${own.tap} [${unit_of(own.quantity)}]`);
  if (choice.until_field > beginning) {
    for (const [who, w] of [
      ["reference", truth],
      ["scheme", wave],
    ])
      if (w) rows.push(...outline_of(w).map(row => ({...row, who})));
    const layer = [
      {
        data: {values: rows},
        mark: {type: "area", opacity: 0.75, line: false, tooltip: null},
        encoding: {y: {...y, field: "low"}, y2: {field: "high"}, color},
      },
      head,
    ];
    return {spec: framed({height: print ? 300 : 200, encoding: {x}, layer}, title, print)};
  }
  const first = Math.round(from * wave.rate),
    count = Math.min(wave.samples.length - first, Math.floor(choice.until_field * wave.rate) + 1);
  for (let n = first; n < first + count; ++n) {
    const ms = (1000 * n) / wave.rate,
      scheme = wave.samples[n] * wave.scale,
      reference = truth ? truth.samples[n] * truth.scale : NaN;
    for (const [who, value] of Object.entries({reference, scheme, difference: scheme - reference}))
      if (Number.isFinite(value)) rows.push({ms, who, value});
  }
  const mark = {type: "line", clip: true, strokeJoin: "round", tooltip: null},
    size = {condition: {test: "datum.who == 'reference'", value: 3.5}, value: 1.2};
  const layer = [
    {
      data: {values: rows},
      ...(print ? {} : zoomed("x")),
      mark,
      encoding: {y, color, size, detail: {field: "who"}},
    },
    head,
  ];
  return {spec: framed({height: print ? 300 : 200, encoding: {x}, layer}, title, print)};
}
function waveform_section() {
  const drawn = drawn_sounds(),
    scenes = distinct(drawn.map(s => s.problem)),
    longest = Math.max(...sounds().map(s => (s.samples.length * 3) / 8 / s.rate));
  if (!sounds().length || page.run) return null;
  const spans = [
      [0.05, "50 ms"],
      [0.02, "20 ms"],
      [0.005, "5 ms"],
      ...(longest > beginning ? [[longest, `whole, ${digits(longest, 3)} s`]] : []),
    ],
    chart = {
      name: "a scheme's trace over its reference's",
      menus: () => [{label: "show", key: "until_field", choices: spans}],
      scenes,
      spec: wave_spec,
      twins: [
        {file: "waveforms.svg", choice: {until_field: beginning, sound_field: drawn[0]?.file}},
      ],
    };
  return {
    id: "sounds",
    heading: "Traces, to look at and to listen to",
    charts: drawn.length ? [chart] : [],
    left_out: page.left_out.sounds,
  };
}

// ---- Spectrograms: 0-8 kHz, in decibels below the common maximum, as rectangles. Equal neighbours
// in time are merged, levels 80 dB below the maximum are background, and the steps in level, time
// and frequency grow until the rectangles fit.
const silent = -4000,
  level_range = 800; // [0.1 dB]
const levels = new Map();
function levels_of(kept) {
  if (!levels.has(kept)) levels.set(kept, {...kept, level: integers(kept.level)});
  return levels.get(kept);
}
// Strongest level among merged cells, in steps of level; -level_range for background.
function stepped(l, frame, row, step, top) {
  let strongest = silent;
  for (let m = frame; m < Math.min(frame + step.frames, l.frames); ++m)
    for (let r = row; r < Math.min(row + step.rows, l.rows); ++r)
      strongest = Math.max(strongest, l.level[m * l.rows + r]);
  return (
    -Math.floor((-Math.max(strongest - top, -level_range) + step.level / 2) / step.level) *
    step.level
  );
}
function tiles_of(panel, top, step, difference) {
  const l = panel.levels,
    against = panel.against,
    background = difference ? 0 : -level_range,
    tiles = [];
  for (let row = 0; row < l.rows; row += step.rows) {
    let before = background;
    for (let m = 0; m < l.frames; m += step.frames) {
      const own = stepped(l, m, row, step, top),
        both = difference && m < against.frames && row < against.rows;
      const level = !difference
          ? own
          : both
            ? own - stepped(against, m, row, step, top)
            : background,
        to = l.start + Math.min(m + step.frames, l.frames) * l.hop;
      if (level !== background && level === before) tiles.at(-1).b = to;
      else if (level !== background)
        tiles.push({
          a: l.start + m * l.hop,
          b: to,
          f: (row * l.row_hz) / 1000,
          g: (Math.min(row + step.rows, l.rows) * l.row_hz) / 1000,
          l: level / 10,
        });
      before = level;
    }
  }
  return tiles;
}
// Tiles for the panels {title, levels, against?, status}, at most `most` in all, and their common
// frame.
function tiled(panels, most, difference = false) {
  const heard = panels.filter(p => p.levels),
    top = Math.max(
      silent,
      ...heard.map(p => p.levels.level.reduce((a, b) => Math.max(a, b), silent)),
    );
  const step = {level: 20, frames: 1, rows: 1},
    make = () =>
      heard.map(p => (difference && !p.against ? [] : tiles_of(p, top, step, difference)));
  let all = make();
  for (let round = 0; all.flat().length > most && round < 12; ++round) {
    if (step.level < 50) step.level = step.level === 20 ? 40 : 50;
    else if (round % 2 === 0) step.frames *= 2;
    else step.rows *= 2;
    all = make();
  }
  heard.forEach((p, k) => {
    p.tiles = all[k];
  });
  const of = f => heard.map(p => f(p.levels));
  return {
    first: Math.min(...of(l => l.start)),
    last: Math.max(...of(l => l.start + l.frames * l.hop)),
    highest: Math.max(1, ...of(l => (l.rows * l.row_hz) / 1000)),
    width: 3 * Math.min(60, Math.max(...of(l => l.frames))),
  };
}
function panel_spec(panel, frame, {left, lowest, difference = false, size = {}}) {
  const axis = (shown, title) => ({
      title: shown ? title : null,
      labels: shown,
      tickCount: 4,
      grid: false,
    }),
    scale = domain => ({domain, nice: false, zero: false});
  const whole = {
    title: {text: panel.title, fontSize: 10, anchor: "start"},
    width: frame.width,
    height: 200,
    ...size,
  };
  if (!panel.levels)
    return {
      ...whole,
      view: {fill: "#eee"},
      data: {values: [{}]},
      mark: {type: "text", text: panel.status, fontSize: 12},
    };
  // viridis (van der Walt & Smith 2015)
  const range = difference
    ? {scheme: "purpleorange", domain: [-24, 24]}
    : {scheme: "viridis", domain: [-80, 0]};
  return {
    ...whole,
    view: {fill: difference ? "#f7f7f7" : "#440154"},
    data: {values: panel.tiles},
    mark: {type: "rect", aria: false, tooltip: null},
    encoding: {
      x: {
        field: "a",
        type: "quantitative",
        scale: scale([frame.first, frame.last]),
        axis: axis(lowest, "time [s]"),
      },
      x2: {field: "b"},
      y: {
        field: "f",
        type: "quantitative",
        scale: scale([0, frame.highest]),
        axis: axis(left !== null, left ? [left, "frequency [kHz]"] : "frequency [kHz]"),
      },
      y2: {field: "g"},
      color: {
        field: "l",
        type: "quantitative",
        scale: {...range, clamp: true},
        legend: {title: difference ? "dB" : "dB re common maximum", gradientLength: 200},
      },
    },
  };
}
const on_one_grid = (a, b) =>
  ["start", "hop", "row_hz"].every(
    key => Math.abs(a[key] - b[key]) <= 1e-6 * Math.abs(a[key]) + 1e-9,
  );
const spectrograms_across = 4;
// Spectrograms of the cells: {levels, status, problem, series, rate, reference, against: the
// reference's levels if both have the same grid}.
function heard_cells() {
  const several = distinct(cells().map(c => c.rate)).length > 1,
    references = new Map(
      page.levels.filter(l => l.problem !== undefined).map(l => [l.problem, levels_of(l)]),
    );
  return page.levels
    .filter(l => l.cell !== undefined)
    .map(kept => {
      const c = cells()[kept.cell],
        own = kept.frames > 0 ? levels_of(kept) : null,
        truth = references.get(c.problem);
      return {
        status: c.status,
        problem: c.problem,
        series: c.series,
        rate: several ? ` at ${digits(c.rate / 1000, 6)} kHz` : "",
        levels: own,
        reference: truth,
        against: own && truth && on_one_grid(own, truth) ? truth : null,
      };
    });
}
function spectrogram_spec(choice, print) {
  const all = heard_cells();
  if (print) {
    // Problems go down, schemes across.
    const across = distinct(all.map(p => p.series + p.rate)),
      down = distinct(all.map(p => p.problem)),
      frame = tiled(all, 14000);
    if (page.width) {
      // A column of a paper has two panels across, in turn.
      const size = {width: (print_width() - 60) / 2, height: 90},
        title = p =>
          [...(down.length > 1 ? [p.problem] : []), p.series, p.rate.trim()].filter(Boolean);
      const concat = all.map((p, k) =>
        panel_spec({...p, title: title(p)}, frame, {
          left: k % 2 ? null : "",
          lowest: k + 2 >= all.length,
          size,
        }),
      );
      return {
        spec: framed(
          {width: undefined, columns: 2, spacing: 10, concat},
          {title: page.title, subtitle: `spectrograms; ${page.source}`},
          true,
        ),
      };
    }
    const concat = down.flatMap((row, k) =>
      across.map((column, m) => {
        const panel = all.find(p => p.problem === row && p.series + p.rate === column) ?? {
          levels: null,
          status: "",
        };
        return panel_spec({...panel, title: k ? "" : column}, frame, {
          left: m ? null : row,
          lowest: k === down.length - 1,
        });
      }),
    );
    return {
      spec: framed(
        {width: undefined, columns: across.length, spacing: 12, concat},
        {title: page.title, subtitle: `spectrograms; ${page.source}`},
        true,
      ),
    };
  }
  const own = all.filter(p => p.problem === choice.scene),
    panels = own.map(p => ({...p, title: [p.series, p.rate.trim()].filter(Boolean)})),
    difference = choice.shown_field === "difference";
  if (own[0]?.reference)
    panels.unshift({title: ["reference"], levels: own[0].reference, status: ""});
  const frame = tiled(panels, 14000, difference);
  const concat = panels.map((p, k) =>
    panel_spec(p, frame, {
      left: k % spectrograms_across ? null : "",
      lowest: k + spectrograms_across >= panels.length,
      difference,
    }),
  );
  return {
    spec: framed({width: undefined, columns: spectrograms_across, spacing: 12, concat}, {}, false),
  };
}
function spectrogram_section() {
  const all = heard_cells(),
    scenes = distinct(all.map(p => p.problem)),
    differences = all.some(p => p.against);
  if (!all.length) return null;
  const menus = () =>
    differences
      ? [
          {
            label: "show",
            key: "shown_field",
            choices: [
              ["level", "levels"],
              ["difference", "difference from the reference"],
            ],
          },
        ]
      : [];
  const notes = [
    "Decibels below the maximum of all panels; the reference comes first." +
      (differences
        ? " A difference is that of the levels, where either lies above the background: " +
          "orange is louder than the reference."
        : ""),
  ];
  if (all.some(p => !p.reference))
    notes.push("Where a scene has no reference here, the suite kept no sound of it.");
  return {
    id: "spectrograms",
    heading: "Spectrograms",
    notes,
    charts: [
      {
        name: "spectrograms side by side, the reference first",
        scrolls: true,
        menus,
        scenes,
        spec: spectrogram_spec,
        twins: [{file: "spectrograms.svg", choice: {}}],
      },
    ],
  };
}
