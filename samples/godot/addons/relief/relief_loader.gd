@tool
# SPDX-License-Identifier: Apache-2.0
## Loads `.relief` files as ReliefCollider, in the editor and in exported projects.
class_name ReliefLoader
extends ResourceFormatLoader


func _get_recognized_extensions() -> PackedStringArray:
	return ["relief"]


func _handles_type(type: StringName) -> bool:
	return type == &"Resource" or type == &"ReliefCollider"


func _get_resource_type(path: String) -> String:
	return "Resource" if path.get_extension() == "relief" else ""


func _get_resource_script_class(path: String) -> String:
	return "ReliefCollider" if path.get_extension() == "relief" else ""


func _load(path: String, _original_path: String, _use_sub_threads: bool, _cache_mode: int) -> Variant:
	var collider := ReliefCollider.new()
	var error := collider.parse(FileAccess.get_file_as_bytes(path))
	if error == "":
		return collider
	printerr("%s: %s" % [path, error])
	return ERR_FILE_CORRUPT
