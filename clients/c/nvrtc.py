"""Compiles a kernel by NVRTC: nvrtc.py CUDA HEADERS KERNEL, the folder of CUDA, that of the headers,
and the file of the kernel. Exit status 1 with the compiler's log if it fails."""

import ctypes
import sys
from pathlib import Path

cuda, headers, kernel = map(Path, sys.argv[1:])
nvrtc = ctypes.CDLL(str(next((cuda / "lib").glob("libnvrtc.so.*"))))


def check(status):
    if status:
        sys.exit(f"error: NVRTC returned {status}")


program = ctypes.c_void_p()
source = kernel.read_bytes()
check(nvrtc.nvrtcCreateProgram(ctypes.byref(program), source, b"kernel.cu", 0, None, None))
options = [b"--gpu-architecture=compute_80", b"-I" + str(headers).encode()]
status = nvrtc.nvrtcCompileProgram(program, len(options), (ctypes.c_char_p * 2)(*options))
size = ctypes.c_size_t()
check(nvrtc.nvrtcGetProgramLogSize(program, ctypes.byref(size)))
log = ctypes.create_string_buffer(size.value)
check(nvrtc.nvrtcGetProgramLog(program, log))
if status or log.value.strip():
    sys.exit(f"error: {log.value.decode()}")
check(nvrtc.nvrtcGetPTXSize(program, ctypes.byref(size)))
print(f"compiled by NVRTC: {size.value} bytes of PTX")
