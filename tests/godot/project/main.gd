# SPDX-License-Identifier: Apache-2.0
# Loads a container, reads hostile ones, evaluates points and plays particles. Prints results, and one line per part.
extends Node3D

const POINTS := 4096
const PLAYED := {
	"bounce": {"restitution": 0.4, "friction": 0.1},
	"rest": {"rest_on_contact": true},
	"free": {},  # with an empty collider
	"turned": {"restitution": 0.4, "friction": 0.1},  # the body is turned by 90 degrees, scaled and moved
	"again": {},  # each life lasts 0.4 s
}


func _ready() -> void:
	var camera := Camera3D.new()
	add_child(camera)
	camera.position.z = 6.0
	var begun := Time.get_ticks_msec()
	var collider: ReliefCollider = load("res://bunny.relief")
	print("loaded: ", Time.get_ticks_msec() - begun)
	_use_menu()
	_read_hostile()
	_evaluate(collider)
	_system(collider, 64, load("res://page.gdshader"))
	for frame in 4:
		await get_tree().process_frame
	_keep("points", POINTS)
	_keep("level", POINTS + 1)
	print("evaluated")
	for system: String in PLAYED:
		_play(collider, system)
	for snapshot in 3:
		for frame in 6:
			await get_tree().process_frame
		for system: String in PLAYED:
			_keep("%s %d" % [system, snapshot], _amount(system))
	print("end")


# Copies the particles of the system with this amount from the GPU, for the test.
func _keep(name_: String, amount: int) -> void:
	JavaScriptBridge.eval("keepParticles('%s', %d)" % [name_, amount], true)


func _amount(system: String) -> int:
	return 10000 + PLAYED.keys().find(system)


# Chooses the plugin's menu item for a mesh. The template starts no programs, so that the bake fails.
func _use_menu() -> void:
	var plugin: EditorPlugin = load("res://addons/relief/plugin.gd").new()
	add_child(plugin)
	var menu: EditorContextMenuPlugin = plugin.menus[0]
	menu.call("_popup_menu", ["res://main.tscn"])
	print("menu: ", menu.items.keys())
	menu.call("_popup_menu", ["res://main.tscn", "res://rock.glb"])
	print("menu: ", menu.items.keys())
	menu.items["Bake Relief collider"].call(["res://rock.glb"])
	plugin.free()


func _read_hostile() -> void:
	for file in DirAccess.get_files_at("res://hostile"):
		print("file: ", file, " ", load("res://hostile/" + file) == null)
	var good := FileAccess.get_file_as_bytes("res://small.relief")
	var original := ReliefCollider.new()
	print("good: ", original.parse(good))
	print("constants: ", _constants(original))
	for length in [0, 1, 11, 12, 63, 64, 65, 200, good.size() / 2, good.size() - 64, good.size() - 1]:
		_report("truncated", good.slice(0, length))
	_report("longer", good + PackedByteArray([0]))
	for at in good.size():
		var flipped := good.duplicate()
		flipped[at] ^= 1 << at % 8
		_report("flipped", flipped)
	# Random changes with valid checksums: the test compares each verdict with that of `relief check`.
	var random := RandomNumberGenerator.new()
	random.seed = 1
	for i in 300:
		var changed := good.duplicate()
		var texels := changed.decode_s64(40) + 64
		for change in 1 if i % 3 == 0 else random.randi_range(1, 3):
			var at := random.randi_range(64, texels - 1) if i % 3 == 0 else random.randi_range(texels, changed.size() - 1)
			changed[at] ^= 1 << random.randi_range(0, 7)
		_sign(changed)
		var collider := ReliefCollider.new()
		var error := collider.parse(changed)
		print("changed: ", error, "|", _constants(collider), "|", Marshalls.raw_to_base64(changed))
	print("hostile")


func _constants(collider: ReliefCollider) -> String:
	return str(collider.rows, collider.size, collider.place)


func _report(kind: String, data: PackedByteArray) -> void:
	print(kind, ": ", ReliefCollider.new().parse(data))


# Writes the checksums of the metadata, of the payload, and of the header.
func _sign(data: PackedByteArray) -> void:
	var size := data.decode_s64(40)
	var begin := (64 + size + 63) / 64 * 64
	var original := FileAccess.get_file_as_bytes("res://small.relief")
	for at in range(64, 64 + size - 7):
		if original.decode_s64(at) == ReliefCollider.Checksum.xxh3(original, begin, original.size() - begin):
			data.encode_s64(at, ReliefCollider.Checksum.xxh3(data, begin, data.size() - begin))
	data.encode_s64(48, ReliefCollider.Checksum.xxh3(data, 64, size))
	data.encode_s64(56, ReliefCollider.Checksum.xxh3(data, 0, 56))


func _evaluate(collider: ReliefCollider) -> void:
	var points := Image.create_from_data(64, POINTS / 64, false, Image.FORMAT_RGBAF,
			FileAccess.get_file_as_bytes("res://points.bin"))
	var system := _system(collider, POINTS, load("res://query.gdshader"))
	system.process_material.set_shader_parameter("points", ImageTexture.create_from_image(points))
	var level := _system(collider, POINTS + 1, load("res://level.gdshader"))
	level.process_material.set_shader_parameter("points", ImageTexture.create_from_image(points))
	_upload(level, "texels", 2048, Image.FORMAT_RGBA16I, 8)
	_upload(level, "bodies", 3584, Image.FORMAT_RGBA16I, 8)
	_upload(level, "cells", 2048, Image.FORMAT_RG16I, 4)


# A texture of an exported level.
func _upload(system: ReliefParticles, name_: String, width: int, format: Image.Format, texel: int) -> void:
	var data := FileAccess.get_file_as_bytes("res://level." + name_)
	var image := Image.create_from_data(width, data.size() / (width * texel), false, format, data)
	system.process_material.set_shader_parameter("u_" + name_, ImageTexture.create_from_image(image))


# Particles fall from a box above the bunny. In the first frame, a second has passed.
func _play(collider: ReliefCollider, name_: String) -> void:
	var shader: Shader = load("res://addons/relief/relief_particles.gdshader")
	if name_ == "free":
		var empty := ReliefCollider.new()
		empty.texels = collider.texels
		collider = empty
	var system := _system(collider, _amount(name_), shader)
	if name_ == "turned":
		system.body = Node3D.new()
		system.body.transform = Transform3D(Basis(Vector3.UP, PI / 2).scaled(Vector3.ONE * 0.8), Vector3(0.1, 0, 0))
		add_child(system.body)
	system.position.y = 2.4
	system.lifetime = 0.4 if name_ == "again" else 60.0
	system.fixed_fps = 60
	system.preprocess = 1.0
	system.use_fixed_seed = true
	system.seed = 1
	var options := {"emission_box": Vector3(0.9, 1.2, 0.6), "floor_height": -1.0, "gravity": Vector3(0, -2, 0)}
	options.merge(PLAYED[name_])
	for option: String in options:
		system.process_material.set_shader_parameter(option, options[option])


func _system(collider: ReliefCollider, amount: int, shader: Shader) -> ReliefParticles:
	var system := ReliefParticles.new()
	system.collider = collider
	system.amount = amount
	system.process_material = ShaderMaterial.new()
	system.process_material.shader = shader
	system.explosiveness = 1.0
	system.draw_pass_1 = PointMesh.new()
	system.visibility_aabb = AABB(Vector3.ONE * -100.0, Vector3.ONE * 200.0)
	add_child(system)
	return system
