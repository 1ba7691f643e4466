"""What the module costs over the engine, and what run_many gains by a second core: python3 throughput.py [SCENES]

Processor time, not wall time, so that what else the machine does hardly counts; the wall ratio stands beside its load.
"""

import os
import resource
import sys
import time

import jvari

scenes = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
scheme, whole = "modal_two_point", jvari.scene("tanpura_c3_release")


def spent():
    use = resource.getrusage(resource.RUSAGE_SELF)
    return use.ru_utime + use.ru_stime


# A run of 50 ms of computing: what the call costs beside its stepping. Only runs count that nothing interrupted.
rate, duration = 44100, 1.0
while True:
    seconds = min(jvari.run(whole, scheme, rate=rate, duration=duration).wall_seconds for _ in range(5))
    if seconds > 50e-3 or rate >= 44100 * 64:
        break
    rate *= 2
duration = min(1.0, duration * 50e-3 / seconds)
shares = []
for _ in range(200):
    switches = resource.getrusage(resource.RUSAGE_THREAD).ru_nivcsw
    start = time.thread_time()
    run = jvari.run(whole, scheme, rate=rate, duration=duration)
    run["nut"], run.time, run.facts
    took = time.thread_time() - start
    if resource.getrusage(resource.RUSAGE_THREAD).ru_nivcsw == switches:
        shares.append((took - run.wall_seconds) / took)
shares.sort()
if len(shares) >= 10:
    print(f"a run of {run.wall_seconds * 1e3:.0f} ms ({rate} Hz): {100 * shares[len(shares) // 2]:.2f} % of it are not stepping (median of {len(shares)})")
else:
    print(f"a run of 50 ms: not measured, {len(shares)} of 200 were not interrupted")

# The same many times. What one thread does alone bounds the gain: 1 / (s + (1 - s) / 2), s its share.
start = time.thread_time()
all_scenes = [whole.set("string.0.tension", 30 + 10 * k / scenes) for k in range(scenes)]
making = time.thread_time() - start
total, alone, wall = {}, {}, {}
for jobs in (1, 2):
    before, own, clock = spent(), time.thread_time(), time.monotonic()
    jvari.run_many(all_scenes, scheme, rate=rate, duration=duration, jobs=jobs)
    total[jobs], alone[jobs], wall[jobs] = spent() - before, time.thread_time() - own, time.monotonic() - clock
more, serial = total[2] / total[1], alone[2] / total[2]
print(f"run_many of {scenes} scenes: two threads take {more:.3f} times the processor time of one; {100 * serial:.2f} % of it on the calling thread")
print(f"so two free cores are at most {1 / more / (serial + (1 - serial) / 2):.2f} times as fast as one; making a scene takes {1e3 * making / scenes:.2f} ms")
print(f"wall time: {wall[1] / wall[2]:.2f} times as fast, at a load of {os.getloadavg()[0]:.1f} on {len(os.sched_getaffinity(0))} cores")
