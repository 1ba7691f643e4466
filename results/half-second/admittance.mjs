// What a contact sees of a string, over frequency: draws admittance.svg beside this file, and
// admittance.csv with what is drawn.
//     node results/half-second/admittance.mjs
// Displacement at the contact per newton, mean over a step, of a force that is constant over each
// step: of the true string (6000 modes, exact in time), of the modes below 20 kHz by the matched
// two-point step (van Walstijn et al. 2016, eqs 32-38, with true impedances), the difference of the
// two, and the ladder that stands for it (docs/compliance-matching.md). On a circle |z| > 1 three
// mode spacings outside, so that single resonances blur.
import {writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";
import * as vega from "vega";
import * as vegaLite from "vega-lite";

const here = dirname(fileURLToPath(import.meta.url)),
  all = 6000,
  rates = [44100, 176400],
  points = 120;

// scenes/tanpura_c3_release.toml at its bridge, scenes/guitar_over_fret.toml at its fret
const contacts = [
  {
    name: "bridge of C3",
    L: 1,
    mu: 4.83e-4,
    T: 33.1,
    EI: 6.03e-5,
    s: [0.6, 6.5e-3, 5e-6],
    x: 10e-3,
    w: 2e-3,
  },
  {
    name: "fret of the guitar",
    L: 0.648,
    mu: 6.8e-3,
    T: 77.56,
    EI: 4.4e-4,
    s: [0.6, 8e-3, 5e-7],
    x: 36.4e-3,
    w: 2e-3,
  },
];

const times = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
const over = ([a, b], [c, d]) => [
  (a * c + b * d) / (c * c + d * d),
  (b * c - a * d) / (c * c + d * d),
];
const plus = ([a, b], [c, d]) => [a + c, b + d];

function modesOf(c) {
  return Array.from({length: all}, (_, i) => {
    // a cosine footprint
    const b = ((i + 1) * Math.PI) / c.L,
      q = b * c.w,
      apart = Math.PI ** 2 - q * q;
    const g =
      Math.sin(b * c.x) *
      (Math.abs(apart) < 1e-9 ? Math.PI / 4 : (Math.PI ** 2 * Math.cos(q / 2)) / apart);
    return {
      omega: Math.sqrt((c.T * b * b + c.EI * b ** 4) / c.mu),
      sigma: c.s[0] + c.s[1] * b + c.s[2] * b ** 3,
      yields: (2 * g * g) / (c.mu * c.L),
    };
  });
}

// y over F of a mode, at z: F constant over a step, exact
function exact({omega, sigma, yields}, z, h) {
  const w = Math.sqrt(omega ** 2 - sigma ** 2),
    e = Math.exp(-sigma * h),
    c = e * Math.cos(w * h),
    s = ((e * sigma) / w) * Math.sin(w * h);
  const below = plus(plus(times(z, z), times([-2 * c, 0], z)), [e * e, 0]);
  return times(
    [yields / omega ** 2, 0],
    over(plus(times([1 - c - s, 0], z), [e * e + s - c, 0]), below),
  );
}
// and by the two-point step: (z - 1)(z - 1 + l) + c z, with A of eq 33, and the gain by which
// sqrt(k m) of the mode is the true one
function stepped({omega, sigma, yields}, z, h) {
  const e = Math.exp(-sigma * h),
    l = 1 - e * e,
    c = 2 - l - 2 * e * Math.cos(Math.sqrt(omega ** 2 - sigma ** 2) * h);
  const byJ = 1 - c / 4 - l / 2,
    gain = 0.5 * yields * h * h * byJ * (Math.sqrt(c / 4 / byJ) / ((omega * h) / 2)),
    back = plus(z, [-1, 0]);
  return times(
    [gain, 0],
    over(plus(z, [1, 0]), plus(times(back, plus(back, [l, 0])), times([c, 0], z))),
  );
}

const table = [];
for (const c of contacts)
  for (const rate of rates) {
    const modes = modesOf(c),
      kept = modes.filter(m => m.omega < 2 * Math.PI * 20e3).length,
      h = 1 / rate;
    const sum = (some, of) => some.map(of).reduceRight((a, b) => a + b, 0);
    const atRest = m => m.yields / m.omega ** 2,
      beyond = modes.slice(kept),
      cut = sum(beyond, atRest);
    const mass = sum(beyond, m => atRest(m) / m.omega ** 2) / cut ** 2;
    const touching = Array.from({length: 22}, (_, k) => modes[kept - 1].omega * 1.1 ** k).map(s => {
      const there = sum(beyond, m => m.yields / (m.omega ** 2 + s ** 2));
      return (mass * s) / ((mass * s * s) / (1 / there - 1 / cut) - 1);
    });
    const nyquist = Math.PI / h,
      kept_ones = modes.slice(0, kept),
      inertia = some => sum(some, m => atRest(m) / m.omega ** 2);
    const heavier =
      sum(kept_ones, ({omega, yields}) => {
        const more = sum(beyond, m => atRest(m) / (m.omega ** 2 - omega ** 2));
        return ((yields / omega) * more) / (cut * (cut + more * omega ** 2));
      }) / sum(kept_ones, m => m.yields / m.omega);
    const carried = (heavier * inertia(beyond.filter(m => m.omega < nyquist))) / inertia(beyond);
    const branch = ((2 * carried) / h) * Math.tanh((Math.min(...touching) * h) / carried / 2);
    const own = sum(modes.slice(0, kept), m => stepped(m, [1 + 1e-9, 0], h)[0]),
      C = sum(modes, atRest) - own;
    const damper =
      ((h / 2) *
        sum(
          beyond.filter(m => m.omega > nyquist),
          atRest,
        )) /
      C ** 2;
    const blur = Math.exp(((3 * Math.PI) / c.L) * Math.sqrt(c.T / c.mu) * h);
    for (let k = 0; k < points; ++k) {
      const phase = (Math.PI * (k + 0.5)) / points,
        z = [blur * Math.cos(phase), blur * Math.sin(phase)],
        mean = times([0.5, 0], plus(z, [1, 0]));
      const total = (some, of) => times(mean, some.map(m => of(m, z, h)).reduce(plus));
      const truth = total(modes, exact),
        scheme = total(modes.slice(0, kept), stepped),
        missing = plus(truth, times([-1, 0], scheme));
      const speed = times([2 / h, 0], over(plus(z, [-1, 0]), plus(z, [1, 0])));
      const behind = over([carried * branch, 0], plus([branch, 0], times(speed, [carried, 0])));
      const element = over(
        [1, 0],
        plus([1 / C, 0], times(speed, plus([damper, 0], times(speed, behind)))),
      );
      const lines = {
        "true string": truth,
        "modes and step": scheme,
        "what is missing": missing,
        ladder: element,
      };
      for (const [line, [re, im]] of Object.entries(lines))
        table.push({
          contact: c.name,
          rate,
          line,
          frequency_hz: (phase * rate) / (2 * Math.PI),
          admittance_m_per_N: Math.hypot(re, im),
        });
    }
    console.log(
      `${c.name}, ${rate} Hz: ${kept} modes, C ${C.toExponential(2)} m/N, damper ` +
        `${damper.toPrecision(3)} and ${branch.toPrecision(3)} kg/s, mass ` +
        `${carried.toExponential(2)} kg`,
    );
  }
const rounded = x => Number(x.toPrecision(4));
const columns = Object.keys(table[0]);
const text = x => (typeof x === "number" ? String(rounded(x)) : x);
writeFileSync(
  join(here, "admittance.csv"),
  [columns.join(","), ...table.map(row => columns.map(c => text(row[c])).join(","))].join("\n") +
    "\n",
);

const order = ["true string", "modes and step", "what is missing", "ladder"];
const chart = {
  $schema: "https://vega.github.io/schema/vega-lite/v5.json",
  title: {text: "What a contact sees, up to half the sample rate", anchor: "start"},
  data: {
    values: table.map(row => ({
      ...row,
      kHz: rounded(row.frequency_hz / 1e3),
      Y: rounded(row.admittance_m_per_N),
    })),
  },
  facet: {
    column: {field: "contact", title: null, sort: contacts.map(c => c.name)},
    row: {field: "rate", title: "sample rate [Hz]"},
  },
  resolve: {scale: {x: "independent", y: "shared"}},
  spec: {
    width: 320,
    height: 190,
    mark: {type: "line", clip: true},
    encoding: {
      x: {field: "kHz", type: "quantitative", title: "frequency [kHz]", scale: {nice: false}},
      y: {
        field: "Y",
        type: "quantitative",
        title: "displacement per force [m/N]",
        scale: {type: "log", domain: [1e-8, 1e-3]},
      },
      color: {
        field: "line",
        type: "nominal",
        title: null,
        sort: order,
        scale: {domain: order, range: ["#222222", "#7f7f7f", "#1f77b4", "#d62728"]},
      },
      strokeDash: {
        field: "line",
        type: "nominal",
        sort: order,
        scale: {
          domain: order,
          range: [
            [1, 0],
            [6, 3],
            [1, 0],
            [6, 3],
          ],
        },
      },
    },
  },
  config: {background: "white", view: {stroke: null}},
};
const view = new vega.View(vega.parse(vegaLite.compile(chart).spec), {renderer: "none"});
writeFileSync(join(here, "admittance.svg"), await view.toSVG());
