"""A scheme of one's own in the work-precision picture, beside one that is built in:
python3 picture.py [FILE.svg]"""

import sys
import time

import jvari
from matplotlib import pyplot
from two_point import TwoPoint

scene, traces, cost = "tanpura_c3_release", {}, {}
for rate in (44100, 88200, 176400):
    problem, began = jvari.problem(scene, rate, 133, duration=0.05), time.perf_counter()
    traces[rate], _ = TwoPoint(problem).advance(problem.rows)
    cost[rate] = (time.perf_counter() - began) / 0.05  # for one second of sound
rows = jvari.judge(scene, traces, name="mine", cost=cost, schemes=["modal_two_point"],
                   duration=0.05)
for scheme in ("mine", "modal_two_point"):
    line = [row for row in rows if row["scheme"] == scheme]
    pyplot.loglog([row["cost_s_per_s"] for row in line], [row["error_l2_50ms"] for row in line],
                  "o-", label=scheme)
pyplot.xlabel("computing time per second of sound [s]")
pyplot.ylabel("relative error over 50 ms")
pyplot.legend()
pyplot.savefig(sys.argv[1] if len(sys.argv) > 1 else "picture.svg")
