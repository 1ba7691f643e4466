// The module's C calls as functions: texts and numbers in, objects and views of the module's memory
// out. A refusal is thrown with the program's sentence.
function jvari_core(module) {
  // Passes texts by the heap: a scene may be larger than the stack.
  const call = (name, type, ...values) => {
    const texts = [],
      given = values.map(v => {
        if (typeof v !== "string") return v;
        const bytes = new TextEncoder().encode(v),
          at = module._malloc(bytes.length + 1);
        texts.push(at);
        module.HEAPU8.set(bytes, at);
        module.HEAPU8[at + bytes.length] = 0;
        return at;
      });
    try {
      return module.ccall(
        name,
        type,
        given.map(() => "number"),
        given,
      );
    } finally {
      texts.forEach(at => module._free(at));
    }
  };
  const last_text = () => call("jv_said", "string");
  const parsed = text => {
    if (!text) throw new Error(last_text());
    return JSON.parse(text);
  };
  const view = (at, rows) => new Float64Array(module.HEAPF64.buffer, at, rows);
  return {
    list: () => parsed(call("jv_list", "string")),
    scene: (text, overrides = []) => parsed(call("jv_scene", "string", text, overrides.join("\n"))),
    problem: (text, overrides, rate, modes, duration) =>
      parsed(call("jv_problem", "string", text, overrides.join("\n"), rate, modes, duration)),
    // Runs {scene, overrides, scheme, rate, tap_rate, modes, options, duration, shape, energy}; the
    // last five may be absent.
    run(a) {
      const handle = call(
        "jv_run",
        "number",
        a.scene,
        (a.overrides ?? []).join("\n"),
        a.scheme,
        a.rate ?? 44100,
        a.tap_rate ?? 44100,
        a.modes ?? 0,
        (a.options ?? []).join("\n"),
        a.duration ?? 0,
        (a.shape ?? []).join("\n"),
        a.energy ? 1 : 0,
      );
      if (!handle) throw new Error(last_text());
      const about = parsed(call("jv_about", "string", handle)),
        energy = call("jv_energy", "number", handle, 0);
      return {
        ...about,
        handle,
        tap: k => view(call("jv_tap", "number", handle, k), about.rows),
        ledger: () =>
          energy
            ? [0, 1, 2].map(k => view(call("jv_energy", "number", handle, k), about.rows))
            : null,
        free: () => call("jv_free", null, handle),
      };
    },
    error: (a, b, tap, seconds = 0) => call("jv_error", "number", a.handle, b.handle, tap, seconds),
    sounds: (a, b, tap) => parsed(call("jv_sounds", "string", a.handle, b.handle, tap)),
    horizon: (a, b, tap) => call("jv_horizon", "number", a.handle, b.handle, tap),
    left_after: (last, before, matched) => call("jv_left_after", "number", last, before, matched),
    third_octaves: (a, b, tap, range) =>
      call("jv_third_octaves", "number", a.handle, b.handle, tap, range),
    louder: (a, b, tap, hertz) => call("jv_louder", "number", a.handle, b.handle, tap, hertz),
    // Indices into `points`: the best (null: none), the ties, the perhaps cheaper.
    cheapest(points, accuracy) {
      const at = module._malloc(40 * points.length);
      new Float64Array(module.HEAPF64.buffer, at, 5 * points.length).set(
        points.flatMap(p => [p.error, p.uncertainty ?? NaN, p.cost, p.lower, p.upper]),
      );
      try {
        return parsed(
          call("jv_cheapest", "string", points.map(p => p.scheme).join("\n"), at, accuracy),
        );
      } finally {
        module._free(at);
      }
    },
    // A table that scenes name, in the working directory.
    write: (name, text) => module.FS.writeFile(`/${name}`, text),
    memory: () => module.HEAPF64.length * 8,
  };
}
