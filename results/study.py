"""What the scripts beside the records share: runs of the module jvari, claims, pictures.

A claim is a number with limits. It holds where the number, give or take its uncertainty, lies
within them. It does not hold where it lies outside, and cannot be told where it straddles one.
"""

import argparse
import collections
import csv
import math
import os
import tempfile

import jvari
import matplotlib
import numpy as np

matplotlib.use("Agg")
matplotlib.rcParams.update({
    "svg.hashsalt": "jvari", "svg.fonttype": "none", "font.size": 8, "axes.titlesize": 8,
    "axes.grid": True, "grid.alpha": 0.3, "lines.linewidth": 0.9, "figure.titlesize": 9})
from matplotlib import pyplot  # noqa: E402

RESULTS = os.path.dirname(os.path.abspath(__file__))


def arguments(says, out, **numbers):
    """Of the command line: --out, where to write, and a whole number for each of `numbers`."""
    parser = argparse.ArgumentParser(description=says,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", metavar="DIR", default=os.path.join(RESULTS, out))
    for name, default in numbers.items():
        parser.add_argument("--" + name, type=int, metavar="N", default=default)
    given = parser.parse_args()
    os.makedirs(given.out, exist_ok=True)
    return given


def scene(name, changes={}, taps={}):
    """A scene of the library with keys changed and taps added, {name: (quantity, string, x)}."""
    changed = jvari.scene(name)
    for key, value in changes.items():
        changed = changed.set(key, value)
    text = changed.toml()
    for tap, (quantity, *where) in taps.items():
        if tap in changed.taps:
            continue
        text += f'\n[[tap]]\nname = "{tap}"\nquantity = "{quantity}"\n'
        text += "".join(f"{key} = {value}\n" for key, value in zip(("string", "position"), where))
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(text)
        file.flush()
        return jvari.scene(file.name)


# ---- Numbers, and what is claimed of them

class Number(collections.namedtuple("Number", "value uncertainty rests_on", defaults=(0, ""))):
    """What was measured, by how much it may be off, and by what that is known ("": by the run)."""

    def __sub__(self, other):
        return Number(self.value - other.value, self.uncertainty + other.uncertainty,
                      self.rests_on or other.rests_on)

    def __truediv__(self, other):
        ratio = self.value / other.value
        off = (self.uncertainty + abs(ratio) * other.uncertainty) / abs(other.value)
        return Number(ratio, off, self.rests_on or other.rests_on)


class Table:
    """A table of a record. A field is asked for as a number, or as text: "" is an empty one."""

    def __init__(self, record, name):
        with open(os.path.join(RESULTS, record, name + ".csv"), newline="") as file:
            self.rows = list(csv.DictReader(file))

    def where(self, fields):
        def alike(field, value):
            return field == value if isinstance(value, str) else field and float(field) == value
        return [row for row in self.rows if all(alike(row[k], v) for k, v in fields.items())]

    def number(self, column, fields):
        row, = (row for row in self.where(fields) if row[column])
        value = float(row[column])
        if column == "ns_per_step":
            cost, low, high = (float(row["cost_" + k]) for k in ("s_per_s", "lower", "upper"))
            return Number(value, value * max(high - cost, cost - low) / cost, "quartiles")
        return Number(value)


class Errors:
    """The errors of a record, asked for by measure, tap, and facts of the cell."""

    def __init__(self, record):
        self.facts = Table(record, "facts")
        self.figures = {(row["cell"], row["tap"], row["measure"]): row
                        for row in Table(record, "errors").rows}

    def number(self, measure, tap, fields, part="value"):
        figures = (self.figures.get((row["cell"], tap, measure))
                   for row in self.facts.where(fields))
        figure, = (f for f in figures if f and f[part])
        return error_of(measure, figure, part)


def error_of(measure, figure, part="value"):
    """Of a row of errors.csv, or of what jvari.compare gives for a tap and a measure, with the
    uncertainty that stands beside it."""
    value = float(figure[part])
    if not measure.startswith("error_"):
        return Number(value)
    off = figure["certificate" + "_in_model" * (part == "in_model")]
    return Number(value, float("nan" if off in ("", None) else off),
                  "the reference's certificate")


class Claims:
    def __init__(self):
        self.rows = []

    def __call__(self, says, place, *measured, at_least=-math.inf, at_most=math.inf, unit="",
                 note="", left_open=""):
        """All that is measured has to lie within the limits. `left_open`: why it cannot be told."""
        numbers = [n if isinstance(n, Number) else Number(n) for n in measured]

        def gravity(n):
            low, high = n.value - n.uncertainty, n.value + n.uncertainty
            within = at_least <= low and high <= at_most
            return 0 if within else 2 if high < at_least or low > at_most else 1
        verdict = 1 if left_open else max(map(gravity, numbers))
        row = {"claim": says, "place": place, "measured": "", "uncertainty": "", "unit": unit,
               "verdict": ("holds", "cannot be told", "does not hold")[verdict], "rests_on": "",
               "expected": " and ".join(f"{words} {limit:.6g}" for words, limit in (
                   ("at least", at_least), ("at most", at_most)) if math.isfinite(limit)),
               "note": "; ".join(filter(None, (left_open, note)))}
        if numbers:
            n = min(numbers, key=lambda n: min(n.value - at_least, at_most - n.value))
            row.update(measured=f"{n.value:.5g}", rests_on=n.rests_on or "the run itself",
                       uncertainty=f"{n.uncertainty:.5g}" if n.rests_on else "")
        self.rows.append(row)

    def write(self, folder):
        columns = "claim place verdict measured uncertainty unit expected rests_on note".split()
        write(os.path.join(folder, "claims.csv"), columns, self.rows)
        count = collections.Counter(row["verdict"] for row in self.rows)
        print(f"{len(self.rows)} claims: {count['holds']} hold, {count['does not hold']} do not "
              f"hold, {count['cannot be told']} cannot be told")


def write(path, columns, rows):
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, columns, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


# ---- What is made of a signal: its rows come `rate` times a second

def window_of(signal, rate, start, end):
    """Time [s] and value of its rows from `start` to `end` [s]."""
    last = int(min(end * rate + 1e-6, len(signal) - 1))
    rows = np.arange(math.ceil(start * rate - 1e-6), last + 1)
    return rows / rate, signal[rows]


def extent(signal, rate, count):
    """Middle [s], least and largest value of each of `count` equal parts."""
    each = len(signal) / count
    parts = [signal[int(i * each):int((i + 1) * each)] for i in range(count)]
    return ((np.arange(count) + 0.5) * each / rate, np.array([p.min() for p in parts]),
            np.array([p.max() for p in parts]))


def powers(frames):
    """Of each bin of each frame, by a periodic Hann window: a sine of amplitude A has A^2/2."""
    n = frames.shape[-1]
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(n) / n)
    power = 2 * np.abs(np.fft.rfft(frames * window)) ** 2 / (n * np.sum(window ** 2))
    power[..., 0] /= 2
    power[..., -1] /= 2 - n % 2
    return power


def envelope(signal, rate, width, highest, points):
    """Frequency [Hz] and the level [dB] of the strongest bin within half a `width` of it."""
    power, bin_hz = powers(signal), rate / len(signal)
    half = round(0.5 * width / bin_hz)
    frequency = highest * np.arange(1, points + 1) / points
    nearest = np.rint(frequency / bin_hz).astype(int)
    return frequency, 10 * np.log10([power[max(0, k - half):k + half + 1].max() for k in nearest])


def spectrogram(signal, rate, window, hop):
    """Middles of the frames [s], frequencies [Hz], and powers, frame by frame."""
    frames = np.lib.stride_tricks.sliding_window_view(signal, window, axis=-1)[..., ::hop, :]
    return ((0.5 * window + hop * np.arange(frames.shape[-2])) / rate,
            np.arange(window // 2 + 1) * rate / window, powers(frames))


def centroid(signal, rate, window, hop, lowest=0, highest=math.inf):
    """Middles of the frames [s], and centres of their spectra between two frequencies [Hz]."""
    time, frequency, power = spectrogram(signal, rate, round(window * rate), round(hop * rate))
    within = (lowest <= frequency) & (frequency <= highest)
    return time, power[:, within] @ frequency[within] / power[:, within].sum(axis=1)


def between(x, y, start, end):
    return y[(start <= x) & (x <= end)]


def slope(x, y):
    """Of the fitted line, with its 95 % interval by Student's t."""
    (a, b), dof = np.polyfit(x, y, 1), len(x) - 2
    t = np.linspace(0, 50, 500_001)
    density = (1 + t * t / dof) ** (-(dof + 1) / 2)
    area = np.cumsum(density) - density / 2 - density[0] / 2
    quantile = np.interp(0.95 * area[-1], area, t)
    scatter = np.sqrt(np.sum((y - a * x - b) ** 2) / dof / np.sum((x - x.mean()) ** 2))
    return Number(a, quantile * scatter, "95 % interval")


# ---- Pictures

def axes_of(panels, columns, size, **share):
    rows = -(-len(panels) // columns)
    figure, grid = pyplot.subplots(rows, columns, layout="constrained", squeeze=False,
                                   figsize=(size[0] * columns, size[1] * rows + 0.5), **share)
    for cell, heading in zip(grid.flat, panels):
        cell.set_title(heading)
    for cell in grid.flat[len(panels):]:
        cell.axis("off")
    return figure, grid


def save(figure, title, path):
    figure.suptitle(title)
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    pyplot.close(figure)


def draw(path, title, panels, x, y, columns=1, size=(6.4, 2.4), share=True, **axes):
    """Of each panel the lines, {label: (x, y)}, or bands, {label: (x, low, high)}."""
    figure, grid = axes_of(panels, columns, size, sharex=share, sharey=share)
    for cell, lines in zip(grid.flat, panels.values()):
        for label, line in lines.items():
            if len(line) == 2:
                cell.plot(*line, marker="." if len(line[0]) < 20 else "", label=label)
            else:
                cell.fill_between(*line)
        cell.set(xlabel=x, ylabel=y, **axes)
        if share:
            cell.label_outer()
        if len(lines) > 1 and cell is grid[0, -1]:
            cell.legend(bbox_to_anchor=(1, 1), loc="upper left")
    save(figure, title, path)


def draw_spectrograms(path, title, panels, rate, columns=1, size=(2.6, 2.6), frames=100):
    """Of each panel the signal up to 8 kHz: the strongest bins in decibels below that of all."""
    window = 2 ** int(math.log2(0.047 * rate))
    drawn = [spectrogram(signal, rate, window, max(1, (len(signal) - window) // frames))
             for signal in panels.values()]
    top = max(power.max() for _, _, power in drawn)
    figure, grid = axes_of(panels, columns, size, sharex=True, sharey=True)
    for cell, (time, frequency, power) in zip(grid.flat, drawn):
        each = math.ceil(np.sum(frequency < 8000) / 128)
        count = int(8000 / frequency[each])
        level = power[:, :count * each].reshape(len(time), count, each).max(axis=2).T / top
        image = cell.imshow(10 * np.log10(level + 1e-30), origin="lower", vmin=-80, vmax=0,
                            aspect="auto", interpolation="none",
                            extent=(0, time[-1] + time[0], 0, count * frequency[each] / 1e3))
        cell.set(xlabel="time [s]", ylabel="frequency [kHz]")
        cell.label_outer()
        cell.grid(False)
    figure.colorbar(image, ax=grid, label="dB re common maximum")
    save(figure, title, path)
