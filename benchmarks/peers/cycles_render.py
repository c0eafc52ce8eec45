"""Renders with Blender Cycles what cycles.cpp wrote down of a scene.

blender --background --factory-startup --python-exit-code 1 --python cycles_render.py --
    SCENE.json SECONDS THREADS SEED PICTURE.exr TIMES.txt

Plain path tracing: no denoiser, no clamping, no adaptive sampling, no bound on bounces that
matters. TIMES.txt gets the samples per pixel, the seconds that they took, and those of a render's
start and end.
"""

import json
import sys
import time

import bpy
from mathutils import Matrix, Vector


def reflectance_by_angle(nodes, links, reflectance):
    """A colour that follows from the cosine between normal and view: its values from 0 to 1."""
    geometry = nodes.new("ShaderNodeNewGeometry")
    cosine = nodes.new("ShaderNodeVectorMath")
    cosine.operation = "DOT_PRODUCT"
    links.new(geometry.outputs["Normal"], cosine.inputs[0])
    links.new(geometry.outputs["Incoming"], cosine.inputs[1])
    curves = nodes.new("ShaderNodeRGBCurve")
    for channel in range(3):
        points = curves.mapping.curves[channel].points
        while len(points) < len(reflectance):
            points.new(0.5, 0.5)
        for i, color in enumerate(reflectance):
            points[i].location = (i / (len(reflectance) - 1), color[channel])
            points[i].handle_type = "VECTOR"
    curves.mapping.update()
    links.new(cosine.outputs["Value"], curves.inputs["Color"])
    return curves.outputs["Color"]


def scattering(nodes, links, surface):
    """The shader of what a surface does to light."""
    if surface["material"] == "diffuse":
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs["Color"].default_value = (*surface["reflectance"][0], 1)
    elif surface["material"] == "mirror":
        shader = nodes.new("ShaderNodeBsdfGlossy")
        shader.distribution = "SHARP"
        links.new(reflectance_by_angle(nodes, links, surface["reflectance"]),
                  shader.inputs["Color"])
    else:
        shader = nodes.new("ShaderNodeBsdfGlass")
        shader.distribution = "SHARP"
        shader.inputs["Color"].default_value = (1, 1, 1, 1)
        shader.inputs["IOR"].default_value = surface["ior"]
    return shader


def material_of(surface):
    material = bpy.data.materials.new(surface["name"])
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    shader = scattering(nodes, links, surface)
    if any(surface["radiance"]):
        # The colour of a node is at most 1 in the interface, not here.
        emission = nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*surface["radiance"], 1)
        both = nodes.new("ShaderNodeAddShader")
        links.new(shader.outputs[0], both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        shader = both
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def mesh_of(surface):
    mesh = bpy.data.meshes.new(surface["name"])
    mesh.from_pydata(surface["positions"], [], surface["triangles"])
    mesh.materials.append(material_of(surface))
    if surface["normals"]:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices(surface["normals"])
    return mesh


def build_scene(description):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for surface in description["surfaces"]:
        scene.collection.objects.link(bpy.data.objects.new(surface["name"], mesh_of(surface)))

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "HORIZONTAL"
    camera.angle = description["horizontal_fov"]
    camera.clip_start, camera.clip_end = 1e-3, 1e3
    forward, up = Vector(description["forward"]), Vector(description["up"])
    eye = bpy.data.objects.new("camera", camera)
    world_from_camera = Matrix((forward.cross(up), up, -forward)).transposed().to_4x4()
    world_from_camera.translation = description["position"]
    eye.matrix_world = world_from_camera
    scene.collection.objects.link(eye)
    scene.camera = eye
    return scene


def set_up_rendering(scene, description, threads, seed):
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = description["size"]
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", threads
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"

    cycles.device = "CPU"
    cycles.seed = seed
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = cycles.diffuse_bounces = 1024
    cycles.glossy_bounces = cycles.transmission_bounces = 1024
    cycles.blur_glossy = 0
    # The standard deviation of Cycles' Gaussian is a quarter of what it calls width.
    cycles.pixel_filter_type = "GAUSSIAN"
    cycles.filter_width = 4 * description["filter_stddev"]


def seconds_of_render(scene, samples):
    scene.cycles.samples = samples
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    return time.perf_counter() - start


def render_for(scene, seconds):
    """Samples per pixel, the time for them alone, and that of a render's start and end, which is
    known from renders of one sample and taken off."""
    one_sample = min(seconds_of_render(scene, 1) for _ in range(3))

    def seconds_per_sample(samples):
        return (seconds_of_render(scene, samples) - one_sample) / (samples - 1)

    per_sample = seconds_per_sample(16)
    for goal in (seconds / 6, seconds):
        samples = max(2, round(goal / per_sample))
        per_sample = seconds_per_sample(samples)
    return samples, per_sample * samples, max(0, one_sample - per_sample)


def main():
    scene_path, seconds, threads, seed, picture, times = sys.argv[sys.argv.index("--") + 1:]
    with open(scene_path, encoding="utf-8") as file:
        description = json.load(file)
    scene = build_scene(description)
    set_up_rendering(scene, description, int(threads), int(seed))
    scene.render.filepath = picture
    samples, taken, start_up = render_for(scene, float(seconds))
    with open(times, "w", encoding="utf-8") as file:
        file.write(f"{samples} {taken} {start_up}\n")


main()
