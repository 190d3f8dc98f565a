"""The scene of benches/caustic.toml for Cycles, as Blender's module has it (`pip install bpy numpy`).

caustic.py version                      prints Blender's version
caustic.py render SAMPLES FILE.exr      renders by path tracing on the processor, without denoising or clamping
"""

import math
import sys

import bpy

WIDTH, HEIGHT = 320, 240
# Meridians of the ball, which is a mesh here; half as many parallels.
SEGMENTS = 256


def turned(vector):
    """Blender's z is up, ours is towards the viewer."""
    x, y, z = vector
    return x, -z, y


def mesh(name, points, faces):
    made = bpy.data.meshes.new(name)
    made.from_pydata([turned(point) for point in points], [], faces)
    return made


def ball(center, radius):
    """A mesh of its own: Blender's operator that makes one takes twenty seconds."""
    rings = SEGMENTS // 2 - 1
    points = []
    for i in range(1, rings + 1):
        for j in range(SEGMENTS):
            down, around = 2 * math.pi * i / SEGMENTS, 2 * math.pi * j / SEGMENTS
            points.append((math.sin(down) * math.cos(around), math.cos(down), math.sin(down) * math.sin(around)))
    top, bottom = len(points), len(points) + 1
    points += [(0, 1, 0), (0, -1, 0)]
    faces = []
    for j in range(SEGMENTS):
        k = (j + 1) % SEGMENTS
        faces.append((top, k, j))
        for i in range(0, (rings - 1) * SEGMENTS, SEGMENTS):
            faces.append((i + j, i + k, i + SEGMENTS + k, i + SEGMENTS + j))
        faces.append((bottom, (rings - 1) * SEGMENTS + j, (rings - 1) * SEGMENTS + k))
    return mesh("ball", [tuple(c + radius * x for c, x in zip(center, point)) for point in points], faces)


def place(name, data, material):
    data.materials.append(material)
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    return made


def material(name, kind, **inputs):
    """A material of one shader, and that shader's node."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    output_of = shader.outputs[0]
    tree.links.new(output_of, output.inputs["Surface"])
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    return made, tree, shader


def board():
    made, tree, shader = material("board", "ShaderNodeBsdfDiffuse")
    place_node, checker = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexChecker")
    shift = tree.nodes.new("ShaderNodeVectorMath")
    shift.operation = "ADD"
    # Away from the heights at which cubes meet.
    shift.inputs[1].default_value = (0, 0, 0.5)
    checker.inputs["Scale"].default_value = 1
    checker.inputs["Color1"].default_value = (0.2, 0.2, 0.2, 1)
    checker.inputs["Color2"].default_value = (0.8, 0.8, 0.8, 1)
    tree.links.new(place_node.outputs["Object"], shift.inputs[0])
    tree.links.new(shift.outputs[0], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Color"], shader.inputs["Color"])
    return made


def build():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    square = lambda x, y, z, size: [(x, y, z), (x + size, y, z), (x + size, y, z + size), (x, y, z + size)]
    # Seen from below the lamp's corners are counter-clockwise, from above the board's.
    place("board", mesh("board", square(-50, 0, -50, 100), [(3, 2, 1, 0)]), board())
    lamp, _, _ = material("lamp", "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=60)
    place("lamp", mesh("lamp", square(-2.15, 5, -0.15, 0.3), [(0, 1, 2, 3)]), lamp)
    glass, _, _ = material("glass", "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0, IOR=1.5)
    place("ball", ball((0, 1, 0), 1), glass).data.shade_smooth()

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "HORIZONTAL"
    camera.angle = math.radians(36)
    seat = bpy.data.objects.new("camera", camera)
    bpy.context.collection.objects.link(seat)
    seat.location = turned((0, 3, 7))
    seat.rotation_euler = (math.pi / 2 - math.atan2(2.3, 7), 0, 0)
    bpy.context.scene.camera = seat


def render(samples, file):
    build()
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.transmission_bounces = cycles.glossy_bounces = cycles.diffuse_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.light_sampling_threshold = 0
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True)


def main():
    command, *words = sys.argv[1:]
    if command == "version":
        print(bpy.app.version_string)
    else:
        render(int(words[0]), words[1])


main()
