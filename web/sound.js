// What is heard: the worker's force on the nut as an AudioBuffer. Both sounds are as loud as the
// reference, and one goes over into the other.
const sound = {context: null, buffers: {}, source: null, playing: "", wanted: "", started: null};

// null where the run failed before its first sample
function buffer_of({rate, sound: samples}) {
  if (samples.length === 0) return null;
  const loudest = samples.reduce((most, x) => Math.max(most, Math.abs(x)), 1e-12),
    buffer = new AudioBuffer({length: samples.length, sampleRate: rate, numberOfChannels: 1});
  const fade = Math.min(400, samples.length >> 3);
  buffer.copyToChannel(
    samples.map((x, n) => ((0.7 * x) / loudest) * Math.min(1, (samples.length - 1 - n) / fade)),
    0,
  );
  return buffer;
}

function stop_sound() {
  if (sound.source) ((sound.source.onended = null), sound.source.stop());
  sound.source = null;
  sound.playing = "";
  mark_sound();
}

async function play_sound(which) {
  sound.wanted = which;
  if (which === "reference" && !sound.buffers.reference) return fetch_reference_sound();
  if (!sound.buffers[which]) return; // it plays when it comes
  sound.context ??= new AudioContext();
  await sound.context.resume();
  stop_sound();
  sound.source = new AudioBufferSourceNode(sound.context, {buffer: sound.buffers[which]});
  sound.source.connect(sound.context.destination);
  sound.source.onended = stop_sound;
  sound.source.start();
  sound.started ??= performance.now();
  sound.changed = performance.now();
  sound.playing = which;
  sound.wanted = "";
  mark_sound();
}

async function fetch_reference_sound() {
  const name = shown.scene?.reference;
  if (!name)
    return say(
      "There is no exact solution of this scene in the page. The program has one: jvari run " +
        state.scene +
        " --scheme sundials --out sound.wav",
    );
  say("The exact solution of a whole second is being computed.");
  try {
    const {run} = await ask("pair", {
      run: run_of({
        scheme: name,
        modes: 0,
        options: options_of(name, "matched"),
        duration: heard_seconds,
      }),
    });
    sound.buffers.reference = buffer_of({rate: run.rate, sound: Float32Array.from(run.nut)});
    say("");
    play_sound("reference");
  } catch (error) {
    if (!(error instanceof Stale_question)) say(error.message);
  }
}

function mark_sound() {
  for (const which of ["scheme", "reference"]) {
    const button = document.getElementById(`hear_${which}`);
    button.setAttribute("aria-pressed", String(sound.playing === which));
    button.querySelector("span").textContent = sound.playing === which ? "\u25a0" : "\u25b6";
  }
}
const toggle_sound = which => (sound.playing === which ? stop_sound() : play_sound(which));
