// The string as it moves, slowed: the whole of it, and where it touches (motion.csv), the reference in ink and a scheme over it, with the force of the
// contact. A row of the table is a cell, or the reference that others were measured against.
const motion_across = 1180, motion_down = 150;  // [px]
function motions() {  // of each scene: {reference, schemes}
  return records("motion").map(m => {
    const scales = m.scales.split(" ").map(Number), x = m.positions.split(" ").map(Number), shape = integers(m.shape), count = x.length;
    const frames = Array.from({length: shape.length / count}, (_, k) => x.map((_, i) => shape[k * count + i] * scales[i] / 32767));
    const force = integers(m.force).map(f => f * number(m.force_scale) / 32767), obstacle = m.obstacle.split(" ").filter(Boolean).map(point => point.split(":").map(Number));
    return {problem: m.problem, reference: m.scheme === "reference", series: m.series, detail: kilohertz(number(m.rate)), x, frames, force, obstacle, step: number(m.step_s), from: number(m.from_s)};
  });
}
// Two pictures of one string: from `from` to `to` along it, as high as it gets there.
function view_of(all, from, to, left, width, down = 0) {
  const inside = all[0].x.map((x, i) => [x, i]).filter(([x]) => x >= from && x <= to).map(([, i]) => i), values = all.flatMap(m => m.frames.flatMap(f => inside.map(i => f[i])));
  const solid = all[0].obstacle.filter(([x]) => x >= from && x <= to), top = Math.max(...values, ...solid.map(([, h]) => h)), bottom = Math.min(...values, ...solid.map(([, h]) => h));
  const x = at => left + 10 + (width - 20) * (at - from) / (to - from), y = value => down + 24 + (motion_down - 50) * (top - value) / (top - bottom || 1);
  return {inside, solid, x, y, top, bottom, width, left, down, line: (m, k) => "M" + inside.map(i => `${x(m.x[i]).toFixed(1)},${y(m.frames[k][i]).toFixed(1)}`).join("L")};
}
function motion_of() {
  const all = motions(), scenes = distinct(all.map(m => m.problem));
  if (!all.length) return [];
  const picture = svg_element("svg", {role: "img", "aria-label": "the string as it moves, slowed"}), said = element("p", {className: "soft small-text"});
  const go = element("button", {type: "button", className: "play"}), which = element("select"), choose_it = element("label", {}, "over the reference: ", which);
  let shown = [], parts = [], running = !matchMedia("(prefers-reduced-motion: reduce)").matches, at = 0, before = 0;
  const slowed = 400;  // times
  const frame = k => {
    const time = k * shown[0].step + shown[0].from;
    for (const {view, lines, arrow, label} of parts) {
      lines.forEach((line, m) => line.setAttribute("d", view.line(shown[m], k)));
      if (!arrow) continue;
      const most = Math.max(1e-12, ...shown.flatMap(m => m.force.map(Math.abs))), force = shown[0].force[k] ?? 0, [place, top] = view.solid.reduce((a, b) => b[1] > a[1] ? b : a), x = view.x(place), y = view.y(top);
      arrow.setAttribute("d", `M${x},${y}v${-Math.min(y - view.down - 20, 60) * Math.abs(force) / most}`);
      label.textContent = Math.abs(force) > 1e-9 ? `${digits(force, 2)} N` : "";
      label.setAttribute("x", x + 7);
      label.setAttribute("y", y + 16);
    }
    said.textContent = `${(1000 * time).toFixed(1)} ms, slowed ${slowed} times. ${shown.length > 1 ? `Solid: ${shown[0].reference ? "the reference" : spoken(shown[0].series)}; dashed: ${spoken(shown[1].series)}, ${shown[1].detail}.` : spoken(shown[0].series)}`;
  };
  const build = () => {
    const own = all.filter(m => m.problem === scene_shown()), reference = own.find(m => m.reference), schemes = own.filter(m => !m.reference), scheme = schemes[which.selectedIndex] ?? schemes[0];
    shown = [reference, scheme].filter(Boolean);
    if (!shown.length) return;
    const length = shown[0].x.at(-1), solid = shown[0].obstacle.map(([x]) => x), near = solid.length ? Math.min(length, 2.5 * Math.max(...solid)) : 0, colours = [ink[0], looks_of([scheme?.series ?? ""]).get(scheme?.series ?? "").colour];
    const two = near > 0 && near < 0.6 * length, stacked = narrow.matches, across = stacked ? 380 : motion_across;  // on a phone one above the other
    const touching = () => stacked ? view_of(shown, 0, near, 0, across, motion_down) : view_of(shown, 0, near, 0.6 * across, 0.4 * across);
    const views = two ? [view_of(shown, 0, length, 0, stacked ? across : 0.58 * across), touching()] : [view_of(shown, 0, length, 0, across)];
    picture.setAttribute("viewBox", `0 0 ${across} ${two && stacked ? 2 * motion_down : motion_down}`);
    picture.replaceChildren();
    parts = views.map((view, v) => {
      const close = v === views.length - 1, floor = view.down + motion_down - 22, ground = view.solid.length ? `M${view.x(view.solid[0][0])},${floor}L` + view.solid.map(([x, h]) => `${view.x(x)},${view.y(h)}`).join("L") + `L${view.x(view.solid.at(-1)[0])},${floor}Z` : "";
      if (ground) picture.append(svg_element("path", {d: ground, fill: "#c9b48f", stroke: "#c9b48f", "stroke-width": 4, "stroke-linejoin": "round"}));
      const lines = shown.map((m, k) => svg_element("path", {fill: "none", stroke: shade(colours[k] ?? ink[0]), "stroke-width": k ? 1.8 : 2.2, "stroke-dasharray": k ? "6 4" : "none"}));
      const arrow = close && view.solid.length ? svg_element("path", {stroke: shade("#610a2d"), "stroke-width": 4, fill: "none"}) : null, label = svg_element("text", {"font-size": 13, fill: "currentColor"});
      const name = svg_element("text", {x: view.left + 10, y: view.down + 14, "font-size": 12, fill: "currentColor"});
      const height = 1000 * (view.top - view.bottom);
      name.textContent = `${close && views.length > 1 ? `the first ${digits(1000 * near, 3)} mm, where it touches` : `the whole string, ${digits(length, 3)} m`}: ${height < 0.1 ? `${digits(1000 * height, 2)} \u00b5m` : `${digits(height, 2)} mm`} high`;
      picture.append(...lines, ...(arrow ? [arrow, label] : []), name);
      return {view, lines, arrow, label};
    });
    frame(Math.floor(at) % shown[0].frames.length);
  };
  const follow = () => {
    const schemes = all.filter(m => m.problem === scene_shown() && !m.reference), here = scenes.includes(scene_shown());
    which.replaceChildren(...schemes.map(m => new Option(`${spoken(m.series)}, ${m.detail}`)));
    section.hidden = !here;
    choose_it.hidden = schemes.length < 2;
    build();
  };
  const tick = now => {
    if (!running) return;
    if (shown.length && section.getBoundingClientRect().bottom > 0) frame(Math.floor(at = (at + Math.min(100, now - before) / 1000 / slowed / shown[0].step) % shown[0].frames.length));
    before = now;
    requestAnimationFrame(tick);
  };
  const toggle = () => {
    running = !running;
    go.textContent = running ? "\u25a0 hold" : "\u25b6 move";
    if (running) requestAnimationFrame(now => { before = now; tick(now); });
  };
  go.onclick = toggle;
  which.onchange = build;
  const section = element("section", {id: "motion", ariaLabel: "the string as it moves"}, picture, element("div", {className: "menus"}, go, choose_it, said));
  on_scene.push(follow);
  for (const media of [dark, narrow]) media.addEventListener("change", build);
  follow();
  running = !running;
  toggle();
  return [section];
}
