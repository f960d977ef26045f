# SPDX-License-Identifier: Apache-2.0
# Loads OBJ files of triangles as meshes, as the editor's importer does for the demo.
class_name ObjLoader
extends ResourceFormatLoader


func _get_recognized_extensions() -> PackedStringArray:
	return ["obj"]


func _handles_type(type: StringName) -> bool:
	return type == &"Mesh"


func _get_resource_type(path: String) -> String:
	return "Mesh" if path.get_extension() == "obj" else ""


func _load(path: String, _original_path: String, _use_sub_threads: bool, _cache_mode: int) -> Variant:
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	tool.set_smooth_group(0)
	var vertices: PackedVector3Array = []
	for line in FileAccess.get_file_as_string(path).split("\n"):
		var words := line.split(" ", false)
		if words.size() == 4 and words[0] == "v":
			vertices.append(Vector3(float(words[1]), float(words[2]), float(words[3])))
		elif words.size() == 4 and words[0] == "f":
			for corner in [1, 3, 2]:
				tool.add_vertex(vertices[int(words[corner]) - 1])
	tool.generate_normals()
	return tool.commit()
