# SPDX-License-Identifier: Apache-2.0
"""Blender add-on: bakes the selected object into a Relief collider, shows its errors, and plays particles.

Needs the Python package relief: python3-relief, or the build's python/ folder in PYTHONPATH. README.md in this folder
describes the installation.
"""
import os
import pathlib
import re
import sys

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy.props import EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

bl_info = {
    "name": "Relief colliders",
    "description": "Bake particle colliders, show their errors, play particles",
    "author": "The Relief authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Relief",
    "category": "Object",
}

COLOR = "relief_error"
OVERLAY = "relief errors of "
PLACE = "relief place "
CAUSES = {
    "sheet": "Sheet thinner than its texels: use more bytes or a larger thickness",
    "open": "A map sees inside the open mesh: close it, or bake it as a shell",
    "unseen": "No map sees this place: use more maps or more bytes",
    "silhouette": "Hidden by another part in the deciding map: use more maps or more bytes",
    "texel": "Finer than a texel: use more bytes",
}


class ReliefError(Exception):
    """An error with a message for the user."""


def relief_module():
    try:
        import relief
    except ImportError as error:
        raise ReliefError("the Python package relief is missing; install python3-relief, or start Blender with its folder "
                          f"in PYTHONPATH ({error})") from error
    return relief


# --- axes: z is up in Blender. Relief has no up axis, but gravity points along -y by default, as in most engines.

def to_relief(points, up):
    points = np.asarray(points, dtype=np.float32).reshape(-1, 3)
    return points if up == "Z" else np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)


def to_blender(points, up):
    points = np.asarray(points, dtype=np.float32).reshape(-1, 3)
    return points if up == "Z" else np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)


# --- meshes

def world_mesh(context, obj):
    """World-space vertices (n, 3) and triangles (m, 3) of an object with its modifiers."""
    evaluated = obj.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", vertices)
        triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        evaluated.to_mesh_clear()
    if len(triangles) == 0:
        raise ReliefError(f"{obj.name} has no faces; select an object with faces")
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    world = vertices.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    triangles = triangles.reshape(-1, 3)
    if np.linalg.det(matrix[:3, :3]) < 0:
        triangles = triangles[:, ::-1]  # keeps the faces of mirrored objects pointing outwards
    return world.astype(np.float32), triangles


def chosen_object(context):
    obj = context.active_object
    if obj is None:
        raise ReliefError("nothing is selected; select the object to bake")
    if obj.type not in {"MESH", "CURVE", "SURFACE", "FONT", "META"}:
        raise ReliefError(f"{obj.name} is a {obj.type.lower()}, not a mesh; select an object with faces")
    return obj


def collider_of(obj):
    path = bpy.path.abspath(obj.relief.path) if obj.relief.path else ""
    if not path or not os.path.isfile(path):
        raise ReliefError(f"{obj.name} has no collider yet; bake it first" if not path else
                          f"{path}, the collider of {obj.name}, does not exist; bake it again")
    return relief_module().load(path)


def finer(vertices, triangles, longest):
    """Subdivides until no edge is longer than `longest` or there are 200,000 triangles: shows errors between vertices."""
    while len(triangles) < 200_000:
        corners = vertices[triangles]
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        if edges.max(initial=0) <= longest:
            break
        a, b, c = triangles.T
        n = len(vertices)
        pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
        unique, which = np.unique(pairs, axis=0, return_inverse=True)
        vertices = np.concatenate([vertices, 0.5 * (vertices[unique[:, 0]] + vertices[unique[:, 1]])]).astype(np.float32)
        ab, bc, ca = n + which.reshape(3, -1)
        triangles = np.concatenate([np.stack(f, axis=1) for f in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return vertices, triangles


def error_colors(distance, known, worst):
    """Blue: the mesh is inside the collider. Orange: outside. White: they agree. Pink: no map votes."""
    share = np.clip(np.abs(distance) / worst, 0, 1)[:, None] ** 0.45
    end = np.where(distance[:, None] < 0, np.array([[0.02, 0.14, 0.55]]), np.array([[0.65, 0.12, 0.01]]))
    colors = 0.9 * (1 - share) + end * share
    colors[~known] = (0.7, 0.35, 0.75)
    return np.concatenate([colors, np.ones((len(colors), 1))], axis=1).astype(np.float32)


def sheet_depth(collider):
    """Half the thickness of the shells of open parts: the distance from a part to the surface of its shell."""
    found = re.search(r"(?:^| )--thickness ([0-9.e+-]+)", collider.options)
    return 0.5 * float(found.group(1)) if found else 0.0


# --- operators

class ReliefOperator:
    """Reports a ReliefError, or an error of the package, instead of a traceback."""
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            return self.work(context)
        except ReliefError as error:
            self.report({"ERROR"}, str(error))
        except Exception as error:
            module = sys.modules.get("relief")
            if module is None or not isinstance(error, module.Error):
                raise
            self.report({"ERROR"}, str(error))
        return {"CANCELLED"}


class RELIEF_OT_bake(ReliefOperator, bpy.types.Operator):
    """Bake the active object, in world space and with its modifiers, into a .relief file"""
    bl_idname = "relief.bake"
    bl_label = "Bake collider"

    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"SKIP_SAVE"})

    def work(self, context):
        relief = relief_module()
        obj = chosen_object(context)
        settings = obj.relief
        path = self.filepath or settings.path or f"//{bpy.path.clean_name(obj.name)}.relief"
        if path.startswith("//") and not bpy.data.filepath:
            raise ReliefError("the collider is written beside the .blend file; save the .blend file first, or choose a file")
        vertices, triangles = world_mesh(context, obj)
        window = context.window_manager
        window.progress_begin(0, 1)
        try:
            collider = relief.bake(to_relief(vertices, settings.up), triangles, budget=int(1000 * settings.budget),
                                   thickness=settings.thickness or None, name=obj.name)
            collider.save(bpy.path.abspath(path))
            accuracy = relief.check(collider, to_relief(vertices, settings.up), triangles, samples=50_000)
        finally:
            window.progress_end()
        settings.path = path
        settings.wrong = accuracy.wrong_percent
        self.report({"INFO"}, f"{obj.name}: {len(collider.maps)} maps, {collider.gpu_bytes / 1000:.0f} kB, "
                              f"{accuracy.wrong_percent:.2g} % wrong near the surface")
        return {"FINISHED"}


class RELIEF_OT_show(ReliefOperator, bpy.types.Operator):
    """Colour a copy of the object by its distance to the collider, and mark the worst places"""
    bl_idname = "relief.show_errors"
    bl_label = "Show errors"

    def work(self, context):
        obj = chosen_object(context)
        collider = collider_of(obj)
        vertices, triangles = world_mesh(context, obj)
        bounds = np.asarray(collider.bounds)
        size = float((bounds[1] - bounds[0]).max())
        box = to_relief(vertices, obj.relief.up)
        off = max(np.abs(box.min(axis=0) - bounds[0]).max(), np.abs(box.max(axis=0) - bounds[1]).max())
        if off > 0.01 * size + sheet_depth(collider):
            raise ReliefError(f"{obj.name} was moved, scaled or edited after it was baked; bake it again")
        self.remove(obj)
        self.add_overlay(context, obj, collider, *finer(vertices, triangles, size / 150))
        self.add_places(context, obj, collider, vertices, triangles, size)
        return {"FINISHED"}

    @staticmethod
    def remove(obj):
        for other in list(bpy.data.objects):
            if other.get("relief_of") == obj.name:
                data = other.data
                bpy.data.objects.remove(other)
                if data is not None and data.users == 0:
                    bpy.data.meshes.remove(data)

    @staticmethod
    def add_overlay(context, obj, collider, vertices, triangles):
        depth = sheet_depth(collider)
        distance, _, which = collider.query(to_relief(vertices, obj.relief.up), distance="nearest")
        distance = np.where(distance < -0.5 * depth, distance + depth, distance)
        known = (which >= 0) & (np.abs(distance) < 1e29)
        worst = max(float(np.quantile(np.abs(distance[known]), 0.995)) if known.any() else 0.0, 1e-9)
        mesh = bpy.data.meshes.new(OVERLAY + obj.name)
        mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
        colors = mesh.color_attributes.new(COLOR, "FLOAT_COLOR", "POINT")
        colors.data.foreach_set("color", error_colors(distance, known, worst).ravel())
        mesh.color_attributes.active_color = colors
        errors = mesh.attributes.new("relief_distance", "FLOAT", "POINT")
        errors.data.foreach_set("value", np.where(known, distance, 0).astype(np.float32))
        mesh.materials.append(error_material())
        overlay = bpy.data.objects.new(OVERLAY + obj.name, mesh)
        overlay["relief_of"] = obj.name
        overlay["relief_range"] = worst
        context.scene.collection.objects.link(overlay)
        obj.hide_set(True)

    @staticmethod
    def add_places(context, obj, collider, vertices, triangles, size):
        accuracy = relief_module().check(collider, to_relief(vertices, obj.relief.up), triangles, samples=50_000)
        obj.relief.wrong = accuracy.wrong_percent
        for number, place in enumerate(accuracy.worst_places, 1):
            empty = bpy.data.objects.new(f"{PLACE}{number}: {place.contribution_percent:.1f} %, {place.cause}", None)
            empty.empty_display_type = "SPHERE"
            empty.empty_display_size = max(0.5 * place.size, 0.02 * size)
            empty.location = to_blender([place.position], obj.relief.up)[0].tolist()
            empty.show_name = True
            empty["relief_of"] = obj.name
            empty["why"] = CAUSES.get(place.cause, place.cause)
            context.scene.collection.objects.link(empty)


def error_material():
    material = bpy.data.materials.get(COLOR)
    if material is None:
        material = bpy.data.materials.new(COLOR)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        color = nodes.new("ShaderNodeVertexColor")
        color.layer_name = COLOR
        shader = nodes["Principled BSDF"]
        shader.inputs["Roughness"].default_value = 0.9
        shader.inputs["Specular"].default_value = 0.1
        material.node_tree.links.new(color.outputs["Color"], shader.inputs["Base Color"])
    return material


class RELIEF_OT_hide(ReliefOperator, bpy.types.Operator):
    """Remove the coloured copy and the marks, and show the object again"""
    bl_idname = "relief.hide_errors"
    bl_label = "Hide errors"

    def work(self, context):
        active = context.active_object
        # The active object or the object of the active overlay; without an active object, all.
        names = {active.get("relief_of", active.name)} if active else {one.get("relief_of") for one in bpy.data.objects}
        for obj in [bpy.data.objects[name] for name in sorted(names - {None}) if name in bpy.data.objects]:
            RELIEF_OT_show.remove(obj)
            obj.hide_set(False)
        return {"FINISHED"}


# --- particle caches: a folder of particles_0000.ply and so on, written by relief-sim --dump-frames

PLY = np.dtype([("position", "<f4", 3), ("velocity", "<f4", 3), ("age", "<f4"), ("lifetime", "<f4"), ("id", "<u4"),
                ("type", "<u4")])
HEADER = [b"property float " + name for name in (b"x", b"y", b"z", b"vx", b"vy", b"vz", b"age", b"lifetime")] + \
    [b"property uint id", b"property uint type"]


def read_particles(path):
    data = pathlib.Path(path).read_bytes()
    head, mark, body = data.partition(b"end_header\n")
    lines = head.split(b"\n")
    count = next((int(line.split()[2]) for line in lines if line.startswith(b"element vertex ")), None)
    if not mark or lines[0] != b"ply" or count is None or [line for line in lines if line.startswith(b"property")] != HEADER:
        raise ReliefError(f"{path} is not a particle file of relief-sim; write it with relief-sim --dump-frames")
    if len(body) != count * PLY.itemsize:
        raise ReliefError(f"{path} is truncated; write it again with relief-sim --dump-frames")
    return np.frombuffer(body, dtype=PLY)


def cache_files(folder):
    return sorted(str(path) for path in pathlib.Path(bpy.path.abspath(folder)).glob("particles_[0-9]*.ply"))


def show_frame(obj, frame):
    files = cache_files(obj.relief_cache.folder)
    if not files:
        raise ReliefError(f"{obj.relief_cache.folder} contains no particles_0000.ply; write it with relief-sim --dump-frames")
    cache = obj.relief_cache
    at = min(max((frame - cache.start) // max(cache.every, 1), 0), len(files) - 1)
    particles = read_particles(files[at])
    mesh = obj.data
    mesh.clear_geometry()
    mesh.vertices.add(len(particles))
    mesh.vertices.foreach_set("co", to_blender(particles["position"], cache.up).ravel())
    for name, kind, key, values in (("velocity", "FLOAT_VECTOR", "vector", to_blender(particles["velocity"], cache.up)),
                                    ("age", "FLOAT", "value", particles["age"]),
                                    ("lifetime", "FLOAT", "value", particles["lifetime"]),
                                    ("id", "INT", "value", particles["id"].astype(np.int32)),
                                    ("type", "INT", "value", particles["type"].astype(np.int32))):
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, kind, "POINT")
        attribute.data.foreach_set(key, np.ascontiguousarray(values).ravel())
    mesh.update()


@persistent
def follow_frames(scene, _graph=None):
    for obj in scene.objects:
        if obj.type == "MESH" and obj.relief_cache.folder:
            try:
                show_frame(obj, scene.frame_current)
            except (ReliefError, OSError) as error:
                obj.relief_cache.message = str(error)
            else:
                obj.relief_cache.message = ""


class RELIEF_OT_cache(ReliefOperator, bpy.types.Operator):
    """Play the particles of a folder written by relief-sim --dump-frames"""
    bl_idname = "relief.load_cache"
    bl_label = "Load particles"

    directory: StringProperty(subtype="DIR_PATH", options={"SKIP_SAVE"})
    up: EnumProperty(name="Up", items=[("Y", "Y", "As in most engines"), ("Z", "Z", "As in Blender")], default="Z")
    every: IntProperty(name="Frames per file", description="Number of Blender frames per file", default=1, min=1)

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def work(self, context):
        files = cache_files(self.directory)
        if not files:
            raise ReliefError(f"{self.directory} contains no particles_0000.ply; write it with relief-sim --dump-frames")
        read_particles(files[0])
        name = pathlib.Path(bpy.path.abspath(self.directory)).name or "particles"
        mesh = bpy.data.meshes.new(name)
        obj = bpy.data.objects.new(name, mesh)
        context.scene.collection.objects.link(obj)
        cache = obj.relief_cache
        cache.folder, cache.up, cache.every, cache.start = self.directory, self.up, self.every, context.scene.frame_current
        show_frame(obj, context.scene.frame_current)
        context.view_layer.objects.active = obj
        context.scene.frame_end = max(context.scene.frame_end, cache.start + len(files) * self.every - 1)
        self.report({"INFO"}, f"{name}: {len(files)} frames")
        return {"FINISHED"}


# --- settings and the panel

class ReliefSettings(bpy.types.PropertyGroup):
    path: StringProperty(name="File", subtype="FILE_PATH", description="Collider file (default: beside the .blend file)")
    budget: FloatProperty(name="kB", description="Size on the GPU in kB", default=1000, min=32, max=64000)
    thickness: FloatProperty(name="Thickness", description="Thickness of the shells of open parts; 0: chosen by the budget", default=0,
                             min=0, unit="LENGTH")
    up: EnumProperty(name="Up", items=[("Z", "Z", "As in Blender"), ("Y", "Y", "As in most engines")], default="Z")
    wrong: FloatProperty(default=-1, options={"HIDDEN"})


class ReliefCache(bpy.types.PropertyGroup):
    folder: StringProperty(name="Folder", subtype="DIR_PATH")
    up: EnumProperty(name="Up", items=[("Z", "Z", ""), ("Y", "Y", "")], default="Z")
    start: IntProperty(name="Start", description="Blender frame of the first file", default=1)
    every: IntProperty(name="Frames per file", default=1, min=1)
    message: StringProperty(options={"HIDDEN"})


class RELIEF_PT_panel(bpy.types.Panel):
    bl_label = "Relief"
    bl_idname = "RELIEF_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Relief"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        obj = context.active_object
        if obj is None:
            layout.label(text="Select an object")
        elif obj.type == "MESH" and obj.relief_cache.folder:
            for name in ("folder", "up", "start", "every"):
                layout.prop(obj.relief_cache, name)
            if obj.relief_cache.message:
                layout.label(text=obj.relief_cache.message, icon="ERROR")
        else:
            for name in ("path", "budget", "thickness", "up"):
                layout.prop(obj.relief, name)
            layout.operator(RELIEF_OT_bake.bl_idname, icon="MOD_PHYSICS")
            if obj.relief.wrong >= 0:
                layout.label(text=f"{obj.relief.wrong:.2g} % wrong near the surface",
                             icon="CHECKMARK" if obj.relief.wrong <= 1 else "ERROR")
            row = layout.row(align=True)
            row.operator(RELIEF_OT_show.bl_idname)
            row.operator(RELIEF_OT_hide.bl_idname)
            if "why" in obj:
                layout.label(text=obj["why"])
        layout.separator()
        layout.operator(RELIEF_OT_cache.bl_idname, icon="PARTICLES")


CLASSES = (ReliefSettings, ReliefCache, RELIEF_OT_bake, RELIEF_OT_show, RELIEF_OT_hide, RELIEF_OT_cache, RELIEF_PT_panel)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.relief = PointerProperty(type=ReliefSettings)
    bpy.types.Object.relief_cache = PointerProperty(type=ReliefCache)
    bpy.app.handlers.frame_change_post.append(follow_frames)


def unregister():
    bpy.app.handlers.frame_change_post.remove(follow_frames)
    del bpy.types.Object.relief_cache
    del bpy.types.Object.relief
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)


if __name__ == "__main__":
    register()
