"""The scenes of benches/agreement for Mitsuba 3, and means over the regions of pictures, for `cargo xtask bench agreement`.

agreement.py version                              prints Mitsuba's version
agreement.py render SUBJECT SAMPLES SEED...       renders once for each seed; prints a line of means for each
agreement.py means FILE.exr...                    prints for each picture three lines of means: red, green and blue
agreement.py panorama FILE.exr                    writes the panorama of `environment`

Regions are those of a grid, row by row from the top left. All is grey, so that colours need no spectra.
"""

import math
import sys

import mitsuba as mi
import numpy as np

WIDTH, HEIGHT = 96, 72
COLUMNS, ROWS = 4, 3
PANORAMA_ROWS = 128
# Paths end by chance alone, and late.
PATH = {"type": "path", "max_depth": -1, "rr_depth": 32}
VOLPATH = {"type": "volpath", "max_depth": -1, "rr_depth": 64}


def choose_variant():
    for name in ("llvm_ad_rgb", "scalar_rgb"):
        try:
            mi.set_variant(name)
            return
        except ImportError:
            pass


def grey(value):
    return {"type": "rgb", "value": value}


def diffuse(value):
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": grey(value)}}


def shine(shape, radiance):
    """The shape as a lamp that reflects nothing; it shines to the side of its normals."""
    return {**shape, "bsdf": {"type": "diffuse", "reflectance": grey(0.0)}, "emitter": {"type": "area", "radiance": grey(radiance)}}


def sphere(center, radius):
    return {"type": "sphere", "center": center, "radius": radius}


def rectangle(corner, edge_u, edge_v):
    """From a corner along two edges, as ours; Mitsuba's own goes from -1 to 1 in x and y."""
    corner, u, v = (np.array(vector, float) for vector in (corner, edge_u, edge_v))
    normal = np.cross(u, v)
    columns = [u / 2, v / 2, normal / np.linalg.norm(normal), corner + u / 2 + v / 2]
    matrix = np.vstack([np.array(columns).T, [0, 0, 0, 1]])
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(matrix)}


def box(low, high):
    low, high = np.array(low), np.array(high)
    t = mi.ScalarTransform4f
    return {"type": "cube", "to_world": t().translate(list((low + high) / 2)) @ t().scale(list((high - low) / 2))}


def disk(center, normal, radius):
    frame = mi.ScalarTransform4f().look_at(center, list(np.array(center) + np.array(normal)), [0, 0, 1])
    return {"type": "disk", "to_world": frame @ mi.ScalarTransform4f().scale([radius, radius, 1])}


def table():
    return rectangle([-5, 0, 5], [10, 0, 0], [0, 0, -10])


def globe():
    return shine(sphere([-1.5, 5, -2], 1.3), 5)


def sky(radiance):
    return {"type": "constant", "radiance": grey(radiance)}


def body(distance, anisotropy, absorption):
    """A medium by the mean distance between scatterings and the coefficient of absorption."""
    scattering = 1 / distance
    extinction = scattering + absorption
    return {
        "type": "homogeneous", "sigma_t": extinction, "albedo": scattering / extinction,
        "phase": {"type": "hg", "g": anisotropy},
    }


def subject(name):
    """Integrator, camera (eye, look_at, fov) and objects."""
    if name == "diffuse":
        return PATH, ([0, 1.5, 6.5], [0, 1.5, 0], 42), {
            "floor": {**rectangle([-2, 0, 2], [4, 0, 0], [0, 0, -4]), "bsdf": diffuse(0.75)},
            "ceiling": {**rectangle([-2, 3, 2], [4, 0, 0], [0, 0, -4]), "bsdf": diffuse(0.75)},
            "back": {**rectangle([-2, 0, -2], [4, 0, 0], [0, 3, 0]), "bsdf": diffuse(0.75)},
            "left": {**rectangle([-2, 0, 2], [0, 0, -4], [0, 3, 0]), "bsdf": diffuse(0.5)},
            "right": {**rectangle([2, 0, 2], [0, 0, -4], [0, 3, 0]), "bsdf": diffuse(0.25)},
            "ball": {**sphere([-0.8, 0.7, -0.6], 0.7), "bsdf": diffuse(0.5)},
            "box": {**box([0.3, 0, -0.9], [1.3, 1.4, 0.1]), "bsdf": diffuse(0.75)},
            "lamp": shine(rectangle([-0.6, 2.95, -0.6], [1.2, 0, 0], [0, 0, 1.2]), 12),
        }
    if name == "area-light":
        return PATH, ([0, 3.5, 7], [0, 0.9, 0], 44), {
            "floor": {**rectangle([-6, 0, 6], [12, 0, 0], [0, 0, -12]), "bsdf": diffuse(0.6)},
            "back": {**rectangle([-6, 0, -3], [12, 0, 0], [0, 7, 0]), "bsdf": diffuse(0.6)},
            "ball": {**sphere([-0.9, 0.8, 0.2], 0.8), "bsdf": diffuse(0.4)},
            "box": {**box([0.7, 0, -0.8], [1.7, 1.2, 0.2]), "bsdf": diffuse(0.4)},
            "globe": shine(sphere([-2.2, 2.6, -0.5], 0.45), 6),
            "disk": shine(disk([0.2, 3.2, -1.5], [0, -1, 0.5], 0.6), 10),
            "panel": shine(rectangle([2.8, 0.4, -1.2], [0, 0, 2.4], [0, 1.6, 0]), 4),
        }
    if name == "smooth-glass":
        return PATH, ([0, 3, 6], [0, 0.8, 0], 42), {
            "sky": sky(0.4),
            "floor": {**table(), "bsdf": diffuse(0.6)},
            "ball": {**sphere([-1, 1.1, 0], 1), "bsdf": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}},
            "block": {**box([0.5, 0.2, -0.9], [2, 1.2, 0.6]), "bsdf": {"type": "dielectric", "int_ior": 1.75, "ext_ior": 1.0}},
            "lamp": globe(),
        }
    if name == "rough-glass":
        board = {"type": "checkerboard", "color0": grey(0.7), "color1": grey(0.3), "to_uv": mi.ScalarTransform4f().scale([5, 5, 1])}
        frosted = {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.015, "int_ior": 1.5, "ext_ior": 1.0}
        return PATH, ([0, 3, 6], [0, 0.9, 0], 38), {
            "sky": sky(0.4),
            "floor": {**table(), "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": board}}},
            "block": {**box([-1.1, 0.2, -0.6], [1.1, 2, 0.6]), "bsdf": frosted},
            "lamp": globe(),
        }
    if name == "medium":
        return VOLPATH, ([0, 2.5, 6], [0, 0.9, 0], 42), {
            "sky": sky(0.5),
            "floor": {**table(), "bsdf": diffuse(0.5)},
            "fog": {**sphere([-1.1, 1.1, 0], 1), "bsdf": {"type": "null"}, "interior": body(0.5, 0.6, 0.2)},
            "milk": {
                **sphere([1.1, 1.1, 0], 1), "bsdf": {"type": "dielectric", "int_ior": 1.33, "ext_ior": 1.0},
                "interior": body(0.5, -0.3, 0.2),
            },
            "lamp": globe(),
        }
    if name == "environment":
        mirror = {"type": "conductor", "material": "none"}
        return PATH, ([1, 2.5, 6], [0, 0.9, 0], 46), {
            # Ours has its middle along -z, Mitsuba its borders.
            "sky": {"type": "envmap", "bitmap": their_panorama(), "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 180 + 40)},
            "floor": {**rectangle([-3, 0, 3], [6, 0, 0], [0, 0, -6]), "bsdf": diffuse(0.5)},
            "mirror": {**sphere([-1.1, 1, 0], 1), "bsdf": mirror},
            "matt": {**sphere([1.1, 1, 0], 1), "bsdf": diffuse(0.7)},
        }
    sys.exit(f"no subject `{name}`")


def scene(name):
    integrator, (eye, look_at, fov), objects = subject(name)
    sensor = {
        "type": "perspective", "fov": fov, "fov_axis": "x", "to_world": mi.ScalarTransform4f().look_at(eye, look_at, [0, 1, 0]),
        "film": {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
        "sampler": {"type": "independent"},
    }
    return mi.load_dict({"type": "scene", "integrator": integrator, "sensor": sensor, **objects})


def print_means(channel):
    """The mean of every region of one channel."""
    regions = channel.astype(float).reshape(ROWS, HEIGHT // ROWS, COLUMNS, WIDTH // COLUMNS)
    print(*(f"{mean:.8g}" for mean in regions.mean(axis=(1, 3)).ravel()), flush=True)


def panorama(down):
    """Rows of a panorama at angles from the top: a broad brightness and a narrow one."""
    down = down[:, None]
    right = (np.arange(2 * len(down)) + 0.5)[None, :] / (2 * len(down)) * 2 * math.pi
    broad = 1 + np.cos(right - 1.0)
    narrow = np.exp(6 * (np.sin(down) * np.cos(right - 4.0) - 1)) * np.exp(-8 * (down - 1.0) ** 2)
    light = 0.2 + np.sin(down) ** 4 * (0.4 * broad + 12 * narrow)
    return mi.Bitmap(np.repeat(light[:, :, None], 3, axis=2).astype(np.float32))


def our_panorama():
    """Our rows are strips between the poles: what is stored is seen in the middle of each."""
    return panorama((np.arange(PANORAMA_ROWS) + 0.5) / PANORAMA_ROWS * math.pi)


def their_panorama():
    """Mitsuba's rows go from pole to pole: what is stored in the first and the last is seen there."""
    return panorama(np.arange(PANORAMA_ROWS) / (PANORAMA_ROWS - 1) * math.pi)


def main():
    command, *words = sys.argv[1:]
    choose_variant()
    if command == "version":
        print(mi.__version__)
    elif command == "render":
        name, samples, *seeds = words
        made = scene(name)
        for seed in seeds:
            print_means(np.array(mi.render(made, spp=int(samples), seed=int(seed))).mean(axis=2))
    elif command == "means":
        for name in words:
            picture = np.array(mi.Bitmap(name).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
            for channel in range(3):
                print_means(picture[:, :, channel])
    else:
        our_panorama().convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float16).write(words[0])


main()
