// Sounds: the force on the nut from the scheme and from the exact solution, each scaled to the same
// peak. Both play in a loop together, with one muted: a press changes over in mid-sound, and both
// end some seconds after the last press.
const sound = {context: null, buffers: {}, parts: {}, playing: "", wanted: "", started: null};
const rounds_heard = 2,
  fade = 0.01; // [s]

// Buffer with the samples; null if the run failed before the first sample.
function buffer_of({rate, sound: samples}) {
  if (samples.length === 0) return null;
  const loudest = samples.reduce((most, x) => Math.max(most, Math.abs(x)), 1e-12),
    buffer = new AudioBuffer({length: samples.length, sampleRate: rate, numberOfChannels: 1});
  const end = Math.min(400, samples.length >> 3);
  buffer.copyToChannel(
    samples.map((x, n) => ((0.7 * x) / loudest) * Math.min(1, (samples.length - 1 - n) / end)),
    0,
  );
  return buffer;
}

// A longer buffer goes on where the former is.
function new_sound(name, buffer) {
  const part = sound.parts[name];
  sound.buffers[name] = buffer;
  if (!part) return;
  part.source.onended = null;
  part.source.stop();
  delete sound.parts[name];
  if (buffer) play_sound(sound.playing);
}

function stop_sound(wanted = "") {
  for (const {source} of Object.values(sound.parts)) ((source.onended = null), source.stop());
  sound.parts = {};
  sound.playing = "";
  sound.wanted = wanted;
  mark_sound();
}

async function play_sound(which) {
  sound.wanted = which;
  if (which === "reference" && !sound.buffers.reference) fetch_reference_sound();
  if (!sound.buffers[which]) return mark_sound(); // plays on arrival
  const context = (sound.context ??= new AudioContext());
  await context.resume();
  if (!sound.playing) sound.began = context.currentTime;
  for (const [name, buffer] of Object.entries(sound.buffers)) {
    if (!buffer || sound.parts[name]) continue;
    const gain = new GainNode(context, {gain: 0}),
      source = new AudioBufferSourceNode(context, {buffer, loop: true});
    source.connect(gain).connect(context.destination);
    source.onended = () => stop_sound(sound.wanted); // may still be on the way
    source.start(0, (context.currentTime - sound.began) % buffer.duration);
    sound.parts[name] = {source, gain};
  }
  const end = context.currentTime + rounds_heard * heard_seconds;
  for (const {source} of Object.values(sound.parts)) source.stop(end);
  for (const [name, {gain}] of Object.entries(sound.parts))
    gain.gain.setTargetAtTime(Number(name === which), context.currentTime, fade / 3);
  sound.started ??= performance.now();
  sound.changed = performance.now();
  sound.playing = which;
  sound.wanted = "";
  mark_sound();
}

// Fetches the sound of what the run is judged by, once, at the first press.
async function fetch_reference_sound() {
  const of = shown.verdict;
  if (!of || sound.buffers.reference || sound.fetching === of) return;
  sound.fetching = of;
  try {
    const {run} = await ask("pair", {run: run_of({...of.heard, duration: heard_seconds})});
    if (shown.verdict !== of) return;
    sound.buffers.reference = buffer_of({rate: run.rate, sound: Float32Array.from(run.nut)});
    if (sound.wanted === "reference") play_sound("reference");
  } catch (error) {
    if (!(error instanceof Stale_question)) say(error.message);
  }
}

function mark_sound() {
  const button = document.getElementById("hear"),
    exact = shown.verdict?.heard.estimated ? "finer run" : "exact",
    [now, next] = {
      "": ["\u25b6 play", "the scheme"],
      scheme: ["\u25b6 scheme", shown.verdict ? `press for ${exact}` : "press to stop"],
      reference: [`\u25b6 ${exact}`, "press for scheme"],
    }[sound.playing];
  button.setAttribute("aria-pressed", String(Boolean(sound.playing)));
  button.classList.toggle("exact", sound.playing === "reference");
  button.querySelector("b").textContent = now;
  button.querySelector("span").textContent =
    sound.playing && sound.wanted === "reference" ? `computing the ${exact} …` : next;
  document.getElementById("stop").hidden = !sound.playing;
}
function toggle_sound() {
  if (sound.playing === "scheme" && !shown.verdict) return stop_sound();
  play_sound(sound.playing === "scheme" ? "reference" : "scheme");
  fetch_reference_sound();
}
