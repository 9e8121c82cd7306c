"""Values and derivatives of the module that `export slang` writes, by slangpy on the processor:
values against the reference, derivatives against differences and against the model, and modules
that lost a structure's derivatives, which must be found.

    check.py EXPORT EXPORT-OF-FAMILY REFERENCE.CSV MICROFACET-BAKE
"""

import csv
import io
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import slangpy

import derivatives
from device import GAMMA, HEIGHT_CORRELATED, L, SIGMA, U, UNCORRELATED, V, Module

MASKING = {"uncorrelated": UNCORRELATED, "height-correlated": HEIGHT_CORRELATED}
# By function: the column of the reference, and the error that shaders are allowed
# (`docs/shaders.md`); of densities relative.
VALUES = {
    "student_t_d": ("d_table", 2e-3),
    "student_t_masking": ("g1_table", 1e-5),
    "student_t_masking_shadowing": ("g2_table", 1e-5),
    "student_t_visible_normal_pdf": ("density_table", 2e-3),
    "student_t_albedo": ("e_table", 1e-5),
    "student_t_albedo_parts, scale": ("scale_table", 1e-5),
    "student_t_albedo_parts, bias": ("bias_table", 1e-5),
    "student_t_albedo_parts, F82": ("f82_table", 1e-5),
    "student_t_albedo_average": ("e_avg_table", 3e-5),
    "student_t_albedo_average_parts, bias": ("bias_avg_table", 3e-5),
    "student_t_albedo_average_parts, F82": ("f82_avg_table", 3e-5),
    "student_t_sample_visible_normal, x": ("nx_table", 2e-4),
    "student_t_sample_visible_normal, y": ("ny_table", 2e-4),
    "student_t_sample_visible_normal, z": ("nz_table", 2e-4),
}


def values(module, path):
    """Compares values with those of the Rust crate."""
    rows = list(csv.DictReader(io.StringIO(pathlib.Path(path).read_text())))
    names = "gamma sigma_x sigma_y vx vy vz mx my mz u1 u2".split()
    points = np.array([[float(row[name]) for name in names] for row in rows])
    lights = points.copy()
    lights[:, L] = [[float(row[name]) for name in ("lx", "ly", "lz")] for row in rows]
    masking = [MASKING[row["masking"]] for row in rows]
    for function, (column, allowed) in VALUES.items():
        at = lights if function == "student_t_masking_shadowing" else points
        expected = np.array([float(row[column] or "nan") for row in rows])
        value, _ = module(function, masking, points[:, GAMMA], at)
        error = np.abs(value - expected)
        if function in ("student_t_d", "student_t_visible_normal_pdf"):
            error /= np.maximum(np.abs(expected), 1e-30)
        if "normal," in function:
            # Exports draw those of GGX from a spherical cap.
            error = error[points[:, GAMMA] != 2]
        worst = np.nanmax(error)
        print(f"{function:37} differs from the crate by {worst:.1e}, of {allowed:.0e}")
        assert worst <= allowed, function


def query(command, kind, columns, rows):
    """The answers of `microfacet-bake query`."""
    text = "\n".join(",".join(map(str, row)) for row in [columns, *rows])
    arguments = [command, "--quiet", "query", kind, "--input", "-"]
    output = subprocess.run(arguments, input=text, capture_output=True, text=True, check=True)
    return csv.DictReader(io.StringIO(output.stdout))


def model(module, command):
    """Compares derivatives by ln sigma of round lobes with differences of the model in double
    precision: what the tables add."""
    count, step = 400, 0.01
    shapes, points = derivatives.shapes_and_points(list(module.offsets), count, 2)
    points[:, SIGMA.start] = points[:, SIGMA.stop - 1]

    def exact(kind, at):
        of = list(zip(at[:, SIGMA.start], shapes, np.arccos(at[:, V.stop - 1]), strict=True))
        if kind == "g1":
            columns = ["sigma_x", "sigma_y", "gamma", "theta", "phi"]
            rows, name = [(s, s, g, theta, 0) for s, g, theta in of], "g1_exact"
        elif kind == "albedo":
            columns = ["sigma", "gamma", "cos_theta", "masking"]
            rows = [(s, g, np.cos(theta), "height-correlated") for s, g, theta in of]
            name = "E_exact"
        else:
            columns = ["sigma", "gamma", "masking"]
            rows, name = [(s, g, "height-correlated") for s, g, _ in of], "E_avg_exact"
        return np.array([float(row[name]) for row in query(command, kind, columns, rows)])

    cases = (
        ("student_t_masking", "g1", 1e-4),
        ("student_t_albedo", "albedo", 5e-3),
        ("student_t_albedo_average", "albedo-average", 5e-3),
    )
    for function, kind, allowed in cases:
        _, gradient = module(function, HEIGHT_CORRELATED, shapes, points)
        ours = derivatives.along_numbers(points, "sigma", gradient)
        of = [exact(kind, derivatives.moved(points, "sigma", k * step)) for k in (-2, -1, 1, 2)]
        theirs = (of[0] - 8 * of[1] + 8 * of[2] - of[3]) / (12 * step)
        error = np.abs(ours - theirs)
        print(
            f"{function:37} by ln sigma: {error.max():.1e} from the model, {np.median(error):.0e} "
            f"at half of the points, of up to {np.abs(theirs).max():.2f}"
        )
        assert error.max() <= allowed, function


def mutants(export):
    """Takes its derivatives from one structure at a time, and from the functions that return it:
    a compiler has nothing to say of that."""
    text = pathlib.Path(export, "student_t.slang").read_text()
    names = re.findall(r"^struct (StudentTImpl\w+) : IDifferentiable", text, re.MULTILINE)
    assert names
    for name in names:
        lost = text.replace(f"struct {name} : IDifferentiable", f"struct {name}")
        lost = re.sub(rf"^\[Differentiable\]\n(?={name} )", "", lost, flags=re.MULTILINE)
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "student_t.slang").write_text(lost)
            try:
                wrong = derivatives.check(Module(export, folder), 200, tells=False)
            except slangpy.SlangCompileError as why:
                wrong = re.findall(r"error\[.*", str(why))[:1]
        assert wrong, f"derivatives lost in {name} are not found"
        print(f"without those of {name}: {wrong[0]}")


def main(export, family, reference, command):
    module = Module(export)
    values(module, reference)
    for one in (module, Module(family, is_family=True)):
        print("family, derivatives by gamma too" if one.is_family else "single shapes")
        wrong = derivatives.check(one)
        assert not wrong, wrong
    model(module, command)
    mutants(export)


if __name__ == "__main__":
    main(*sys.argv[1:])
