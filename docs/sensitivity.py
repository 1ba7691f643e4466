"""How the motion depends on the height of a stop: its exact slope, and that of each scheme.

usage: python3 sensitivity.py [JVARI]; needs NumPy. Prints the table and draws the figure of
sensitivity.md. A slope is a central difference of two runs whose stops are 20 nm apart."""
import subprocess, sys, tempfile
import numpy as np

jvari = sys.argv[1] if len(sys.argv) > 1 else "jvari"
height, apart = -1e-4, 1e-8  # m
schemes = ["modal_two_moment", "modal_two_point", "modal_three_point", "finite_difference_theta",
           "modal_quadratised"]


def run(scheme, stiffness, h, *more):
    with tempfile.NamedTemporaryFile(suffix=".csv") as trace:
        subprocess.run([jvari, "run", "guitar_over_fret", "--scheme", scheme, "--modes", "60",
                        "--duration", "10ms", "--set", f"string.0.barrier.0.height={h!r}", "--set",
                        f"string.0.barrier.0.stiffness={stiffness}", "--quiet", *more, "--out",
                        trace.name], check=True)
        return np.genfromtxt(trace.name, delimiter=",", names=True)["y02"]


def slope(scheme, stiffness, *more, step=apart):
    up, down = (run(scheme, stiffness, height + way * step, *more) for way in (1, -1))
    return (up - down) / (2 * step)


def off(x, truth):
    return f"{100 * np.linalg.norm(x - truth) / np.linalg.norm(truth):.2g} %"


exact, lines = ["--option", "tolerance=1e-13"], {}
for stiffness in ("1e4", "1e5", "1e6", "1e8"):
    truth, motion = (f("exact_contact", stiffness, *x) for f, x in
                     ((slope, exact), (lambda s, k, *m: run(s, k, height, *m), exact)))
    print(f"{stiffness} N/m; exact, of a step ten times smaller:",
          off(slope("exact_contact", stiffness, *exact, step=apart / 10), truth))
    lines.setdefault(stiffness, []).append(("exact", truth))
    for scheme in schemes:
        s, large = slope(scheme, stiffness), np.abs(truth) > 0.1 * np.abs(truth).max()
        print(f"  {scheme}: motion {off(run(scheme, stiffness, height), motion)}, slope "
              f"{off(s, truth)}, of the wrong sign {100 * np.mean((s * truth < 0)[large]):.0f} %")
        lines[stiffness].append((scheme, s))

svg, colours = "", ["#000", "#2a6", "#c40", "#06c", "#a5a", "#888"]
for i, (name, s) in enumerate(lines["1e6"]):
    points = " ".join(f"{60 + 1.2 * n:.1f},{150 - 30 * y:.1f}" for n, y in enumerate(s))
    svg += (f'<polyline points="{points}" fill="none" stroke="{colours[i]}" '
            f'stroke-width="{1 + (i == 0)}"/>\n<text x="610" y="{30 + 20 * i}" '
            f'fill="{colours[i]}">{name}</text>\n')
axes = "".join(f'<text x="30" y="{155 - 30 * y}">{y}</text>' for y in (-2, 0, 2))
open("sensitivity.svg", "w").write(
    f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 300" font-family="sans-serif" '
    f'font-size="13"><rect width="800" height="300" fill="#fff"/>{axes}<path stroke="#aaa" '
    f'd="M60 20V270M60 150H590"/>\n{svg}<text x="60" y="290">0 to 10 ms; change of the '
    f'displacement at 0.2 m per change of the height of the stop</text></svg>\n')
