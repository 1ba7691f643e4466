// One player for all sounds of a scene. They run side by side from one clock and one of them is
// heard, so that another takes over in the middle of the sound. Space plays and stops; keys 1 to 9
// choose. A blind comparison hides the names and deals the keys anew until it is asked for them.
const player = {
  sounds: [],
  shown: [],
  heard: null,
  context: null,
  playing: null,
  started: 0,
  buttons: [],
  play: null,
  blind: null,
  level: null,
};

const sound_like = (scheme, rate, scene) =>
  player.sounds.find(s => s.name === scheme && s.detail === rate && s.problem === scene);
function listen_to(sound) {
  const button = element(
    "button",
    {type: "button", className: "listen", onclick: () => listen(sound)},
    "\u25b6 listen",
  );
  button.setAttribute("aria-label", `listen to ${sound.name}, ${sound.detail}`);
  return button;
}

function listen(sound) {
  if (player.blind.checked) {
    // its name has been said
    player.blind.checked = false;
    player.blind.onchange();
  }
  hear(sound, true);
}

// For ears: the mean taken away, the ends faded over 5 ms, all sounds at one root mean square, the
// loudest that leaves every peak within 0.9.
const shapes_heard = new Map();
function shape_of(sound) {
  if (shapes_heard.has(sound)) return shapes_heard.get(sound);
  const {samples} = wave_of(sound),
    mean = samples.reduce((sum, x) => sum + x, 0) / samples.length,
    centred = samples.map(x => (x - mean) / 32768);
  const shape = {
    centred,
    rms: Math.sqrt(centred.reduce((sum, x) => sum + x * x, 0) / samples.length),
    peak: centred.reduce((most, x) => Math.max(most, Math.abs(x)), 0),
  };
  shapes_heard.set(sound, shape);
  return shape;
}
function levelled(sound, level) {
  const {centred, rms} = shape_of(sound),
    fade = 0.005 * sound.rate,
    last = centred.length - 1;
  return Float32Array.from(
    centred,
    (x, n) => (rms > 0 ? level / rms : 0) * Math.min(1, n / fade, (last - n) / fade) * x,
  );
}
const level_of = sounds =>
  Math.min(
    1,
    ...sounds
      .map(shape_of)
      .filter(s => s.peak > 0)
      .map(s => (0.9 * s.rms) / s.peak),
  );
function buffer_of(sound) {
  if (sound.buffer) return sound.buffer;
  const signal = levelled(sound, (player.level ??= level_of(player.sounds)));
  sound.buffer = player.context.createBuffer(1, signal.length, sound.rate);
  sound.buffer.copyToChannel(signal, 0);
  return sound.buffer;
}

function stop() {
  player.playing?.forEach(({source}) => {
    source.onended = null;
    source.stop();
  });
  player.playing = null;
  mark();
}

async function play() {
  player.context ??= new AudioContext();
  await player.context.resume();
  const buffers = player.shown.map(buffer_of);
  stop();
  player.started = player.context.currentTime + 0.02;
  player.playing = buffers.map((buffer, k) => {
    const source = new AudioBufferSourceNode(player.context, {buffer}),
      gain = new GainNode(player.context, {gain: player.shown[k] === player.heard ? 1 : 0});
    source.connect(gain).connect(player.context.destination);
    source.start(player.started);
    return {source, gain, sound: player.shown[k]};
  });
  player.playing.reduce((a, b) =>
    b.source.buffer.duration > a.source.buffer.duration ? b : a,
  ).source.onended = stop;
  mark();
}

function hear(sound, from_start = false) {
  player.heard = sound;
  player.playing?.forEach(({gain, sound: of}) => {
    gain.gain.value = of === sound ? 1 : 0;
  });
  mark();
  if (from_start) play();
}

function mark() {
  player.buttons.forEach((button, k) =>
    button.setAttribute("aria-pressed", String(player.shown[k] === player.heard)),
  );
  if (player.play) player.play.textContent = player.playing ? "\u25a0 stop" : "\u25b6 play";
}

function player_of(sounds) {
  if (!sounds.length) return [];
  player.sounds = sounds;
  const choices = element("div", {className: "choices"});
  choices.setAttribute("role", "group");
  choices.setAttribute("aria-label", "what is heard");
  player.play = element("button", {
    type: "button",
    className: "play",
    onclick: () => (player.playing ? stop() : play()),
  });
  player.blind = element("input", {type: "checkbox"});
  const fill = () => {
    stop();
    const own = sounds.filter(s => s.problem === scene_shown()),
      answers = report.verdicts.find(v => v.scene === scene_shown())?.answers ?? [];
    const place = s =>
      s.reference ? 0 : answers.some(a => a.scheme === s.name && a.rate === s.detail) ? 1 : 2;
    player.shown = (own.length ? own : [...sounds]).sort((a, b) => place(a) - place(b));
    if (player.blind.checked)
      player.shown = player.shown
        .slice(0, 9)
        .map(s => [Math.random(), s])
        .sort(([a], [b]) => a - b)
        .map(([, s]) => s);
    player.heard = player.shown[0];
    player.buttons = player.shown.map((sound, k) => {
      const name = player.blind.checked ? "sound" : spoken(sound.name),
        detail = player.blind.checked ? "" : sound.detail;
      return element(
        "button",
        {type: "button", onclick: () => hear(sound)},
        ...(k < 9 ? [element("kbd", {}, String(k + 1)), " "] : []),
        name,
        element("span", {className: "soft"}, " " + detail),
      );
    });
    choices.replaceChildren(...player.buttons);
    mark();
  };
  player.blind.onchange = fill;
  on_scene.push(fill);
  fill();
  document.addEventListener("keydown", event => {
    if (
      event.ctrlKey ||
      event.altKey ||
      event.metaKey ||
      event.target.closest?.("input, select, textarea")
    )
      return;
    const k = Number(event.key) - 1;
    if (event.key === " " && !event.target.closest?.("button, a, summary, [tabindex]"))
      player.playing ? stop() : play();
    else if (Number.isInteger(k) && k >= 0 && k < Math.min(9, player.shown.length))
      hear(player.shown[k]);
    else return;
    event.preventDefault();
  });
  return [
    element(
      "section",
      {id: "player", ariaLabel: "sounds"},
      element(
        "div",
        {className: "menus"},
        player.play,
        element("label", {}, player.blind, " blind: hide the names"),
        element(
          "span",
          {className: "soft"},
          "Space plays and stops. Keys 1 to 9 change what is heard while the sound goes " +
            "on, at equal loudness.",
        ),
      ),
      choices,
    ),
  ];
}
