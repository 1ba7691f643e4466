// Map of a scheme's failures: the outcome over the stiffness of the obstacle and the sample rate,
// filled column by column while you watch.
const map = {number: 0, columns: [], stiffness: [], rates: [], running: false};
const map_size = {columns: 28, rows: 13};

async function fill_map() {
  const number = ++map.number,
    base = shown.scene?.string[0].barrier[0];
  map.columns = [];
  if (!base) return draw_map("This string has no obstacle.");
  const middle = Math.log10((map.around ??= base.stiffness));
  map.stiffness = Array.from(
    {length: map_size.columns},
    (_, k) => 10 ** (middle - 3 + (5 * k) / (map_size.columns - 1)),
  );
  map.rates = Array.from({length: map_size.rows}, (_, k) => Math.round(22050 * 2 ** (k / 3)));
  map.running = true;
  for (const stiffness of map.stiffness) {
    try {
      const runs = map.rates.map(rate => run_at(stiffness, rate)),
        column = await ask("outcomes", {runs});
      if (number !== map.number) return;
      map.columns.push(column);
      draw_map();
    } catch {
      return; // the worker was replaced, and another request fills the map
    }
  }
  map.running = false;
  draw_map();
}

// Colours by outcome; the outcomes are the program's (analysis/judgement.hpp).
const kinds = {
  sound: "sound",
  flagged: "flagged",
  energy_gaining: "gains",
  adhesive: "force",
  diverged: "fails",
  not_converged: "stuck",
  unjudged: "soft",
  refused: "none",
};

function draw_map(note = "") {
  const {pen, width, height} = canvas_of("map"),
    left = 58,
    bottom = 34,
    across = (width - left - 8) / map_size.columns,
    up = (height - bottom - 6) / map_size.rows;
  map.columns.forEach((column, k) =>
    column.forEach((cell, n) => {
      pen.fillStyle = colour(kinds[cell]);
      pen.fillRect(
        left + k * across,
        6 + (map_size.rows - 1 - n) * up,
        Math.ceil(across) - 0.5,
        Math.ceil(up) - 0.5,
      );
    }),
  );
  pen.fillStyle = colour("soft");
  map.rates.forEach((rate, n) => {
    if (n % 3 === 0)
      pen.fillText(`${(rate / 1e3).toPrecision(3)} kHz`, 4, 6 + (map_size.rows - 0.5 - n) * up + 4);
  });
  map.stiffness.forEach((k, n) => {
    if (n % 6 === 3)
      pen.fillText(k.toExponential(0).replace("e+", "e"), left + n * across - 8, height - 18);
  });
  pen.fillText("stiffness of the obstacle", left + (width - left) / 2 - 60, height - 3);
  const stiffness = shown.scene?.string[0].barrier[0]?.stiffness;
  if (stiffness && map.stiffness.length) {
    const k =
        ((Math.log10(stiffness) - Math.log10(map.stiffness[0])) /
          (Math.log10(map.stiffness.at(-1)) - Math.log10(map.stiffness[0]))) *
        (map_size.columns - 1),
      n = 3 * Math.log2(state.rate / 22050);
    pen.strokeStyle = colour("ink");
    pen.lineWidth = 2;
    (pen.beginPath(),
      pen.arc(left + (k + 0.5) * across, 6 + (map_size.rows - 0.5 - n) * up, 7, 0, 7),
      pen.stroke());
  }
  const cells = map.columns.flat(),
    count = kind => cells.filter(c => c === kind).length,
    found = Object.keys(kinds).filter(count);
  const summary =
      note || `${state.scheme}: ${cells.length} of ${map_size.columns * map_size.rows} runs. `,
    counted = found.map(kind => [kind, `${kind.replace("_", " ")}: ${count(kind)}; `]);
  by_id("map_said").replaceChildren(
    summary,
    ...counted.flatMap(([kind, text]) => [
      element("span", {className: "key", style: `background: var(--${kinds[kind]})`}),
      text,
    ]),
  );
  const words = [summary, ...counted.map(([, text]) => text)].join("");
  by_id("map").setAttribute(
    "aria-label",
    `map of outcomes over stiffness and sample rate. ${words}`,
  );
}

function watch_map() {
  const canvas = document.getElementById("map");
  canvas.onclick = e => {
    const box = canvas.getBoundingClientRect(),
      left = 58,
      across = (box.width - left - 8) / map_size.columns,
      k = Math.floor((e.clientX - box.left - left) / across);
    if (map.stiffness[k]) move_handle("bridge_stiffness", map.stiffness[k]);
  };
  const part = document.getElementById("map_part");
  part.ontoggle = () => {
    if (part.open) fill_map();
  };
}
