"""The scene of benches/caustic.toml for Mitsuba 3, and the comparison of pictures of it.

caustic.py version                      prints Mitsuba's version
caustic.py render SAMPLES FILE.npy      renders, by `path` with LLVM where that works, else scalar
caustic.py compare REFERENCE FILE...    prints for each file the root-mean-square error: whole picture, caustic
"""

import sys

import mitsuba as mi
import numpy as np

WIDTH, HEIGHT = 320, 240
# Rows and columns where the caustic is.
CAUSTIC = (slice(140, 180), slice(150, 240))


def variant():
    for name in ("llvm_ad_rgb", "scalar_rgb"):
        try:
            mi.set_variant(name)
            return name
        except ImportError:
            pass


def scene(samples):
    t = mi.ScalarTransform4f
    white = lambda value: {"type": "rgb", "value": value}
    board = {"type": "checkerboard", "color0": white(0.8), "color1": white(0.2), "to_uv": t().scale([50, 50, 1])}
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 64},
        "sensor": {
            "type": "perspective", "fov": 36, "fov_axis": "x",
            "to_world": t().look_at([0, 3, 7], [0, 0.7, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent", "sample_count": samples},
        },
        "board": {
            "type": "rectangle", "to_world": t().rotate([1, 0, 0], -90).scale([50, 50, 1]),
            "bsdf": {"type": "diffuse", "reflectance": board},
        },
        "ball": {"type": "sphere", "center": [0, 1, 0], "radius": 1.0, "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}},
        "lamp": {
            "type": "rectangle", "to_world": t().translate([-2, 5, 0]).rotate([1, 0, 0], 90).scale([0.15, 0.15, 1]),
            "emitter": {"type": "area", "radiance": white(60.0)},
        },
    })


def read(name):
    if name.endswith(".npy"):
        return np.load(name)
    return np.array(mi.Bitmap(name).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))


def main():
    command, *words = sys.argv[1:]
    if command == "version":
        print(mi.__version__)
    elif command == "render":
        variant()
        np.save(words[1], np.array(mi.render(scene(int(words[0])))))
    else:
        mi.set_variant("scalar_rgb")
        reference = read(words[0])
        for name in words[1:]:
            squares = (read(name) - reference) ** 2
            print(squares.mean() ** 0.5, squares[CAUSTIC].mean() ** 0.5)


main()
