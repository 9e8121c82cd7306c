"""Rows of docs/reference.csv: the run-time crate against its own numbers, the model against the
exact ones."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import microfacet
from microfacet import exact

REFERENCE = Path(__file__).resolve().parents[3] / "docs/reference.csv"

# The averages of the reference are read from a table of them, those of a lobe are integrals of its
# albedo; the two differ by the certificate of that table.
AVERAGE = 9.4e-5
# Batches differ from single calls by at most 2 ulp.
SINGLE = 5e-7
# The exact columns have 17 digits of the same functions.
DOUBLE = 1e-13
# Of albedos by quadrature at different tolerances.
QUADRATURE = 1e-8


def rows():
    with open(REFERENCE, newline="") as file:
        return list(csv.DictReader(file))


def inputs(row):
    single = lambda name: float(np.float32(row[name]))
    vector = lambda name: np.array([single(name + axis) for axis in "xyz"])
    sigma, gamma = (single("sigma_x"), single("sigma_y")), float(row["gamma"])
    return sigma, gamma, vector("v"), vector("l"), vector("m"), [single("u1"), single("u2")]


def close(name, value, want, allowed):
    """Relative, but of normals and albedos, which are in [-1, 1], absolute."""
    relative = name in ["g1", "g2", "d", "density"]
    return abs(value - want) <= allowed * (max(abs(want), 1e-37) if relative else 1)


def compare(row, lobe, kind, v, l, m, u):
    """Differences of what a lobe says from the columns of a kind, by column."""
    nx, ny, nz = lobe.sample_visible_normal(v, u)
    got = {
        "g1": lobe.g1(v),
        "g2": lobe.g2(v, l, row["masking"]),
        "d": lobe.d(m),
        "density": lobe.visible_normal_pdf(v, m),
        "nx": nx,
        "ny": ny,
        "nz": nz,
    }
    if kind == "table" and row["e_table"]:
        scale, bias, f82 = lobe.albedo_parts(v, row["masking"])
        _, bias_avg, f82_avg = lobe.albedo_average_parts(row["masking"])
        got |= {"e": lobe.albedo(v, row["masking"]), "scale": scale, "bias": bias, "f82": f82}
        got |= {"e_avg": lobe.albedo_average(row["masking"])}
        got |= {"bias_avg": bias_avg, "f82_avg": f82_avg}
    return {
        name: (float(value), float(row[f"{name}_{kind}"]))
        for name, value in got.items()
        if row[f"{name}_{kind}"]
    }


def test_the_crate_gives_its_own_numbers():
    cells = 0
    for line, row in enumerate(rows(), 2):
        sigma, gamma, v, l, m, u = inputs(row)
        lobe = microfacet.StudentT(sigma, gamma)
        for name, (value, want) in compare(row, lobe, "table", v, l, m, u).items():
            allowed = AVERAGE if name.endswith("avg") else SINGLE
            assert close(name, value, want, allowed), f"line {line}, {name}: {value} for {want}"
            cells += 1
    assert cells > 2500


def test_the_model_gives_the_exact_numbers():
    cells = 0
    for line, row in enumerate(rows(), 2):
        sigma, gamma, v, l, m, u = inputs(row)
        lobe = exact.StudentT(sigma, gamma)
        for name, (value, want) in compare(row, lobe, "exact", v, l, m, u).items():
            # The column takes such views as grazing ones, as the crate does; the model has 0.
            if name == "density" and v[2] <= 0.0:
                assert value == 0.0
                continue
            assert close(name, value, want, DOUBLE), f"line {line}, {name}: {value} for {want}"
            cells += 1
    assert cells > 700


def test_albedos_by_quadrature():
    chosen = [row for row in rows() if row["e_exact"]][::8]
    assert len(chosen) > 10
    for row in chosen:
        sigma, gamma, v, *_ = inputs(row)
        lobe = exact.StudentT(sigma, gamma)
        e = float(lobe.albedo(cos_theta=v[2], masking=row["masking"]))
        assert abs(e - float(row["e_exact"])) <= QUADRATURE, row
        parts = lobe.albedo_parts(cos_theta=v[2], masking=row["masking"])
        for name, part in zip(["scale", "bias", "f82"], parts):
            assert abs(part - float(row[f"{name}_exact"])) <= QUADRATURE, row


def test_averages_by_quadrature():
    row = next(row for row in rows() if row["e_avg_exact"] and float(row["gamma"]) == 2.5)
    sigma, gamma, *_ = inputs(row)
    average = exact.StudentT(sigma, gamma).albedo_average(row["masking"])
    assert abs(average - float(row["e_avg_exact"])) <= QUADRATURE


@pytest.mark.parametrize("gamma", [1.6, 2.0, 2.5, math.inf])
def test_tables_are_as_near_to_the_model_as_their_certificate(gamma):
    rng = np.random.default_rng(7)
    z = rng.random(2000)
    phi = rng.random(2000) * 2 * math.pi
    r = np.sqrt(1 - z * z)
    v = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    lobe, model = microfacet.StudentT((0.3, 0.1), gamma), exact.StudentT((0.3, 0.1), gamma)
    assert np.abs(lobe.g1(v) - model.g1(v)).max() < 5e-6
    albedo, want = microfacet.StudentT(0.5, gamma), exact.StudentT(0.5, gamma)
    cos = np.linspace(0.02, 1.0, 40)
    assert np.abs(albedo.albedo(cos_theta=cos) - want.albedo(cos_theta=cos)).max() < 2e-4
