// Slow motion of the string over the bridge: the scheme in colour, the exact solution in black; and
// the force, the energy and the error at that moment.
const shown = {scene: null, motion: null, reference: null, verdict: null, words: null};
const film = {at: 0, paused: false, slowed: 200, last: 0, zoomed: false, dragged: null};
const colour = name =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// Clears a canvas at the screen's resolution, and returns the size in CSS pixels.
function canvas_of(id) {
  const canvas = document.getElementById(id),
    pen = canvas.getContext("2d"),
    scale = devicePixelRatio || 1,
    {clientWidth: width, clientHeight: height} = canvas;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale))
    ((canvas.width = Math.round(width * scale)), (canvas.height = Math.round(height * scale)));
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "12px system-ui, 'DejaVu Sans', sans-serif";
  return {pen, width, height};
}

// A path through places, a line and a disc.
function path_of(pen, [from, ...places]) {
  pen.beginPath();
  pen.moveTo(...from);
  for (const place of places) pen.lineTo(...place);
}
const stroke_of = (pen, ...places) => (path_of(pen, places), pen.stroke());
const disc_of = (pen, x, y, radius) => (pen.beginPath(), pen.arc(x, y, radius, 0, 7));

// ---- The view: metres to pixels. The deflection is exaggerated by a factor, which the picture
// names.

function view_of(width, height) {
  const s = shown.scene.string[0],
    length = film.zoomed ? zoom_length(s) : s.length,
    margin = 26;
  const most = film.most || 1e-3,
    middle = height * (film.zoomed ? 0.5 : 0.58);
  const across = (width - 2 * margin) / length,
    up = (height * 0.4) / (film.zoomed ? most * Math.min(1, (3 * length) / s.length) : most);
  return {
    x: v => margin + v * across,
    y: v => middle - v * up,
    back_x: px => (px - margin) / across,
    back_y: py => (middle - py) / up,
    exaggerated: up / across,
    length,
    width,
    height,
  };
}
function zoom_length(s) {
  const b = s.barrier[0];
  return b
    ? Math.min(
        s.length,
        2.5 * (b.shape === "lumped" ? Math.max(b.position, s.thread?.position ?? 0) : b.to),
      )
    : 0.1 * s.length;
}
function largest_deflection({shape}) {
  let most = 1e-6;
  for (const y of shape) if (Math.abs(y) > most && Math.abs(y) < 1) most = Math.abs(y);
  return most;
}

// ---- The parts at rest.

function draw_obstacles(pen, v) {
  const s = shown.scene.string[0],
    floor = v.height - 2;
  pen.fillStyle = colour("wood");
  for (const b of s.barrier) {
    const lumped = b.shape === "lumped",
      half = lumped && Math.max(4, v.x(b.width / 2) - v.x(0)),
      top = lumped
        ? [-half, half].map(dx => [v.x(b.position) + dx, v.y(b.height)])
        : b.x.map((x, k) => [v.x(x), v.y(b.height[k])]),
      wider = lumped ? 7 : 0;
    path_of(pen, [
      [top[0][0] - wider, floor],
      ...top.map(([x, y]) => [x, Math.min(floor, y)]),
      [top.at(-1)[0] + wider, floor],
    ]);
    pen.fill();
  }
  if (s.thread) {
    const x = v.x(s.thread.position);
    pen.strokeStyle = colour("thread");
    pen.lineWidth = 3;
    stroke_of(pen, [x, v.y(s.thread.height)], [x, floor]);
  }
  pen.fillStyle = colour("ink");
  // Masses at t = 0.
  for (const m of s.mass) (disc_of(pen, v.x(m.position), v.y(m.height) + 7, 7), pen.fill());
  for (const x of [0, s.length]) if (x <= v.length) (disc_of(pen, v.x(x), v.y(0), 4), pen.fill());
}

// Draws the motion at row `row`; a fraction interpolates between two rows.
function draw_string(pen, v, picture, row, stroke, dash) {
  const n = Math.min(Math.floor(row), picture.rows - 1),
    next = Math.min(n + 1, picture.rows - 1),
    part = row - n,
    s = shown.scene.string[0];
  const of = k =>
    (1 - part) * picture.shape[n * picture.points + k] +
    part * picture.shape[next * picture.points + k];
  pen.strokeStyle = stroke;
  pen.lineWidth = 2;
  pen.setLineDash(dash);
  pen.beginPath();
  pen.moveTo(v.x(0), v.y(0));
  for (let k = 0; k < picture.points; ++k) {
    const x = s.length * shape_points[k];
    pen.lineTo(v.x(x), v.y(of(k)));
    if (x > v.length) break;
  }
  if (s.length <= v.length) pen.lineTo(v.x(s.length), v.y(0));
  pen.stroke();
  pen.setLineDash([]);
}

function draw_force(pen, v, picture, row) {
  // Arrow for the force on the first barrier.
  const b = shown.scene.string[0].barrier[0],
    n = Math.min(Math.round(row), picture.rows - 1),
    force = picture.force?.[n];
  if (!b || !(force > 0.02 * film.most_force)) return;
  const x = v.x(b.shape === "lumped" ? b.position : (b.from + b.to) / 2),
    y = v.y(b.shape === "lumped" ? b.height : b.height[32]),
    length = 12 + 40 * Math.min(1, force / film.most_force);
  pen.strokeStyle = pen.fillStyle = colour("force");
  pen.lineWidth = 3;
  stroke_of(pen, [x, y], [x, y - length]);
  pen.fillText(`${digits(force)} N`, x + 8, y - length + 4);
}

// ---- Handles to drag on the picture: each moves a slider in x and another in y. The thread's
// handle is below the string, beside the bridge's.

// Name of an obstacle by the tap on the force there: bridge, fret, bolt.
const called = (quantity, otherwise) =>
  shown.scene.tap.find(t => t.quantity === quantity)?.name ?? otherwise;
function grips(v) {
  const s = shown.scene.string[0],
    b = point_of(s),
    all = [],
    grip = (x, y, name, across, up, of = height => height) =>
      x <= v.length && all.push({x: v.x(x), y, name, across, up, of});
  if (b) grip(b.position, v.y(b.height), called("bridge_force", "bridge"), ...bridge_handles);
  const curved = s.barrier[0];
  if (curved?.coefficient)
    grip(
      curved.to,
      Math.min(v.height - 2, v.y(curved.height.at(-1))),
      "curve",
      null,
      "bridge_curve",
      y => -y / curved.to ** 2,
    );
  if (s.thread)
    grip(s.thread.position, v.height - 16, called("thread_force", "thread"), "thread_position");
  if (s.pluck) grip(s.pluck.position, v.y(0), "pull here", "pluck_position");
  if (s.start?.amplitude !== undefined)
    grip(
      s.start.position ?? s.length / 2,
      v.y(s.start.amplitude),
      "pull here",
      s.start.position && "release_position",
      "release_height",
    );
  return all;
}
const bridge_handles = ["bridge_position", "bridge_height"];
function draw_grips(pen, v) {
  for (const {x, y, name} of grips(v)) {
    pen.strokeStyle = pen.fillStyle = colour("key");
    pen.lineWidth = 1;
    pen.setLineDash([2, 4]);
    stroke_of(pen, [x, y], [x, v.y(0)]);
    pen.setLineDash([]);
    const right = x < v.width - 90,
      down = y > v.height - 30 ? 4 : y < v.y(0) ? -4 : 18,
      place = [name, x + (right ? 11 : -11), y + down];
    pen.textAlign = right ? "left" : "right";
    pen.strokeStyle = colour("paper");
    pen.lineWidth = 4;
    (pen.strokeText(...place), pen.fillText(...place));
    pen.strokeStyle = colour("key");
    pen.textAlign = "left";
    pen.fillStyle = colour("paper");
    pen.lineWidth = 2;
    (disc_of(pen, x, y, 6), pen.fill(), pen.stroke());
  }
}

function draw_picture() {
  const {pen, width, height} = canvas_of("string");
  if (!shown.scene) return;
  const v = view_of(width, height);
  draw_obstacles(pen, v);
  if (shown.reference) draw_string(pen, v, shown.reference, film.at, colour("ink"), []);
  if (shown.motion)
    draw_string(pen, v, shown.motion, film.at, colour("key"), shown.reference ? [6, 4] : []);
  if (shown.motion) draw_force(pen, v, shown.motion, film.at);
  draw_grips(pen, v);
  pen.fillStyle = colour("soft");
  const rate = shown.motion?.rate ?? 44100,
    note =
      `${((1e3 * film.at) / rate).toFixed(1)} ms, slowed ${film.slowed} times, deflection × ` +
      `${digits(v.exaggerated).toPrecision(2)}`;
  pen.fillText(width < 500 ? note.split(",")[0] : note, 10, 18);
  draw_graphs();
}

// ---- Three curves over the window, with a line at the drawn moment.

function draw_graphs() {
  const {pen, width, height} = canvas_of("graphs"),
    {motion, reference} = shown;
  if (!motion) return;
  const least = (a, b) => (reference ? Float64Array.from(a, (x, n) => Math.abs(x - b[n])) : null);
  const most_nut = reference ? reference.nut.reduce((m, x) => Math.max(m, Math.abs(x)), 0) : 1;
  const lines = [
    {title: "force", unit: "N", scheme: motion.force, exact: reference?.force},
    {title: "energy", unit: "mJ", scheme: motion.stored, exact: reference?.stored, times: 1e3},
    {title: "error", unit: "%", scheme: least(motion.nut, reference?.nut), times: 100 / most_nut},
  ].filter(l => l.scheme?.length);
  const each = width / lines.length,
    rows = motion.rows;
  lines.forEach((line, k) => {
    const left = k * each + 6,
      right = (k + 1) * each - 14,
      top = 20,
      bottom = height - 16,
      times = line.times ?? 1;
    let most = 0;
    for (const series of [line.scheme, line.exact])
      if (series)
        for (const y of series) if (Number.isFinite(y)) most = Math.max(most, Math.abs(y * times));
    most = most || 1;
    pen.fillStyle = colour("soft");
    const to = each < 150 ? "" : " up to";
    pen.fillText(`${line.title}${to} ${two_digits(most)} ${line.unit}`, left, 12);
    pen.strokeStyle = colour("line");
    pen.lineWidth = 1;
    stroke_of(pen, [left, bottom], [right, bottom]);
    const curve = (series, stroke, dash) => {
      pen.strokeStyle = stroke;
      pen.lineWidth = 1.3;
      pen.setLineDash(dash);
      pen.beginPath();
      const step = Math.max(1, Math.floor(series.length / (right - left) / 2));
      for (let n = 0; n < series.length; n += step) {
        let y = series[n];
        for (let j = n; j < Math.min(n + step, series.length); ++j)
          if (Math.abs(series[j]) > Math.abs(y)) y = series[j];
        pen.lineTo(
          left + ((right - left) * n) / (series.length - 1),
          bottom - (bottom - top) * Math.max(0, Math.min(1.1, (y * times) / most)),
        );
      }
      pen.stroke();
      pen.setLineDash([]);
    };
    if (line.exact) curve(line.exact, colour("ink"), []);
    curve(line.scheme, colour("key"), line.exact ? [4, 3] : []);
    const x = left + ((right - left) * film.at) / (rows - 1);
    pen.strokeStyle = colour("force");
    stroke_of(pen, [x, top], [x, bottom]);
    pen.fillStyle = colour("soft");
    (pen.fillText("0", left, height - 3),
      pen.fillText(`${digits(1e3 * run_seconds())} ms`, right - 34, height - 3));
  });
}

function film_frame(now) {
  const passed = Math.min(100, now - film.last);
  film.last = now;
  if (!film.paused && shown.motion && !document.hidden) {
    film.at += (passed * 1e-3 * shown.motion.rate) / film.slowed;
    if (film.at >= shown.motion.rows - 1) film.at = 0;
    draw_picture();
  }
  requestAnimationFrame(film_frame);
}

function new_pictures() {
  // Picture for the scales.
  const picture = shown.reference ?? shown.motion;
  film.most = largest_deflection(picture);
  film.most_force = picture.force?.reduce((most, x) => Math.max(most, x), 1e-9) ?? 1e-9;
  draw_picture();
}

// Place of the pointer in the picture [px], and the view there.
function pointed_at({target, clientX, clientY}) {
  const {left, top, width, height} = target.getBoundingClientRect();
  return {v: view_of(width, height), x: clientX - left, y: clientY - top};
}
function grip_near(event) {
  const {v, x, y} = pointed_at(event);
  return grips(v).find(g => Math.hypot(g.x - x, g.y - y) < 18);
}
function drag(event, {across, up, of}) {
  const {v, x, y} = pointed_at(event);
  if (across) move_handle(across, v.back_x(x));
  if (up) move_handle(up, of(v.back_y(y)));
}
function watch_grips() {
  const canvas = document.getElementById("string");
  canvas.onpointerdown = e => {
    film.dragged = shown.scene && grip_near(e);
    if (!film.dragged) return;
    canvas.setPointerCapture(e.pointerId);
    e.preventDefault();
  };
  canvas.onpointermove = e => {
    if (film.dragged) drag(e, film.dragged);
    else canvas.style.cursor = shown.scene && grip_near(e) ? "grab" : "";
  };
  canvas.onpointerup = canvas.onpointercancel = () => {
    film.dragged = null;
  };
}
