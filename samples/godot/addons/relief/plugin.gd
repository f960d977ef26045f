@tool
# SPDX-License-Identifier: Apache-2.0
## Adds "Bake Relief collider" to the menu of mesh files in the FileSystem dock.
extends EditorPlugin

var _menu := BakeMenu.new()


func _enter_tree() -> void:
	add_context_menu_plugin(EditorContextMenuPlugin.CONTEXT_SLOT_FILESYSTEM, _menu)


func _exit_tree() -> void:
	remove_context_menu_plugin(_menu)


class BakeMenu extends EditorContextMenuPlugin:
	func _popup_menu(paths: PackedStringArray) -> void:
		for path in paths:
			if path.get_extension().to_lower() in ["glb", "gltf", "obj", "fbx", "stl", "ply"]:
				add_context_menu_item("Bake Relief collider", _bake)
				return

	## Runs `relief bake MESH -o MESH.relief` beside each mesh.
	func _bake(paths: Array) -> void:
		for path: String in paths:
			var output := path.get_basename() + ".relief"
			var lines := []
			var words := ["bake", ProjectSettings.globalize_path(path), "-o", ProjectSettings.globalize_path(output)]
			if OS.execute("relief", PackedStringArray(words), lines, true) != 0:
				push_error("%s: relief bake failed: %s" % [path, "".join(lines).strip_edges()])
			EditorInterface.get_resource_filesystem().update_file(output)
