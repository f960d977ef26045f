# SPDX-License-Identifier: Apache-2.0
# Queries points.bin on the GPU, plays particles, and reads hostile containers. Prints one line per finished part.
extends Node3D

const POINTS := 4096
const PARTICLES := 10000
const OPTIONS := {"radius_min": 0.01, "radius_max": 0.01, "restitution": 0.3, "friction": 0.1}


func _ready() -> void:
	var camera := Camera3D.new()
	add_child(camera)
	camera.position = Vector3(0, 0, 6)
	var begun := Time.get_ticks_msec()
	var collider: ReliefCollider = load("res://bunny.relief")
	print("loaded %d ms" % (Time.get_ticks_msec() - begun))
	_query(collider)
	for k in 5:
		await get_tree().process_frame
	print("queried")
	_play(collider)
	for snapshot in 3:
		for k in 10:
			await get_tree().process_frame
		print("played %d" % snapshot)


func _play(collider: ReliefCollider) -> void:
	var system := _system(collider, PARTICLES, load("res://addons/relief/relief_particles.gdshader"))
	system.position = Vector3(0, 2.4, 0)
	system.lifetime = 60.0
	system.fixed_fps = 60
	system.preprocess = 4.0
	system.process_material.set_shader_parameter("emission_box", Vector3(0.9, 1.2, 0.6))
	system.process_material.set_shader_parameter("gravity", Vector3(0, -2, 0))
	system.process_material.set_shader_parameter("floor_height", -1.0)
	for name in OPTIONS:
		system.process_material.set_shader_parameter(name, OPTIONS[name])


func _query(collider: ReliefCollider) -> void:
	var points := Image.create_from_data(64, POINTS / 64, false, Image.FORMAT_RGBAF,
			FileAccess.get_file_as_bytes("res://points.bin"))
	var system := _system(collider, POINTS, load("res://query.gdshader"))
	system.process_material.set_shader_parameter("points", ImageTexture.create_from_image(points))


func _system(collider: ReliefCollider, amount: int, shader: Shader) -> ReliefParticles:
	var material := ShaderMaterial.new()
	material.shader = shader
	var system := ReliefParticles.new()
	system.collider = collider
	system.amount = amount
	system.process_material = material
	system.explosiveness = 1.0
	system.draw_pass_1 = QuadMesh.new()
	system.visibility_aabb = AABB(Vector3.ONE * -100, Vector3.ONE * 200)
	add_child(system)
	return system
