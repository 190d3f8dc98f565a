"""The scene of benches/caustic.toml for LuxCore (`pip install pyluxcore numpy`).

caustic.py version                      prints LuxCore's version
caustic.py render SAMPLES FILE.npy      renders, by the bidirectional integrator on the processor
"""

import math
import sys
import time

import numpy as np
import pyluxcore

WIDTH, HEIGHT = 320, 240
# Meridians of the ball, which is a mesh here; half as many parallels.
SEGMENTS = 256


def ball(center, radius):
    """Vertices, triangles and normals."""
    points, triangles = [], []
    for i in range(SEGMENTS // 2 + 1):
        for j in range(SEGMENTS):
            down, around = 2 * math.pi * i / SEGMENTS, 2 * math.pi * j / SEGMENTS
            points.append((math.sin(down) * math.cos(around), math.cos(down), math.sin(down) * math.sin(around)))
    at = lambda i, j: i * SEGMENTS + j % SEGMENTS
    for i in range(SEGMENTS // 2):
        for j in range(SEGMENTS):
            if i > 0:
                triangles.append((at(i, j), at(i, j + 1), at(i + 1, j)))
            if i + 1 < SEGMENTS // 2:
                triangles.append((at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)))
    return [tuple(c + radius * x for c, x in zip(center, point)) for point in points], triangles, points


def square(corner, edge_u, edge_v):
    add = lambda *vectors: tuple(map(sum, zip(*vectors)))
    return [corner, add(corner, edge_u), add(corner, edge_u, edge_v), add(corner, edge_v)], [(0, 1, 2), (0, 2, 3)]


def properties(values):
    made = pyluxcore.Properties()
    for name, value in values.items():
        made.Set(pyluxcore.Property(name, value))
    return made


def scene():
    made = pyluxcore.Scene()
    points, triangles, normals = ball((0, 1, 0), 1)
    made.DefineMesh("ball", points, triangles, normals, None, None, None)
    points, triangles = square((-50, 0, 50), (100, 0, 0), (0, 0, -100))
    made.DefineMesh("board", points, triangles, None, [(0, 0), (1, 0), (1, 1), (0, 1)], None, None)
    points, triangles = square((-2.15, 5, -0.15), (0.3, 0, 0), (0, 0, 0.3))
    made.DefineMesh("lamp", points, triangles, None, None, None, None)
    made.Parse(properties({
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": [0, 3, 7],
        "scene.camera.lookat.target": [0, 0.7, 0],
        "scene.camera.up": [0, 1, 0],
        "scene.camera.fieldofview": 36,
        # Half as wide and high as the picture; one row lower, since LuxCore's rows lie one higher than others.
        "scene.camera.screenwindow": [-1, 1, -(HEIGHT + 2) / WIDTH, (HEIGHT - 2) / WIDTH],
        "scene.camera.autofocus.enable": 0,
        "scene.textures.squares.type": "checkerboard2d",
        "scene.textures.squares.texture1": [0.8] * 3,
        "scene.textures.squares.texture2": [0.2] * 3,
        "scene.textures.squares.mapping.type": "uvmapping2d",
        "scene.textures.squares.mapping.uvscale": [100, 100],
        "scene.materials.board.type": "matte",
        "scene.materials.board.kd": "squares",
        "scene.materials.glass.type": "glass",
        "scene.materials.glass.kr": [1] * 3,
        "scene.materials.glass.kt": [1] * 3,
        "scene.materials.glass.interiorior": 1.5,
        "scene.materials.glass.exteriorior": 1.0,
        "scene.materials.lamp.type": "matte",
        "scene.materials.lamp.kd": [0] * 3,
        "scene.materials.lamp.emission": [60] * 3,
        "scene.objects.board.shape": "board",
        "scene.objects.board.material": "board",
        "scene.objects.ball.shape": "ball",
        "scene.objects.ball.material": "glass",
        "scene.objects.lamp.shape": "lamp",
        "scene.objects.lamp.material": "lamp",
    }))
    return made


def render(samples):
    config = pyluxcore.RenderConfig(properties({
        "renderengine.type": "BIDIRCPU",
        "sampler.type": "SOBOL",
        "path.maxdepth": 64,
        "light.maxdepth": 64,
        "film.width": WIDTH,
        "film.height": HEIGHT,
        # Each sample counts for its own pixel alone; the narrowest box spreads them a little.
        "film.filter.type": "NONE",
        "film.outputs.1.type": "RGB",
        "film.outputs.1.filename": "caustic.exr",
        "batch.haltspp": samples,
    }), scene())
    session = pyluxcore.RenderSession(config)
    session.Start()
    while not session.HasDone():
        time.sleep(0.05)
        session.UpdateStats()
    session.Stop()
    pixels = np.zeros(WIDTH * HEIGHT * 3, np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0)
    # Rows begin at the bottom there.
    return pixels.reshape(HEIGHT, WIDTH, 3)[::-1]


def main():
    command, *words = sys.argv[1:]
    if command == "version":
        # The module prints more about itself on its way.
        print(pyluxcore.Version())
        return
    pyluxcore.Init()
    np.save(words[1], render(int(words[0])))


main()
