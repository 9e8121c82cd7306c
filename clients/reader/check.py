"""Compares the reader with the test vectors: check.py [TABLES [REFERENCE]].

Exit status 1 if a value differs from that of the run-time crate by more than TOLERANCES allow.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

from microfacet_reader import Albedo, StudentT, Tables

ROOT = Path(__file__).resolve().parent.parent.parent
SETS = [ROOT / "tables/default.safetensors", ROOT / "sampler/data/default.safetensors"]

# The run-time crate works in single precision, which rounds by up to 6e-8 of a number,
# and the reader in double. A lookup adds up ten to thirty such roundings; numbers that may be small
# are compared in relation to their size. D is the exponential of a logarithm of up to 90, which
# multiplies its rounding, and the density of visible normals has D for a factor.
RELATIVE = {"g1": 2e-6, "g2": 2e-6, "d": 6e-6, "density": 6e-6}
ABSOLUTE = dict.fromkeys(["nx", "ny", "nz", "e", "scale", "bias", "f82", "e_avg"], 2e-6)
TOLERANCES = RELATIVE | ABSOLUTE
# Below this single precision has not all its digits.
SMALLEST = 1.2e-38


def results(row, tables):
    """What the reader makes of a row's inputs, by column."""
    single = lambda name: float(np.float32(row[name]))
    vector = lambda name: np.array([single(name + axis) for axis in "xyz"])
    sigma, gamma = [single("sigma_x"), single("sigma_y")], float(row["gamma"])
    v, m, l = vector("v"), vector("m"), vector("l")
    material = StudentT(tables, sigma, gamma)
    got = {"g1": material.g1(v), "g2": material.g2(v, l, row["masking"]), "d": material.d(m)}
    got["density"] = material.density(v, m)
    got |= zip(["nx", "ny", "nz"], material.visible_normal(v, single("u1"), single("u2")))
    if row["e_table"]:
        albedo = Albedo(tables, sigma[0], gamma, row["masking"])
        got |= zip(["e", "scale", "bias", "f82"], albedo.moments(v[2]))
        got["e_avg"] = albedo.average()[0]
    return got


def main(tables=None, reference=ROOT / "docs/reference.csv"):
    tables = Tables(tables or next((path for path in SETS if path.exists()), SETS[0]))
    with open(reference, newline="") as file:
        rows = list(csv.DictReader(file))
    # The largest difference and its row, by column and by what it is from.
    worst = {(name, of): (-1.0, "", 0) for of in ["table", "exact"] for name in TOLERANCES}
    counts = dict.fromkeys(worst, 0)
    for line, row in enumerate(rows, 2):
        for name, value in results(row, tables).items():
            for of in ["table", "exact"]:
                if not row[f"{name}_{of}"]:
                    continue
                want = float(row[f"{name}_{of}"])
                difference = abs(value - want)
                if name in RELATIVE:
                    difference /= max(abs(want), SMALLEST)
                if math.isnan(difference):
                    difference = math.inf
                counts[name, of] += 1
                worst[name, of] = max(worst[name, of], (float(difference), row["case"], line))
    failed = []
    print(f"{len(rows)} rows; largest differences, and where")
    for (name, of), (difference, case, line) in worst.items():
        kind = "relative" if name in RELATIVE else "absolute"
        text = f"{name + '_' + of:14} {counts[name, of]:4} values  {difference:.1e} {kind}"
        verdict = ""
        # A column without values has not been compared.
        if of == "table":
            good = 0 <= difference <= TOLERANCES[name]
            verdict = f"of {TOLERANCES[name]:.0e} allowed{'' if good else ': TOO LARGE'}"
            failed += [] if good else [name]
        print(f"{text:47} {verdict:16}  line {line}, {case}")
    print("differs: " + ", ".join(failed) if failed else "the reader reads what the crate reads")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
