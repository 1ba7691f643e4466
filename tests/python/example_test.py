"""The example draws its picture, and its cells are those of the committed study.

example_test.py SOURCE: one of its schemes has three cells in results/work-precision. They come out
to the last digit where sources, compiler and vector instructions are those of the study, else to
what rounding leaves: a reference may add in another order since."""

import csv
import importlib.util
import json
import os
import runpy
import sys
import tempfile
import warnings
import xml.etree.ElementTree

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: matplotlib is not installed (Debian: python3-matplotlib)")
    sys.exit(77)
import jvari

source = sys.argv[1]
warnings.simplefilter("ignore")  # what is said of certificates
with tempfile.TemporaryDirectory() as folder:
    sys.argv = ["work_precision.py", os.path.join(folder, "picture.svg")]
    rows = runpy.run_path(os.path.join(source, "python", "examples", "work_precision.py"))["rows"]
    drawing = xml.etree.ElementTree.parse(sys.argv[1]).getroot()
lines = [e for e in drawing.iter() if e.get("id", "").startswith("line2d_")
         and len(list(e.iter("{http://www.w3.org/2000/svg}use"))) == 3]
assert len(lines) >= 3, f"{len(lines)} lines of three points are drawn"


def table(name):
    with open(os.path.join(source, "results", "work-precision", name)) as file:
        return list(csv.DictReader(file))


cells = {row["cell"]: (row["scheme"], float(row["rate"]), int(row["modes"]))
         for row in table("facts.csv")
         if row["options"] in ("", "compliance=own") and row["rate"]}
study = {(cells[row["cell"]], row["tap"], row["measure"]): row for row in table("errors.csv")
         if row["cell"] in cells}
with open(os.path.join(source, "results", "work-precision", "manifest.json")) as file:
    made_by = json.load(file)
here = jvari.made_by()
alike = all(here[key] == made_by[key] for key in ("compiler", "flags", "vectors"))
allowed = 0 if alike and here["sources"] == made_by["sources"] else 1e-10 if alike else 1e-6
noise = 1e-12 if allowed else 0  # the floor is rounding itself

checked = 0
for row in rows:
    key = (row["scheme"], row["rate"], row["modes"])
    if (row["scheme"] != "modal_two_point" or row["options"] not in ("", "compliance=own")
            or key not in cells.values()):
        continue
    for measure, part in (("error_l2_10ms", "value"), ("error_l2_50ms", "value"),
                          ("error_l2_10ms", "in_model"), ("error_l2_50ms", "in_model"),
                          ("error_l2_50ms", "floor")):
        found = row["errors"]["nut"][measure][part]
        expected = float(study[key, "nut", measure][part])
        assert abs(found - expected) <= allowed * expected + noise, (
            f"{row['rate']} Hz: {part} of {measure} is {found}, not {expected}")
    checked += 1
assert checked == 3, f"{checked} cells"
print(f"three cells to {allowed:g}" if allowed else "three cells to the last digit")
