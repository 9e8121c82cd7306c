"""Derivatives of all functions, against differences of their values."""

import numpy as np

from device import FUNCTIONS, GAMMA, HEIGHT_CORRELATED, L, SIGMA, U, V

# What a derivative may differ by: this share of itself, or of SCALE times the size of what it is
# of, whichever is more; of normals three times as much.
ALLOWED = 1e-3
SCALE = 0.05
# Changes of a number, for differences. Tables of normals are linear in the view: corners are close
# to each other.
STEP = 0.008
OF_NORMALS = 0.004


def moved(points, along, step):
    """Points with a number changed: roughness and gamma - 1 by a factor, directions by an angle."""
    to = points.copy()
    if along == "sigma":
        to[:, SIGMA] *= np.exp(step)
    elif along == "sigma_x":
        to[:, 1] *= np.exp(step)
    elif along == "gamma":
        to[:, GAMMA] = 1 + (points[:, GAMMA] - 1) * np.exp(step)
    elif along in ("v", "l"):
        # Turned about y.
        direction, (c, s) = {"v": V, "l": L}[along], (np.cos(step), np.sin(step))
        x, y, z = points[:, direction].T
        to[:, direction] = np.stack([c * x + s * z, y, c * z - s * x], -1)
    else:
        to[:, {"u1": U.start, "u2": U.start + 1}[along]] += step
    return to


def along_numbers(points, along, gradient):
    """The derivative with respect to the step of `moved`, from the gradient at the points."""
    small = 1e-6
    direction = (moved(points, along, small) - moved(points, along, -small)) / (2 * small)
    return (gradient * direction).sum(1)


def compare(module, function, along, shapes, points, masking=HEIGHT_CORRELATED):
    """The largest error over what is allowed, and the share of points that it is of."""
    value, gradient = module(function, masking, shapes, points)
    ours = along_numbers(points, along, gradient)

    def at(step):
        return module(function, masking, shapes, moved(points, along, step))[0]

    size = np.ones(len(points))
    if function == "student_t_lambda":
        size = 1 + value
    elif function.startswith("student_t_d") or function.endswith("_pdf"):
        size = np.abs(value)
    least, allowed = (OF_NORMALS, 3 * ALLOWED) if "normal," in function else (STEP, ALLOWED)
    steps = [(step, at(step), at(-step)) for step in (least, 2 * least, 4 * least)]
    slopes = [(after - before) / (2 * step) for step, after, before in steps]
    bends = [(after - 2 * value + before) / step for step, after, before in steps]
    # Without the error of second order, from smaller steps and from larger ones. Where these differ
    # there is a corner of a table between them, or rounding, and neither is the derivative; so
    # where half the smallest step has another slope; and where the bend stays as steps shrink there
    # is a corner at the point.
    near, far = (4 * slopes[0] - slopes[1]) / 3, (4 * slopes[1] - slopes[2]) / 3
    half = (at(least / 2) - at(-least / 2)) / least
    scale = allowed * np.maximum(np.abs(near), SCALE * size)
    known = np.isfinite(near) & (scale > 1e-30) & (np.abs(half - near) <= scale)
    known &= (np.abs(near - far) <= 0.3 * scale) & (np.abs(2 * bends[0] - bends[1]) <= scale)
    errors = np.abs(ours - near)[known] / scale[known]
    return (errors.max(initial=0) if np.isfinite(ours).all() else np.inf), known.mean()


def shapes_and_points(shapes, count, seed):
    """Random points above the horizon; half of the second directions are normals of the lobe. The
    gamma of the family, of which there is no list, are from 1.503 to 31."""
    random = np.random.default_rng(seed)
    tails = 1 + np.exp(random.uniform(np.log(0.503), np.log(30), count))
    shape = random.choice(shapes, count) if shapes else tails
    points = np.empty((count, 11))
    points[:, GAMMA] = np.minimum(shape, 50)
    sigma = np.exp(random.uniform(np.log(0.02), np.log(1.5), count))
    points[:, SIGMA] = sigma[:, None] * np.exp(random.uniform(-0.4, 0.4, (count, 2)))
    for direction in (V, L):
        theta = random.uniform(0.05, 1.45, count)
        if direction == L:
            near = np.arctan(sigma * random.uniform(0.1, 3, count))
            theta = np.where(random.random(count) < 0.5, near, theta)
        phi = random.uniform(0, 2 * np.pi, count)
        sine = np.sin(theta)
        points[:, direction] = np.stack([sine * np.cos(phi), sine * np.sin(phi), np.cos(theta)], -1)
    points[:, U] = random.uniform(0.05, 0.95, (count, 2))
    return shape, points


# What the functions depend on.
ROUGHNESS = ("sigma", "sigma_x")
DEPENDENCES = {
    "student_t_d": (*ROUGHNESS, "l"),
    "student_t_d_of_gamma": (*ROUGHNESS, "gamma", "l"),
    "student_t_masking": (*ROUGHNESS, "v"),
    "student_t_lambda": (*ROUGHNESS, "v"),
    "student_t_masking_shadowing": (*ROUGHNESS, "v", "l"),
    "student_t_reflection_weight": (*ROUGHNESS, "v", "l"),
    "student_t_visible_normal_pdf": (*ROUGHNESS, "v", "l"),
    "student_t_reflection_pdf": (*ROUGHNESS, "v", "l"),
    "student_t_albedo": (*ROUGHNESS, "v"),
    "student_t_albedo_parts": (*ROUGHNESS, "v"),
    "student_t_albedo_average": ROUGHNESS,
    "student_t_albedo_average_parts": ROUGHNESS,
    "student_t_compensation": (*ROUGHNESS, "v", "l"),
    "student_t_sample_visible_normal": (*ROUGHNESS, "v", "u1", "u2"),
    "student_t_reflect": ("v", "l"),
}


def check(module, count=2000, tells=True):
    """Compares all derivatives of a module, and returns those that are wrong, in words."""
    shapes, points = shapes_and_points(list(module.offsets), count, 1)
    wrong = []
    for function in FUNCTIONS:
        worst, least = 0, 1
        dependences = DEPENDENCES[function.split(",")[0]]
        if module.is_family and ROUGHNESS[0] in dependences:
            dependences = {*dependences, "gamma"}
        for along in dependences:
            error, known = compare(module, function, along, shapes, points)
            worst, least = max(worst, error), min(least, known)
            if not error <= 1 or known < 0.4:
                wrong.append(f"{function} by {along}, {error:.3g} times what is allowed")
        if tells:
            print(f"{function:37} {worst:5.2f} of what is allowed, at {least:4.0%} of points")
    return wrong
