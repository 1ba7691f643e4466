// What of the page is chosen: one scene for all of it, and each chart's menus. It stands in the
// address behind #, so that a view can be linked to:
// #at=convergence&scene=free_string&work-precision.cost_field=rate
const view = new Map(new URLSearchParams(location.hash.slice(1)));
const on_scene = []; // what follows the scene: called with its name

function choose(key, value) {
  if (value === null) view.delete(key);
  else view.set(key, value);
  history.replaceState(null, "", "#" + new URLSearchParams([...view]));
}

const scene_shown = () =>
  document.getElementById("scene")?.value ?? report.verdicts[0]?.scene ?? report.scenes[0] ?? "";

function scene_menu(scenes) {
  const select = element("select", {id: "scene"}, ...scenes.map(name => new Option(name)));
  select.selectedIndex = Math.max(0, scenes.indexOf(view.get("scene")));
  select.onchange = async () => {
    choose("scene", select.selectedIndex === 0 ? null : select.value);
    document.documentElement.dataset.ready = "false";
    for (const follow of on_scene) await follow(select.value);
    document.documentElement.dataset.ready = "true";
  };
  return element("label", {}, "scene ", select);
}

function card_of(answer) {
  const title = answer.within.replace(/^waveform /, ""),
    found = answer.rate !== "" || answer.modes !== "";
  const sound = found ? sound_like(answer.scheme, answer.rate, scene_shown()) : null;
  const head = element(
    "p",
    {className: "card-scheme"},
    element("strong", {}, spoken(answer.scheme)),
  );
  if (sound) head.append(listen_to(sound));
  const facts = [answer.rate, answer.error, answer.cost && answer.cost + " per second"]
    .filter(Boolean)
    .join(" \u00b7 ");
  const card = element(
    "article",
    {className: "card"},
    element("p", {className: "soft"}, title),
    head,
  );
  if (facts) card.append(element("p", {}, facts));
  card.append(
    element(
      "p",
      {className: "soft small"},
      [answer.modes && answer.modes + " modes", answer.certain].filter(Boolean).join("; "),
    ),
  );
  if (answer.colour) card.style.borderLeftColor = shade(answer.colour);
  return card;
}

function verdict_of(verdicts, command) {
  const cards = element("div", {className: "answers"}),
    sentences = element("div");
  const show = scene => {
    const v = verdicts.find(one => one.scene === scene) ?? verdicts[0];
    document.querySelector("h1").textContent = v.finding;
    cards.replaceChildren(...v.answers.map(card_of));
    // a card may show the beginning alone
    const certain = v.answers.map(
      a => `${a.within[0].toUpperCase()}${a.within.slice(1)}: ${a.certain.replace(/\.?$/, ".")}`,
    );
    sentences.replaceChildren(
      ...[...certain, ...v.sentences].map(text => element("p", {className: "soft"}, text)),
    );
  };
  on_scene.push(show);
  dark.addEventListener("change", () =>
    show(document.getElementById("scene")?.value ?? verdicts[0].scene),
  );
  show(document.getElementById("scene")?.value ?? verdicts[0].scene);
  const ground = folded("What the answers rest on", [sentences]);
  if (command)
    ground.append(element("p", {className: "soft"}, "Made by ", element("code", {}, command)));
  return element(
    "section",
    {id: "verdict", ariaLabel: "the cheapest scheme for each accuracy"},
    cards,
    ground,
  );
}
