"""What the module costs over the engine, and what run_many gains by a second core.

throughput.py [SCENES [MILLISECONDS [REPEATS]]]: that many scenes, each of so much computing, on one
core and on two in turn. Medians over the repeats. Processor time hardly depends on what else the
machine does; wall time does, so its ratio stands beside the load."""

import os
import resource
import statistics
import sys
import time

import jvari

given = sys.argv[1:] + ["1000", "50", "5"][len(sys.argv) - 1:]
scenes, milliseconds, repeats = (int(number) for number in given)
scheme, whole = "modal_two_point", jvari.scene("tanpura_c3_release")
rate = 44100 * 64


def spent(who=resource.RUSAGE_SELF):
    use = resource.getrusage(who)
    return use.ru_utime + use.ru_stime


def called(duration):
    """Processor seconds of a call, of what is read from its run, and whether nothing interrupted
    them; the run."""
    switches, start = resource.getrusage(resource.RUSAGE_THREAD).ru_nivcsw, time.thread_time()
    run = jvari.run(whole, scheme, rate=rate, duration=duration)
    between = time.thread_time()
    run["nut"], run.time, run.facts
    end = time.thread_time()
    undisturbed = resource.getrusage(resource.RUSAGE_THREAD).ru_nivcsw == switches
    return between - start, end - between, undisturbed, run


# A run of 50 ms of computing. A call of one row has all that is beside the stepping, the making of
# the scheme too.
second = min(called(0.1)[0] for _ in range(5)) / 0.1
duration = 50e-3 / second
calls, reads, nothing, direct = [], [], [], []
for _ in range(40):
    call, read, undisturbed, run = called(duration)
    calls.append(call + read)
    reads.append(read)
    nothing.append(called(0)[0])
    if undisturbed:
        direct.append((call + read - run.wall_seconds) / (call + read))
call, beside = statistics.median(calls), statistics.median(nothing) + statistics.median(reads)
print(f"a call of {1e3 * call:.1f} ms: {1e6 * beside:.0f} us of it, {100 * beside / call:.2f} %, "
      "beside its stepping, the making of the scheme among them")
if len(direct) >= 10:
    print(f"  {100 * statistics.median(direct):.2f} % by the engine's own clock, in {len(direct)} "
          "calls that nothing interrupted")

# The same many times, on one thread and on two in turn. What one thread does alone bounds the gain:
# 1 / (s + (1 - s) / 2), s its share.
start = time.thread_time()
all_scenes = [whole.set("string.0.tension", 30 + 10 * k / scenes) for k in range(scenes)]
making = (time.thread_time() - start) / scenes
duration = 1e-3 * milliseconds / second
more, serial, faster, loads = [], [], [], []
for _ in range(repeats):
    total, alone, wall = {}, {}, {}
    for jobs in (1, 2):
        before, own, clock = spent(), time.thread_time(), time.monotonic()
        jvari.run_many(all_scenes, scheme, rate=rate, duration=duration, jobs=jobs)
        total[jobs], alone[jobs] = spent() - before, time.thread_time() - own
        wall[jobs] = time.monotonic() - clock
    more.append(total[2] / total[1])
    serial.append(alone[2] / total[2])
    faster.append(wall[1] / wall[2])
    loads.append(os.getloadavg()[0])
more, alone = statistics.median(more), statistics.median(serial)
print(f"run_many of {scenes} scenes, {1e3 * total[1] / scenes:.1f} ms each: two threads take "
      f"{more:.3f} times the processor time of one, {100 * alone:.2f} % of it on the calling "
      "thread")
print(f"  so two free cores are up to {1 / more / (alone + (1 - alone) / 2):.2f} times as fast as "
      f"one; making a scene takes {1e3 * making:.2f} ms")
print(f"  wall time: {statistics.median(faster):.2f} times as fast ({min(faster):.2f} to "
      f"{max(faster):.2f}), at a load of {statistics.median(loads):.1f} on "
      f"{len(os.sched_getaffinity(0))} cores")
