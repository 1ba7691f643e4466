// Picture of one run: taps over time, spectrum and spectrogram of the first tap, the energy ledger
// if probed, and the times of contact. The program makes the tables: a value per stretch of time, a
// level per band.
const smallest = 10, // [px], 7.5 pt
  small_axis = {labelFontSize: smallest, titleFontSize: smallest, titlePadding: 2, tickSize: 3};
function run_spec(choice, print) {
  const {scheme, taps, heard, contact, ledger_open} = page.run,
    hue = looks_of([scheme]).get(scheme).colour,
    // A column of a paper has room for contacts, the first tap, spectrum and spectrogram.
    narrow = print && print_width() < 500,
    width = narrow ? print_width() : print ? print_width() - 60 : 700;
  const of = (name, columns) =>
    records(name).map(r => Object.fromEntries(columns.map(c => [c, finite(r[c])])));
  const axis = (field, title, scale = {}, format = "~g") => ({
      field,
      type: "quantitative",
      scale,
      axis: {title, format, titleLimit: 260, ...(narrow ? small_axis : {})},
    }),
    time = axis("t", narrow ? null : "time [s]", {nice: false});
  const panel = (title, height, values, mark, encoding) => ({
    title: {text: title, anchor: "start", fontSize: narrow ? smallest : 12},
    width,
    height,
    data: {values},
    mark: {tooltip: null, color: hue, ...mark},
    encoding,
  });
  const panels = taps.slice(0, narrow ? 1 : taps.length).map((tap, k) => {
    const values = of("waves_" + k, ["t", "low", "high"]),
      whole = values.every(v => v.low === v.high);
    return panel(
      `${tap.name} (${tap.quantity})`,
      narrow ? 50 : 110,
      values,
      {type: whole ? "line" : "area", strokeWidth: 1.2, line: false},
      {x: time, y: axis("low", tap.unit), ...(whole ? {} : {y2: {field: "high"}})},
    );
  });
  if (records("contacts").length)
    panels.splice(
      0,
      0,
      panel(
        contact.title,
        narrow ? 14 : 26,
        records("contacts").map(r => ({tap: r.tap, a: r.from, b: r.to})),
        {type: "bar", height: narrow ? 10 : 16},
        {
          x: {
            ...axis("a", "time [s]", {domain: [0, contact.until], nice: false}),
            ...(narrow ? {axis: null} : {}),
          },
          x2: {field: "b"},
          y: {field: "tap", type: "nominal", title: null, ...(narrow ? {axis: small_axis} : {})},
        },
      ),
    );
  if (records("spectrum").length)
    panels.push(
      panel(
        `spectrum of ${heard}`,
        narrow ? 50 : 140,
        of("spectrum", ["f", "level"]),
        {type: "line", strokeWidth: 1},
        {
          x: axis("f", "frequency [Hz]", {type: "log", nice: false}, ",~r"),
          y: axis("level", narrow ? "dB" : "level re strongest [dB]", {}, "d"),
        },
      ),
    );
  if (page.levels.length) {
    const sound = {title: `spectrogram of ${heard}`, levels: levels_of(page.levels[0])},
      frame = tiled([sound], 2800),
      panel = panel_spec(sound, frame, {
        left: "",
        lowest: true,
        size: {width, height: narrow ? 60 : 160},
      });
    const fontSize = narrow ? smallest : 12;
    if (narrow) {
      panel.encoding.color.legend = null; // it takes a third of a column
      Object.assign(panel.encoding.y.axis, {...small_axis, title: "kHz"});
      Object.assign(panel.encoding.x.axis, small_axis);
    }
    panels.push({...panel, title: {text: sound.title, anchor: "start", fontSize}});
  }
  const ledger = of("ledger", ["t", "stored", "supplied", "dissipated"]),
    names = {stored: "stored", supplied: "supplied so far", dissipated: "dissipated so far"};
  const most = Math.max(...ledger.flatMap(r => [r.stored, r.supplied, r.dissipated].map(Math.abs))),
    [factor, unit] = most < 1e-3 ? [1e6, "\u00b5J"] : most < 1 ? [1e3, "mJ"] : [1, "J"];
  if (ledger.length && !narrow)
    panels.push(
      panel(
        `energy balance, closes to ${ledger_open} of the largest stored energy`,
        110,
        ledger.flatMap(r =>
          Object.entries(names).map(([key, what]) => ({t: r.t, what, j: factor * r[key]})),
        ),
        {type: "line", strokeWidth: 1.4},
        {
          x: time,
          y: axis("j", unit),
          strokeDash: {
            field: "what",
            type: "nominal",
            scale: {
              domain: Object.values(names),
              range: [
                [1, 0],
                [6, 3],
                [2, 3],
              ],
            },
            legend: {title: null, symbolType: "stroke", symbolSize: 500, symbolStrokeWidth: 1.4},
          },
        },
      ),
    );
  return {
    spec: framed(
      {
        width: undefined,
        spacing: narrow ? 6 : 16,
        vconcat: panels,
        resolve: {scale: {color: "independent", strokeDash: "independent"}},
      },
      {title: page.title, subtitle: page.about},
      print,
    ),
  };
}
function run_section() {
  return page.run
    ? {
        id: "run",
        heading: "The run",
        charts: [
          {
            name: "waveforms, spectrum, spectrogram, energy and contact of the run",
            scrolls: true,
            spec: run_spec,
            twins: [{file: "run.svg", choice: {}}],
          },
        ],
      }
    : null;
}
