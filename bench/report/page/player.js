// "Hear it": two sounds of a scene run side by side from one clock, and a switch changes between
// them in mid-sound. X is drawn by lot from the two; guesses are counted. Space plays and stops,
// the keys a, b and x choose.
const player = {pair: [], hidden: 0, heard: 0, right: 0, guesses: 0, playing: null, context: null};

// Prepares a sound for listening: mean removed, ends faded over 5 ms, the same root mean square for
// all sounds, as loud as peaks below 0.9 allow.
function shape_of(sound) {
  if (sound.shape) return sound.shape;
  const {samples} = wave_of(sound),
    mean = samples.reduce((sum, x) => sum + x, 0) / samples.length,
    centred = samples.map(x => (x - mean) / 32768),
    rms = Math.sqrt(centred.reduce((sum, x) => sum + x * x, 0) / samples.length),
    peak = centred.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
  return (sound.shape = {centred, rms, peak});
}
function levelled(sound, level) {
  const {centred, rms} = shape_of(sound),
    fade = 0.005 * sound.rate,
    last = centred.length - 1,
    gain = rms > 0 ? level / rms : 0;
  return Float32Array.from(centred, (x, n) => gain * Math.min(1, n / fade, (last - n) / fade) * x);
}
const level_of = sounds =>
  Math.min(1, ...sounds.map(shape_of).map(s => (s.peak > 0 ? (0.9 * s.rms) / s.peak : 1)));
function buffer_of(sound) {
  if (sound.buffer) return sound.buffer;
  const signal = levelled(sound, (player.level ??= level_of(sounds())));
  sound.buffer = player.context.createBuffer(1, signal.length, sound.rate);
  sound.buffer.copyToChannel(signal, 0);
  return sound.buffer;
}

const audible = () => (player.heard === 2 ? player.hidden : player.heard);
function stop() {
  player.playing?.forEach(({source}) => {
    source.onended = null;
    source.stop();
  });
  player.playing = null;
  player.mark();
}
async function play() {
  player.context ??= new AudioContext();
  await player.context.resume();
  const buffers = player.pair.map(buffer_of);
  stop();
  player.started = player.context.currentTime + 0.02;
  player.playing = buffers.map((buffer, k) => {
    const source = new AudioBufferSourceNode(player.context, {buffer}),
      gain = new GainNode(player.context, {gain: k === audible() ? 1 : 0});
    source.connect(gain).connect(player.context.destination);
    source.start(player.started);
    return {source, gain};
  });
  player.playing.reduce((a, b) =>
    b.source.buffer.duration > a.source.buffer.duration ? b : a,
  ).source.onended = stop;
  player.mark();
}
function hear(which) {
  // Stops the sound if it plays already.
  if (player.playing && player.heard === which) return stop();
  player.heard = which;
  player.playing?.forEach(({gain}, k) => {
    gain.gain.value = k === audible() ? 1 : 0;
  });
  player.mark();
  if (!player.playing) play();
}

// Player for a scene: A is the reference, B the sound chosen by `prefer`, the answer's.
function hear_it() {
  const score = element("output", {className: "soft"}),
    names = ["A", "B", "X"],
    buttons = names.map((name, k) => element("button", {type: "button", onclick: () => hear(k)})),
    selects = ["A", "B"].map(name => element("select", {ariaLabel: `what ${name} is`})),
    guesses = [0, 1].map(k =>
      element("button", {type: "button", className: "guess", onclick: () => guess(k)}, names[k]),
    );
  player.mark = () =>
    buttons.forEach((button, k) => {
      const sounds_now = player.playing && player.heard === k;
      button.textContent = `${sounds_now ? "\u25a0" : "\u25b6"} ${names[k]}`;
      button.setAttribute("aria-pressed", String(player.heard === k));
    });
  function anew() {
    stop();
    Object.assign(player, {right: 0, guesses: 0, hidden: Math.random() < 0.5 ? 0 : 1});
    score.textContent = "";
  }
  function guess(k) {
    ++player.guesses;
    player.right += k === player.hidden;
    score.textContent = score_text(player.right, player.guesses);
    stop();
    player.hidden = Math.random() < 0.5 ? 0 : 1;
  }
  let own = [];
  const choose_pair = () => {
    player.pair = selects.slice(0, own.length).map(select => own[select.selectedIndex]);
    anew();
    player.seen?.();
  };
  player.prefer = best => {
    const k = own.findIndex(s => s.series === best?.series && s.hertz === best?.rate);
    if (k < 0 || own[k] === player.pair[1]) return;
    selects[1].selectedIndex = k;
    choose_pair();
  };
  const section = element("section", {id: "player", className: "card", ariaLabel: "sounds"});
  const fill = scene => {
    const of = name => sounds().filter(s => s.problem === name);
    section.hidden = !of(scene).length;
    own = of(section.hidden ? (drawn_sounds()[0] ?? sounds()[0]).problem : scene);
    own.sort((a, b) => b.reference - a.reference);
    const names_of = s => scheme_words(s.name) + (s.detail && `, ${s.detail}`);
    for (const select of selects) select.replaceChildren(...own.map(s => new Option(names_of(s))));
    selects[1].selectedIndex = Math.max(
      0,
      own.findIndex((s, k) => k > 0 && !s.reference),
    );
    choose_pair();
  };
  selects.forEach(select => (select.onchange = choose_pair));
  on_scene.push(fill);
  fill(scene_shown());
  document.addEventListener("keydown", event => {
    if (
      event.ctrlKey ||
      event.altKey ||
      event.metaKey ||
      event.target.closest?.("input, select, textarea")
    )
      return;
    const k = names.indexOf(event.key.toUpperCase());
    if (event.key === " " && !event.target.closest?.("button, a, summary, [tabindex]"))
      player.playing ? stop() : play();
    else if (k >= 0 && (k < 2 ? k : 1) < own.length) hear(k);
    else return;
    event.preventDefault();
  });
  const pair = own.length > 1;
  section.append(
    element("h2", {}, pair ? "Hear it, blind" : "Hear it"),
    ...(pair ? [0, 1] : [0]).map(k => element("p", {className: "ab"}, buttons[k], selects[k])),
    pair ? element("p", {className: "ab"}, buttons[2], "is", ...guesses, score) : "",
    ...page.left_out.sounds.map(note),
  );
  return section;
}
// "See it": the played trace over the reference's.
function see_it(section) {
  const [chart] = section.charts;
  if (!chart) return "";
  const {parts, draw} = chart_of(
    {
      ...chart,
      chosen: () => ({sound_field: [...player.pair].reverse().find(s => !s.reference)?.file}),
    },
    section.id,
  );
  const drawing = {id: section.id, draw};
  drawings.push(drawing);
  const whose = element("p", {className: "soft small"}),
    name_it = () => {
      const s = [...player.pair].reverse().find(s => !s.reference);
      whose.textContent = s
        ? `The trace of ${scheme_words(s.name)}${s.detail && `, ${s.detail}`}, chosen under “Hear it”.`
        : "";
    };
  player.seen = () => (name_it(), drawing.drawn && draw());
  name_it();
  return element(
    "section",
    {id: section.id, className: "card", ariaLabel: section.heading},
    element("h2", {}, "See it"),
    whose,
    ...parts,
  );
}
