"""Is a scheme statistically the reference where waveforms forget their start? Writes ensemble.csv
and ensemble.svg; takes two minutes, with `--runs 8` half a minute.

A guitar string that buzzes on a fret, 32 runs of each scheme, whose starts are scaled by 1 ± 1e-4
and no two alike, against 32 of the exact solution. They are compared by level and decay of each
third octave and by the spectral centroid of each quarter of the run. A trait differs where the
test of Kolmogorov and Smirnov (for short samples: Stephens 1970) says so at a false-discovery rate
of 5 % over all traits (Benjamini & Hochberg 1995), and its median by 0.1 dB, 1 dB/s or 1 %.

Beside p stand two sizes of the effect: the difference of the medians, and Cliff's delta, the
chance that a run of the scheme has the larger value less the chance that it has the smaller one.
Third octaves count that reference or scheme play within 40 dB of the reference's strongest: where
the string sounds it is within 25 dB, and between its partials more than 45 dB below.
"""

import collections

import jvari
import numpy as np

from study import arguments, axes_of, powers, save, spectrogram, write

AMPLITUDE, RATE, DURATION = 2e-3, 44100, 0.25         # of the start [m], of the rows [Hz], s
SPREAD, SOUNDS_WITHIN, FALSE_ALARMS = 1e-4, 40, 0.05  # of the start, dB, share
LEAST = {"third_octave_db": 0.1, "decay_db_per_s": 1, "centroid_hz": 0.01}
CENTRES = 1000 * 10 ** (np.arange(-13, 13) / 10)  # of third octaves, 50 Hz to 15.8 kHz
given = arguments(__doc__, "", runs=32)
scene = jvari.scene("guitar_over_fret")


def levels(signals):
    """Of third octaves with ideal flanks [dB]; a bin's power is spread evenly over its width."""
    power, bin_hz = powers(signals), RATE / signals.shape[1]
    edges = np.clip(np.arange(power.shape[1] + 1) - 0.5, 0, power.shape[1] - 1) * bin_hz
    below = np.pad(np.cumsum(power, axis=1), ((0, 0), (1, 0)))
    upto = [np.array([np.interp(CENTRES * flank, edges, one) for one in below])
            for flank in (10 ** -0.05, 10 ** 0.05)]
    return 10 * np.log10(upto[1] - upto[0])


def ensemble(scheme, rate=RATE, modes=132, options={}, first=0):
    """Traits of runs from starts first, first + 1, ...: {(kind, place): a value for each run}."""
    turns = np.arange(first, first + given.runs) * (5 ** 0.5 - 1) / 2  # the golden ratio's
    starts = [scene.set("string.0.start.amplitude", AMPLITUDE * (1 + SPREAD * u))
              for u in 2 * (turns % 1) - 1]
    signals = jvari.run_many(starts, scheme, rate, modes, duration=DURATION, tap_rate=RATE,
                             options=options, jobs=1)[:, :, scene.taps.index("saddle")]
    half = signals.shape[1] // 2
    fall = (levels(signals[:, :half]) - levels(signals[:, half:])) / (0.5 * DURATION)
    traits = {("third_octave_db", hz): x for hz, x in zip(CENTRES, levels(signals).T)}
    traits.update({("decay_db_per_s", hz): x for hz, x in zip(CENTRES, fall.T)})
    _, frequency, power = spectrogram(signals, RATE, 2048, 512)
    for q, part in enumerate(np.split(power, np.arange(1, 4) * power.shape[1] // 4, axis=1)):
        centre = part.sum(axis=1) @ frequency / part.sum(axis=(1, 2))
        traits["centroid_hz", (q + 0.5) / 4 * DURATION] = centre
    return traits


def p_of(a, b):
    """The probability that two samples of one distribution differ as much as these."""
    every, root = np.sort(np.concatenate([a, b])), np.sqrt(len(a) * len(b) / (len(a) + len(b)))
    share_a, share_b = (np.searchsorted(np.sort(x), every, "right") / len(x) for x in (a, b))
    reach = (root + 0.12 + 0.11 / root) * abs(share_a - share_b).max()
    terms = 2 * np.exp(-2 * (np.arange(1, 101) * reach) ** 2)
    return 1.0 if reach < 0.2 else np.clip(terms[::2].sum() - terms[1::2].sum(), 0, 1)


def compared(theirs, mine):
    """A row for each trait that counts."""
    level = {hz: [np.median(of["third_octave_db", hz]) for of in (theirs, mine)] for hz in CENTRES}
    floor = max(reference for reference, _ in level.values()) - SOUNDS_WITHIN
    rows = []
    for (kind, where), values in theirs.items():
        if where in level and max(level[where]) < floor:
            continue
        own = mine[kind, where]
        a, b, above = np.median(values), np.median(own), np.sign(own[:, None] - values[None, :])
        rows.append({"trait": kind, "where": where, "reference": a, "candidate": b,
                     "difference": b - a, "cliffs_delta": above.mean(), "p": p_of(own, values)})
    ordered = sorted(row["p"] for row in rows)
    found = [p for k, p in enumerate(ordered, 1) if p <= FALSE_ALARMS * k / len(rows)]
    for row in rows:
        least = LEAST[row["trait"]] * (row["reference"] if row["trait"] == "centroid_hz" else 1)
        row["differs"] = int(row["p"] <= max(found, default=-1) and abs(row["difference"]) > least)
    return rows


MATCHED, RATES, MODES = {"compliance": "matched"}, (44100, 176400, 705600), (132, 264, 528)
N = given.runs  # starts 0 to N - 1 are the reference's
studies = {
    "132 own modes": ({}, 132, [("exact_contact", RATE, 132, {})] + [
        (name, rate, 132, how) for rate in RATES for name, how in (
            ("modal_two_point", {}), ("modal_quadratised", {}),
            ("modal_quadratised", {"variant": "raw"}))]),
    "1064 matched modes": (MATCHED, 1064, [
        (name, rate, modes, how) for modes in MODES for name, rate, how in (
            ("exact_contact", RATE, MATCHED), ("modal_two_point", RATES[-1], MATCHED),
            ("modal_two_point", RATES[-1], {"compliance": "own"}))])}
table, drawn = [], collections.defaultdict(list)
for against, (how, modes, cells) in studies.items():
    reference = ensemble("exact_contact", modes=modes, options=how)
    for name, rate, count, options in cells:
        text = " ".join(f"{key}={value}" for key, value in options.items())
        try:
            rows = compared(reference, ensemble(name, rate, count, options, first=N))
        except jvari.Refusal as refusal:
            print(f"against {against}: {text} {count} modes at {rate} Hz: {refusal}", flush=True)
            continue
        exact = name == "exact_contact"
        cell = {"against": against, "scheme": name, "options": text, "modes": count,
                "rate": "" if exact else rate}
        table += [{**cell, **{key: f"{value:.4g}" if isinstance(value, float) else value
                              for key, value in row.items()}} for row in rows]
        share = np.mean([row["differs"] for row in rows])
        apart = np.median([abs(r["difference"]) for r in rows if r["trait"] == "third_octave_db"])
        delta = np.median([abs(row["cliffs_delta"]) for row in rows])
        drawn[against, f"{name} {text}".strip()].append(
            (count if modes > 132 else rate, 100 * share, apart))
        print(f"against {against}: {name} {text} {'' if exact else f'at {rate} Hz, '}{count} "
              f"modes: {sum(row['differs'] for row in rows)} of {len(rows)} traits differ. "
              f"Medians: levels by {apart:.2g} dB, delta {delta:.2g}", flush=True)
write(f"{given.out}/ensemble.csv", table[0], table)

figure, grid = axes_of([f"against {name}, exact in time" for name in studies] + [""] * 2, 2, (4, 2))
for (against, label), points in drawn.items():
    x, *measured = np.transpose(points)
    for row, y in zip(grid, measured):
        cell = row[list(studies).index(against)]
        if len(points) == 1:
            cell.axhline(y[0], linestyle=":", color="gray", label="the reference again")
        else:
            cell.semilogx(x, y, marker=".", label=label)
            cell.set_xticks(x, [f"{v:g}" for v in x])
            cell.minorticks_off()
for cell in grid[0]:
    cell.set(ylabel="traits that differ [%]", ylim=(-5, 105))
for cell, x, where in zip(grid[1], ("sample rate [Hz]", "modes"), ("lower left", "upper right")):
    cell.set(xlabel=x, ylabel="levels apart [dB]", yscale="log", ylim=(0.003, 30))
    cell.legend(fontsize=7, loc=where)
save(figure, "Is a scheme statistically the reference? A guitar string over a fret, 0.25 s\nTraits "
     "that differ, and the median difference of levels in third octaves",
     f"{given.out}/ensemble.svg")
