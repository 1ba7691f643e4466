"""Draws error against cost of a few schemes: python3 work_precision.py [FILE.svg]

Each line is a scheme with its options, each point a rate. Down is more accurate, left is cheaper.
"""

import sys

import jvari
import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

file = sys.argv[1] if len(sys.argv) > 1 else "work_precision.svg"
scene = jvari.scene("tanpura_c3_release")

# %% One run, to look at
run = jvari.run(scene, scheme="modal_two_point", duration=0.05, energy=True)
print(f"{run.status}: {len(run.time)} rows of {', '.join(run.keys())}; largest nut force "
      f"{abs(run['nut']).max():.3g} {run.units['nut']}")

# %% Schemes and rates against the exact solution, as the suite work-precision has it
rows = jvari.compare(
    scene,
    schemes=["modal_two_point", "modal_three_point", "finite_difference_theta"],
    rates=[44100, 88200, 176400],
    modes=133,
    options={"compliance": ["own", "matched"]},
    reference="exact_contact",
    reference_modes=1064,
    duration=0.05,
    repeats=2,
)

# %% The picture
figure, axes = pyplot.subplots(figsize=(6, 4), layout="constrained")
def name_of(row):
    return f"{row['scheme']} {row['options']}".strip()


for scheme in dict.fromkeys(map(name_of, rows)):
    own = [row for row in rows if name_of(row) == scheme and row["status"] == "ok"]
    axes.loglog([row["cost_s_per_s"] for row in own], [row["error_l2_50ms"] for row in own],
                marker="o", label=scheme)
axes.set_xlabel("computing time per second of sound [s/s]")
axes.set_ylabel("relative error of the nut force over 50 ms")
axes.set_title(scene.name)
axes.legend()
figure.savefig(file)
print(f"written: {file}")
