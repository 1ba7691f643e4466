"""How the motion depends on the height of a stop: its exact slope, and that of each scheme.

usage: python3 sensitivity.py [JVARI]; needs NumPy. Prints the table of sensitivity.md and writes
motion.csv and sensitivity.svg here. A slope is a central difference over stops 20 nm apart."""
import subprocess, sys
import numpy as np

jvari, height, apart = sys.argv[1] if len(sys.argv) > 1 else "jvari", -1e-4, 1e-8  # m
colours = {"exact_contact": "#000", "modal_two_moment": "#2a6", "modal_two_point": "#c40",
           "modal_three_point": "#06c", "finite_difference_theta": "#a5a",
           "modal_quadratised": "#888"}

def motion(scheme, stiffness, height=height):
    command = [jvari, "run", "guitar_over_fret", "--scheme", scheme, "--modes", "60", "--duration",
               "10ms", "--set", f"string.0.barrier.0.height={height!r}", "--set",
               f"string.0.barrier.0.stiffness={stiffness}", "--quiet", "--out", "motion.csv"]
    exactly = ["--option", "tolerance=1e-13"] if scheme == "exact_contact" else []
    subprocess.run(command + exactly, check=True)
    return np.genfromtxt("motion.csv", delimiter=",", names=True)["y02"]

def slope(scheme, stiffness, step=apart):
    up, down = (motion(scheme, stiffness, height + way * step) for way in (1, -1))
    return (up - down) / (2 * step)

def off(x, exact):
    return f"{100 * np.linalg.norm(x - exact) / np.linalg.norm(exact):.2g} %"

slopes = {}
for stiffness in ("1e4", "1e5", "1e6", "1e8"):
    slopes[stiffness] = {scheme: slope(scheme, stiffness) for scheme in colours}
    exact_motion, exact = motion("exact_contact", stiffness), slopes[stiffness]["exact_contact"]
    large = abs(exact) > 0.1 * abs(exact).max()
    print(f"{stiffness} N/m; exact, of a step ten times smaller:",
          off(slope("exact_contact", stiffness, apart / 10), exact))
    for scheme in list(colours)[1:]:
        s, error = slopes[stiffness][scheme], off(motion(scheme, stiffness), exact_motion)
        print(f"  {scheme}: motion {error}, slope {off(s, exact)}, of the wrong sign "
              f"{100 * np.mean((s * exact < 0)[large]):.0f} %")

svg = "".join(f'<text x="30" y="{155 - 30 * y}">{y}</text>' for y in (-2, 0, 2))
for i, (scheme, s) in enumerate(slopes["1e6"].items()):
    points = " ".join(f"{60 + 1.2 * n:.1f},{150 - 30 * y:.1f}" for n, y in enumerate(s))
    line, text = f'stroke="{colours[scheme]}" stroke-width="{1 + (i == 0)}"', f'y="{30 + 20 * i}"'
    svg += (f'\n<polyline points="{points}" fill="none" {line}/>\n'
            f'<text x="610" {text} fill="{colours[scheme]}">{scheme}</text>')
open("sensitivity.svg", "w").write(f'''<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 300"
font-family="sans-serif" font-size="13"><rect width="800" height="300" fill="#fff"/>
<path stroke="#aaa" d="M60 20V270M60 150H590"/>{svg}<text x="60" y="290">0 to 10 ms; change of the
displacement at 0.2 m per change of the height of the stop</text></svg>
''')
