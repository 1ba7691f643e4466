// Files of the reader: a scene, a table of modes or the profile of a bridge, dropped on the page or
// chosen. They stay in the page and in its link.
const columns_of = text => {
  const lines = text.split(/\r?\n/).filter(line => line.trim() && !line.startsWith("#")),
    cut = line => line.split(/[,;\t]/).map(cell => cell.trim().replace(/^"|"$/g, "")),
    names = cut(lines[0] ?? "").map(name => name.toLowerCase()),
    rows = lines.slice(1).map(line => cut(line).map(Number));
  return pattern => {
    const k = names.findIndex(name => pattern.test(name));
    if (k < 0) return null;
    return {name: names[k], values: rows.map(row => row[k]).filter(Number.isFinite)};
  };
};

// Changes to the state that put a table into the string, and a sentence about them.
function with_table(name, text) {
  const column = columns_of(text),
    [frequency, mode, x] = [/^(f_|freq)/, /^mode$/, /^x_/].map(column),
    key = word => `string.0.${word}`;
  if (frequency?.values.length) {
    const {length, linear_density} = shown.scene.string[0],
      hertz = frequency.values[0] * (/khz/.test(frequency.name) ? 1000 : 1),
      tension = linear_density * (2 * length * (hertz / (mode?.values[0] ?? 1))) ** 2;
    return {
      set: {
        ...state.set,
        [key("damping.law")]: '"table"',
        [key("damping.file")]: JSON.stringify(name),
        [key("tension")]: tension.toPrecision(5),
      },
      note:
        `${name}: ${frequency.values.length} modes. The tension is set to ` +
        `${tension.toPrecision(3)} N by the first one.`,
    };
  }
  if (x?.values.length) {
    const by = /mm/.test(x.name) ? 1e-3 : 1,
      first = shown.scene.string[0].barrier[0],
      has_profile = first?.shape === "profile",
      barrier = {
        curve: '"table"',
        file: JSON.stringify(name),
        from: by * Math.min(...x.values),
        to: by * Math.max(...x.values),
      };
    return {
      ...(has_profile ? {} : {scene: "sitar_parabola", text: null}),
      set: {
        ...(has_profile ? state.set : {}),
        ...Object.fromEntries(
          Object.entries(barrier).map(([word, value]) => [key(`barrier.0.${word}`), `${value}`]),
        ),
      },
      note:
        `${name}: a profile of ${x.values.length} points` +
        (has_profile ? "." : ", under the string of sitar_parabola."),
    };
  }
  return {
    note:
      `${name}: found neither a column of frequencies nor one of places. Expected frequency_hz ` +
      "and decay_rate_per_s (or t60_s), or x_m and height_m (or x_mm and height_mm).",
  };
}

async function take_files(list) {
  const files = await Promise.all(
      [...list].map(async f => [f.name.replace(/[^\w.-]/g, "_"), await f.text()]),
    ),
    scene = files.find(([name]) => name.endsWith(".toml")),
    tables = files.filter(([name]) => !name.endsWith(".toml"));
  state.tour = "";
  take_step();
  const kept_files = {...state.files, ...Object.fromEntries(tables)};
  drop.note = "";
  if (scene) choose({text: scene[1], set: {}, files: kept_files});
  else
    for (const [name, text] of tables) {
      const {note, ...more} = with_table(name, text);
      drop.note = note;
      if (more.set) choose({...more, files: kept_files});
      else say(note);
    }
}
const drop = {note: ""};

function watch_files() {
  by_id("files").onchange = e => take_files(e.target.files);
  document.ondragover = e => e.preventDefault();
  document.ondrop = e => {
    e.preventDefault();
    if (e.dataTransfer.files.length) take_files(e.dataTransfer.files);
  };
}
