"""Opens exported textures with other programs' readers, and reads them with a linear filter.

check.py FOLDER REFERENCE.csv; clients/lut/run makes the folder.
"""

import base64
import csv
import json
import math
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenEXR

# VkFormat and DXGI_FORMAT by channels and bits.
KTX = {(1, 32): 100, (2, 32): 103, (1, 16): 76, (2, 16): 83}
DDS = {(1, 32): 41, (2, 32): 16, (1, 16): 54, (2, 16): 34}


def arrays(folder, name):
    """The same texture from each format, as [..., channel], with its description."""
    told = json.loads((folder / f"{name}.json").read_text())
    bits = {"f16": 16, "f32": 32}[told["precision"]]
    dtype = np.dtype(f"<f{bits // 8}")
    channels = len(told["channels"])
    shape = [axis["texels"] for axis in told["axes_slowest_first"]] + [channels]
    width, height, depth = ([*reversed(shape[:-1])] + [1, 1])[:3]
    found = {"json": np.array(told["data"], dtype).reshape(shape)}
    found["npy"] = np.load(folder / f"{name}.npy").reshape(shape)

    with OpenEXR.File(str(folder / f"{name}.exr"), separate_channels=True) as image:
        planes = image.channels()
        names = ["Y"] if channels == 1 else ["R", "G", "B"]
        assert sorted(planes) == sorted(names), sorted(planes)
        colours = np.stack([planes[channel].pixels for channel in names], axis=-1)
        # A third colour is there for readers that want one.
        assert not colours[..., channels:].any()
        stack = colours[..., :channels]
        assert json.loads(image.header()["microfacet"])["axes_slowest_first"] == told["axes_slowest_first"]
    assert stack.dtype == dtype and stack.shape == (height * depth, width, channels)
    found["exr"] = stack.reshape(shape)

    # three.js has the last row first, in RGBA; what is grey is in all three colours.
    three = json.loads((folder / f"{name}.exr.json").read_text())
    assert three["size"] == [width, height * depth], three["size"]
    texels = np.frombuffer(base64.b64decode(three["texels"]), np.float32).reshape(height * depth, width, 4)
    found["exr in three.js"] = texels[::-1, :, :channels].astype(dtype).reshape(shape)

    ktx = json.loads((folder / f"{name}.ktx2.json").read_text())
    volume = len(shape) == 4
    assert ktx["format"] == KTX[channels, bits]
    assert ktx["size"] == [width, height, depth if volume else 0], ktx["size"]
    # The type's top bits say signed and floating point; lengths are one less.
    assert ktx["channels"] == [[i | 0xC0, bits * i, bits - 1] for i in range(channels)]
    assert json.loads(ktx["keys"]["microfacet"])["masking"] == told["masking"]
    found["ktx2"] = np.frombuffer(base64.b64decode(ktx["texels"]), dtype).reshape(shape)

    data = (folder / f"{name}.dds").read_bytes()
    assert data[:4] == b"DDS " and data[84:88] == b"DX10"
    assert struct.unpack_from("<2I", data, 12) == (height, width)
    assert struct.unpack_from("<2I", data, 128) == (DDS[channels, bits], 4 if volume else 3)
    assert not volume or struct.unpack_from("<I", data, 24) == (depth,)
    found["dds"] = np.frombuffer(data[148:], dtype).reshape(shape)
    for form, values in found.items():
        assert np.array_equal(values, found["npy"]), (folder, name, form)
    return told, found["npy"].astype(np.float64)


def bend(sigma, mu, eta):
    """past and rim, as the description names them."""
    return mu * mu + eta * eta - 1, sigma * mu * math.sqrt(1 - mu * mu)


def coordinate(axis, gamma, sigma, mu, eta):
    """c in [0, 1], from the description alone."""
    if "eta_min" in axis:
        first, last, here = (math.sqrt(abs(n - 1) / (n + 1)) for n in [axis["eta_min"], axis["eta_max"], eta])
        return (here - first) / (last - first)
    if "near" in axis:
        past, rim = bend(sigma, mu, eta)
        x = mu / (mu + axis["kappa"] * sigma * math.sqrt(1 - mu * mu))
        whole = abs(past) + 3.2 * rim
        return axis["near"] * x ** 0.3 + (1 - axis["near"]) / 2 * (1 + (past / whole if whole else 0))
    if "gamma_min" in axis:
        def of(gamma):
            return math.log(1 + 17 / (2 * gamma - 3))
        return of(gamma) / of(axis["gamma_min"])
    if "sigma_max" in axis:
        return math.sqrt(sigma / axis["sigma_max"])
    kappa = axis["kappa"]
    if isinstance(kappa, str):
        assert kappa == "3 + 0.5 / (2 gamma - 3)"
        kappa = 3 + 0.5 / (2 * gamma - 3)
    return (mu / (mu + kappa * sigma * math.sqrt(1 - mu * mu))) ** 0.25


def read(told, values, gamma, sigma, mu, eta=None):
    """What a linear filter reads at (1/2 + (n - 1) c) / n."""
    for axis in told["axes_slowest_first"]:
        x = coordinate(axis, gamma, sigma, mu, eta) * (axis["texels"] - 1)
        x = min(max(x, 0), axis["texels"] - 1)
        i = min(int(x), axis["texels"] - 2)
        values = values[i] + (x - i) * (values[i + 1] - values[i])
    return values


def error(told, quantity):
    return told["errors"][quantity]["largest"] + 1e-6


def smooth(sigma, mu, eta):
    """f of the description: exactly Fresnel's reflectance where sigma is 0."""
    past, rim = bend(sigma, mu, eta)
    whole = abs(past) + rim
    g = math.sqrt(max(0, past) + (rim * rim / (2 * whole) if whole else 0))
    return ((mu - g) / (mu + g)) ** 2 * (1 + ((mu * (mu + g) - 1) / (mu * (g - mu) + 1)) ** 2) / 2


def glass(folder):
    """Both sides of an interface: the same in all formats, and by the headers; Fresnel's if smooth."""
    counted = 0
    for side in ["outside", "inside"]:
        told, values = arrays(folder, f"lut_{side}")
        average_told, average = arrays(folder, f"lut_{side}_average")
        assert told["channels"] == ["reflected_excess", "transmitted_excess"]
        asked, wanted = [], []
        for index in [1.3, 1.41, 1.7]:
            eta = index if side == "outside" else 1 / index
            critical = math.sqrt(max(0, 1 - eta * eta))
            for sigma in [0, 1e-3, 0.1, 0.6, 1]:
                for mu in [1e-4, 0.02, 0.999 * critical, 1.001 * critical, 0.8, 1]:
                    mu = max(mu, 1e-4)
                    r, t = read(told, values, 2, sigma, mu, eta)
                    f = smooth(sigma, mu, eta)
                    both, means = (r + f, t + 1 - f), read(average_told, average, 2, sigma, None, eta)
                    for quantity, share in zip(["reflected", "transmitted"], both, strict=True):
                        most = error(told, quantity)
                        assert -most <= share <= 1 + most, (side, quantity, eta, sigma, mu, share)
                    assert sum(both) <= 1 + error(told, "e"), (side, eta, sigma, mu, both)
                    if sigma == 0:
                        assert abs(r) <= told["largest_errors_along_edges"]["sigma_0"]["reflected"] + 1e-6
                    asked.append(f"{eta!r} {sigma} {mu!r}")
                    wanted.append([*both, *means])
        lines = subprocess.run([folder / "read"], input="\n".join(asked), text=True,
                               capture_output=True, check=True).stdout.split("\n")[:len(asked)]
        for place, line, want in zip(asked, lines, wanted, strict=True):
            # Single precision moves the step of a smooth surface.
            atol = 2e-3 if " 0 " in place else 1e-4
            assert np.allclose([float(x) for x in line.split()], want, atol=atol), (place, line, want)
            counted += 1
    print(f"glass: six formats hold the same from either side; headers agree at {counted} places")


def main():
    folder, reference = Path(sys.argv[1]), sys.argv[2]
    rows = list(csv.DictReader(open(reference, newline="")))
    rows = [row for row in rows if row["sigma_x"] == row["sigma_y"] and row["e_exact"]]
    for name in ["ggx", "half", "lost", "volume"]:
        told, values = arrays(folder / name, "lut")
        average_told, average = arrays(folder / name, "lut_average")
        sigma_max = next(axis["sigma_max"] for axis in told["axes_slowest_first"] if "sigma_max" in axis)
        least = next((axis["gamma_min"] for axis in told["axes_slowest_first"] if "gamma_min" in axis), None)
        lost, counted, worst = told["channels"] == ["one_minus_e"], 0, 0.0
        asked, wanted = [], []
        for row in rows:
            gamma, sigma, mu = (float(row[key]) for key in ["gamma", "sigma_x", "vz"])
            here = gamma >= least if least else gamma == float(told["gamma"])
            if not here or sigma > sigma_max or not 1e-4 <= mu <= 1 or row["masking"] != told["masking"]:
                continue
            got, got_average = read(told, values, gamma, sigma, mu), read(average_told, average, gamma, sigma, None)
            asked.append(f"{gamma} {sigma} {mu}")
            wanted.append((got[0], got_average[0]))
            pairs = [(told, "e", 1 - got[0] if lost else got[0], "e_exact")]
            pairs.append((average_told, "e", 1 - got_average[0] if lost else got_average[0], "e_avg_exact"))
            if told["channels"] == ["e", "bias_excess"]:
                pairs.append((told, "bias", got[1] + got[0] * (1 - mu) ** 5, "bias_exact"))
                pairs.append((average_told, "bias", got_average[1] + got_average[0] / 21, "bias_avg_exact"))
            for told_of, quantity, value, column in pairs:
                share = abs(value - float(row[column])) / error(told_of, quantity)
                assert share <= 1, (name, quantity, gamma, sigma, mu, value, row[column])
                worst, counted = max(worst, share), counted + 1
        assert counted >= 10, (name, counted)
        # Beyond the ends, and at them: sigma, mu, and gamma of a volume.
        gamma, end = (least, 1e30) if least else (told["gamma"], told["gamma"])
        pairs = [(f"{gamma} {5 * sigma_max} 0.3", f"{gamma} {sigma_max} 0.3"),
                 (f"{end} {sigma_max} 2", f"{end} {sigma_max} 1"),
                 (f"{gamma} 0.5 -1", f"{gamma} 0.5 0.0001"),
                 (f"{gamma} nan 0.5", f"{gamma} 0 0.5")]
        if least:
            pairs += [(f"{low} 0.5 0.3", f"{least} 0.5 0.3") for low in ["1.6", "1.5", "1", "nan"]]
        asked += [place for pair in pairs for place in pair]
        lines = subprocess.run([folder / name / "read"], input="\n".join(asked), text=True,
                               capture_output=True, check=True).stdout.split("\n")
        # Single precision, and a power, against double.
        for line, want in zip(lines, wanted, strict=False):
            assert np.allclose([float(x) for x in line.split()], want, atol=1e-4 if name == "half" else 2e-5), (line, want)
        last = lines[len(wanted):len(asked)]
        assert len(last) == 2 * len(pairs)
        for pair, beyond, at_end in zip(pairs, last[::2], last[1::2], strict=True):
            assert beyond == at_end, (name, pair, beyond, at_end)
        print(f"{name}: six formats hold the same; {counted} values within {worst:.2f} of what is stated")
    glass(folder / "glass")


main()
