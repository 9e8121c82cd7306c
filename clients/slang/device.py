"""The functions of an export on slangpy's CPU device, with their derivatives."""

import json
import pathlib

import numpy as np
import slangpy

HERE = pathlib.Path(__file__).parent

# In the order of `functions.slang`.
FUNCTIONS = (
    "student_t_d",
    "student_t_d_of_gamma",
    "student_t_masking",
    "student_t_lambda",
    "student_t_masking_shadowing",
    "student_t_reflection_weight",
    "student_t_visible_normal_pdf",
    "student_t_reflection_pdf",
    "student_t_albedo",
    "student_t_albedo_parts, scale",
    "student_t_albedo_parts, bias",
    "student_t_albedo_parts, F82",
    "student_t_albedo_average",
    "student_t_albedo_average_parts, bias",
    "student_t_albedo_average_parts, F82",
    "student_t_compensation",
    "student_t_sample_visible_normal, x",
    "student_t_sample_visible_normal, y",
    "student_t_sample_visible_normal, z",
    "student_t_reflect, x",
)
# Columns of points: those of `Point`.
GAMMA, SIGMA, V, L, U = 0, slice(1, 3), slice(3, 6), slice(6, 9), slice(9, 11)
COLUMNS = 11
UNCORRELATED, HEIGHT_CORRELATED = 0, 1
READ = slangpy.BufferUsage.shader_resource
WRITTEN = slangpy.BufferUsage.unordered_access


class Module:
    """The kernel of `functions.slang` with the tables of an export, of shapes or of the family."""

    def __init__(self, export, module=None, is_family=False):
        """`module` is the folder of another student_t.slang than that of the export."""
        folders = [pathlib.Path(module or export), HERE]
        self.device = slangpy.create_device(slangpy.DeviceType.cpu, include_paths=folders)
        self.is_family = is_family
        program = self.device.load_program("family" if is_family else "shapes", ["derivatives"])
        self.kernel = self.device.create_compute_kernel(program)
        name = "student_t_family" if is_family else "student_t"
        self.tables = self.buffer(np.fromfile(pathlib.Path(export, f"{name}.bin"), np.uint32), 4)
        self.offsets = {}
        if not is_family:
            shapes = json.loads(pathlib.Path(export, f"{name}.json").read_text())["shapes"]
            self.offsets = {float(gamma): shape["offset"] for gamma, shape in shapes.items()}

    def buffer(self, data, size):
        return self.device.create_buffer(usage=READ, struct_size=size, data=data.reshape(-1))

    def __call__(self, function, masking, shapes, points):
        """Values of a function, and derivatives with respect to the columns of the points."""
        count = len(points)
        queries = np.empty((count, 3), np.uint32)
        queries[:, 0] = FUNCTIONS.index(function)
        queries[:, 1] = 0 if self.is_family else [self.offsets[shape] for shape in shapes]
        queries[:, 2] = masking
        size = 4 * (COLUMNS + 1)
        answers = self.device.create_buffer(
            usage=READ | WRITTEN, struct_size=4, size=size * count
        )
        self.kernel.dispatch(
            [count, 1, 1],
            vars={
                "student_t_tables": self.tables,
                "queries": self.buffer(queries, 12),
                "points": self.buffer(np.asarray(points, np.float32), 4),
                "answers": answers,
                "count": count,
            },
        )
        numbers = answers.to_numpy().view(np.float32).reshape(count, COLUMNS + 1).astype(float)
        return numbers[:, 0], numbers[:, 1:]
