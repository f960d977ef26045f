# SPDX-License-Identifier: Apache-2.0
class_name EditorInterface
extends RefCounted


static func get_resource_filesystem() -> EditorInterface:
	return EditorInterface.new()


func update_file(path: String) -> void:
	print("updated: ", path)
