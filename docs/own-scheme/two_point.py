"""The modal two-point scheme of van Walstijn, Bridges & Mehes 2016 (eqs 33, 38-52):
python3 two_point.py problem.json trace.csv

One contact of exponent 1 at most, and a thread. `jvari export` writes the problem, `jvari judge`
says how wrong the trace is. In Python, `jvari.scheme("mine", represents=REPRESENTS)(TwoPoint)`
makes it a scheme, and picture.py draws it beside others."""

import json
import sys
from types import SimpleNamespace

import numpy as np

REPRESENTS = ["bending stiffness", "damping", "frequency-dependent damping", "measured modes",
              "lumped barrier", "thread", "initial shape", "pluck"]


class TwoPoint:
    def __init__(self, p):
        if p.contacts > 1 or np.any(p.contact_exponent != 1) or np.any(p.contact_loss != 0):
            raise NotImplementedError(
                "this scheme takes one contact at most, of exponent 1 and without loss")
        self.p, self.dt = p, 1 / p.sample_rate
        omega = np.sqrt((p.omega0**2 - p.sigma**2).astype(complex))
        R, E = np.exp(-p.sigma * self.dt), np.expm1(-p.sigma * self.dt)
        num, den = ((E**2 + 4 * R * f(0.5 * omega * self.dt) ** 2).real for f in (np.sin, np.cos))
        self.a, self.b = num / den, -2 * np.expm1(-2 * p.sigma * self.dt) / den  # (33)
        self.J, self.xi = 1 + self.a + self.b, self.dt**2 / (2 * p.modal_mass)
        none = np.zeros(p.modes)
        self.g_b, self.k_b, self.h_b = none, 0, 0
        if p.contacts:
            self.g_b, self.k_b = p.contact_weights[0], p.contact_stiffness[0]
            self.h_b = p.contact_height[0]
        self.g_c = p.thread_weights if p.threads else none
        self.g_e = p.pluck_weights if p.plucks else none
        self.e_b, self.e_c, self.e_e = (self.xi / self.J * g
                                        for g in (self.g_b, self.g_c, self.g_e))
        self.phi_c = p.thread_stiffness / 2 + p.thread_damping / self.dt
        self.theta_bc = self.g_b @ self.e_c
        self.inverse = 1 / (1 + self.phi_c * (self.g_c @ self.e_c))
        self.beta = self.phi_c * self.theta_bc * self.inverse  # (47)
        self.theta = self.g_b @ self.e_b - self.beta * self.theta_bc
        self.heard = np.reshape(p.tap_weights, (p.taps, p.modes))
        self.dofs = 2 * p.modes
        self.reset()

    def reset(self):
        self.y, self.q = self.p.start.copy(), np.zeros(self.p.modes)
        self.n, self.forces, self.supplied, self.lost = 0, np.zeros(2), 0.0, 0.0

    def pluck(self, n):
        return self.p.pluck_force[n] if n < len(self.p.pluck_force) else 0.0

    def contact(self, d, b):
        """Root of r + b = theta F (48), F = k mean of [penetration] from d to d - r: the four cases
        of fig 4; returns F."""
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

    def step(self):
        F_e = 0.5 * (self.pluck(self.n) + self.pluck(self.n + 1))
        u = 2 / self.J * (self.q - self.a * self.y) + self.e_e * F_e  # (42)
        stretched = self.p.thread_height - self.g_c @ self.y
        v_c = (self.p.thread_stiffness * stretched - self.phi_c * (self.g_c @ u)) * self.inverse
        F_b = self.contact(self.h_b - self.g_b @ self.y, -(self.g_b @ u) - self.theta_bc * v_c)
        F_c = v_c - self.beta * F_b  # (46)
        s = u + self.e_b * F_b + self.e_c * F_c  # (41)
        self.y, self.q = self.y + s, s - self.q  # (40)
        self.n, self.forces = self.n + 1, self.forces + (F_b, F_c)
        self.supplied += F_e * (self.g_e @ s)  # (51), (52)
        self.lost += (self.b @ (s * s) / self.xi
                      + self.p.thread_damping / self.dt * (self.g_c @ s) ** 2)

    def stored(self):  # (49) [J]
        modes = (self.q @ self.q + self.a @ (self.y * self.y)) / self.xi
        d_b, d_c = max(0.0, self.h_b - self.g_b @ self.y), self.p.thread_height - self.g_c @ self.y
        thread = 0.5 * self.p.thread_stiffness * d_c**2 * self.p.threads
        return modes + 0.5 * self.k_b * d_b**2 + thread

    def advance(self, rows):
        trace, energy = np.empty((rows, self.p.taps)), np.empty((rows, 3))
        for row, joules in zip(trace, energy):
            joules[:] = self.stored(), self.supplied, self.lost
            self.supplied, self.lost = 0.0, 0.0
            (F_b, F_c), self.forces = self.forces / self.p.steps_per_row, np.zeros(2)
            shape, speed = self.heard @ self.y, self.heard @ (2 / self.dt * self.q)
            forces = {"bridge_force": F_b, "thread_force": F_c, "driving_force": -F_b - F_c}
            row[:] = [forces.get(of, (speed if of == "velocity" else shape)[k])
                      for k, of in enumerate(self.p.tap_quantities)]
            for _ in range(self.p.steps_per_row):
                self.step()
        return trace, energy


if __name__ == "__main__":
    if sys.argv[1] == "represents":  # as `jvari check` asks
        print("represents:", ", ".join(REPRESENTS))
        print("balance: exact")
        sys.exit()
    with open(sys.argv[1]) as file:
        p = SimpleNamespace(**{key: np.array(value) if isinstance(value, list) else value
                               for key, value in json.load(file).items()})
    try:
        trace = np.column_stack((np.arange(p.rows) / p.tap_rate, *TwoPoint(p).advance(p.rows)))
    except NotImplementedError as refusal:
        print(refusal)
        sys.exit(3)  # refused: no error, and nothing to be judged
    names = ["time_s", *p.tap_names, "energy_stored_J", "energy_supplied_J", "energy_dissipated_J"]
    np.savetxt(sys.argv[2], trace, "%.17g", ",", header=",".join(names), comments="")
