// A scheme typed into the page. A separate worker runs the text: no access to the page, no network
// (the page's policy), and at most two seconds.
const own_limit = 2000; // [ms]
// p holds the string as arrays; return one array of p.rows numbers for each tap.
const own_example = `
// This is the modal two-point scheme with one contact, van Walstijn et al. 2016, eqs 33-48.
const dt = 1 / p.sample_rate, M = p.modes, g = p.contact_weights[0];
const c = p.threads ? p.thread_weights : g.map(() => 0);
const a = [], xi = [], y = [...p.start], q = y.map(() => 0), taps = p.tap_names.map(() => []);
for (let i = 0; i < M; ++i) {
  const w = Math.sqrt(p.omega0[i] ** 2 - p.sigma[i] ** 2), R = Math.exp(-p.sigma[i] * dt);
  const C = Math.cos(w * dt), den = 1 + 2 * R * C + R * R;
  a.push({a: (1 - 2 * R * C + R * R) / den, b: 2 * (1 - R * R) / den});
  xi.push(dt * dt / (2 * p.modal_mass) / (1 + a[i].a + a[i].b));
}
const dot = (u, v) => { let sum = 0; for (let i = 0; i < M; ++i) sum += u[i] * v[i]; return sum; };
const at = (u, v) => dot(u.map((x, i) => x * xi[i]), v);
const k = p.contact_stiffness[0], kc = p.thread_stiffness / 2 + p.thread_damping / dt;
const bb = at(g, g), bc = at(g, c), cc = at(c, c), theta = bb - bc * bc * kc / (1 + kc * cc);
const V = h => h > 0 ? 0.5 * k * h * h : 0;
let Fb = 0, Fc = 0;
for (let row = 0; row < p.rows; ++row) {
  const force = {bridge_force: Fb, thread_force: Fc};
  taps.forEach((tap, t) => tap.push(force[p.tap_quantities[t]] ?? dot(p.tap_weights[t], y)));
  Fb = Fc = 0;
  for (let step = 0; step < p.steps_per_row; ++step) {
    const s = y.map((_, i) => 2 * (q[i] - a[i].a * y[i]) / (1 + a[i].a + a[i].b));
    const vc = (p.thread_stiffness * (p.thread_height - dot(c, y)) - kc * dot(c, s)) /
               (1 + kc * cc);
    const d = p.contact_height[0] - dot(g, y), free = dot(g, s) + bc * vc;
    // F = (V(d - r) - V(d))/-r, r = free + theta F
    let lo = 0, hi = k * (Math.abs(d) + Math.abs(free)) + 1;
    for (let n = 0; n < 60; ++n) {
      const F = (lo + hi) / 2, r = free + theta * F;
      const mean = Math.abs(r) < 1e-18 ? k * Math.max(0, d) : (V(d) - V(d - r)) / r;
      if (mean > F) lo = F; else hi = F;
    }
    const F = (lo + hi) / 2, H = vc - kc * bc * F / (1 + kc * cc);
    for (let i = 0; i < M; ++i) {
      s[i] += xi[i] * (g[i] * F + c[i] * H);
      y[i] += s[i];
      q[i] = s[i] - q[i];
    }
    Fb += F / p.steps_per_row, Fc += H / p.steps_per_row;
  }
}
return taps;
`;

// Wraps the text into a worker's script. The script sends the result as a message and throws
// errors.
const own_prelude = 10; // lines of the script above the text
const own_script = text => `"use strict"; onmessage = ({data: p}) => {
        const began = performance.now(), taps = scheme(p), took = (performance.now() - began) / 1e3;
        const fail = text => { throw new Error(text); };
        if (!Array.isArray(taps) || taps.length !== p.taps)
          fail("it has to return an array for each of the " + p.taps + " taps");
        const rows = (t, k) => t?.length === p.rows ? Float64Array.from(t) :
          fail("tap " + p.tap_names[k] + " has " + t?.length + " rows, expected " + p.rows);
        postMessage({taps: taps.map(rows), took});
    };\nfunction scheme(p) {\n${text}\n}`;

function run_own(text, problem) {
  const url = script_of([own_script(text)]),
    worker = new Worker(url),
    late =
      `it was stopped after ${own_limit / 1e3} s. Make it faster, or write it as a plugin of the ` +
      "program";
  return new Promise((resolve, reject) => {
    setTimeout(() => reject(new Error(late)), own_limit);
    worker.onmessage = ({data}) => resolve(data);
    worker.onerror = e => {
      e.preventDefault();
      reject(new Error(`line ${Math.max(1, e.lineno - own_prelude)}: ${e.message}`));
    };
    worker.postMessage(problem);
  }).finally(() => {
    worker.terminate();
    URL.revokeObjectURL(url);
  });
}

async function judge_own() {
  const answer = document.getElementById("own_said"),
    text = document.getElementById("own_text").value;
  if (!shown.reference) {
    answer.textContent = "It needs a reference solution, and there is none yet.";
    return;
  }
  chart.own = [];
  answer.textContent = "It runs.";
  for (const rate of chart_rates.slice(0, 2)) {
    try {
      const problem = await ask("problem", {
        text: scene_text(),
        overrides: overrides_of(state.set),
        rate,
        modes: state.modes,
        duration: run_seconds(),
      });
      const {taps, took} = await run_own(text, problem),
        nut = Math.max(0, problem.tap_quantities.indexOf("nut_force")),
        exact = shown.reference.nut;
      const last = Math.min(
        exact.length - 1, // the window ends before its last row
        Math.ceil((shown.scene.free_from + (shown.verdict.window ?? 1)) * 44100 - 1e-6),
      );
      let apart = 0,
        of = 0;
      for (let n = Math.ceil(shown.scene.free_from * 44100 - 1e-6); n < last; ++n)
        ((apart += (taps[nut][n] - exact[n]) ** 2), (of += exact[n] ** 2));
      const error = Math.sqrt(apart / of);
      chart.own.push({
        scheme: "mine",
        compliance: "",
        rate,
        error,
        uncertainty: shown.verdict.uncertainty,
        outcome: Number.isFinite(error) ? "ok" : "diverged",
        cost: took / run_seconds(),
      });
      answer.textContent =
        chart.own.map(p => `${p.rate / 1e3} kHz: ${percent(p.error)} error`).join("; ") +
        ". The built-in modal_two_point has " +
        (chart.points
          .filter(p => p.scheme === "modal_two_point" && p.compliance === "own")
          .slice(0, chart.own.length)
          .map(p => percent(p.error))
          .join(" and ") || "no point here") +
        ".";
    } catch (error) {
      answer.textContent = `At ${rate / 1e3} kHz: ${error.message}.`;
      break;
    }
  }
  draw_chart();
}
