@tool
# SPDX-License-Identifier: Apache-2.0
## Particles that collide with a collider. The shader of process_material includes relief_body.gdshaderinc.
class_name ReliefParticles
extends GPUParticles3D

## A `.relief` file.
@export var collider: ReliefCollider
## The node that carries the collider's mesh, with one scale for all axes. Empty: the world's origin.
@export var body: Node3D


func _process(_delta: float) -> void:
	var shader := process_material as ShaderMaterial
	if shader == null or collider == null or collider.texels == null:
		return
	var pose := body.global_transform if body != null else Transform3D.IDENTITY
	shader.set_shader_parameter("relief_pose", global_transform.affine_inverse() * pose if local_coords else pose)
	if shader.get_shader_parameter("relief_texels") != collider.texels:
		collider.apply(shader)
