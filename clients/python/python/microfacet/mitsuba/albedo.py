"""What one bounce off a round lobe with F = 1 loses to further ones, 1 less its directional albedo,
and the average of that.

Of splines over roughness, gamma and view: quadratic, quadratic and cubic. They pass through what
the tables of some gammas have, whose coordinates are those of ``albedo.wgsl`` of the shader export.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .arithmetic import Numbers, Packets, horner, log_growth, place, unit
from .family import GAMMA, shapes

#: Nodes of gamma, nodes of roughness, and cells of the view: as many as keep what splines miss of
#: the tables below 3e-5 for cos theta >= 0.02. Of one gamma there is room for more.
_OF_ALL, _OF_ONE = (64, 149, 64), (1, 297, 192)


class Albedos:
    """The losses for one form of masking, for sigma in [1e-8, 3]; beyond, those of the ends.

    They are of one gamma, or of all. Functions of one take no notice of what they are given.
    """

    def __init__(self, tables: Any, gamma: float | None, correlated: bool) -> None:
        """``tables``: a set of tables; ``gamma``: the shape, if it is a constant."""
        form = "height_correlated" if correlated else "uncorrelated"
        gammas = gamma_nodes() if gamma is None else [gamma]
        some = shapes(tables, gammas) if gamma is None else [tables.shape(gamma)]
        self._of = of = {
            name.partition(".")[2]: value
            for name, value in some[-1].members.items()
            if name.startswith(form + ".")
        }
        # The coordinate of a view has kappa = low + more/(2 gamma - 3).
        kappas = [shape.members[form + ".kappa"] for shape in some]
        less = 2 * some[0].gamma - 3
        more = 0.0 if gamma is not None else (kappas[0] - kappas[-1]) * less
        self._kappa = (kappas[-1], more)
        self._gammas, self._sigmas, self._views = _OF_ALL if gamma is None else _OF_ONE
        sigmas = np.linspace(0, 1, self._sigmas)
        rows = _six(int(of["sigmas"]), sigmas)
        columns = _six(int(of["views"]), np.linspace(0, 1, self._views + 1))
        losses, averages = [], []
        for shape in some:
            moments = np.asarray(shape.tables["albedo_" + form], np.float64)[:, 0]
            moments = moments.reshape(int(of["sigmas"]), -1)
            losses.append(-(rows @ moments @ columns.T))
            logs = np.asarray(shape.tables["averages_" + form], np.float64)[:, 0]
            averages.append(_six(len(logs), sigmas) @ logs)
        #: What is lost by gamma, roughness and view.
        self._lost = np.stack(losses)
        self._cells = Packets(self._splines(_cubics(self._lost)).reshape(-1, 4))
        self._averages = Numbers(self._splines(np.stack(averages)))

    def lost(
        self, sigma: mi.Float, gamma: mi.Float, cos_theta: mi.Float, active: mi.Bool = True
    ) -> mi.Float:
        """1 - E of a view, in [0, 1]. Within 2e-5 of the horizon it is that of the end."""
        sigma = self._clamped(sigma)
        at = self._view(dr, sigma, self._kappa_of(gamma), cos_theta)
        cell, w = place(unit(at) * self._views, self._views - 1)
        cubic = mi.Vector4f(0)
        for row, weight in self._rows(sigma, gamma):
            cubic = cubic + self._cells(row * self._views + cell, active) * weight
        return dr.clip(horner(cubic, w), 0, 1)

    def lost_average(
        self, sigma: mi.Float, gamma: mi.Float, active: mi.Bool = True
    ) -> mi.Float:
        """1 - E_avg, weighted by the cosine of the view, with its digits where that is small."""
        total = mi.Float(0)
        for row, weight in self._rows(self._clamped(sigma), gamma):
            total = total + self._averages(row, active) * weight
        return dr.minimum(dr.exp(total), 1)

    def row(self, sigma: float, gamma: float, cosines: np.ndarray) -> np.ndarray:
        """What is lost at some cosines, near enough for a density to draw from."""
        sigma = min(max(sigma, self._of["sigma_min"]), self._of["sigma_max"])
        i = 0 if self._gammas == 1 else round(gamma_place(gamma))
        j = round(self._sigma_place(sigma))
        at = self._view(np, sigma, self._kappa_of(gamma), cosines)
        lost = np.interp(at, np.linspace(0, 1, self._views + 1), self._lost[i, j])
        return np.asarray(np.clip(lost, 0, 1))

    def _clamped(self, sigma: mi.Float) -> mi.Float:
        return dr.clip(sigma, self._of["sigma_min"], self._of["sigma_max"])

    def _kappa_of(self, gamma: mi.Float) -> mi.Float:
        low, more = self._kappa
        return low if more == 0 else low + more / (2 * gamma - 3)

    def _view(self, m: Any, sigma: mi.Float, kappa: mi.Float, mu: mi.Float) -> mi.Float:
        """The place of a view by its cosine, in [0, 1]; ``m`` is the module of the functions."""
        of = self._of
        lowest = of["floor"] * (of["slope"] * sigma) / (of["floor"] + of["slope"] * sigma)
        nu = of["spread"] * sigma

        def coordinate(mu: Any) -> Any:
            sine = m.sqrt(m.maximum((1 - mu) * (1 + mu), 1e-30))
            x = mu / (mu + kappa * sigma * sine)
            h = mu / (1 + sine)
            roots = of["share"] * m.sqrt(m.sqrt(x)) + (1 - of["share"]) * m.sqrt(m.sqrt(h))
            rest = 1 - of["weight"] - of["normal"]
            return of["weight"] * x + of["normal"] * (nu / (nu + sine)) + rest * roots

        start = coordinate(lowest)
        return (coordinate(m.minimum(m.maximum(mu, lowest), 1)) - start) / (1 - start)

    def _sigma_place(self, sigma: mi.Float) -> mi.Float:
        """The place of a roughness among the nodes."""
        of = self._of
        slow = of["slow"] * dr.log(sigma / of["first"])
        coordinate = log_growth(sigma / of["offset"]) + slow + of["linear"] * sigma
        return (coordinate - of["start"]) * ((self._sigmas - 1) / of["range"])

    def _rows(self, sigma: mi.Float, gamma: mi.Float) -> list[tuple[mi.UInt32, mi.Float]]:
        """Rows of coefficients, and their weights."""
        first, of_sigma = _three(self._sigma_place(sigma), self._sigmas)
        rows = [(first + i, weight) for i, weight in enumerate(of_sigma)]
        if self._gammas == 1:
            return rows
        first, of_gamma = _three(gamma_place(gamma), self._gammas)
        first = first * (self._sigmas + 2)
        return [
            (first + (row + i * (self._sigmas + 2)), outer * inner)
            for i, outer in enumerate(of_gamma)
            for row, inner in rows
        ]

    def _splines(self, values: np.ndarray) -> np.ndarray:
        """Coefficients of quadratic splines along the first two axes, by gamma and roughness."""
        for axis, count in ((1, self._sigmas), (0, self._gammas)):
            if count > 1:
                matrix = _through((1 / 8, 3 / 4, 1 / 8), count)
                values = np.moveaxis(np.tensordot(matrix, values, (1, axis)), 0, axis)
        return values


def gamma_nodes() -> list[float]:
    """The shapes of the nodes of all."""
    low = 2 * GAMMA[0] - 3
    powers = np.linspace((low / (low + 3)) ** 0.25, 1, _OF_ALL[0])[:-1] ** 4
    return [GAMMA[0], *(1.5 + 1.5 * powers / (1 - powers)).tolist()[1:], GAMMA[1]]


def gamma_place(gamma: mi.Float) -> mi.Float:
    """The place of a shape among the nodes of all."""
    low, less = 2 * GAMMA[0] - 3, 2 * gamma - 3
    start = (low / (low + 3)) ** 0.25
    return (dr.sqrt(dr.sqrt(less / (less + 3))) - start) * ((_OF_ALL[0] - 1) / (1 - start))


def _three(x: mi.Float, count: int) -> tuple[mi.UInt32, list[mi.Float]]:
    """The first of three coefficients at a place among nodes, and the weights of all."""
    start = dr.floor(dr.clip(x, 0, count - 1) + 0.5)
    d = x - start
    ends = 0.5 * d * d + 0.125
    return mi.UInt32(start), [ends - 0.5 * d, 1 - 2 * ends, ends + 0.5 * d]


def _through(spline: tuple[float, ...], count: int) -> np.ndarray:
    """The matrix (count + 2, count) from values at nodes to the coefficients of the spline through
    them, of which three have these weights at a node. At both ends differences vanish.
    """
    matrix = np.zeros((count + 2, count + 2))
    for node in range(count):
        matrix[node, node : node + 3] = spline
    differences = (1, -3, 3, -1)
    matrix[-2, : len(differences)] = matrix[-1, -len(differences) :] = differences
    return np.linalg.inv(matrix)[:, :count]


def _cubics(values: np.ndarray) -> np.ndarray:
    """Cubics between values along the last axis, their slopes and bends continuous."""
    c = values @ _through((1 / 6, 2 / 3, 1 / 6), values.shape[-1]).T
    a, b, c, d = (c[..., i : c.shape[-1] - 3 + i] for i in range(4))
    powers = [(a + 4 * b + c) / 6, (c - a) / 2, (a - 2 * b + c) / 2, (d - 3 * c + 3 * b - a) / 6]
    return np.stack(powers, axis=-1)


def _six(count: int, x: np.ndarray) -> np.ndarray:
    """The matrix from values at even nodes to those at places in [0, 1], of the polynomials
    through six nodes about each.
    """
    at = x * (count - 1)
    start = np.clip(np.floor(at) - 2, 0, count - 6)
    matrix = np.zeros((len(x), count))
    for i in range(6):
        others = [(at - start - j) / (i - j) for j in range(6) if j != i]
        matrix[np.arange(len(x)), start.astype(int) + i] = np.prod(others, axis=0)
    return matrix
