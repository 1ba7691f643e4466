"""Schemes written in Python: they run, are judged and are checked like any other. own_scheme_test.py"""

import unittest
import warnings

import jvari
import numpy as np

FEATURES = ["bending stiffness", "damping", "frequency-dependent damping", "measured modes", "lumped barrier", "thread", "initial shape", "pluck"]


class TwoPoint:
    """van Walstijn et al. 2016, eqs 33, 38-52, with the energy ledger of eqs 49, 51, 52: exact in every step."""

    thread_sign = 1.0  # -1: the planted fault of a thread that pushes the wrong way
    kept = 1.0  # of the stored energy: another number is a planted fault

    def __init__(self, p):
        self.p, self.dt = p, 1 / p.sample_rate
        omega = np.sqrt((p.omega0**2 - p.sigma**2).astype(complex))
        R, E = np.exp(-p.sigma * self.dt), np.expm1(-p.sigma * self.dt)
        num, den = ((E**2 + 4 * R * f(0.5 * omega * self.dt) ** 2).real for f in (np.sin, np.cos))
        self.a, self.b = num / den, -2 * np.expm1(-2 * p.sigma * self.dt) / den
        self.J, self.xi = 1 + self.a + self.b, self.dt**2 / (2 * p.modal_mass)
        none = np.zeros(p.modes)
        self.g_b = p.contact_weights[0] if p.contacts else none
        self.g_c = p.thread_weights if p.threads else none
        self.g_e = p.pluck_weights if p.plucks else none
        self.k_b, self.h_b = (p.contact_stiffness[0], p.contact_height[0]) if p.contacts else (0.0, 0.0)
        if p.contacts > 1 or (p.contacts and (p.contact_exponent[0] != 1 or p.contact_loss[0] != 0)):
            raise ValueError("one contact of exponent 1 without loss")
        self.k_c, self.r_c = self.thread_sign * p.thread_stiffness, p.thread_damping
        e_b, e_c = self.xi / self.J * self.g_b, self.xi / self.J * self.g_c
        self.phi = self.k_c / 2 + self.r_c / self.dt
        self.theta_bc, self.inverse = self.g_b @ e_c, 1 / (1 + self.phi * (self.g_c @ e_c))
        self.beta = self.phi * self.theta_bc * self.inverse
        self.theta = self.g_b @ e_b - self.beta * self.theta_bc
        self.force_at = {"displacement": 0, "nut_force": 0, "velocity": 1, "bridge_force": 2, "thread_force": 3, "driving_force": 4}
        self.dofs = 2 * p.modes
        self.start()

    def start(self):
        self.y, self.q, self.n = self.p.start.copy(), np.zeros(self.p.modes), 0
        self.impulse, self.supplied, self.lost = np.zeros(2), 0.0, 0.0

    reset = start

    def contact(self, d, b):
        phi = 0.5 * self.theta * self.k_b
        if self.k_b == 0 or (d <= 0 and d + b <= 0):
            return 0.0
        if d > 0 and d * (1 - phi) + b > 0:
            r = (2 * phi * d - b) / (1 + phi)
        elif d > 0:
            r = (-b + np.sqrt(b * b + 4 * phi * d * d)) / 2
        else:
            r = -(b - 2 * phi * d + np.sqrt(b * b - 4 * phi * d * (b + d))) / (2 * (1 + phi))
        return (r + b) / self.theta

    def pluck(self, n):
        return self.p.pluck_force[n] if n < len(self.p.pluck_force) else 0.0

    def step(self):
        F_e = 0.5 * (self.pluck(self.n) + self.pluck(self.n + 1))
        u = (2 * (self.q - self.a * self.y) + self.xi * F_e * self.g_e) / self.J
        v = (self.k_c * (self.p.thread_height - self.g_c @ self.y) - self.phi * (self.g_c @ u)) * self.inverse
        F_b = self.contact(self.h_b - self.g_b @ self.y, -(self.g_b @ u) - self.theta_bc * v)
        F_c = v - self.beta * F_b
        s = u + self.xi / self.J * (self.g_b * F_b + self.g_c * F_c)
        self.y, self.q, self.n = self.y + s, s - self.q, self.n + 1
        self.impulse += (F_b, F_c)
        self.supplied += F_e * (self.g_e @ s)
        self.lost += self.b @ (s * s) / self.xi + self.r_c / self.dt * (self.g_c @ s) ** 2

    def stored(self):
        modes = (self.q @ self.q + self.a @ (self.y * self.y)) / self.xi
        d_b, d_c = max(0.0, self.h_b - self.g_b @ self.y), self.p.thread_height - self.g_c @ self.y
        return modes + 0.5 * self.k_b * d_b**2 + 0.5 * self.k_c * d_c**2 * self.p.threads

    def advance(self, rows):
        taps, energy = np.empty((rows, self.p.taps)), np.empty((rows, 3))
        for row in range(rows):
            mean = self.impulse / self.p.steps_per_row
            values = (self.p.tap_weights @ self.y, self.p.tap_weights @ (2 / self.dt * self.q), mean[0], mean[1], -mean.sum())
            for k, quantity in enumerate(self.p.tap_quantities):
                value = values[self.force_at[quantity]]
                taps[row, k] = value[k] if np.ndim(value) else value
            energy[row] = self.kept**self.n * self.stored(), self.supplied, self.lost
            self.impulse, self.supplied, self.lost = np.zeros(2), 0.0, 0.0
            for _ in range(self.p.steps_per_row):
                self.step()
        return taps, energy


def registered(name, balance="exact", **faults):
    cls = type(name, (TwoPoint,), faults)
    return jvari.scheme(name, represents=FEATURES, balance=balance, source="van Walstijn et al. 2016, eqs 33, 38-52")(cls)


def broken(name):
    return {row["promise"] for row in jvari.check(name) if row["answer"] == "broken"}


class OwnScheme(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", UserWarning)

    def test_it_is_the_scheme_that_it_repeats(self):
        registered("python_two_point")
        run = {name: jvari.run("tanpura_c3_release", name, duration=0.05, energy=True) for name in ("python_two_point", "modal_two_point")}
        for tap in run["modal_two_point"].keys():
            own, built_in = run["python_two_point"][tap], run["modal_two_point"][tap]
            self.assertLessEqual(np.linalg.norm(own - built_in), 1e-10 * np.linalg.norm(built_in), tap)

    def test_it_is_compared_like_any_other_but_for_its_cost(self):
        registered("python_two_point")
        rows = jvari.compare("tanpura_c3_release", ["python_two_point", "modal_two_point"], rates=[44100], modes=133, duration=0.01, repeats=1)
        own, built_in = ([row for row in rows if row["scheme"] == name and "matched" not in row["options"]][0] for name in
                         ("python_two_point", "modal_two_point"))
        self.assertAlmostEqual(own["error_l2_10ms"], built_in["error_l2_10ms"], delta=1e-10)
        self.assertEqual(own["cost_s_per_s"], "interpreted, not compared")
        self.assertIsNone(own["times_real_time"])
        self.assertGreater(built_in["cost_s_per_s"], 0)

    def test_check_names_each_promise_that_it_breaks(self):
        self.assertEqual(broken("modal_two_point"), set())
        registered("honest_in_python")
        self.assertEqual(broken("honest_in_python"), set())
        registered("thread_turned_round", thread_sign=-1.0)
        self.assertIn("StoresNoNegativeEnergyAndDissipates", broken("thread_turned_round"))
        registered("thread_turned_round_unprobed", balance="none", thread_sign=-1.0)
        self.assertEqual(broken("thread_turned_round_unprobed"), {"ConvergesToTheReference"})
        registered("loses_energy", kept=0.999)
        self.assertTrue({"KeepsItsEnergyLedgerInEveryRow", "KeepsItsEnergyLedgerInSum"} & broken("loses_energy"))

        def reset(self):
            y = self.y
            TwoPoint.start(self)
            self.y = y

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
        jvari.scheme("misshapen", represents=FEATURES)(type("Misshapen", (TwoPoint,), {"advance": lambda self, rows: np.zeros((rows, 99))}))
        row = jvari.compare("free_string", ["misshapen"], rates=[44100], modes=20, duration=0.01)[0]
        self.assertIn("another shape", row["reason"])

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
        rows = jvari.judge(self.scene, self.taps, name="again", cost=0.5, schemes=["modal_two_point"], duration=0.01, repeats=1)
        own, built_in = rows
        self.assertEqual((own["scheme"], own["options"]), ("again", "cost=as_reported"))
        self.assertEqual(own["error_l2_10ms"], built_in["error_l2_10ms"])
        self.assertAlmostEqual(own["cost_s_per_s"], 0.5)
        as_array = jvari.judge(self.scene, np.column_stack(list(self.taps.values())), duration=0.01)[0]
        self.assertEqual(as_array["error_l2_10ms"], own["error_l2_10ms"])

    def test_a_planted_error_is_told_at_its_right_size(self):
        free = jvari.run("free_string", "exact_linear", modes=2000, duration=0.02)
        taps = {tap: 1.001 * free[tap] for tap in jvari.scene("free_string").taps}
        self.assertAlmostEqual(jvari.judge("free_string", taps, duration=0.02)[0]["error_l2_10ms"], 1e-3, delta=1e-5)

    def test_what_is_no_trace_is_refused(self):
        with self.assertRaisesRegex(jvari.UsageError, "tap bridge is missing"):
            jvari.judge(self.scene, {tap: v for tap, v in self.taps.items() if tap != "bridge"}, duration=0.01)
        with self.assertRaisesRegex(jvari.UsageError, "has 442 rows, the scene has 222"):
            jvari.judge(self.scene, self.taps, duration=0.005)
        with self.assertRaisesRegex(jvari.UsageError, "rows x 4 taps"):
            jvari.judge(self.scene, np.zeros((442, 3)), duration=0.01)


class Problem(unittest.TestCase):
    def test_it_has_the_arrays_of_the_scene(self):
        p = jvari.problem("tanpura_c3_release", rate=88200, modes=50, duration=0.01)
        self.assertEqual((p.modes, p.contacts, p.threads, p.rows, p.steps_per_row), (50, 1, 1, 442, 2))
        self.assertEqual(p.contact_weights.shape, (1, 50))
        self.assertEqual(p.tap_weights.shape, (4, 50))
        np.testing.assert_allclose(p.beta, np.arange(1, 51) * np.pi / p.length, rtol=1e-14)
        omega = np.sqrt((p.tension * p.beta**2 + p.bending_stiffness * p.beta**4) / p.linear_density)
        np.testing.assert_allclose(p.omega0, omega, rtol=1e-12)
        # The string of all modes yields more than that of fifty, and as much in both directions.
        own = (p.contact_weights[0] ** 2 / (p.modal_mass * p.omega0**2)).sum()
        self.assertGreater(p.compliance[0, 0], own)
        np.testing.assert_allclose(p.compliance, p.compliance.T, rtol=1e-12)
        many = jvari.problem("tanpura_c3_release", rate=4e6, modes=20000, duration=0.01)
        np.testing.assert_allclose((many.contact_weights[0] ** 2 / (many.modal_mass * many.omega0**2)).sum(), p.compliance[0, 0], rtol=1e-4)

    def test_what_arrays_do_not_hold_is_refused(self):
        with self.assertRaisesRegex(jvari.Refusal, "several strings"):
            jvari.problem("tanpura_drone")


if __name__ == "__main__":
    unittest.main(argv=["own_scheme_test.py"])
