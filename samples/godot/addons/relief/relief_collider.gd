@tool
# SPDX-License-Identifier: Apache-2.0
## A collider from a `.relief` container: a texture and constants for relief.gdshaderinc.
class_name ReliefCollider
extends Resource

const Checksum := preload("relief_checksum.gd")
const LIMIT := 1 << 24  # texels

## 2048 texels wide, four unsigned 16-bit integers per texel.
var texels: ImageTexture
## Rows of the transform from object space to map space.
var rows: Array[Vector4]
## x: size of a root cell in object units; y, z, w: numbers of root cells.
var size: Vector4
## Place and steps of the tree in the texture, as in relief.gdshaderinc.
var place: Vector4i
## Bounds of the mesh in object space.
var bounds: AABB

var _data: PackedByteArray
var _error := ""


## Sets the uniforms of relief_body.gdshaderinc.
func apply(material: ShaderMaterial) -> void:
	material.set_shader_parameter("relief_texels", texels)
	for i in 3:
		material.set_shader_parameter("relief_row_" + "xyz"[i], rows[i])
	material.set_shader_parameter("relief_size", size)
	material.set_shader_parameter("relief_place", place)


## Reads a container. Returns "", or what is wrong with it; the collider is then unusable.
func parse(data: PackedByteArray) -> String:
	_data = data
	_error = ""
	_read()
	_data = PackedByteArray()
	return _error


func _check(condition: bool, error: String) -> bool:
	if _error == "" and not condition:
		_error = error
	return _error == ""


# Unsigned numbers of the metadata, which is followed by the payload. Out of range: sets the error, returns 0.
func _number(at: int, bytes: int) -> int:
	if not _check(at >= 64 and at + bytes <= _data.size(), "has damaged metadata"):
		return 0
	return _data.decode_u32(at) if bytes == 4 else _data.decode_u16(at) if bytes == 2 else _data[at]


func _floats(at: int, count: int) -> PackedFloat32Array:
	_number(at + 4 * count - 4, 4)
	var values := _data.slice(at, at + 4 * count).to_float32_array() if _error == "" else PackedFloat32Array()
	values.resize(count)
	for value in values:
		_check(is_finite(value), "has a transform or bounds that are not finite")
	return values


# Returns the position of a field of a FlatBuffers table, or 0 if it is absent.
func _field(table: int, index: int, required := true) -> int:
	var fields := table - _data.decode_s32(table) if _number(table, 4) + 1 > 0 and _error == "" else 0
	var offset := _number(fields + 4 + 2 * index, 2) if 6 + 2 * index <= _number(fields, 2) else 0
	_check(offset > 0 or not required, "has no field %d in its metadata" % index)
	return table + offset if offset > 0 else 0


func _byte(table: int, index: int) -> int:
	var at := _field(table, index, false)
	return _number(at, 1) if at > 0 else 0


func _read() -> void:
	if not _check(_data.size() >= 64 and _data.slice(0, 12).hex_encode() == "ab52454c494546bb0d0a1a0a",
			"is not a Relief container") or not _check(_data.decode_u16(12) == 2,
			"has version %d, not 2; bake it again" % _data.decode_u16(12)):
		return
	var length := _data.decode_s64(40)
	if not _check(Checksum.xxh3(_data, 0, 56) == _data.decode_s64(56) and _data.decode_u32(16) == 64 and
			_data.decode_u32(20) == 0 and _data.decode_s64(32) == 64, "has a damaged header") or not _check(
			_data.decode_s64(24) == _data.size(), "has %d bytes, not %d; copy it again" % [_data.size(),
			_data.decode_s64(24)]) or not _check(length > 16 and length <= mini(1 << 24, _data.size() - 64) and
			Checksum.xxh3(_data, 64, length) == _data.decode_s64(48), "has damaged metadata"):
		return
	var root := 64 + _number(64, 4)
	_check(_number(68, 4) == 0x32464C52, "has metadata of another kind")
	var low := _floats(_field(root, 0), 3)
	var extent := _floats(_field(root, 1), 3)
	var maps := _field(root, 4)
	maps += _number(maps, 4)
	var count := _number(maps, 4)
	_check(count == 1, "has %d maps; bake it again without --map and --paper" % count)
	var map := maps + 4 + _number(maps + 4, 4)
	_check(_byte(map, 0) == 5 and _byte(map, 10) == 1, "has a map of another kind than patches; " +
			"bake it again without --map and --paper")
	_check(_byte(map, 8) == 0, "is compressed; bake it again with --compress 0")
	var transform := _floats(_field(map, 4), 12)
	var scale := _floats(_field(map, 5), 3)
	var payload := _field(map, 9)
	_number(payload + 28, 4)
	var bytes := _number(_field(map, 2), 4) * _number(_field(map, 3), 4) * 8
	if _error != "":
		return
	var begin := _data.decode_s64(payload)
	if not _check(begin == (64 + length + 63) / 64 * 64 and begin <= _data.size() and bytes == _data.size() - begin and
			bytes == _data.decode_s64(payload + 8) and bytes == _data.decode_s64(payload + 16) and
			_data.slice(64 + length, begin).count(0) == begin - 64 - length, "has a damaged payload") or not _check(
			bytes > 16 and bytes <= 8 * LIMIT, "has %d texels; only 3 to %d are supported" % [bytes / 8, LIMIT]) or \
			not _check(Checksum.xxh3(_data, begin, bytes) == _data.decode_s64(payload + 24), "has damaged texels"):
		return
	for i in 3:
		rows.append(Vector4(transform[4 * i], transform[4 * i + 1], transform[4 * i + 2], transform[4 * i + 3]))
		var along := Vector3(rows[i].x, rows[i].y, rows[i].z).length()
		_check(absf(along * scale[i] - 1.0) < 0.001 and scale[i] == scale[0] and extent[i] >= low[i],
				"has a transform that is not a rotation and a scale")
	bounds = AABB(Vector3(low[0], low[1], low[2]), Vector3(extent[0] - low[0], extent[1] - low[1], extent[2] - low[2]))
	_check_tree(_data.slice(begin), scale[0])


# Checks that no record refers to a texel outside of the tree, or backwards, so that every query ends.
func _check_tree(tree: PackedByteArray, edge: float) -> void:
	var count := tree.size() / 8
	var x := tree.decode_u16(0)
	var y := tree.decode_u16(2)
	var roots := x * y * tree.decode_u16(4)
	var levels := tree.decode_u16(6)
	var at := 1
	var end := 1 + roots
	var valid := roots > 0 and end <= count and levels <= 15
	var patches: PackedInt32Array = []
	var level := 0
	while valid and at < end:
		var next := end
		while valid and at < end:
			var record := tree.decode_u32(8 * at)
			var link := tree.decode_u32(8 * at + 4)
			if record & 3 == 2:
				valid = level < levels and link & 0xFFFFFF == next
				for octant in 8:
					next += record >> (2 + octant) & 1
				valid = valid and next <= count
			elif record & 3 == 3:
				patches.append(at)
			else:
				valid = record >> 16 & 0xFF != 0xFF and record >> 24 != 0xFF and link & 0x7F800000 != 0x7F800000
			at += 1
		end = next
		level += 1
	for first in patches if valid else PackedInt32Array():
		var pair := tree.decode_u32(8 * first) & 15 == 15
		var start := tree.decode_u32(8 * first + 4) & 0xFFFFFF if pair else first
		valid = valid and (not pair or start >= end and start + 2 <= count)
		for i in (2 if pair else 1) if valid else 0:
			var record := tree.decode_u32(8 * (start + i))
			var kind := record >> 2 & 3
			var heights := tree.decode_u32(8 * (start + i) + 4) & 0xFFFFFF
			valid = valid and record & 3 == 3 and kind < 3 and record >> 5 & 3 < 3 and record >> 7 & 3 < 3 and \
					(kind == 0 or heights >= end and heights + (1 if kind == 1 else 3) <= count)
	if not _check(valid, "has a damaged tree of patches"):
		return
	var height := (count + 2047) / 2048
	var rest: PackedByteArray = []
	rest.resize(height * 2048 * 8 - tree.size())
	rest.fill(0)
	tree.append_array(rest)
	texels = ImageTexture.create_from_image(Image.create_from_data(2048, height, false, Image.FORMAT_RGBA16I, tree))
	size = Vector4(edge, x, y, roots / (x * y))
	place = Vector4i(0, x, x * y, levels)
