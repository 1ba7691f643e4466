// The worker, seen from the page. The newest state wins: a worker still busy with an older state
// after `patience` is replaced.
const client = {
  worker: null,
  module: null,
  id: 0,
  waiting: new Map(),
  busy: false,
  ready: null,
  list: null,
  solutions: {}, // of strings as they stand in the library
  since: 0,
  received: new Set(), // kinds of messages received for the newest state
};
const patience = 1500, // [ms]
  late_seconds = 8; // for the exact solution

const gunzipped = base64 => through(bytes_of(base64), new DecompressionStream("gzip"));

const script_of = texts => URL.createObjectURL(new Blob(texts, {type: "text/javascript"}));

function start_worker() {
  client.worker?.terminate();
  for (const {reject} of client.waiting.values()) reject(new Stale_question());
  client.waiting.clear();
  client.busy = false;
  const url = script_of(["glue", "core", "worker"].map(id => by_id(id).textContent + "\n")),
    worker = (client.worker = new Worker(url));
  client.ready = new Promise((resolve, reject) => {
    worker.onerror = e => {
      e.preventDefault();
      reject(new Error(e.message));
      failed(e.message);
    };
    worker.onmessage = ({data}) => {
      if (data.kind === "ready") {
        client.list = data.list;
        URL.revokeObjectURL(url);
        resolve();
      } else if (data.kind === "answer") {
        const waiting = client.waiting.get(data.id);
        client.waiting.delete(data.id);
        if (data.refused !== undefined) waiting?.reject(new Error(data.refused));
        else waiting?.resolve(data.answer);
      } else if (data.id === client.id) {
        if (["charted", "refused"].includes(data.kind)) client.busy = false;
        if (data.last || data.kind === "refused") clearTimeout(client.late);
        else if (data.kind === "reference") wait_for_exact();
        client.received.add(data.kind);
        shows[data.kind](data);
      }
    };
  });
  worker.postMessage({wasm: client.module});
  return client.ready;
}
class Stale_question extends Error {}

// The estimate stands where the exact solution takes too long.
function wait_for_exact() {
  clearTimeout(client.late);
  if (client.exact === "quick")
    client.late = setTimeout(() => {
      start_worker();
      send_state("no");
    }, 1e3 * late_seconds);
}
// `exact`: whether the exact solution is computed: "quick", where that takes no more than
// `late_seconds`; "on", however long it takes; "no".
async function send_state(exact = "quick") {
  if (client.busy && performance.now() - client.since > patience) start_worker();
  client.busy = true;
  client.since = performance.now();
  client.received.clear();
  client.exact = exact;
  wait_for_exact();
  client.worker.postMessage({
    id: ++client.id,
    state: {
      ...run_of(),
      files: state.files,
      known: state.text === null && overrides_of(state.set).length === 0 && solution(),
      exact,
      window: window_seconds,
      heard: heard_seconds,
      places: shape_points,
      compliance: state.compliance,
      lines: chart_schemes,
      rates: chart_rates,
    },
  });
}
const solution = () => client.solutions[state.scene];
const options_of = (name, compliance) =>
  descriptor(name)?.options.some(o => o.name === "compliance") ? [`compliance=${compliance}`] : [];
const descriptor = name =>
  [...client.list.schemes, ...client.list.references].find(d => d.name === name);

// Asks a single question; the worker answers after the present piece of work.
function ask(question, more = {}) {
  const id = `q${++ask.count}`;
  return new Promise((resolve, reject) => {
    client.waiting.set(id, {resolve, reject});
    client.worker.postMessage({question, id, ...more});
  });
}
ask.count = 0;
const run_of = more => ({
  scene: scene_text(),
  overrides: overrides_of(state.set),
  scheme: state.scheme,
  rate: state.rate,
  modes: state.modes,
  options: options_of(state.scheme, state.compliance),
  duration: run_seconds(),
  ...more,
});
const run_at = (stiffness, rate) => {
  const set = {...state.set, "string.0.barrier.0.stiffness": stiffness.toPrecision(8)};
  return run_of({overrides: overrides_of(set), rate, tap_rate: rate, duration: 0.02});
};
