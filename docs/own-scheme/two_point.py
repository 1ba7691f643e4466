"""The modal two-point scheme of van Walstijn, Bridges & Mehes 2016 (eqs 33, 38-48): python3 two_point.py problem.json trace.csv

One contact of exponent 1 at most, and a thread. `jvari export` writes the problem, `jvari judge` says how wrong the trace is.
"""

import json
import sys

import numpy as np

with open(sys.argv[1]) as file:
    p = {key: np.array(value) if isinstance(value, list) else value for key, value in json.load(file).items()}
assert p["contacts"] <= 1 and np.all(p["contact_exponent"] == 1), "this scheme takes one contact of exponent 1 at most"
dt, modes, steps = 1 / p["sample_rate"], p["modes"], p["steps_per_row"]
omega = np.sqrt((p["omega0"] ** 2 - p["sigma"] ** 2).astype(complex))
R, E = np.exp(-p["sigma"] * dt), np.expm1(-p["sigma"] * dt)
num, den = (E**2 + 4 * R * f(0.5 * omega * dt) ** 2 for f in (np.sin, np.cos))
a, b = num.real / den.real, -2 * np.expm1(-2 * p["sigma"] * dt) / den.real  # (33)
J, xi = 1 + a + b, dt**2 / (2 * p["modal_mass"])

g_b = p["contact_weights"][0] if p["contacts"] else np.zeros(modes)
g_c = p["thread_weights"] if p["threads"] else np.zeros(modes)
g_e = p["pluck_weights"] if p["plucks"] else np.zeros(modes)
e_b, e_c, e_e = xi / J * g_b, xi / J * g_c, xi / J * g_e
k_b, h_b = (p["contact_stiffness"][0], p["contact_height"][0]) if p["contacts"] else (0, 0)
phi_c = p["thread_stiffness"] / 2 + p["thread_damping"] / dt
inverse_c, theta_bc = 1 / (1 + phi_c * (g_c @ e_c)), g_b @ e_c
beta_c = phi_c * theta_bc * inverse_c  # (47)
theta = g_b @ e_b - beta_c * theta_bc
pluck = np.zeros((p["rows"] - 1) * steps + 2)
pluck[: len(p["pluck_force"])] = p["pluck_force"][: len(pluck)]


def contact(d, b):
    """Root of r + b = theta F (48), F = k mean of [penetration] from d to d - r: the four cases of fig 4; returns F."""
    phi = 0.5 * theta * k_b
    if k_b == 0 or (d <= 0 and d + b <= 0):
        return 0.0
    if d > 0 and d * (1 - phi) + b > 0:
        r = (2 * phi * d - b) / (1 + phi)
    elif d > 0:
        r = (-b + np.sqrt(b * b + 4 * phi * d * d)) / 2
    else:
        r = -(b - 2 * phi * d + np.sqrt(b * b - 4 * phi * d * (b + d))) / (2 * (1 + phi))
    return (r + b) / theta


y, q, n, trace = p["start"].copy(), np.zeros(modes), 0, []
force = {"bridge_force": 0.0, "thread_force": 0.0, "driving_force": 0.0}
for row in range(p["rows"]):
    read = {"displacement": p["tap_weights"] @ y, "velocity": p["tap_weights"] @ (2 / dt * q), "nut_force": p["tap_weights"] @ y}
    trace.append([row / p["tap_rate"]] + [force[t] if t in force else read[t][k] for k, t in enumerate(p["tap_quantities"])])
    sum_b = sum_c = 0.0
    for n in range(n, n + steps) if row + 1 < p["rows"] else []:
        u = 2 / J * (q - a * y) + e_e * (0.5 * (pluck[n] + pluck[n + 1]))  # (42)
        v_c = (p["thread_stiffness"] * (p["thread_height"] - g_c @ y) - phi_c * (g_c @ u)) * inverse_c
        F_b = contact(h_b - g_b @ y, -(g_b @ u) - theta_bc * v_c)
        F_c = v_c - beta_c * F_b  # (46)
        s = u + e_b * F_b + e_c * F_c  # (41)
        y, q = y + s, s - q  # (40)
        sum_b, sum_c = sum_b + F_b, sum_c + F_c
    n = (row + 1) * steps
    force = {"bridge_force": sum_b / steps, "thread_force": sum_c / steps, "driving_force": -(sum_b + sum_c) / steps}
np.savetxt(sys.argv[2], trace, "%.17g", ",", header="time_s," + ",".join(p["tap_names"]), comments="")
