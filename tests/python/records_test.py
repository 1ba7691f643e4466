"""The scripts beside the records write the verdicts that are committed.

records_test.py SOURCE: those on three papers, and the comparison of ensembles with 4 runs in place
of 32."""

import csv
import importlib.util
import os
import subprocess
import sys
import tempfile

if importlib.util.find_spec("matplotlib") is None:
    print("skipped: matplotlib is not installed (Debian: python3-matplotlib)")
    sys.exit(77)

results = os.path.join(sys.argv[1], "results")


def rows_of(*path):
    with open(os.path.join(*path), newline="") as file:
        return list(csv.DictReader(file))


def written_by(script, folder, *more):
    subprocess.run([sys.executable, "-B", "-W", "ignore", os.path.join(results, script), "--out",
                    folder, *more], check=True)


with tempfile.TemporaryDirectory() as folder:
    for paper in ("van-walstijn", "issanchou", "deshmukh"):
        own = os.path.join(folder, paper)
        written_by(f"paper_{paper.replace('-', '_')}.py", own)
        found, kept = ({row["claim"]: row["verdict"] for row in rows_of(where, "claims.csv")}
                       for where in (own, os.path.join(results, f"paper-{paper}")))
        assert found == kept, f"{paper}: {set(found.items()) ^ set(kept.items())}"
        drawn, committed = ({name for name in os.listdir(where) if name.startswith("figure-")}
                            for where in (own, os.path.join(results, f"paper-{paper}")))
        assert drawn == committed, f"{paper}: {drawn ^ committed}"

    written_by("ensemble.py", folder, "--runs", "4")
    differ = {}
    for row in rows_of(folder, "ensemble.csv"):
        differ.setdefault((row["against"][:3], row["scheme"], row["options"], row["rate"]),
                          []).append(int(row["differs"]))
    again = differ.pop(("132", "exact_contact", "", ""))
    assert sum(again) <= 0.1 * len(again), (
        f"the reference differs from itself in {sum(again)} of {len(again)} traits")
    for (_, scheme, options, rate), traits in differ.items():
        if options == "variant=raw":
            assert sum(traits) > 0.5 * len(traits), (
                f"{scheme} {options} at {rate} Hz differs from the reference in {sum(traits)} "
                "traits alone")
