"""The Python module: the same numbers as the program, its memory without a copy, refusals as
exceptions, Ctrl-C.

module_test.py PROGRAM PLUGIN
"""

import ast
import base64
import csv
import gc
import importlib.util
import io
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
import wave

import jvari
import numpy as np

PROGRAM, PLUGIN = sys.argv[1:3]
SHORT = {"duration": 0.01}


def arguments(function):
    """Name and default of each argument; pybind11 writes its signature into the docstring."""
    if not isinstance(function, ast.FunctionDef):
        function, = ast.parse(f"def {function.__doc__.splitlines()[0]}: ...").body
    own = function.args
    defaults = [None] * (len(own.args) - len(own.defaults)) + own.defaults + own.kw_defaults
    return [(a.arg, d and ast.literal_eval(d))
            for a, d in zip(own.args + own.kwonlyargs, defaults)]


def rows_of(file):
    with open(file) as stream:
        return list(csv.DictReader(stream))


class Module(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", UserWarning)  # what is said of certificates

    def test_a_run_is_the_programs_to_the_last_bit(self):
        scene = jvari.scene("tanpura_c3_release").set("string.0.tension", 40)
        run = jvari.run(scene, scheme="modal_two_point", rate=88200, energy=True,
                        options={"compliance": "matched"}, **SHORT)
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/a.csv"
            subprocess.run(
                [PROGRAM, "run", "tanpura_c3_release", "--set", "string.0.tension=40",
                 "--scheme", "modal_two_point", "--rate", "88200", "--option", "compliance=matched",
                 "--duration", "0.01", "--energy", "--quiet", "--out", file], check=True)
            rows = rows_of(file)
        self.assertEqual(run.status, "ok")
        self.assertEqual(len(rows), 442)
        self.assertEqual(run.keys()[-3:], ["energy_stored_J", "energy_supplied_J",
                                           "energy_dissipated_J"])
        for name in run.keys():
            self.assertEqual([float(row[name]) for row in rows], list(run[name]), name)
        self.assertEqual([float(row["time_s"]) for row in rows], list(run.time))
        self.assertEqual(run.units["nut"], "N")
        self.assertEqual(run.units["y03"], "m")
        self.assertTrue(all(isinstance(value, float) for value in run.facts.values()) and run.facts)
        self.assertEqual(run.steps, 884)

    def test_paths_stand_wherever_a_file_is_named(self):
        from pathlib import Path
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "f.toml").write_text(jvari.scene("free_string").toml())
            (folder / "s.csv").write_text("mode,displacement_m\n1,1e-3\n")
            scene = jvari.scene(folder / "f.toml").set("string.0.start", folder / "s.csv")
            self.assertEqual(jvari.run(scene, "modal_two_point", **SHORT).status, "ok")
            self.assertEqual(jvari.run(folder / "f.toml", "modal_two_point", **SHORT).status, "ok")
            rows = jvari.compare(folder / "f.toml", ["modal_two_point"], [44100], modes=10,
                                 reference_modes=20, repeats=2, out=folder / "out", **SHORT)
            self.assertIn(str(folder / "again" / "cells.csv"), jvari.report(rows, folder / "again"))
            with self.assertRaisesRegex(jvari.UsageError, "nowhere.toml"):
                jvari.suite(folder / "nowhere.toml")

    def test_what_is_no_value_is_refused_with_what_was_found(self):
        run = lambda **more: jvari.run("free_string", "modal_two_point", **SHORT, **more)
        for call, message in (
                (lambda: run(options={"compliance": None}), "found \"None\", expected a text"),
                (lambda: run(options={"compliance": []}), "option compliance: found .*one value"),
                (lambda: run(options={3: "own"}), "options: found \"3\", expected the name"),
                (lambda: jvari.scene("free_string").set("string.0.tension", None), "found \"None\""),
                (lambda: jvari.run(3, "modal_two_point"), "scene: found \"3\", expected a Scene"),
                (lambda: run(modes=-1), "modes: found \"-1\", expected a whole number, 0 or more"),
                (lambda: jvari.compare("free_string", modes=-1), "modes: found \"-1\""),
                (lambda: jvari.compare("free_string", modes=[10, 0]), "modes: found \"0\""),
                (lambda: jvari.compare("free_string", repeats=0), "repeats: found \"0\""),
                (lambda: jvari.compare("free_string", jobs=-1), "jobs: found \"-1\""),
                (lambda: jvari.run_many(["free_string"], "modal_two_point", modes=-1), "modes"),
                (lambda: jvari.report(3), "report: found \"3\"")):
            with self.assertRaisesRegex(jvari.UsageError, message):
                call()
        traces = {name: run()[name] for name in jvari.scene("free_string").taps}
        with self.assertRaisesRegex(TypeError, "another type than jvari.pyi says"):
            jvari.judge("free_string", traces, cost={44100: None}, **SHORT)

    def test_the_child_of_a_fork_does_not_wait_for_the_calls_of_its_parent(self):
        code = """import jvari, os, sys, threading, time
threading.Thread(target=lambda: jvari.run("tanpura_c3_release", "modal_two_point", duration=300.0,
                                          modes=60), daemon=True).start()
time.sleep(0.5)
pid = os.fork()
if pid == 0: sys.exit(7)
for _ in range(100):
    ended, status = os.waitpid(pid, os.WNOHANG)
    if ended: os._exit(os.waitstatus_to_exitcode(status))
    time.sleep(0.1)
os.kill(pid, 9)
os._exit(1)"""
        env = {**os.environ, "PYTHONPATH": os.path.dirname(jvari.__file__)}
        ended = subprocess.run([sys.executable, "-c", code], env=env, timeout=60)
        self.assertEqual(ended.returncode, 7)

    def test_a_run_that_blows_up_says_so_whether_its_energy_is_asked_for_or_not(self):
        scene = jvari.scene("tanpura_c3_release").set("string.0.barrier.0.stiffness", 1e8)
        bare, probed = (jvari.run(scene, "modal_explicit_penalty", energy=energy, duration=0.004)
                        for energy in (False, True))
        self.assertEqual(probed.status, "diverged")
        self.assertEqual((bare.status, bare.steps, len(bare["nut"])),
                         (probed.status, probed.steps, len(probed["nut"])))

    def test_arrays_are_the_engines_memory_and_keep_it(self):
        run = jvari.run("tanpura_c3_release", "modal_two_point", **SHORT)
        a, b = run["nut"], run["nut"]
        self.assertTrue(np.shares_memory(a, b))
        self.assertFalse(a.flags.writeable)
        self.assertFalse(a.flags.owndata)
        before = a.copy()
        del run, b
        gc.collect()
        for _ in range(20):
            jvari.run("free_string", "modal_two_point", **SHORT)
        self.assertTrue(np.array_equal(a, before))

    def test_refusals_are_exceptions_with_the_sentence(self):
        with self.assertRaisesRegex(jvari.UsageError,
                                    'unknown scheme or reference "modal_two_pont"; did you mean '
                                    '"modal_two_point"'):
            jvari.run("tanpura_c3", "modal_two_pont")
        with self.assertRaisesRegex(jvari.Refusal, "sitar_waveguide|represent"):
            jvari.run("tanpura_c3", "sitar_waveguide")
        with self.assertRaisesRegex(jvari.UsageError, "option"):
            jvari.run("tanpura_c3", "modal_two_point", options={"complience": "own"})
        with self.assertRaisesRegex(jvari.UsageError,
                                    "modal_quadratised:compliance: this run is of modal_two_point"):
            jvari.run("tanpura_c3", "modal_two_point",
                      options={"modal_quadratised:compliance": "own"})
        with self.assertRaisesRegex(jvari.SceneError, "string.0.tension.*expected"):
            jvari.scene("tanpura_c3").set("string.0.tension", -3)
        with self.assertRaisesRegex(jvari.SceneError, "did you mean"):
            jvari.scene("tanpura_c4")
        with self.assertRaisesRegex(ValueError, "no whole multiple"):
            jvari.run("tanpura_c3", "modal_two_point", rate=48000, tap_rate=44100)
        with self.assertRaisesRegex(jvari.SceneError,
                                    "duration: found -1 s, expected no less than a row"):
            jvari.run("tanpura_c3", "modal_two_point", duration=-1)
        with self.assertRaisesRegex(KeyError, 'did you mean .*nut'):
            jvari.run("tanpura_c3_release", "modal_two_point", **SHORT)["nutt"]

    def test_a_scene_is_a_value(self):
        a = jvari.scene("tanpura_c3")
        b = a.set("string.0.tension", 40)
        self.assertNotEqual(a.toml(), b.toml())
        self.assertEqual(a.toml(), jvari.scene("tanpura_c3").toml())
        self.assertEqual(repr(b), "jvari.scene('tanpura_c3').set('string.0.tension', '40')")
        self.assertEqual(eval(repr(b)).toml(), b.toml())
        self.assertIn("nut", b.taps)
        self.assertIn("tanpura_c3", jvari.scenes())

    def test_what_would_crash_is_refused(self):
        for kind in (jvari.Scene, jvari.Run, jvari.Trimmed):
            for make in (kind.__new__, object.__new__, lambda kind: kind()):
                self.assertRaises(TypeError, make, kind)
        itself, deep = [], []
        itself.append(itself)
        for _ in range(100000):
            deep = [deep]
        for value in (itself, deep):
            with self.assertRaisesRegex(jvari.UsageError, "nested deeper than"):
                jvari.scene("free_string").set("duration", value)

    def test_leaving_ends_what_a_daemon_thread_computes(self):
        for call in (
            'run_many(["tanpura_c3_release"] * 20, "modal_two_point", duration=5.0, rate=176400)',
            'compare("tanpura_c3_release", duration=1)'):
            script = ("import jvari, threading, time\n"
                      f"threading.Thread(target=lambda: jvari.{call}, daemon=True).start()\n"
                      "time.sleep(0.7)")
            ended = subprocess.run([sys.executable, "-W", "ignore", "-c", script],
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""), call)

    def test_a_failed_run_says_so_and_keeps_its_valid_rows(self):
        run = jvari.run("tanpura_c3_release", "modal_explicit_penalty", **SHORT)
        self.assertEqual(run.status, "diverged")
        self.assertGreater(run.failed_step, 0)
        self.assertLess(len(run.time), 442)
        self.assertEqual(len(run["nut"]), len(run.time))
        many = jvari.run_many(["tanpura_c3_release"], "modal_explicit_penalty", **SHORT)
        self.assertTrue(np.array_equal(many[0, :len(run.time), 0], run[run.keys()[0]]))
        self.assertTrue(np.isnan(many[0, len(run.time):]).all())

    def test_run_many_is_run_one_by_one(self):
        scenes = [jvari.scene("tanpura_c3_release").set("string.0.tension", t)
                  for t in (30, 33.5, 38)]
        many = jvari.run_many(scenes, "modal_two_point", jobs=2, **SHORT)
        self.assertEqual(many.shape, (3, 442, len(scenes[0].taps)))
        for k, scene in enumerate(scenes):
            run = jvari.run(scene, "modal_two_point", **SHORT)
            for j, name in enumerate(scene.taps):
                self.assertTrue(np.array_equal(many[k, :, j], run[name]), name)
        self.assertFalse(np.array_equal(many[0], many[1]))
        with self.assertRaisesRegex(jvari.UsageError, "scene 1 lasts another time"):
            jvari.run_many(["tanpura_c3_release",
                            jvari.scene("tanpura_c3_release").set("duration", 2)],
                           "modal_two_point")
        other = jvari.scene("tanpura_c3_release").set("tap.2.quantity", "thread_force")
        for change in (other, jvari.scene("tanpura_c3_release").set("tap.0.name", "other")):
            with self.assertRaisesRegex(jvari.UsageError,
                                        "scene 1 lasts another time or has taps of other names"):
                jvari.run_many(["tanpura_c3_release", change], "modal_two_point", **SHORT)
        with self.assertRaises(jvari.Refusal):
            jvari.run_many(["tanpura_c3"] * 3, "sitar_waveguide", **SHORT)
        self.assertEqual(jvari.run_many([], "modal_two_point").shape, (0, 0, 0))

    def test_the_interpreter_goes_on_while_the_engine_computes(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        jvari.run("tanpura_c3", "modal_two_point", rate=705600, duration=0.5)
        after = counted[0]
        done.set()
        thread.join()
        self.assertGreater(after - before, 5)

    def test_ctrl_c_ends_whatever_computes(self):
        rate = 44100 * 64
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/long.toml"
            with open(file, "w") as f:
                f.write('[[cells]]\nscenes = ["free_string"]\nschemes = ["modal_two_point"]\n'
                        f'rates = [{rate}]\nduration = 1\nrepeats = 50\n'
                        'measure = ["errors", "cost"]\n')
            slow_reference, slow_map = folder + "/reference.toml", folder + "/map.toml"
            with open(slow_reference, "w") as f:
                f.write('[[cells]]\nscenes = ["tanpura_c3"]\nschemes = ["modal_two_point"]\n'
                        'rates = [44100, 88200]\nduration = 0.2\nreference = "sundials"\n'
                        'reference_modes = "cell"\n')
            with open(slow_map, "w") as f:
                f.write('[[cells]]\nname = "m"\nscenes = "tanpura_c3"\nmeasure = "outcome"\n'
                        'schemes = ["modal_two_point"]\nduration = 0.2\nreference = "sundials"\n'
                        'sweep = { rate = [44100, 48000] }\n')
            for name, call in {
                "run": lambda: jvari.run("tanpura_c3", "modal_two_point", rate=rate, duration=60),
                "run_many": lambda: jvari.run_many(["tanpura_c3"] * 4, "modal_two_point", rate=rate,
                                                   duration=60),
                "compare": lambda: jvari.compare("tanpura_c3", schemes=["modal_two_point"],
                                                 rates=[rate], duration=60),
                "compare, its reference": lambda: jvari.compare("tanpura_c3", ["modal_two_point"],
                                                                [44100], reference="sundials",
                                                                duration=0.2),
                "suite": lambda: jvari.suite(file),
                # two cells wait for one
                "suite, its references": lambda: jvari.suite(slow_reference, jobs=2),
                "suite_tables, its maps": lambda: jvari.suite_tables(slow_map),
                "trim": lambda: jvari.trim("tanpura_c3", "0.0001%", duration=1),
            }.items():
                with self.subTest(name):
                    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
                    timer.start()
                    start = time.process_time()
                    with self.assertRaises(KeyboardInterrupt):
                        call()
                    # of what would take twice to a hundred times as much
                    self.assertLess(time.process_time() - start, 6)
                    timer.join()

    def test_ctrl_c_says_what_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            file, out = folder + "/a.toml", folder + "/out"
            with open(file, "w") as f:
                f.write('[[cells]]\nscenes = ["free_string"]\nschemes = ["modal_two_point"]\n'
                        'rates = [44100]\nduration = 0.01\n'
                        '[[cells]]\nscenes = ["tanpura_c3"]\nschemes = ["modal_two_point"]\n'
                        'rates = [44100]\nduration = 0.2\nreference = "sundials"\n'
                        'reference_modes = "cell"\n')

            def interrupt():
                while not (os.path.isdir(out + "/cells")
                           and any(name.endswith(".json") for name in os.listdir(out + "/cells"))):
                    time.sleep(0.01)
                os.kill(os.getpid(), signal.SIGINT)

            thread = threading.Thread(target=interrupt)
            thread.start()
            with self.assertRaises(KeyboardInterrupt) as raised:
                jvari.suite(file, out=out, jobs=1)
            thread.join()
            self.assertEqual(str(raised.exception),
                             f"interrupted: 1 of 2 cells are kept in {out}; resume=True goes on "
                             "from there")
            self.assertEqual(len(os.listdir(out + "/cells")), 1)
        compared = ("tanpura_c3", ["modal_two_point"], [44100])
        for call in (lambda: jvari.suite(file),
                     lambda: jvari.compare(*compared, reference="sundials", duration=0.2)):
            with tempfile.TemporaryDirectory() as folder:
                file = folder + "/a.toml"
                with open(file, "w") as f:
                    f.write('[[cells]]\nscenes = ["tanpura_c3"]\nschemes = ["modal_two_point"]\n'
                            'rates = [44100]\nduration = 0.2\nreference = "sundials"\n'
                            'reference_modes = "cell"\n')
                timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
                timer.start()
                with self.assertRaisesRegex(KeyboardInterrupt, "interrupted: nothing is kept"):
                    call()
                timer.join()

    def test_a_note_that_the_caller_wants_as_an_error_is_one(self):
        warnings.simplefilter("error", UserWarning)
        with self.assertRaisesRegex(UserWarning, "string"):
            jvari.run(jvari.scene("free_string").set("string.0.start.amplitude", 0),
                      "modal_two_point", **SHORT)

    def test_a_plugin_brings_its_schemes(self):
        before = set(jvari.schemes())
        there = os.getcwd()
        os.chdir(os.path.dirname(PLUGIN))
        try:
            jvari.plugin(os.path.basename(PLUGIN))
        finally:
            os.chdir(there)
        brought = set(jvari.schemes()) - before
        self.assertEqual(len(brought), 1)
        self.assertEqual(jvari.run("free_string", brought.pop(), **SHORT).status, "ok")
        jvari.plugin(PLUGIN)  # once more is none the worse
        with self.assertRaisesRegex(jvari.UsageError, "no/such/plugin.so"):
            jvari.plugin("/no/such/plugin.so")

    def test_a_comparison_is_the_programs_rows(self):
        rows = jvari.compare("tanpura_c3_release", schemes=["modal_two_point", "modal_quadratised"],
                             rates=[44100, 88200], modes=133,
                             options={"compliance": "own"}, repeats=1, **SHORT)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                [PROGRAM, "compare", "tanpura_c3_release", "--schemes", "modal_two_point",
                 "modal_quadratised", "--rates", "44100", "88200", "--modes", "133",
                 "--option", "compliance=own", "--repeats", "1", "--duration", "0.01", "--quiet",
                 "--out", folder], check=True, env={**os.environ, "JVARI_NODE_MODULES": "/nowhere"})
            kept = rows_of(folder + "/errors.csv")
            cells = [row["cell"] for row in rows_of(folder + "/facts.csv")]
        self.assertEqual(len(rows), 4)
        for old in kept:
            figure = rows[cells.index(old["cell"])]["errors"][old["tap"]][old["measure"]]
            for part in ("value", "floor", "certificate", "in_model", "certificate_in_model"):
                self.assertEqual(figure[part], float(old[part]) if old[part] else None, (old, part))
        for row in rows:
            self.assertGreater(row["cost_s_per_s"], 0)
            self.assertIn("bound_l2_10ms", row)
        several = jvari.compare("tanpura_c3_release", schemes=["modal_two_point"], rates=[44100],
                                modes=[60, 80],
                                options={"compliance": ["own", "matched"]}, repeats=1, **SHORT)
        self.assertEqual([(row["options"], row["modes"]) for row in several],
                         [("compliance=own", 60), ("compliance=own", 80),
                          ("compliance=matched", 60), ("compliance=matched", 80)])

    def test_a_reference_tells_what_it_is_uncertain_by(self):
        scene = jvari.scene("tanpura_c3_release")
        truth = jvari.reference(scene, modes=400, **SHORT)
        coarse = jvari.run(scene, "modal_two_point", 88200, 133, options={"compliance": "matched"},
                           **SHORT)
        rows = jvari.compare(scene, schemes=["modal_two_point"], rates=[88200], modes=133,
                             reference_modes=400, options={"compliance": "matched"}, repeats=1,
                             **SHORT)
        window = truth.time < 0.01
        error = (np.linalg.norm((coarse["nut"] - truth["nut"])[window])
                 / np.linalg.norm(truth["nut"][window]))
        figure = rows[0]["errors"]["nut"]["error_l2_10ms"]
        self.assertAlmostEqual(figure["value"] / error, 1, places=9)
        known = truth.uncertainty["taps"]["nut"]["l2_10ms"]
        self.assertEqual(known, figure["certificate"])
        self.assertTrue(0 < known < error)
        self.assertIsNone(coarse.uncertainty)

    def test_a_time_limit_ends_a_run_and_time_is_told(self):
        scene = jvari.scene("tanpura_c3_release")
        self.assertAlmostEqual(1 / scene.period, 130.9, delta=0.2)
        run = jvari.run(scene, "modal_two_point", duration=8 * scene.period)
        self.assertTrue(0 < run.processor_seconds < 5)
        with self.assertRaisesRegex(TimeoutError, "time limit of 0.001 s"):
            jvari.run(scene, "finite_difference_theta", 44100 * 64, time_limit=0.001)

    def test_a_reported_cost_stands_with_the_schemes_that_are_timed(self):
        call = {"schemes": ["modal_two_point"], "rates": [44100], "modes": 60, "repeats": 1}
        with self.assertRaisesRegex(jvari.UsageError, "this scheme is timed"):
            jvari.compare("tanpura_c3_release", cost={"modal_two_point": {44100: 0.8}}, **call,
                          **SHORT)

    def test_a_suite_is_its_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/a.toml"
            with open(file, "w") as f:
                f.write('[[cells]]\nscenes = ["free_string"]\nschemes = ["modal_two_point"]\n'
                        'rates = [44100, 88200]\nsearch = false\nduration = 0.01\n')
            rows = jvari.suite(file, out=folder + "/out")
            self.assertEqual([row["rate"] for row in rows], [44100, 88200])
            written = set(os.listdir(folder + "/out"))
            self.assertLessEqual({"cells", "cells.csv", "report.html"}, written)
            self.assertEqual(len(os.listdir(folder + "/out/cells")), 2)
            self.assertEqual(jvari.suite(file, out=folder + "/out", resume=True), rows)
            self.assertEqual(jvari.suite_tables(file, out=folder + "/out", resume=True),
                             {"cells": rows, "maps": [], "boundaries": []})

    def test_a_suites_maps_are_the_programs_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            file, out = folder + "/a.toml", folder + "/out"
            with open(file, "w") as f:
                f.write('[[cells]]\nname = "penalty"\nscenes = "tanpura_c3"\nmeasure = "outcome"\n'
                        'schemes = ["modal_explicit_penalty"]\nmodes = 60\nduration = 0.02\n'
                        'reference = "none"\ntheory = "penalty_limit"\nrefine = 5\n'
                        'reproduce = false\nset = { "string.0.barrier.0.stiffness" = 4.39e6 }\n'
                        'sweep = { rate = { from = 1e5, to = 1e6, points = 3 }, '
                        '"string.0.tension" = [30, 40] }\n'
                        '[[cells]]\nscenes = ["free_string"]\nschemes = ["modal_two_point"]\n'
                        'rates = [44100]\nduration = 0.01\nmeasure = ["errors"]\n')
            tables = jvari.suite_tables(file, out=out)
            subprocess.run([PROGRAM, "suite", file, "--quiet", "--out", folder + "/whole"],
                           check=True, env={**os.environ, "JVARI_NODE_MODULES": "/nowhere"})
            for name, length in (("maps", 6), ("boundaries", 4)):
                rows, theirs = tables[name], rows_of(f"{folder}/whole/{name}.csv")
                self.assertEqual(len(rows), length)
                for row, old in zip(rows, theirs, strict=True):
                    self.assertEqual(list(row), list(old))
                    for column, text in old.items():
                        number = isinstance(row[column], (int, float))
                        self.assertEqual(row[column] if number else row[column] or "",
                                         float(text) if number else text, column)
            self.assertLess(min(abs(row["relative_difference"] or 1)
                                for row in tables["boundaries"]), 0.1)
            self.assertEqual(len(tables["cells"]), 1)
            cells = os.listdir(out + "/cells")
            # with five bisections of each boundary, and the one cell
            self.assertEqual(len(cells), 6 + 4 * 5 + 1)
            at = os.stat(out + "/cells/" + cells[0]).st_mtime_ns
            self.assertEqual(jvari.suite_tables(file, out=out, resume=True), tables)
            self.assertEqual(os.stat(out + "/cells/" + cells[0]).st_mtime_ns, at)

    def test_a_trim_is_its_path_and_its_needs(self):
        trimmed = jvari.trim("free_string", "10%", scheme="modal_two_point", duration=0.01,
                             reference="exact_linear")
        self.assertTrue(trimmed.found)
        self.assertLess(trimmed.path[-1]["error"], 0.1)
        self.assertLess(trimmed.path[-1]["modes"], 133)  # those of the string below 20 kHz
        self.assertIn("bending_stiffness", " ".join(row["part"] for row in trimmed.needs))
        with tempfile.TemporaryDirectory() as folder:
            with open(folder + "/trimmed.toml", "w") as f:
                f.write(trimmed.toml)
            self.assertEqual(jvari.scene(folder + "/trimmed.toml").name, "free_string_trimmed")
        with self.assertRaisesRegex(jvari.UsageError, "within"):
            jvari.trim("free_string", "ten")

    def test_a_run_is_a_dataset(self):
        if importlib.util.find_spec("xarray") is None:
            self.skipTest("xarray is not installed (Debian: python3-xarray)")
        run = jvari.run("tanpura_c3_release", "modal_two_point", energy=True, **SHORT)
        data = run.to_xarray()
        self.assertEqual(list(data.data_vars), run.keys())
        self.assertEqual(data["nut"].dims, ("time",))
        self.assertEqual(data["nut"].attrs["units"], "N")
        self.assertTrue(np.shares_memory(data["nut"].values, run["nut"]))
        self.assertTrue(np.array_equal(data["time"].values, run.time))
        self.assertEqual(data.attrs, run.facts)

    def test_a_run_in_a_notebook_is_a_picture_of_each_column_and_a_sound_of_each_tap(self):
        run = jvari.run("tanpura_c3_release", "modal_two_moment", energy=True, **SHORT)
        html = run._repr_html_()
        captions = re.findall("<figcaption>(.*?):", html)
        self.assertEqual(captions, run.keys())
        sounds = re.findall('src="data:audio/wav;base64,([^"]*)"', html)
        self.assertEqual(len(sounds), 4)
        nut = run["nut"] - run["nut"].mean()
        with wave.open(io.BytesIO(base64.b64decode(sounds[0]))) as wav:
            self.assertEqual(wav.getframerate(), run.tap_rate)
            heard = np.frombuffer(wav.readframes(wav.getnframes()), np.int16)
        self.assertLess(abs(heard - 32767 * nut / abs(nut).max()).max(), 0.51)
        path = [float(y) for y in re.findall(r",([\d.]+)", re.search('d="M([^"]*)', html)[1])]
        self.assertEqual((min(path), max(path)), (0, 96))  # the whole height, upside down
        first = run["nut"][: len(run["nut"]) // 640 or 1]
        top = 96 * (run["nut"].max() - first.min()) / np.ptp(run["nut"])
        self.assertLess(abs(path[0] - top), 0.06)

    def test_the_readme_runs_as_printed(self):
        readme = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "README.md")
        with open(readme) as file:
            snippet = file.read().split("```python\n")[1].split("```")[0]
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-c", snippet], cwd=folder, check=True)
            self.assertTrue(os.path.exists(folder + "/tuned/report.html"))

    def test_the_stubs_name_what_there_is(self):
        with open(os.path.join(os.path.dirname(jvari.__file__), "jvari.pyi")) as f:
            stubs = ast.parse(f.read())
        functions = (ast.FunctionDef, ast.ClassDef)
        names = {n.name: n for n in stubs.body if isinstance(n, functions)}
        public = {name for name in dir(jvari) if not name.startswith("_")}
        self.assertEqual(set(names), public)
        for name, node in names.items():
            there = getattr(jvari, name)
            self.assertTrue(there.__doc__, name)
            if isinstance(node, ast.ClassDef):
                stubbed = {n.name for n in node.body if isinstance(n, functions)}
                own = set()
                if stubbed:
                    own = {m for m in vars(there) if not m.startswith("_") or m == "__getitem__"}
                self.assertEqual(stubbed, own, name)
                for member in own:
                    self.assertTrue(getattr(there, member).__doc__, f"{name}.{member}")
            else:
                self.assertEqual(arguments(node), arguments(there), name)

    def test_a_field_of_a_comparison_has_one_name_as_argument_flag_and_key_of_suites(self):
        def printed(*words):
            return subprocess.run([PROGRAM, *words], capture_output=True, text=True).stdout
        own = {"scene", "cost", "reference", "time_limit"}  # no flag has the last two
        shared = {"json", "quiet", "plugin", "external", "set", "resume", "help"}
        flags = {flag.replace("-", "_") for flag in
                 re.findall(r"--([a-z-]+) ", printed("compare", "--help").split("Example:")[0])}
        flags = {{"option": "options"}.get(flag, flag) for flag in flags} - shared
        self.assertEqual(set(dict(arguments(jvari.compare))) - own, flags - {"cost"})
        keys = {key["key"].removesuffix("_s")
                for key in json.loads(printed("list", "keys", "--json"))["keys"]["cells"]}
        self.assertLessEqual(
            {"schemes", "rates", "modes", "reference", "reference_modes", "duration", "tap_rate",
             "options", "repeats", "time_limit"}, keys & set(dict(arguments(jvari.compare))))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
