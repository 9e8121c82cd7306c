"""Finds roughness and shape of a lobe from its normals, measured with an error of 2 %, by the
method of Gauss and Newton with derivatives of Slang.

    fit.py EXPORT
"""

import sys

import numpy as np

from device import GAMMA, L, SIGMA, Module


def main(export):
    module = Module(export)
    theta = np.linspace(0.02, 1.2, 60)
    points = np.zeros((len(theta), 11))
    points[:, L] = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], -1)

    def log_d(sigma, gamma):
        """ln D of normals at theta, and its derivatives by ln sigma and ln(gamma - 1)."""
        points[:, SIGMA], points[:, GAMMA] = sigma, gamma
        shapes = [min(module.offsets)] * len(theta)  # read by no function of any gamma
        d, gradient = module("student_t_d_of_gamma", 0, shapes, points)
        by_sigma = gradient[:, SIGMA].sum(1) * sigma / d
        return np.log(d), np.stack([by_sigma, gradient[:, GAMMA] * (gamma - 1) / d], -1)

    true = 0.17, 2.6
    noise = np.random.default_rng(1).normal(0, 0.02, len(theta))
    measured = log_d(*true)[0] + noise
    sigma, gamma = 0.4, 2
    for step in range(5):
        ours, by = log_d(sigma, gamma)
        change = np.linalg.lstsq(by, measured - ours, rcond=None)[0]
        change = np.clip(change, -1, 1)
        sigma, gamma = sigma * np.exp(change[0]), 1 + (gamma - 1) * np.exp(change[1])
        error = np.sqrt(np.mean((measured - ours) ** 2))
        print(f"step {step}: off by {error:.3f}, then sigma {sigma:.4f}, gamma {gamma:.4f}")
    assert abs(sigma / true[0] - 1) < 0.02 and abs(gamma / true[1] - 1) < 0.02


if __name__ == "__main__":
    main(*sys.argv[1:])
