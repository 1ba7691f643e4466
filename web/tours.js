// Guided tours with five steps each. A step may change the state of the page, and computes the
// promised number.
const with_scheme = (scheme, rate = 44100, compliance = "own") => ({
  scheme,
  rate,
  compliance,
  modes: 0,
});
const c3 = {scene: "tanpura_c3_release", set: {}};
const exact = () => ({
  scheme: shown.scene.reference,
  modes: 0,
  options: options_of(shown.scene.reference, tours[state.tour].exact ?? "matched"),
});
const fact_of = (run, name) => run.facts.find(f => f.name === name)?.value ?? NaN;
const signed = x => (x < 0 ? "\u2212" : "+") + Math.abs(x).toFixed(1);

// Compares the chosen scheme with the exact solution over `duration`. The page already has both
// over the window.
const beside_exact = duration => ask("pair", {run: run_of({duration}), beside: exact()});
async function brighter_by() {
  return (
    `above 2 kHz the scheme has ${signed((await beside_exact(0.4)).louder)} dB against the ` +
    "exact solution"
  );
}
const error_now = () => `${percent(shown.verdict.error)} error of the force on the nut`;
const energy_and_error = () =>
  `energy not accounted for: ${shown.motion.residual.toExponential(1)} of what there is; ` +
  `error: ${percent(shown.verdict.error)}`;

// Whether a scheme runs at a stiffness; `boundary` bisects for the largest stiffness without a
// failure.
const runs_at = async (stiffness, rate) => {
  const [verdict] = await ask("outcomes", {runs: [run_at(stiffness, rate)]});
  return !["diverged", "not_converged", "refused"].includes(verdict);
};
async function boundary(rate) {
  let [low, high] = [1e2, 1e12];
  for (let k = 0; k < 24; ++k) {
    const middle = Math.sqrt(low * high);
    if (await runs_at(middle, rate)) low = middle;
    else high = middle;
  }
  return low;
}

// Third-octave difference in the force on the nut between a run with few modes and with all modes.
async function octaves_of(modes) {
  const {octaves} = await ask("pair", {
    run: run_of({modes, duration: 0.4}),
    beside: {options: options_of(state.scheme, state.compliance), modes: 0},
  });
  return {modes, apart: octaves};
}
async function fewest_modes(limit) {
  for (const modes of [10, 15, 20, 30, 40, 50, 60, 80, 100, 120]) {
    const o = await octaves_of(modes);
    if (o.apart <= limit) return o;
  }
  return octaves_of(133);
}

const tours = {
  brighter: {
    title: "Why the published scheme sounds brighter",
    steps: [
      {
        say:
          "A tanpura string is let go over its bridge. Black is the exact solution, blue the " +
          "modal scheme as it was published in 2016, at 44.1 kHz. The two part after the " +
          "first contact.",
        set: {...c3, ...with_scheme("modal_two_point")},
        number: error_now,
      },
      {
        say:
          "Listen with the large button under the picture: each further press goes over to the " +
          "other of the two. The scheme has more high partials.",
        number: brighter_by,
      },
      {
        say:
          "The cause is at the bridge. A string of finitely many modes yields too little " +
          "where it touches, and so does a finite time step. The contact is too hard.",
        number: () =>
          "under a steady force the scheme's string yields " +
          `${percent(fact_of(shown.motion, "static_compliance"))} of what the true string ` +
          "yields",
      },
      {
        say:
          "Matched compliance puts what is missing as a spring between string and bridge. " +
          "Nothing else changes.",
        set: {compliance: "matched"},
        number: error_now,
      },
      {
        say: "At 88.2 kHz the spectrum is close to the exact one as well.",
        set: {rate: 88200},
        number: async () => `${error_now()}; ${await brighter_by()}`,
      },
    ],
  },
  energy: {
    title: "The energy is exact, the motion is wrong",
    steps: [
      {
        say:
          "The scheme is built so that no energy is lost or gained unaccounted for. The " +
          "ledger closes to rounding.",
        set: {...c3, ...with_scheme("modal_two_point")},
        number: energy_and_error,
      },
      {
        say:
          "At eight times the sample rate the ledger closes as well, and the error stops " +
          "falling: it comes from the modes that are left out.",
        set: {rate: 352800},
        number: energy_and_error,
      },
      {
        say: "The same holds for another scheme with exact energy, the implicit grid.",
        set: with_scheme("finite_difference_theta"),
        number: energy_and_error,
      },
      {
        say:
          "An exact energy keeps a scheme from exploding. It does not tell how wrong the " +
          "motion is.",
        set: with_scheme("modal_two_point", 88200, "matched"),
        number: energy_and_error,
      },
    ],
  },
  explode: {
    title: "The explicit scheme explodes: find the boundary",
    steps: [
      {
        say:
          "This control takes the contact force from the step before. With a soft bridge it " +
          "runs.",
        set: {
          ...c3,
          set: {"string.0.barrier.0.stiffness": "1e4"},
          ...with_scheme("modal_explicit_penalty"),
        },
        number: error_now,
      },
      {
        say: "With the bridge of the tanpura it fails.",
        set: {set: {"string.0.barrier.0.stiffness": "4.39e8"}},
        number: () => `${shown.motion.outcome.replace("_", " ")} at step ${shown.motion.step}`,
      },
      {
        say: "Between the two is a boundary. It is found here by 24 halvings at 44.1 kHz.",
        number: async () => `it fails from ${(await boundary(44100)).toExponential(1)} N/m on`,
      },
      {
        say: "A doubled sample rate moves the boundary. Open the map below to see the whole of it.",
        set: {rate: 88200},
        number: async () => {
          const [slow, fast] = [await boundary(44100), await boundary(88200)];
          return (
            `at 88.2 kHz it fails from ${fast.toExponential(1)} N/m on, ` +
            `${digits(fast / slow).toPrecision(2)} times as much`
          );
        },
      },
      {
        say: "The implicit scheme solves for the force, and runs with any stiffness.",
        set: with_scheme("modal_two_point"),
        number: async () => {
          const {run} = await ask("pair", {
            run: run_of({
              overrides: overrides_of({...state.set, "string.0.barrier.0.stiffness": "1e12"}),
              energy: true,
            }),
          });
          return (
            `with 1e12 N/m: ${run.outcome}, energy not accounted for ` +
            `${run.residual.toExponential(1)}`
          );
        },
      },
    ],
  },
  guitar: {
    title: "A guitar on its fret cannot be compared by waveform",
    exact: "own",
    steps: [
      {
        say: "A low E string buzzes on the first fret.",
        set: {scene: "guitar_over_fret", set: {}, ...with_scheme("modal_two_point")},
        number: error_now,
      },
      {
        say:
          "Start the exact solution twice, one a part in a million million higher. The two " +
          "agree, then they part.",
        number: async () => `they agree within 10 % for ${time_text(await sensitivity())}`,
      },
      {
        say: "A higher sample rate does not help for long: no scheme can follow beyond that time.",
        set: {rate: 352800},
        number: async () => {
          const {error, horizon} = await beside_exact(0.25);
          return (
            `over 250 ms the error is ${percent(error)}; it stays within 10 % for ` +
            `${time_text(horizon)}`
          );
        },
      },
      {
        say: "The spectrum is less sensitive than the waveform. Third octaves still compare.",
        number: async () =>
          `third octaves are ${(await beside_exact(0.4)).octaves.toFixed(1)} dB apart`,
      },
      {
        say:
          "The two exact solutions are about as far apart: no scheme can be told from them " +
          "by its spectrum.",
        number: async () =>
          `third octaves of the two are ${(await twice_exact(0.4)).octaves.toFixed(1)} dB apart`,
      },
    ],
  },
  modes: {
    title: "No more modes than you hear",
    steps: [
      {
        say: "All 133 modes below 20 kHz, with matched compliance.",
        set: {...c3, ...with_scheme("modal_two_point", 44100, "matched")},
        number: error_now,
      },
      {
        say: "Half as many modes. What is left out in compliance, the matched spring gives back.",
        set: {modes: 66},
        number: async () => {
          const o = await octaves_of(66);
          return `third octaves ${o.apart.toFixed(2)} dB from those of all modes`;
        },
      },
      {
        say: "Thirty modes reach up to about 4 kHz.",
        set: {modes: 30},
        number: async () => {
          const o = await octaves_of(30);
          return `third octaves ${o.apart.toFixed(2)} dB apart`;
        },
      },
      {
        say: "How few will do for 1 dB?",
        number: async () => {
          const o = await fewest_modes(1);
          return `${o.modes} modes: ${o.apart.toFixed(2)} dB`;
        },
      },
      {
        say: "And for 3 dB? The program does this for whole scenes: jvari trim.",
        number: async () => {
          const o = await fewest_modes(3);
          return `${o.modes} modes: ${o.apart.toFixed(2)} dB`;
        },
      },
    ],
  },
};
async function twice_exact(duration) {
  // Starts the second run higher by 1e-12 relative.
  const amplitude = shown.scene.string[0].start.amplitude,
    higher = overrides_of({
      ...state.set,
      "string.0.start.amplitude": (amplitude * (1 + 1e-12)).toPrecision(17),
    });
  return ask("pair", {
    run: run_of({...exact(), duration, overrides: higher}),
    beside: {...exact(), overrides: overrides_of(state.set)},
  });
}
const sensitivity = async () => (await twice_exact(0.25)).horizon;

// ---- Walking.

const invitation = {
  title: "Take the tour: why the published scheme sounds brighter",
  steps: [
    {say: "Five steps, five minutes: see it, hear it, find the cause at the bridge, mend it."},
  ],
};
async function take_step() {
  const set = (id, values) => Object.assign(document.getElementById(id), values),
    tour = tours[state.tour] ?? invitation,
    walks = tour !== invitation;
  state.step = Math.max(0, Math.min(state.step, tour.steps.length - 1));
  const step = tour.steps[state.step],
    place = walks ? `: step ${state.step + 1} of ${tour.steps.length}` : "",
    number_text = set("tour_number", {textContent: ""});
  set("tour_choice", {value: state.tour || "brighter"});
  set("tour_title", {textContent: tour.title + place});
  set("tour_text", {textContent: step.say});
  set("tour_back", {disabled: state.step === 0, hidden: !walks});
  set("tour_next", {
    disabled: walks && state.step === tour.steps.length - 1,
    textContent: walks ? "next" : "begin",
  });
  set("tour_end", {hidden: !walks});
  if (!walks || !client.list) return;
  number_text.textContent = "…";
  // Applies all steps so far: the address may begin in mid-tour.
  for (const before of tour.steps.slice(0, state.step + 1))
    Object.assign(state, structuredClone(before.set ?? {}));
  Object.assign(state, {text: null, files: {}});
  show_state(true);
  const request = ++take_step.count;
  try {
    await settled();
    const number = await step.number();
    if (request === take_step.count) number_text.textContent = number;
  } catch (error) {
    if (request === take_step.count && !(error instanceof Stale_question))
      number_text.textContent = error.message;
  }
}
take_step.count = 0;
function walk(by) {
  state.step += by;
  take_step();
}
