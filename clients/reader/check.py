"""Compares the reader with the test vectors: check.py [TABLES [REFERENCE]].

Exit status 1 if a value differs from that of the run-time crate by more than `allowed`, or if a
file cannot be read.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

from microfacet_reader import Albedo, StudentT, Tables

ROOT = Path(__file__).resolve().parent.parent.parent
SET = ROOT / "crates/sampler/data/default.safetensors"

# The run-time crate works in single precision, which rounds by up to 6e-8 of a number, and the
# reader in double. A lookup adds up ten to thirty such roundings. Numbers of any size are compared
# in relation to it. D is the exponential of a logarithm of up to 90, which multiplies its rounding.
RELATIVE = {"g1": 2e-6, "g2": 2e-6, "d": 6e-6, "density": 6e-6}
NORMAL = dict.fromkeys(["nx", "ny", "nz"], 2e-6)
ALBEDO = ["e", "scale", "bias", "f82", "e_avg", "bias_avg", "f82_avg"]
ABSOLUTE = NORMAL | dict.fromkeys(ALBEDO, 2e-6)
# Below it single precision has not all its digits.
SMALLEST = 1.2e-38


def allowed(name, gamma):
    """The largest difference that rounding explains."""
    if name in NORMAL and gamma < 1.8:
        # The heavy part is a power 1/(2 gamma - 3) of a number with three roundings.
        return NORMAL[name] + 2e-7 / (2 * gamma - 3)
    return (RELATIVE | ABSOLUTE)[name]


def difference(name, value, want):
    """How far a value is from the one wanted; infinite for what is no number."""
    # A normal on the horizon is above it, by the smallest cosine.
    if math.isnan(value) or name == "nz" and want > 0 and not value > 0:
        return math.inf
    return abs(value - want) / (max(abs(want), SMALLEST) if name in RELATIVE else 1)


def results(row, tables):
    """What the reader makes of a row's inputs, by column."""
    single = lambda name: float(np.float32(row[name]))
    vector = lambda name: np.array([single(name + axis) for axis in "xyz"])
    sigma, gamma = [single("sigma_x"), single("sigma_y")], float(row["gamma"])
    v, m, l = vector("v"), vector("m"), vector("l")
    material = StudentT(tables, sigma, gamma)
    got = {"g1": material.g1(v), "g2": material.g2(v, l, row["masking"]), "d": material.d(m)}
    got["density"] = material.density(v, m)
    got |= zip(NORMAL, material.visible_normal(v, single("u1"), single("u2")))
    if row["e_table"]:
        albedo = Albedo(tables, sigma[0], gamma, row["masking"])
        e_avg, _, bias_avg, f82_avg = albedo.average()
        got |= zip(ALBEDO, [*albedo.moments(v[2]), e_avg, bias_avg, f82_avg])
    return {name: float(value) for name, value in got.items()}


def main(tables=SET, reference=ROOT / "docs/reference.csv"):
    tables = Tables(tables)
    with open(reference, newline="") as file:
        rows = list(csv.DictReader(file))
    got = [results(row, tables) for row in rows]
    failed = False
    for kind in ["table", "exact"]:
        print(f"largest differences from the columns _{kind} of {len(rows)} rows, and where")
        for name in RELATIVE | ABSOLUTE:
            found = []
            for line, (row, values) in enumerate(zip(rows, got), 2):
                if row[f"{name}_{kind}"]:
                    far = difference(name, values[name], float(row[f"{name}_{kind}"]))
                    limit = allowed(name, float(row["gamma"])) if kind == "table" else math.inf
                    share = far / limit if kind == "table" else far
                    found.append((share, far, limit, f"line {line}, {row['case']}"))
            # A column without values has not been compared.
            share, far, limit, where = max(found, default=(math.inf, math.inf, 0, "no values"))
            unit = "relative" if name in RELATIVE else "absolute"
            good = kind == "exact" or share <= 1
            verdict = "" if kind == "exact" else f" of {limit:.1e}, {'good' if good else 'TOO FAR'}"
            print(f"  {name:8} {len(found):4} values: {far:.1e} {unit}{verdict}; {where}")
            failed |= not good
    print("The reader differs." if failed else "The reader reads what the run-time crate reads.")
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except (OSError, ValueError) as why:
        sys.exit(f"error: {why}")
