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

// The page's state is a run's request: {...state, rate: 88200} asks for another run of the string.
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

// The stored energy of a run as a curve.
const stored_of = run => {
  const ledger = run.ledger();
  return ledger && Float64Array.from(ledger[0]);
};
// What the page needs of a run: what the core says about it, and the headline's taps.
function summary_of({handle, tap, ledger, free, ...about}, scene) {
  const {nut, force} = headline_of(scene);
  return {
    ...about,
    nut: Float64Array.from(tap(nut)),
    force: force < 0 ? null : Float64Array.from(tap(force)),
    stored: stored_of({ledger}),
  };
}
// The same with the shape of the string, for the picture.
function pictured(run, scene, points) {
  const shape = new Float32Array(run.rows * points);
  for (let k = 0; k < points; ++k) {
    const column = run.tap(scene.tap.length + k);
    for (let n = 0; n < run.rows; ++n) shape[n * points + k] = column[n];
  }
  return {...summary_of(run, scene), shape, points};
}
// The first of a list of settings that the core does not refuse, by `act`.
function first_taken(list, act) {
  let why;
  for (const one of list)
    try {
      return act(one);
    } catch (error) {
      why = error;
    }
  throw why;
}

// ---- What a run is judged by, kept until the string changes: first an estimate by two runs, then
// the exact solution. `jvari run --within` (bench/README.md) counts the difference between two
// runs, the finer with twice the rate and 1.5 or 2 times the modes, 2.5 times as the error of the
// coarser. If both err to the same side, that leaves 1.5 times for the finer, the uncertainty here;
// no record verifies it. The uncertainty of the exact solution is the estimated change by further
// doublings of the modes.

const kept = {key: "", estimate: null, exact: null, known: null};
function forget() {
  for (const of of [kept.estimate, kept.exact, kept.known]) of?.runs.forEach(run => run.free());
  Object.assign(kept, {key: "", estimate: null, exact: null, known: null});
}
// Windows after the pluck [s]; a run is judged over the longest that is known to a tenth.
const windows = [50e-3, 20e-3, 10e-3, 5e-3],
  known_to = 0.1;
const known_over = uncertain => {
  const k = uncertain.findIndex(u => u <= known_to);
  return {window: windows[k] ?? null, uncertainty: uncertain[Math.max(0, k)]};
};
const differences = (a, b, tap) => windows.map(w => jvari.error(a, b, tap, w));

const estimators = ["modal_two_moment", "modal_two_point"],
  estimate_seconds = 0.6; // a finer run is made where it probably takes no longer
async function estimate_of(state, scene, go_on) {
  const {nut} = headline_of(scene),
    able = name => scene.able.includes(name),
    scheme = [...estimators, state.scheme].find(able),
    profile = scene.string.some(s => s.barrier.some(b => b.shape === "profile")),
    knows_points = jvari.known[scheme].options.some(o => o.name === "points"),
    runs = [];
  const run = (times, modes, options, points) => {
    const request = {
        ...{scheme, rate: 44100 * times, modes: Math.round(modes)},
        options: profile && knows_points ? [...options, `points=${points}`] : options,
      },
      found = jvari.run({...state, ...request, shape: state.places});
    runs.push(found);
    return Object.assign(found, {request, times, choice: options, points});
  };
  // Twice the rate, the points of a profile and the modes of a run; a table has no more modes.
  const finer = ({times, modes, choice, points}, factors) =>
    first_taken(factors, by => run(2 * times, by * modes, choice, 2 * points));
  try {
    // Matched where the finer run can be too.
    let [coarse, fine] = first_taken([[2, 1.5], [1]], factors =>
      first_taken(["matched", "own"], compliance => {
        const first = run(2, 0, options_of(scheme, compliance), 16);
        return [first, finer(first, factors)];
      }),
    );
    const heard = [coarse.request, fine.request];
    // A difference counts as a third of the one before at least.
    const counted = before =>
      differences(coarse, fine, nut).map((d, k) => Math.max(d, before[k] / 3));
    let difference = counted(windows.map(() => 0));
    while (fine.times < 32 && 4 * fine.wall < estimate_seconds && !(difference[0] < 0.01)) {
      await go_on();
      let next;
      try {
        next = finer(fine, [2, 1.5]);
      } catch {
        break;
      }
      [coarse, fine] = [fine, next];
      difference = counted(difference);
    }
    return {
      ...{runs, run: fine, estimated: true, recorded: estimators.includes(scheme), heard},
      ...{...fine.request, modes: fine.modes, ...known_over(difference.map(d => 1.5 * d))},
      horizon: jvari.horizon(coarse, fine, nut),
      cost: fine.wall / state.duration / (fine.times / 4) ** 2, // of the first finer run
      picture: pictured(fine, scene, state.places.length),
    };
  } catch (error) {
    runs.forEach(r => r.free());
    throw error;
  }
}

// Scenes with an exact solution that takes seconds: masses, many contacts, a power law, or a pluck
// in the closed form with many digits. It is computed at request, and its modes are not doubled.
const dear = scene =>
  scene.string.some(
    s =>
      s.mass.length > 0 ||
      s.barrier.length > 2 ||
      s.barrier.some(b => b.shape === "profile" || b.exponent !== 1),
  ) ||
  (scene.reference === "exact_linear" && scene.string.some(s => s.pluck));
async function exact_of(state, scene, go_on) {
  const {nut} = headline_of(scene),
    profile = scene.string.some(s => s.barrier.some(b => b.shape === "profile")),
    runs = [];
  // Matched compliance if the program uses it here and the reference does not refuse.
  let options;
  // Only the run with half the modes probes the energy: energy costs eight times as much as motion,
  // and half the modes hold all but 0.2 %.
  const run = (modes, more = {}, points = []) => {
    const request = {scheme: scene.reference, modes, options: [...options, ...points]},
      solution = jvari.run({...state, ...request, ...more});
    runs.push(solution);
    return solution;
  };
  try {
    const change = (fine, coarse) => differences(fine, coarse, nut),
      base = first_taken(scene.matched ? ["matched", ""] : [""], compliance => {
        options = options_of(scene.reference, compliance);
        return run(0, {shape: state.places});
      });
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
      left = changed.map(c => jvari.left_after(c, NaN, matched));
    for (let more = 2; more <= 4 && !dear(scene) && !(left[0] < 1e-3); more *= 2) {
      const finer = run(more * modes, {shape: state.places}),
        by = change(finer, best);
      left = by.map((b, k) => jvari.left_after(b, changed[k], matched));
      [best, changed] = [finer, by];
      await go_on();
    }
    const picture = {...pictured(best, scene, state.places.length), stored: stored_of(half)};
    return {
      ...{runs, run: best, scheme: scene.reference, options, picture},
      ...{modes: (best.dofs / 2) | 0, ...known_over(left)},
    };
  } catch (error) {
    runs.forEach(r => r.free());
    throw error;
  }
}
// The program's solution of a string of the library: the headline's tap after the pluck, by the
// differences of its samples. It takes the column of a run of the same rows.
function known_of({known, ...state}, scene) {
  const {scheme, rate, modes, options} = kept.estimate.heard[0],
    run = jvari.run({...state, scheme, rate, modes, options}),
    column = run.tap(headline_of(scene).nut),
    first = run.rows - known.differences.length;
  let sum = 0;
  known.differences.forEach((d, k) => (column[first + k] = (sum += d) * known.unit));
  const {reference, uncertainty, window} = known;
  return {
    ...{runs: [run], run, nut: Float64Array.from(column)},
    ...{scheme: reference, modes: known.modes, uncertainty, window},
  };
}
// What is drawn and heard as the string itself; and what a run is judged by: a solution that is
// known over no window gives way to an estimate that is.
const drawn = () =>
    kept.exact?.window || !kept.estimate?.window ? (kept.exact ?? kept.estimate) : kept.estimate,
  best_kept = () => kept.known ?? drawn(),
  picture = () => ({...drawn().picture, ...(kept.known ? {nut: kept.known.nut} : {})}),
  heard_of = ({scheme, options, estimated, rate, modes}) =>
    estimated ? {scheme, options, estimated, rate, modes} : {scheme, options, modes: 0};

// Verdict on a run at the headline's tap: the error, and the time of agreement within 10 %.
function judged(run, scene) {
  const {nut} = headline_of(scene),
    of = best_kept(),
    {estimated, recorded, window, uncertainty, scheme, modes} = of;
  return {
    ...{estimated, recorded, window, uncertainty, reference: scheme, modes},
    heard: heard_of(drawn()),
    error: jvari.error(run, of.run, nut, window ?? 0),
    horizon: jvari.horizon(run, of.run, nut),
    known_for: of.horizon ?? null,
  };
}

// How the scheme sounds, beside the finer of the first two runs of the estimate; and how the coarser
// does, which says how far that is known.
const words_seconds = 0.5, // of computing
  words_heard = 1;
async function words_of(state, scene, go_on) {
  const [coarse, fine] = kept.estimate.heard,
    seconds = Math.max(0.1, Math.min(words_heard, words_seconds / kept.estimate.cost)),
    {nut} = headline_of(scene),
    runs = [];
  try {
    for (const request of [{}, fine, coarse]) {
      runs.push(jvari.run({...state, ...request, duration: scene.free_from + seconds}));
      await go_on();
    }
    const [a, b, c] = runs,
      beside_fine = run => jvari.sounds(run, b, nut);
    return {kind: "words", seconds, finer: fine, run: beside_fine(a), known: beside_fine(c)};
  } finally {
    runs.forEach(r => r.free());
  }
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

// Costs of a line by one power of the rate, fitted to their logarithms: a disturbed sample does not
// let the line run backwards. Quartiles move with their median.
function fitted(cells) {
  const found = cells.map(({label, costs}) => ({...label, ...quartiles(costs)})),
    line_of = c => c.scheme + c.compliance;
  for (const line of new Set(found.map(line_of))) {
    const of = found.filter(c => line_of(c) === line),
      mean = list => list.reduce((sum, x) => sum + x, 0) / list.length,
      x = of.map(c => Math.log(c.rate)),
      y = of.map(c => Math.log(c.cost)),
      [x0, y0] = [mean(x), mean(y)],
      spread = mean(x.map(v => (v - x0) ** 2)),
      power = spread ? mean(x.map((v, k) => (v - x0) * (y[k] - y0))) / spread : 0;
    of.forEach((c, k) => {
      const by = Math.exp(y0 + Math.max(0.5, power) * (x[k] - x0) - y[k]);
      for (const name of ["lower", "cost", "upper"]) c[name] *= by;
    });
  }
  return found;
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
      const request = {...state, scheme, rate, options, modes: 0};
      const point = sampled(request, run => ({
        ...label,
        ...judged(run, scene),
        outcome: run.outcome,
        dofs: run.dofs,
      }));
      post({kind: "point", point: {...point, lower: point.cost, upper: point.cost}});
      cells.push({label, request, costs: [point.cost]});
    } catch (error) {
      post({kind: "point", point: {...label, refused: error.message}});
    }
    await go_on();
  }
  post({kind: "timed", last: false, costs: fitted(cells)});
  post({kind: "charted"});
  for (const cell of cells) cell.costs = [];
  for (let round = 1; round <= rounds; ++round) {
    for (const {request, costs} of cells) {
      costs.push(sampled(request).cost);
      await go_on();
    }
    post({kind: "timed", last: round === rounds, costs: fitted(cells)});
  }
}

// ---- One state of the page: the string, its motion, its sound, the reference, the chart.

const first_heard = 1; // [s], at once; the rest of the sound follows
async function show(request, post, go_on) {
  for (const [name, text] of Object.entries(request.files)) jvari.write(name, text);
  const scene = jvari.scene(request.scene, [
    ...request.overrides.filter(o => !o.startsWith("duration=")),
    `duration=${request.window}`,
  ]);
  // Errors count after the pluck.
  const state = {...request, duration: scene.free_from + request.window};
  const cells = cells_of(state, scene),
    key = JSON.stringify([state.scene, state.overrides, state.files, cells, state.exact]),
    same = key === charted;
  post({kind: "scene", scene, cells: cells.length, kept: same});
  const run = jvari.run({...state, shape: state.places, energy: true});
  const sounds = seconds => {
    const sound = jvari.run({...state, duration: seconds});
    post({
      kind: "sound",
      whole: seconds === state.heard,
      rate: sound.rate,
      sound: Float32Array.from(sound.tap(headline_of(scene).nut)),
      cost: sound.wall / seconds,
    });
    sound.free();
  };
  try {
    post({kind: "motion", picture: pictured(run, scene, state.places.length)});
    await go_on();
    sounds(first_heard);
    await go_on();
    const string = JSON.stringify([state.scene, state.overrides, state.files, state.duration]);
    if (kept.key !== string) (forget(), (kept.key = string));
    const tries_exact =
      scene.reference && (state.exact === "on" || (state.exact === "quick" && !dear(scene)));
    const post_verdict = last =>
      post({
        ...{kind: "reference", last, can_go_on: Boolean(scene.reference) && !kept.exact},
        ...{picture: picture(), verdict: judged(run, scene)},
      });
    kept.estimate ??= await estimate_of(state, scene, go_on);
    if (state.known) kept.known ??= known_of(state, scene);
    post_verdict(!tries_exact || Boolean(kept.exact));
    await go_on();
    if (run.outcome === "ok") post(await words_of(state, scene, go_on));
    sounds(state.heard);
    await go_on();
    if (tries_exact && !kept.exact) {
      kept.exact = await exact_of(state, scene, go_on).catch(error => {
        if (error instanceof Stale) throw error;
        return null; // refused: the estimate stays
      });
      post_verdict(true);
      await go_on();
    }
  } finally {
    run.free();
  }
  if (same) return post({kind: "charted", kept: same});
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
      {nut} = headline_of(scene),
      answer = {run: summary_of(a, scene)};
    if (beside) {
      const b = jvari.run({...first, options: [], ...beside});
      Object.assign(answer, {
        beside: summary_of(b, scene),
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
