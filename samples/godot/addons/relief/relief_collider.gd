@tool
# SPDX-License-Identifier: Apache-2.0
## A collider from a `.relief` container: a texture and constants for relief.gdshaderinc.
class_name ReliefCollider
extends Resource

const Checksum := preload("relief_checksum.gd")
const TEXELS_MAX := 1 << 24

## 2048 texels wide, four unsigned 16-bit integers per texel.
var texels: ImageTexture
## Rows of the transform from object space to map space.
var rows: Array[Vector4] = [Vector4(), Vector4(), Vector4()]
## x: size of a root cell in object units; y, z, w: numbers of root cells.
var size: Vector4
## Position of the tree in the texture, its strides and levels, as in relief.gdshaderinc.
var place: Vector4i

var _data: PackedByteArray
var _damaged := false


## Sets the uniforms of relief_body.gdshaderinc.
func apply(material: ShaderMaterial) -> void:
	material.set_shader_parameter("relief_texels", texels)
	for i in 3:
		material.set_shader_parameter("relief_row_" + "xyz"[i], rows[i])
	material.set_shader_parameter("relief_size", size)
	material.set_shader_parameter("relief_place", place)


## Reads a container. Returns an error, or ""; after an error, the collider is unusable.
func parse(data: PackedByteArray) -> String:
	_data = data
	var error := _check_header()
	error = _read_metadata() if error == "" else error
	_data = PackedByteArray()
	return error


func _check_header() -> String:
	if _data.size() < 64 or _data.slice(0, 12).hex_encode() != "ab52454c494546bb0d0a1a0a":
		return "is not a Relief container"
	if _data.decode_u16(12) != 2:
		return "has version %d, not 2; bake it again" % _data.decode_u16(12)
	if Checksum.xxh3(_data, 0, 56) != _data.decode_s64(56) or \
			[_data.decode_u32(16), _data.decode_u32(20), _data.decode_s64(32)] != [64, 0, 64]:
		return "has a damaged header"
	if _data.decode_s64(24) != _data.size():
		return "has %d bytes, not %d; copy it again" % [_data.size(), _data.decode_s64(24)]
	var length := _data.decode_s64(40)
	if length <= 16 or length > mini(1 << 24, _data.size() - 64) or \
			Checksum.xxh3(_data, 64, length) != _data.decode_s64(48) or _data.decode_u32(68) != 0x32464C52:
		return "has damaged metadata"
	return ""


# Returns an unsigned number, or 0 if it lies outside of the metadata and the payload.
func _number(at: int, bytes: int) -> int:
	_damaged = _damaged or at < 64 or at + bytes > _data.size()
	return 0 if _damaged else _data.decode_u32(at) if bytes == 4 else _data.decode_u16(at) if bytes == 2 else _data[at]


# Returns the position of a field of a FlatBuffers table, or 0 if it is absent.
func _field(table: int, index: int) -> int:
	var begin := _number(table, 4)
	var fields := table - (begin if begin < 1 << 31 else begin - (1 << 32))
	var offset := _number(fields + 4 + 2 * index, 2) if 6 + 2 * index <= _number(fields, 2) else 0
	return table + offset if offset > 0 else 0


func _value(table: int, index: int, bytes: int) -> int:
	var at := _field(table, index)
	return _number(at, bytes) if at > 0 else 0


# Returns the numbers of a field, which must be finite. An absent field has position 0, which fails the check.
func _floats(at: int, count: int) -> PackedFloat32Array:
	_number(at + 4 * count - 4, 4)
	var values := PackedFloat32Array() if _damaged else _data.slice(at, at + 4 * count).to_float32_array()
	values.resize(count)
	for value in values:
		_damaged = _damaged or not is_finite(value)
	return values


func _read_metadata() -> String:
	var root := 64 + _number(64, 4)
	var low := _floats(_field(root, 0), 3)
	var high := _floats(_field(root, 1), 3)
	var maps := _field(root, 4)
	maps += _number(maps, 4)
	var count := _number(maps, 4)
	if not _damaged and count != 1:
		return "has %d maps; bake it again without --map and --paper" % count
	var map := maps + 4 + _number(maps + 4, 4)
	if not _damaged and (_value(map, 0, 1) != 5 or _value(map, 10, 1) != 1):
		return "has a map of another kind than patches; bake it again without --map and --paper"
	if _value(map, 8, 1) != 0:
		return "is compressed; bake it again with --compress 0"
	var transform := _floats(_field(map, 4), 12)
	var scale := _floats(_field(map, 5), 3)
	var payload := _field(map, 9)
	_number(payload + 28, 4)
	var bytes := _value(map, 2, 4) * _value(map, 3, 4) * 8
	for i in 3:
		rows[i] = Vector4(transform[4 * i], transform[4 * i + 1], transform[4 * i + 2], transform[4 * i + 3])
		var row := Vector3(rows[i].x, rows[i].y, rows[i].z)
		var other := Vector3(transform[(4 * i + 4) % 12], transform[(4 * i + 5) % 12], transform[(4 * i + 6) % 12])
		_damaged = _damaged or absf(row.length() * scale[i] - 1.0) > 0.001 or scale[i] != scale[0] or \
				absf(row.dot(other)) > 0.0001 * row.length() * other.length() or high[i] < low[i]
	_damaged = _damaged or _value(map, 2, 4) > 16384 or _value(map, 3, 4) > 16384
	return "has damaged metadata" if _damaged else _read_payload(payload, bytes, scale[0])


func _read_payload(payload: int, bytes: int, edge: float) -> String:
	var end := 64 + _data.decode_s64(40)
	var begin := (end + 63) / 64 * 64
	if [_data.decode_s64(payload), _data.decode_s64(payload + 8), _data.decode_s64(payload + 16), _data.size()] != \
			[begin, bytes, bytes, begin + bytes] or _data.slice(end, begin).count(0) != begin - end:
		return "has a damaged payload"
	if bytes <= 16 or bytes > 8 * TEXELS_MAX:
		return "has %d texels; only 3 to %d are supported" % [bytes / 8, TEXELS_MAX]
	if Checksum.xxh3(_data, begin, bytes) != _data.decode_s64(payload + 24):
		return "has damaged texels"
	var tree := _data.slice(begin)
	if not _is_tree(tree):
		return "has a damaged tree of patches"
	size = Vector4(edge, tree.decode_u16(0), tree.decode_u16(2), tree.decode_u16(4))
	place = Vector4i(0, tree.decode_u16(0), tree.decode_u16(0) * tree.decode_u16(2), tree.decode_u16(6))
	var height := (bytes / 8 + 2047) / 2048
	tree.resize(height * 2048 * 8)
	texels = ImageTexture.create_from_image(Image.create_from_data(2048, height, false, Image.FORMAT_RGBA16I, tree))
	return ""


# Returns true if no record refers backwards or to a texel outside of the tree, so that every query ends.
static func _is_tree(tree: PackedByteArray) -> bool:
	var count := tree.size() / 8
	var end := 1 + tree.decode_u16(0) * tree.decode_u16(2) * tree.decode_u16(4)
	var levels := tree.decode_u16(6)
	var at := 1
	var valid := end > 1 and end <= count and levels <= 15
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
	for first in patches:
		var pair := tree.decode_u32(8 * first) & 15 == 15
		var start := tree.decode_u32(8 * first + 4) & 0xFFFFFF if pair else first
		valid = valid and (not pair or start >= end and start + 2 <= count)
		for at_patch in range(start, start + 2 if pair else start + 1) if valid else []:
			var record := tree.decode_u32(8 * at_patch)
			var kind := record >> 2 & 3
			var heights := tree.decode_u32(8 * at_patch + 4) & 0xFFFFFF
			valid = valid and record & 3 == 3 and kind < 3 and record >> 5 & 3 < 3 and record >> 7 & 3 < 3 and \
					(kind == 0 or heights >= end and heights + 2 * kind - 1 <= count)
	return valid
