// The worker: answers questions from the page, in pieces, so that the newest state of the page
// wins. Each answer carries the number of the question.
let jvari,
  newest = 0,
  started;
const ready = new Promise(resolve => {
  started = resolve;
});
const turn = () =>
  new Promise(resolve => {
    const c = new MessageChannel();
    c.port1.onmessage = () => {
      c.port1.close();
      resolve();
    };
    c.port2.postMessage(0);
  });
class Stale extends Error {}

const asked_of = (state, more) => ({
  scene: state.text,
  overrides: state.overrides,
  scheme: state.scheme,
  rate: state.rate,
  modes: state.modes,
  options: state.options,
  ...more,
});
const options_of = (name, compliance) => {
  // Only some schemes know the option.
  const knows = jvari.known[name]?.options.some(o => o.name === "compliance");
  return knows && compliance ? [`compliance=${compliance}`] : [];
};
// Taps for the headline and the picture: the first nut force, or the first tap (0) without one; the
// first bridge force, or -1.
function headline_of(scene) {
  const first = quantity => scene.tap.findIndex(t => t.quantity === quantity);
  const nut = Math.max(0, first("nut_force"));
  return {nut, force: first("bridge_force")};
}

// Energy of a run: the stored energy as a curve, and the energy gained or lost without account,
// relative to the largest stored energy.
const balance_of = run => {
  const ledger = run.ledger();
  return ledger ? {stored: Float64Array.from(ledger[0]), residual: run.residual ?? NaN} : {};
};

function pictured(run, scene, points) {
  // Data of a run for the picture.
  const {nut, force} = headline_of(scene),
    count = scene.tap.length,
    shape = new Float32Array(run.rows * points);
  for (let k = 0; k < points; ++k) {
    const column = run.tap(count + k);
    for (let n = 0; n < run.rows; ++n) shape[n * points + k] = column[n];
  }
  return {
    shape,
    points,
    rows: run.rows,
    rate: run.rate,
    outcome: run.outcome,
    step: run.step,
    facts: run.facts,
    dofs: run.dofs,
    steps: run.steps,
    nut: Float64Array.from(run.tap(nut)),
    force: force < 0 ? null : Float64Array.from(run.tap(force)),
    ...balance_of(run),
  };
}

// ---- The reference solution, kept until the string changes. The uncertainty is the estimated
// change by further doublings of the modes.

let reference = null;
function forget() {
  reference?.runs.forEach(run => run.free());
  reference = null;
}
// Scenes with an exact solution that takes seconds: masses, many contacts, a power law, or a pluck
// in the closed form with many digits. The modes are not doubled for these.
const dear = scene =>
  scene.string.some(
    s =>
      s.mass.length > 0 ||
      s.barrier.length > 2 ||
      s.barrier.some(b => b.shape === "profile" || b.exponent !== 1),
  ) ||
  (scene.reference === "exact_linear" && scene.string.some(s => s.pluck));
async function reference_of(state, scene, go_on) {
  const key = JSON.stringify([state.text, state.overrides, state.window, state.shape]);
  if (reference?.key === key) return reference;
  forget();
  const {nut} = headline_of(scene),
    profile = scene.string.some(s => s.barrier.some(b => b.shape === "profile")),
    runs = [];
  // Matched compliance if the program uses it here and the reference does not refuse.
  let options = options_of(scene.reference, scene.matched ? "matched" : "");
  // Only the run with half the modes probes the energy: energy costs eight times as much as motion,
  // and half the modes hold all but 0.2 %.
  const run = (modes, more = {}, points = []) => {
    const solution = jvari.run({
      scene: state.text,
      overrides: state.overrides,
      scheme: scene.reference,
      modes,
      options: [...options, ...points],
      duration: state.window,
      ...more,
    });
    runs.push(solution);
    return solution;
  };
  try {
    const change = (fine, coarse) => jvari.error(fine, coarse, nut);
    let base;
    try {
      base = run(0, {shape: state.shape});
    } catch (error) {
      if (options.length === 0) throw error;
      options = [];
      base = run(0, {shape: state.shape});
    }
    // Rigid barriers are matched without the option.
    const rigid = scene.string.some(s => s.barrier.some(b => b.stiffness === Infinity)),
      matched = rigid || options.length > 0,
      modes = (base.dofs / 2) | 0;
    await go_on();
    // Half the modes, and half the points along a profile.
    const half = run(Math.max(1, modes >> 1), {energy: !dear(scene)}, profile ? ["nodes=16"] : []);
    await go_on();
    let best = base,
      changed = change(base, half),
      left = jvari.left_after(changed, NaN, matched);
    for (let more = 2; more <= 4 && !dear(scene) && !(left < 1e-3); more *= 2) {
      const finer = run(more * modes, {shape: state.shape}),
        by = change(finer, best);
      left = jvari.left_after(by, changed, matched);
      [best, changed] = [finer, by];
      await go_on();
    }
    const picture = {...pictured(best, scene, state.shape.length), stored: balance_of(half).stored};
    reference = {
      ...{key, runs, run: best, options, picture},
      ...{modes: (best.dofs / 2) | 0, uncertainty: left},
    };
    return reference;
  } catch (error) {
    runs.forEach(r => r.free());
    throw error;
  }
}

// Verdict on a run at the headline's tap: the error, and the time of agreement within 10 %.
function judged(run, scene, state) {
  const {nut} = headline_of(scene);
  return {
    error: jvari.error(run, reference.run, nut),
    horizon: jvari.horizon(run, reference.run, nut),
    uncertainty: reference.uncertainty,
    reference: scene.reference,
    options: reference.options,
    modes: reference.modes,
  };
}

// ---- The chart: schemes at several rates, each with error and cost [s per second of sound].

// Mean time of enough runs to fill a sample: a browser's clock is coarse.
const sample_seconds = 4e-3,
  rounds = 9;
function sampled(request, keep = () => ({})) {
  let spent = 0,
    runs = 0,
    kept;
  do {
    const run = jvari.run(request);
    spent += run.wall;
    kept ??= keep(run);
    run.free();
  } while (++runs < 30 && spent < sample_seconds);
  return {...kept, cost: spent / runs / request.duration};
}
function quartiles(costs) {
  const sorted = [...costs].sort((a, b) => a - b),
    at = part => {
      const place = part * (sorted.length - 1),
        low = Math.floor(place),
        rest = place - low;
      return (1 - rest) * sorted[low] + rest * sorted[Math.min(low + 1, sorted.length - 1)];
    };
  return {lower: at(0.25), cost: at(0.5), upper: at(0.75)};
}

// Cells of the chart, twenty: five schemes able to run the scene, among them the chosen scheme, at
// four rates.
const chart_lines = 5;
function cells_of({scheme, compliance, lines, rates}, scene) {
  const line_key = ([name, of]) => JSON.stringify([name, options_of(name, of)]),
    chosen = [scheme, compliance],
    able = lines.filter(([name]) => scene.able.includes(name)).slice(0, chart_lines);
  if (!able.some(line => line_key(line) === line_key(chosen)))
    able.splice(Math.min(able.length, chart_lines - 1), 1, chosen);
  return able.flatMap(([scheme, compliance]) => rates.map(rate => ({scheme, compliance, rate})));
}
let charted = ""; // key of the last whole chart, kept to save computing it again

// Runs each cell once for the error, then in rounds for the costs, in turn, like the program: a
// browser recompiles frequent code while it runs.
async function chart(state, scene, chosen, post, go_on) {
  const cells = [];
  for (const {scheme, compliance, rate} of chosen) {
    const options = options_of(scheme, compliance),
      label = {scheme, compliance: options.length ? compliance : "", rate};
    try {
      const request = {
        scene: state.text,
        overrides: state.overrides,
        scheme,
        rate,
        options,
        duration: state.window,
      };
      const point = sampled(request, run => ({
        ...label,
        ...judged(run, scene, state),
        outcome: run.outcome,
        dofs: run.dofs,
      }));
      post({kind: "point", point: {...point, lower: point.cost, upper: point.cost}});
      cells.push({label, request, costs: []});
    } catch (error) {
      post({kind: "point", point: {...label, refused: error.message}});
    }
    await go_on();
  }
  post({kind: "charted"});
  for (let round = 1; round <= rounds; ++round) {
    for (const {request, costs} of cells) {
      costs.push(sampled(request).cost);
      await go_on();
    }
    post({
      kind: "timed",
      last: round === rounds,
      costs: cells.map(({label, costs}) => ({...label, ...quartiles(costs)})),
    });
  }
}

// ---- One state of the page: the string, its motion, its sound, the reference, the chart.

async function show(request, post, go_on) {
  const scene = jvari.scene(request.text, [
    ...request.overrides.filter(o => !o.startsWith("duration=")),
    `duration=${request.window}`,
  ]);
  // Errors count after the pluck.
  const state = {...request, window: scene.free_from + request.window};
  const cells = cells_of(state, scene),
    key = JSON.stringify([state.text, state.overrides, cells]),
    kept = key === charted;
  post({kind: "scene", scene, cells: cells.length, kept});
  const points = state.shape.length,
    run = jvari.run(asked_of(state, {duration: state.window, shape: state.shape, energy: true}));
  try {
    const picture = pictured(run, scene, points);
    post({kind: "motion", picture});
    await go_on();
    const sound = jvari.run(asked_of(state, {duration: state.heard}));
    post({
      kind: "sound",
      of: "scheme",
      rate: sound.rate,
      sound: Float32Array.from(sound.tap(headline_of(scene).nut)),
      outcome: sound.outcome,
      cost: sound.wall / state.heard,
    });
    sound.free();
    await go_on();
    if (!scene.reference) return post({kind: "unreferenced"});
    await reference_of(state, scene, go_on);
    post({kind: "reference", picture: reference.picture, verdict: judged(run, scene, state)});
    await go_on();
  } finally {
    run.free();
  }
  if (kept) return post({kind: "charted", kept});
  await chart(state, scene, cells, post, go_on);
  charted = key;
}

// ---- Single questions from the player, the map and the tours, answered in turn.

const questions = {
  // One run, and with `beside` another of the same scene: the error, the difference in third
  // octaves within 60 dB of the loudest and in loudness above 2 kHz, and the time of agreement.
  pair({run: first, beside}) {
    const a = jvari.run(first),
      scene = jvari.scene(first.scene, first.overrides),
      {nut, force} = headline_of(scene);
    const summary_of = r => ({
      outcome: r.outcome,
      step: r.step,
      rate: r.rate,
      rows: r.rows,
      dofs: r.dofs,
      cost: r.wall / first.duration,
      facts: r.facts,
      nut: Float64Array.from(r.tap(nut)),
      force: force < 0 ? null : Float64Array.from(r.tap(force)),
      ...balance_of(r),
    });
    const answer = {run: summary_of(a)};
    if (beside) {
      const b = jvari.run({...first, options: [], ...beside});
      Object.assign(answer, {
        beside: summary_of(b),
        error: jvari.error(a, b, nut),
        horizon: jvari.horizon(a, b, nut),
        octaves: jvari.third_octaves(a, b, nut, 60),
        louder: jvari.louder(a, b, nut, 2000),
      });
      b.free();
    }
    a.free();
    return answer;
  },
  outcomes({runs}) {
    // Outcomes for a column of the map.
    return runs.map(request => {
      try {
        const run = jvari.run({...request, energy: true});
        run.free();
        return run.verdict;
      } catch {
        return "refused";
      }
    });
  },
  cheapest: ({points, accuracy}) => jvari.cheapest(points, accuracy),
  scene: ({text, overrides}) => jvari.scene(text, overrides),
  problem: ({text, overrides, rate, modes, duration}) =>
    jvari.problem(text, overrides, rate, modes, duration),
  memory: () => jvari.memory(),
};

onmessage = async ({data}) => {
  if (data.wasm) {
    jvari = jvari_core(
      await jvari_module({
        instantiateWasm: (imports, done) => {
          WebAssembly.instantiate(data.wasm, imports).then(i => done(i));
          return {};
        },
      }),
    );
    const list = jvari.list();
    jvari.known = Object.fromEntries([...list.schemes, ...list.references].map(d => [d.name, d]));
    started();
    return postMessage({kind: "ready", list});
  }
  await ready;
  if (data.question) {
    try {
      postMessage({kind: "answer", id: data.id, answer: questions[data.question](data)});
    } catch (error) {
      postMessage({kind: "answer", id: data.id, refused: error.message});
    }
    return;
  }
  newest = Math.max(newest, data.id);
  const post = message => postMessage({...message, id: data.id});
  const go_on = async () => {
    await turn();
    if (data.id !== newest) throw new Stale();
  };
  try {
    await go_on();
    await show(data.state, post, go_on);
  } catch (error) {
    if (!(error instanceof Stale)) post({kind: "refused", why: error.message});
  }
};
