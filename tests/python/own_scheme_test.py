"""Schemes written in Python: they run, are judged and are checked like any other.
own_scheme_test.py"""

import copy
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree

import jvari
import numpy as np

TEMPLATES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs",
                         "own-scheme")
sys.path.insert(0, TEMPLATES)
from two_point import REPRESENTS as FEATURES, TwoPoint as Template  # noqa: E402


class TwoPoint(Template):
    """The template, and faults to be planted."""

    thread_sign = 1.0  # -1: the planted fault of a thread that pushes the wrong way
    kept = 1.0  # of the stored energy: another number is a planted fault

    def __init__(self, p):
        p = copy.copy(p)
        p.thread_stiffness *= self.thread_sign
        if p.contacts and p.contact_loss[0] != 0:
            raise ValueError("a contact without loss")
        super().__init__(p)

    def stored(self):
        return self.kept**self.n * super().stored()


def registered(name, balance="exact", **faults):
    cls = type(name, (TwoPoint,), faults)
    return jvari.scheme(name, represents=FEATURES, balance=balance,
                        source="van Walstijn et al. 2016, eqs 33, 38-52")(cls)


def broken(name):
    return {row["promise"] for row in jvari.check(name) if row["answer"] == "broken"}


class OwnScheme(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", UserWarning)

    def test_the_template_as_it_stands_is_the_scheme_that_it_repeats(self):
        jvari.scheme("template", represents=FEATURES)(Template)
        run = {name: jvari.run("tanpura_c3_release", name, duration=0.05, energy=True)
               for name in ("template", "modal_two_point")}
        for tap in run["modal_two_point"].keys():
            own, built_in = run["template"][tap], run["modal_two_point"][tap]
            self.assertLessEqual(np.linalg.norm(own - built_in), 1e-10 * np.linalg.norm(built_in),
                                 tap)

    @unittest.skipIf(importlib.util.find_spec("matplotlib") is None,
                     "matplotlib is not installed (Debian: python3-matplotlib)")
    def test_ten_lines_make_the_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, os.path.join(TEMPLATES, "picture.py"),
                            folder + "/picture.svg"], check=True,
                           env={**os.environ, "MPLBACKEND": "Agg"})
            drawing = xml.etree.ElementTree.parse(folder + "/picture.svg").getroot()
        points = [len(list(e.iter("{http://www.w3.org/2000/svg}use"))) for e in drawing.iter()
                  if e.get("id", "").startswith("line2d_")]
        self.assertEqual(points.count(3), 2, "two lines of three rates")

    def test_it_is_compared_like_any_other_but_for_its_cost(self):
        registered("python_two_point")
        rows = jvari.compare("tanpura_c3_release", ["python_two_point", "modal_two_point"],
                             rates=[44100], modes=133, duration=0.01, repeats=1)
        own, built_in = ([row for row in rows if row["scheme"] == name
                          and "matched" not in row["options"]][0] for name in
                         ("python_two_point", "modal_two_point"))
        self.assertAlmostEqual(own["error_l2_10ms"], built_in["error_l2_10ms"], delta=1e-10)
        self.assertEqual(own["untimed"], "interpreted, not compared")
        self.assertIsNone(own["times_real_time"])
        self.assertGreater(built_in["cost_s_per_s"], 0)

    def test_it_is_in_the_page_of_its_comparison(self):
        registered("python_two_point")
        with tempfile.TemporaryDirectory() as folder:
            rows = jvari.compare("free_string", ["python_two_point", "modal_two_point"],
                                 rates=[44100], modes=20, reference_modes=20, duration=0.01,
                                 repeats=1, out=folder + "/compared")
            written = jvari.report(rows, folder + "/reported")
            for name in ("compared", "reported"):
                with open(f"{folder}/{name}/report.html") as file:
                    self.assertIn("python_two_point", file.read())
                with open(f"{folder}/{name}/cells.csv") as file:
                    self.assertEqual(len(file.readlines()), 1 + len(rows))
            self.assertIn(folder + "/reported/manifest.json", written)
            os.remove(folder + "/compared/report.html")
            self.assertIn("report.html", jvari.report(folder + "/compared"))
            self.assertTrue(os.path.exists(folder + "/compared/report.html"))
            for call in (lambda: jvari.report(rows[:1], folder), lambda: jvari.report(rows),
                         lambda: jvari.report(folder, folder)):
                self.assertRaisesRegex(jvari.UsageError, "expected the", call)
            with self.assertRaisesRegex(jvari.UsageError, "comparison of free_string"):
                jvari.compare("tanpura_c3_release", ["modal_two_point"], rates=[44100],
                              duration=0.01, out=folder + "/compared")
            silence = np.zeros((442, len(jvari.scene("free_string").taps)))
            judged = jvari.judge("free_string", silence, duration=0.01)
            self.assertIn(folder + "/judged/report.html", jvari.report(judged, folder + "/judged"))

    def test_check_names_each_promise_that_it_breaks(self):
        self.assertEqual(broken("modal_two_point"), set())
        registered("honest_in_python")
        self.assertEqual(broken("honest_in_python"), set())
        registered("thread_turned_round", thread_sign=-1.0)
        self.assertIn("StoresNoNegativeEnergyAndDissipates", broken("thread_turned_round"))
        # without energies
        unprobed = {"advance": lambda self, rows: Template.advance(self, rows)[0],
                    "thread_sign": -1.0}
        registered("thread_turned_round_unprobed", balance="none", **unprobed)
        self.assertEqual(broken("thread_turned_round_unprobed"), {"ConvergesToTheReference"})
        registered("loses_energy", kept=0.999)
        ledgers = {"KeepsItsEnergyLedgerInEveryRow", "KeepsItsEnergyLedgerInSum"}
        self.assertTrue(ledgers & broken("loses_energy"))

        def reset(self):
            y = getattr(self, "y", None)
            TwoPoint.reset(self)
            self.y = self.y if y is None else y

        registered("forgets_to_reset", reset=reset)
        self.assertIn("StartsAnewAfterAReset", broken("forgets_to_reset"))

    def test_what_it_raises_is_the_reason_of_its_row(self):
        class Stumbles(TwoPoint):
            def advance(self, rows):
                raise ArithmeticError("no rows today")

        jvari.scheme("stumbles", represents=FEATURES)(Stumbles)
        row = jvari.compare("free_string", ["stumbles"], rates=[44100], modes=20, duration=0.01)[0]
        self.assertEqual(row["status"], "error")
        self.assertIn("no rows today", row["reason"])
        misshapen = {"advance": lambda self, rows: np.zeros((rows, 99))}
        jvari.scheme("misshapen", represents=FEATURES)(type("Misshapen", (TwoPoint,), misshapen))
        row = jvari.compare("free_string", ["misshapen"], rates=[44100], modes=20, duration=0.01)[0]
        self.assertIn("another shape", row["reason"])

    def test_a_dofs_that_is_no_number_is_a_row(self):
        for name, dofs in (("real", 2.5), ("word", "two"), ("large", 2**70), ("negative", -1)):

            class Misstates(TwoPoint):
                def __init__(self, p, dofs=dofs):
                    super().__init__(p)
                    self.dofs = dofs

            jvari.scheme(name, represents=FEATURES)(Misstates)
            row = jvari.compare("free_string", [name], rates=[44100], modes=20, duration=0.01,
                                repeats=1)[0]
            self.assertEqual(row["status"], "error")
            self.assertIn("dofs: found " + repr(dofs), row["reason"])
            with self.assertRaisesRegex(Exception, "dofs: found"):
                jvari.run("free_string", name, duration=0.01)

    def test_what_ends_python_ends_the_study(self):
        for error in (KeyboardInterrupt, SystemExit):
            for where in ("__init__", "advance"):

                def ends(self, *_):
                    raise error("enough")

                jvari.scheme("ends", represents=FEATURES)(type("Ends", (TwoPoint,), {where: ends}))
                with tempfile.TemporaryDirectory() as folder:
                    with open(folder + "/a.toml", "w") as f:
                        f.write('[[cells]]\nscenes = ["free_string"]\nschemes = ["ends"]\n'
                                'rates = [44100]\nmodes = 20\nreference_modes = 20\n'
                                'duration = 0.01\n')
                    for call in (lambda: jvari.run("free_string", "ends", duration=0.01),
                                 lambda: jvari.run_many(["free_string"], "ends", duration=0.01),
                                 lambda: jvari.compare("free_string", ["ends"], rates=[44100],
                                                       modes=20, duration=0.01),
                                 lambda: jvari.suite(folder + "/a.toml")):
                        self.assertRaises(error, call)
        self.assertEqual(jvari.run("free_string", "modal_two_point", duration=0.01).status, "ok")

    def test_its_map_has_a_page(self):
        registered("mapped")
        with tempfile.TemporaryDirectory() as folder:
            with open(folder + "/a.toml", "w") as f:
                f.write('[[cells]]\nname = "tension"\nscenes = ["tanpura_c3"]\n'
                        'measure = "outcome"\nschemes = ["mapped"]\nmodes = 20\n'
                        'duration = 0.01\nreference = "none"\n'
                        'sweep = { "string.0.tension" = [30, 40] }\n')
            tables = jvari.suite_tables(folder + "/a.toml", out=folder + "/m")
            self.assertEqual([row["scheme"] for row in tables["maps"]], ["mapped"] * 2)
            for written in (os.listdir(folder + "/m"),
                            [os.path.basename(f) for f in jvari.report(folder + "/m")]):
                self.assertIn("report.html", written)
            with open(folder + "/m/report.html", encoding="utf-8") as page:
                self.assertIn("mapped", page.read())

    def test_a_scheme_cannot_run_itself(self):
        class Runs(TwoPoint):
            def advance(self, rows):
                return jvari.run("free_string", "runs", duration=0.01)

        jvari.scheme("runs", represents=FEATURES)(Runs)
        with self.assertRaisesRegex(RuntimeError, "a scheme in Python cannot run one in Python"):
            jvari.run("free_string", "runs", duration=0.01)

    def test_rows_are_real_numbers(self):
        for rows in (np.ma.ones((1, 1)), np.ones((1, 1)) * 1j, [["a"]]):
            unreal = {"advance": lambda self, _, rows=rows: rows}
            jvari.scheme("unreal", represents=FEATURES)(type("Unreal", (TwoPoint,), unreal))
            with self.assertRaisesRegex(RuntimeError, "expected real numbers"):
                jvari.run("free_string", "unreal", duration=0.01)
            with self.assertRaisesRegex(TypeError, "expected real numbers"):
                jvari.judge("free_string", rows, duration=0.01)

    def test_its_name_and_its_features_must_be_known(self):
        with self.assertRaisesRegex(jvari.UsageError, "already"):
            jvari.scheme("modal_two_point")(TwoPoint)
        with self.assertRaisesRegex(jvari.UsageError, "did you mean .thread"):
            jvari.scheme("mine", represents=["thred"])(TwoPoint)


class Judge(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", UserWarning)
        self.scene = jvari.scene("tanpura_c3_release")
        self.run = jvari.run(self.scene, "modal_two_point", duration=0.01)
        self.taps = {tap: self.run[tap] for tap in self.scene.taps}

    def test_a_trace_is_judged_as_the_scheme_that_made_it(self):
        rows = jvari.judge(self.scene, self.taps, name="again", cost=0.5,
                           schemes=["modal_two_point"], duration=0.01, repeats=1)
        own, built_in = rows
        self.assertEqual((own["scheme"], own["options"]), ("again", "cost=as_reported"))
        self.assertEqual(own["error_l2_10ms"], built_in["error_l2_10ms"])
        self.assertAlmostEqual(own["cost_s_per_s"], 0.5)
        as_array = jvari.judge(self.scene, np.column_stack(list(self.taps.values())),
                               duration=0.01)[0]
        self.assertEqual(as_array["error_l2_10ms"], own["error_l2_10ms"])

    def test_a_trace_that_holds_no_number_is_a_failed_row(self):
        broken = {tap: values.copy() for tap, values in self.taps.items()}
        broken["nut"][300:] = np.nan
        rows = jvari.judge(self.scene, {44100: self.taps, 88200: broken}, duration=0.01)
        self.assertEqual([row["status"] for row in rows], ["ok", "diverged"])
        self.assertIn("tap nut holds no number in row 300", rows[1]["reason"])

    def test_what_is_no_trace_is_refused(self):
        with self.assertRaisesRegex(jvari.UsageError, "tap bridge is missing"):
            jvari.judge(self.scene, {tap: v for tap, v in self.taps.items() if tap != "bridge"},
                        duration=0.01)
        with self.assertRaisesRegex(jvari.UsageError, "has 442 rows, the scene has 222"):
            jvari.judge(self.scene, self.taps, duration=0.005)
        with self.assertRaisesRegex(jvari.UsageError, "rows x 4 taps"):
            jvari.judge(self.scene, np.zeros((442, 3)), duration=0.01)


    def test_no_call_keeps_its_traces(self):
        def megabytes():
            with open("/proc/self/statm") as f:
                return int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

        run = jvari.run("free_string", "modal_two_point", duration=0.5, modes=5)
        trace = np.column_stack([run[tap] for tap in run.keys()])
        for count in (3, 10):
            before = megabytes()
            for _ in range(count):
                jvari.judge("free_string", trace, duration=0.5, repeats=1,
                            reference="modal_two_point")
        self.assertLess(megabytes() - before, 0.5 * count * trace.nbytes / 1e6)


class Problem(unittest.TestCase):
    def test_it_has_the_arrays_of_the_scene(self):
        p = jvari.problem("tanpura_c3_release", rate=88200, modes=50, duration=0.01)
        self.assertEqual((p.modes, p.contacts, p.threads, p.rows, p.steps_per_row),
                         (50, 1, 1, 442, 2))
        self.assertEqual(p.contact_weights.shape, (1, 50))
        self.assertEqual(p.tap_weights.shape, (4, 50))
        np.testing.assert_allclose(p.beta, np.arange(1, 51) * np.pi / p.length, rtol=1e-14)
        omega = np.sqrt((p.tension * p.beta**2
                         + p.bending_stiffness * p.beta**4) / p.linear_density)
        np.testing.assert_allclose(p.omega0, omega, rtol=1e-12)
        # The string of all modes yields more than that of fifty, and as much in both directions.
        own = (p.contact_weights[0] ** 2 / (p.modal_mass * p.omega0**2)).sum()
        self.assertGreater(p.compliance[0, 0], own)
        np.testing.assert_allclose(p.compliance, p.compliance.T, rtol=1e-12)
        many = jvari.problem("tanpura_c3_release", rate=4e6, modes=20000, duration=0.01)
        np.testing.assert_allclose(
            (many.contact_weights[0] ** 2 / (many.modal_mass * many.omega0**2)).sum(),
            p.compliance[0, 0], rtol=1e-4)

    def test_what_arrays_do_not_hold_is_refused(self):
        with self.assertRaisesRegex(jvari.Refusal, "several strings"):
            jvari.problem("tanpura_drone")


if __name__ == "__main__":
    unittest.main(argv=["own_scheme_test.py"])
