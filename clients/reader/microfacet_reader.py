"""A reader of microfacet tables, format versions 4 and 5, after the core of docs/format.md.

Directions are three numbers, a unit vector with n = +z. All arithmetic is in double precision.
"""

import json
import zlib
from math import exp, expm1, floor, hypot, inf, log, log1p, log2, pi, sqrt

import numpy as np


class Tables:
    """A set: its document, and with every table its values."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        start = 8 + int.from_bytes(data[:8], "little")
        try:
            header = json.loads(data[8:start])
            self.document = json.loads(header["__metadata__"]["microfacet"])
        except (ValueError, KeyError, TypeError):
            raise ValueError(f"{path}: not a table set; microfacet-bake writes them") from None
        # They differ in what materials state, not in tables.
        known = [("microfacet-tables", version) for version in (4, 5)]
        if (self.document["format"], self.document["version"]) not in known:
            raise ValueError(f"{path}: not microfacet tables of version 4 or 5")
        prefix = rb'\"checksum\":\"'
        digits = data.index(prefix, 8, start) + len(prefix)
        crc = zlib.crc32(data[:digits] + b"00000000" + data[digits + 8 :])
        if data[digits : digits + 8] != b"%08x" % crc:
            raise ValueError(f"{path}: the checksum does not match, the file is damaged")
        self.tables = []
        for stack in self.document["tables"]:
            tensor = header[stack["name"]]
            first, last = (start + offset for offset in tensor["data_offsets"])
            dtype = {"F32": "<f4", "F16": "<f2", "U16": "<u2"}[tensor["dtype"]]
            values = np.frombuffer(data[first:last], dtype).reshape(tensor["shape"]).astype(float)
            if "count" not in stack:
                values = values[np.newaxis]
            for i, own in enumerate(values):
                self.tables.append(self.table(stack, i, own))

    def table(self, stack, i, values):
        """One table of a tensor: what all of them share, and its own entries of the columns."""
        columns = {key: stack[key][i] for key in COLUMNS if key in stack}
        if stack["precision"] == "u16":
            values = np.array(columns["offset"]) + np.array(columns["scale"]) * values
        table = stack | columns | {"values": values}
        table["axes"] = [with_nodes(self.document["axes"][axis], table) for axis in stack["axes"]]
        return table

    def find(self, kind, coordinates, covers=lambda table: True, **wanted):
        """The first table that fits, its first axes collapsed at what `coordinates` says of it."""
        wanted |= {"kind": kind, "lobe": "family"}
        for table in self.tables:
            if all(table.get(key) == value for key, value in wanted.items()) and covers(table):
                values, at = table["values"], zip(table["axes"], coordinates(table))
                weights = [axis_weights(axis, t) for axis, t in at]
                if all(w is not None for w in weights):
                    for w in weights:
                        values = np.tensordot(w, values, 1)
                    return table, values
        return None


COLUMNS = ["gamma", "sigma", "eta", "k", "theta", "distribution", "scale", "offset"]


def ends(interval):
    """The ends of a number or a range; what is missing or null is infinite."""
    if isinstance(interval, dict):
        return interval["min"], inf if interval.get("max") is None else interval["max"]
    return (inf, inf) if interval is None else (interval, interval)


def covers_gamma(table, gamma):
    """Whether a table covers gamma, but for rounding."""
    least, most = ends(table["gamma"])
    return inside(1 / (gamma - 1), 1 / (most - 1), 1 / (least - 1))


def inside(x, least, most):
    """Whether x is in a range, but for rounding."""
    return least * (1 - 1e-9) <= x <= most * (1 + 1e-9)


def coordinate(mapping, gamma, sigma):
    """The coordinate of gamma, or of sigma, along an axis of it."""
    if mapping["kind"] == "inverse_shape":
        return 1 / (gamma - 1)
    if mapping["kind"] == "log_shape":
        return log1p(mapping["scale"] / (2 * gamma - 3))
    t = log1p(sigma / mapping["offset"]) + mapping["linear"] * sigma
    return t + mapping["slow"] * (log(sigma / mapping["first"]) if sigma > 0 else -inf)


def with_nodes(axis, table):
    """An axis with the coordinates of its nodes."""
    nodes = axis.get("nodes")
    if nodes is None:
        gamma, sigma = (ends(table[key])[0] for key in ["gamma", "sigma"])
        nodes = [coordinate(axis["mapping"], gamma, sigma)]
    elif isinstance(nodes, int):
        nodes = np.linspace(0, 1, nodes)
    return axis | {"nodes": nodes}


def window(nodes, k, t):
    """The first of the k nodes about t, and their Lagrange weights."""
    start = min(max(np.searchsorted(nodes, t, "right") - k // 2, 0), len(nodes) - k)
    x = nodes[start : start + k]
    return start, np.array([np.prod((t - x[x != a]) / (a - x[x != a])) for a in x])


def axis_weights(axis, t):
    """Weights of all nodes at t; None where the axis does not cover it."""
    nodes, kind = np.array(axis["nodes"]), axis["interpolation"]
    same = 1e-9 * (1 + abs(nodes[-1])) if kind == "lagrange6" else 1e-12 * (1 + abs(t))
    weights = (abs(nodes - t) <= same).astype(float)
    if not weights.any():
        if kind == "nodes" or not nodes[0] < t < nodes[-1]:
            return None
        k = min(int(kind[-1]), len(nodes))
        start, weights[start : start + k] = window(nodes, k, t)
    return weights


def make_monotone(run):
    """Makes values and slopes of a run of nodes along u ascend."""
    value = np.maximum.accumulate(np.maximum(run[:, 0], 0))
    rise = 3 * np.diff(value)
    limit = np.minimum(np.append(rise, inf), np.append(inf, rise))
    return np.stack([value, np.clip(run[:, 1], 0, limit)], 1)


def cell(t, n):
    """The cell of n even nodes that t is in, and the position inside it."""
    i = min(max(floor(t * (n - 1)), 0), n - 2)
    return i, t * (n - 1) - i


def hermite(nodes, t):
    """The cubic through (value, slope) of the two nodes about t."""
    i, w = cell(t, len(nodes))
    (a, da), (b, db) = nodes[i], nodes[i + 1]
    return a + w * (da + w * (3 * (b - a) - 2 * da - db + w * (da + db - 2 * (b - a))))


def slope(nodes, u):
    """X : Z of the slope at u, from the nodes of its half."""
    g = hermite(nodes, (2 * min(u, 1 - u)) ** 0.25)
    return (2 if u > 0.5 else -2) * (1 - g), g * (2 - g)


def unit(m):
    """A normal of unit length, not below the smallest cosine."""
    m = m / np.linalg.norm(m)
    return np.array([m[0], m[1], max(m[2], 1e-18)])


class StudentT:
    """D, masking and visible normals of one material; sigma is one number, or those of x and y."""

    def __init__(self, tables, sigma, gamma):
        self.sigma, self.gamma, self.s = np.broadcast_to(sigma, 2), gamma, 1 / (gamma - 1)
        kinds = ["shadowing", "visible_slope", "visible_slope_peeled", "visible_slope_conditional"]
        covers = lambda table: covers_gamma(table, gamma)
        found = (tables.find(kind, lambda table: [self.s], covers) for kind in kinds)
        g1, whole, peeled, across = found
        if not (g1 and (whole or peeled) and across):
            raise ValueError(f"no tables for gamma {gamma}")
        view, self.g = g1[0]["axes"][1]["mapping"], g1[1]
        self.kappa, self.crowded = view["scale"] / (2 - self.s), view.get("crowded", False)
        self.moment, self.peeled = self.kappa / self.g[0, 0], not whole
        table, slopes = whole or peeled
        self.knots = table["axes"][1]["mapping"].get("knots", [])
        halves = slopes.reshape(len(slopes), 2, -1, 2)
        self.rows = np.array([[make_monotone(run) for run in row] for row in halves])
        self.across = make_monotone(across[1])

    def _stretched(self, v):
        xy = self.sigma * v[:2]
        return xy, hypot(*xy), max(v[2], 0)

    def _masking(self, rho, z):
        """G1 and G1/v_z."""
        area = z + self.kappa * rho
        value = hermite(self.g, 1 - sqrt(self.kappa * rho / area) if self.crowded else z / area)
        return min(1, value * z / area), value / area

    def g1(self, v):
        return self._masking(*self._stretched(v)[1:])[0]

    def g2(self, v, l, masking):
        a, b = self.g1(v), self.g1(l)
        if masking == "uncorrelated":
            return a * b
        return a * b / (a + b - a * b) if a + b > 0 else 0.0

    def d(self, m):
        """Density of normals."""
        s, z = self.s, m[2]
        if not z > 0:
            return 0.0
        r = hypot(*(m[:2] / self.sigma))
        x = (r / z) * (r / z)
        if s == 0:
            e = -x - 4 * log(z)
        elif s * x < 1e-4:
            e = -(1 + s) * x * (1 - s * x / 2 + (s * x) ** 2 / 3) - 4 * log(z)
        elif s * x < 1e3:
            e = -self.gamma * log1p(s * x) - 4 * log(z)
        else:
            e = (2 * self.gamma - 4) * log(z) - self.gamma * log(z * z + s * r * r)
        return exp(e) / (pi * self.sigma[0] * self.sigma[1])

    def density(self, v, m):
        """Density of normals visible from v."""
        return max(0, np.dot(v, m)) * self.d(m) * self._masking(*self._stretched(v)[1:])[1]

    def _in_plane(self, rho, z, u):
        if self.peeled:
            heavy = min(self.moment * rho * self._masking(rho, z)[1], 1)
            if u > 1 - heavy:
                e = log((1 - u) / heavy) / (2 * self.gamma - 3) if u < 1 else -inf
                return sqrt(-expm1(2 * e)), sqrt(self.s) * exp(e)
            u = u / (1 - heavy) if u > 0 else 0.0
        r = hypot(rho, z)
        t = np.interp(z / (rho + r), *np.transpose([[0, 0], *self.knots, [1, 1]]))
        i, w = cell(t, len(self.rows))
        half = 1 if u > 0.5 else 0
        return slope((1 - w) * self.rows[i, half] + w * self.rows[i + 1, half], u)

    def visible_normal(self, v, u1, u2):
        """A normal visible from v, from two numbers in [0, 1]."""
        u1, u2 = (min(max(u, 0), 1) for u in (u1, u2))
        xy, rho, z = self._stretched(v)
        c, d = xy / rho if rho >= 1e-18 else (1, 0)
        (x, z1), (t, u) = self._in_plane(rho, z, u1), slope(self.across, u2)
        y, x, z1 = sqrt(z1 * z1 + self.s * x * x) * t, x * u, z1 * u
        m = unit(np.array([self.sigma[0] * (x * c - y * d), self.sigma[1] * (x * d + y * c), z1]))
        seen = np.array([v[0], v[1], z])
        facing = np.dot(seen, m)
        return m if facing >= 0 else unit(m - facing * seen)


class Albedo:
    """Directional albedo of one round material, F = 1, and its moments, for one form of masking."""

    def __init__(self, tables, sigma, gamma, masking):
        self.sigma, self.masking, self.mirror = sigma, masking, False

        def covers(table):
            return covers_gamma(table, gamma) and inside(sigma, *ends(table["sigma"]))

        def coordinates(table):
            shape, rough = (axis["mapping"] for axis in table["axes"][:2])
            t = coordinate(rough, gamma, sigma)
            first, last = (table["axes"][1]["nodes"][end] for end in (0, -1))
            self.mirror = sigma == 0
            if sigma > 0 and t < first - 1e-9 * (1 + abs(last)):
                raise ValueError(f"sigma {sigma} lies between 0, a mirror, and the first node")
            return coordinate(shape, gamma, sigma), max(t, first)

        wanted = {"reflectance": "moments", "masking": masking}
        directional = tables.find("albedo", coordinates, covers, **wanted)
        average = tables.find("albedo_average", coordinates, covers, **wanted)
        if not directional:
            raise ValueError(f"no albedo for sigma {sigma} and gamma {gamma}")
        self.nodes = directional[1]
        self.averages = average and average[1] * (not self.mirror)
        p = self.view = directional[0]["axes"][2]["mapping"]
        self.kappa = p["scale"] + p["heavy"] / (2 * gamma - 3)
        self.floor = p["floor"] * p["slope"] * sigma / (p["floor"] + p["slope"] * sigma)

    def _y(self, mu):
        p, sin = self.view, sqrt((1 - mu) * (1 + mu))
        x, h = mu / (mu + self.kappa * self.sigma * sin), mu / (1 + sin)
        nu = p["spread"] * self.sigma
        roots = p["share"] * x**0.25 + (1 - p["share"]) * h**0.25
        rest = 1 - p["weight"] - p["normal"]
        return p["weight"] * x + p["normal"] * nu / (nu + sin) + rest * roots

    def _channels(self, mu):
        n, first = len(self.nodes), self._y(self.floor)
        start, weights = window(np.linspace(0, 1, n), 6, (self._y(mu) - first) / (1 - first))
        e, bias, f82 = weights @ self.nodes[start : start + 6]
        return min(max(e, -1), 0), bias, f82

    def moments(self, mu):
        """E, scale, bias and F82 at the cosine mu of a view."""
        mu = min(max(mu, 0), 1)
        if self.mirror:
            return limited(whole(mu, (0, 0, 0)))
        channels = self._channels(max(mu, self.floor))
        if mu >= self.floor or channels[0] == 0:  # what loses nothing is a mirror, too
            return limited(whole(mu, channels))
        above, p = self._channels(4 * self.floor), 1.0
        if self.masking == "height-correlated":
            p = min(1, 0.5 * log2(max(1, above[0] / channels[0])))
        a, b = whole(self.floor, channels), whole(4 * self.floor, above)
        return limited(a + (a - b) * ((1 - (mu / self.floor) ** p) / (4**p - 1) if p > 0 else 0))

    def average(self):
        """Their averages over the hemisphere of views."""
        if self.averages is None:
            raise ValueError("a set of single materials has no averages: integrate the moments")
        e, bias, f82 = self.averages
        return limited((e, bias + (1 + e) / 21, f82 + (1 + e) * 117649 / 839808))


def whole(mu, channels):
    """E - 1 and the moments themselves, from the channels of a table."""
    e, bias, f82 = channels
    mirror = (1 - mu) ** 5, 7**7 / 6**6 * mu * (1 - mu) ** 6
    return np.array([e, bias + (1 + e) * mirror[0], f82 + (1 + e) * mirror[1]])


def limited(moments):
    """E, scale, bias and F82, each in its range."""
    e, bias, f82 = moments
    total = 1 + min(max(e, -1), 0)
    bias = min(max(bias, 0), total)
    return total, total - bias, bias, min(max(f82, 0), 1)
