# SPDX-License-Identifier: Apache-2.0
# The template has no editor classes. These stand-ins compile and run plugin.gd.
class_name EditorPlugin
extends Node

var menus: Array[EditorContextMenuPlugin] = []


func add_context_menu_plugin(_slot: int, menu: EditorContextMenuPlugin) -> void:
	menus.append(menu)


func remove_context_menu_plugin(menu: EditorContextMenuPlugin) -> void:
	menus.erase(menu)
