# SPDX-License-Identifier: Apache-2.0
class_name EditorContextMenuPlugin
extends RefCounted

enum { CONTEXT_SLOT_SCENE_TREE, CONTEXT_SLOT_FILESYSTEM }

var items := {}


func add_context_menu_item(text: String, callback: Callable, _icon: Texture2D = null) -> void:
	items[text] = callback
