# SPDX-License-Identifier: Apache-2.0
## XXH3-64 with seed 0, the checksum of a container. Integers are signed; shift() and fold() compute unsigned results.
extends Object

const SECRET := "b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671fcb79e64eccc0e578825ad07dccff7221" + \
		"b8084674f743248ee03590e6813a264c3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8" + \
		"a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364eac5ac8334d3ebc3c581a0fffa1363eb" + \
		"170ddd51b7f0da49d316552629d4689e2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e"
const P32 := [0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D]
const P64 := [-0x61C8864E7A143579, -0x3D4D51C2D82B14B1, 0x165667B19E3779F9, -0x7A1435883D4D519D, 0x27D4EB2F165667C5]
const WORD := 0xFFFFFFFF


static func shift(value: int, bits: int) -> int:
	return (value & 0x7FFFFFFFFFFFFFFF) >> bits | (1 << (63 - bits) if value < 0 else 0)


## The two halves of the 128-bit product, combined by XOR.
static func fold(a: int, b: int) -> int:
	var middle := shift(a, 32) * (b & WORD)
	var cross := shift((a & WORD) * (b & WORD), 32) + (middle & WORD) + (a & WORD) * shift(b, 32)
	return (shift(middle, 32) + shift(cross, 32) + shift(a, 32) * shift(b, 32)) ^ (a * b)


static func avalanche(value: int) -> int:
	value = (value ^ shift(value, 37)) * 0x165667919E3779F9
	return value ^ shift(value, 32)


## The checksum of size > 16 bytes of `data` from `at`, which must lie within it.
static func xxh3(data: PackedByteArray, at: int, size: int) -> int:
	var secret := SECRET.hex_decode()
	var mix := func(from: int, key: int) -> int:
		return fold(data.decode_s64(at + from) ^ secret.decode_s64(key),
				data.decode_s64(at + from + 8) ^ secret.decode_s64(key + 8))
	var sum: int = size * P64[0]
	if size <= 128:
		for i in (size - 1) / 32 + 1:
			sum += mix.call(16 * i, 32 * i) + mix.call(size - 16 * i - 16, 32 * i + 16)
		return avalanche(sum)
	if size <= 240:
		for i in size / 16:
			sum = avalanche(sum) if i == 8 else sum
			sum += mix.call(16 * i, 16 * i if i < 8 else 16 * i - 125)
		return avalanche((avalanche(sum) if size < 144 else sum) + mix.call(size - 16, 119))
	var lanes: Array[int] = [P32[2], P64[0], P64[1], P64[2], P64[3], P32[1], P64[4], P32[0]]
	var stripes := (size - 1) / 64
	for stripe in stripes + 1:
		var from := at + (64 * stripe if stripe < stripes else size - 64)
		var key := 8 * (stripe % 16) if stripe < stripes else 121
		for lane in 8:
			var i := 8 * lane
			var low := data.decode_u32(from + i) ^ secret.decode_u32(key + i)
			lanes[lane ^ 1] += data.decode_s64(from + i)
			lanes[lane] += low * (data.decode_u32(from + i + 4) ^ secret.decode_u32(key + i + 4))
		if stripe % 16 == 15 and stripe < stripes:
			for lane in 8:
				lanes[lane] = (lanes[lane] ^ shift(lanes[lane], 47) ^ secret.decode_s64(128 + 8 * lane)) * P32[0]
	for i in 4:
		sum += fold(lanes[2 * i] ^ secret.decode_s64(11 + 16 * i), lanes[2 * i + 1] ^ secret.decode_s64(19 + 16 * i))
	return avalanche(sum)
