// SPDX-License-Identifier: Apache-2.0
// Reads a container: formats/README.md, "Bytes" and "Validation".
import { bytesOf, check, isPlainText, viewOf } from "./bytes.js";
import { validateMaterials } from "./materials.js";
import { readMetadata } from "./metadata.js";
import { treeSize, validateTree } from "./patches.js";
import { unpack } from "./zstd.js";
import { xxh3 } from "./xxh3.js";

const kSignature = [0xab, 0x52, 0x45, 0x4c, 0x49, 0x45, 0x46, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];
const kHeader = 64;
const kMetadataMax = 16 << 20;
const kTextureWidth = 2048;
const kFormats = ["float32", "fixed8", "front-back of halfs", "cube", "front-back", "patches"];
const kPatches = 5;
const kMapSizeMax = 16384;
const kPayloadMax = 8 * 2 ** 24;
const kUnpackedMax = 64 * 2 ** 20; // every compressed container may unpack to this many bytes
const kUnpackedPerStored = 16; // larger containers may unpack to this multiple of their size
const kZstdRatioMax = 32768;
const kCosineMax = 1e-4; // between rows of the transform
const kLengthTolerance = 1e-3; // of objectPerMap
const kTextMax = { unit: 16, mesh_name: 255, tool_version: 64, options: 1 << 20 };

const floatsOf = (view) => Array.from({ length: view.byteLength / 4 }, (_, i) => view.getFloat32(4 * i, true));

function checkText(name, view) {
    check(view.byteLength <= kTextMax[name] && isPlainText(view),
          `${name} has more than ${kTextMax[name]} bytes, or is not UTF-8 without control characters`);
}

/** @returns the header's metadata size */
function checkHeader(bytes, view) {
    check(bytes.length >= kHeader, `${bytes.length} bytes, but a header has ${kHeader}; is this a .relief file?`);
    check(kSignature.every((byte, i) => bytes[i] === byte), "not a .relief container; bake the mesh with `relief bake`");
    const [major, minor] = [view.getUint16(12, true), view.getUint16(14, true)];
    check(major === 2, `container version ${major}.${minor}; this reader supports version 2: bake the mesh again`);
    const long = (at) => Number(view.getBigUint64(at, true));
    check(view.getBigUint64(56, true) === xxh3(bytes.subarray(0, 56)),
          "the checksum of the header does not match; copy the file again");
    check(view.getUint32(16, true) === kHeader && view.getUint32(20, true) === 0 && long(32) === kHeader,
          "header_size, reserved or metadata_offset is not that of version 2");
    check(long(24) <= bytes.length, `truncated: ${bytes.length} of ${long(24)} bytes; copy the file again`);
    check(long(24) === bytes.length,
          `${bytes.length - long(24)} bytes more than stated in the header; copy the file again`);
    check(long(40) <= Math.min(kMetadataMax, bytes.length - kHeader),
          `the metadata of ${long(40)} bytes exceeds the file or 16 MiB`);
    return long(40);
}

function checkDescription({ boundsMin, boundsMax, unit, provenance, materials }, decompress) {
    const [low, high] = [floatsOf(boundsMin), floatsOf(boundsMax)];
    check([...low, ...high].every(Number.isFinite) && low.every((from, i) => from <= high[i]),
          "bounds are not finite, or their minimum exceeds their maximum");
    checkText("unit", unit);
    checkText("mesh_name", provenance.meshName);
    check(!bytesOf(provenance.meshName).includes(0x2f), "mesh_name contains '/': it must be a name without a folder");
    const hash = bytesOf(provenance.meshHash);
    check([0, 32].includes(hash.length) && hash.every((byte) => "0123456789abcdef".includes(String.fromCharCode(byte))),
          "mesh_hash is neither empty nor 32 lower-case hexadecimal digits");
    checkText("tool_version", provenance.toolVersion);
    const texts = (provenance.options ?? []).flatMap(({ name, value }) => [name, value]);
    const size = texts.reduce((sum, text) => sum + text.byteLength, 0);
    check(size <= kTextMax.options, `the options take ${size} bytes; at most ${kTextMax.options} are allowed`);
    const all = new Uint8Array(size);
    texts.reduce((at, text) => (all.set(bytesOf(text), at), at + text.byteLength), 0);
    checkText("options", new DataView(all.buffer));
    if (materials) {
        validateMaterials(materials, decompress);
    }
    return { min: low, max: high };
}

/** @returns the floats of the transform, and the edge of a root cell */
function checkFrame({ format, compare, decode, width, height, objectToMap, objectPerMap }) {
    check(format < kFormats.length, `map 0: its format ${format} is unknown`);
    check(format === kPatches,
          `unsupported: a map of format ${kFormats[format]}; bake again without --map and --paper`);
    check(compare < 2 && decode === 1, "map 0: its compare or decode is not that of patches");
    check(width >= 1 && height >= 1 && width <= kMapSizeMax && height <= kMapSizeMax,
          `map 0: its size ${width}x${height} is not in 1x1 to ${kMapSizeMax}x${kMapSizeMax}`);
    const transform = floatsOf(objectToMap);
    check(transform.every(Number.isFinite), "map 0: object_to_map is not finite");
    const rows = [0, 4, 8].map((at) => transform.slice(at, at + 3));
    const lengths = rows.map(([x, y, z]) => Math.sqrt(x * x + y * y + z * z));
    check(lengths.every((length) => length > 0), "map 0: a row of object_to_map is zero");
    const cosine = (a, b) => rows[a].reduce((sum, x, i) => sum + (x / lengths[a]) * (rows[b][i] / lengths[b]), 0);
    check([0, 1, 2].every((i) => Math.abs(cosine(i, (i + 1) % 3)) <= kCosineMax),
          "map 0: object_to_map is not a rotation with scale");
    const [root, ...others] = floatsOf(objectPerMap);
    check(root > 0 && Number.isFinite(root) && others.every((other) => other === root),
          "map 0: object_per_map is not uniform, positive and finite");
    check(lengths.every((length) => Math.abs(root - 1 / length) <= kLengthTolerance / length),
          "map 0: object_per_map does not match object_to_map");
    return { transform, root };
}

/** Returns the texels of the only map. end: of the metadata. */
function readPayload(bytes, end, { width, height, compression, payload }, decompress) {
    const [offset, stored, raw] = [0, 8, 16].map((at) => Number(payload.getBigUint64(at, true)));
    check(compression < 2, `map 0: its compression ${compression} is unknown`);
    check(raw === 8 * width * height,
          `map 0: its raw_size is ${raw}, but its size and format require ${8 * width * height} bytes`);
    check(compression === 0 ? stored === raw : stored < raw && Math.floor(raw / kZstdRatioMax) <= stored,
          `map 0: its stored_size ${stored} does not match its raw_size ${raw} and its compression`);
    check(raw <= kPayloadMax && (compression === 0 || raw <= Math.max(kUnpackedMax, kUnpackedPerStored * bytes.length)),
          `map 0: its ${raw} bytes exceed the limit for a file of ${bytes.length} bytes; bake again without --compress`);
    check(raw >= 16, "map 0: texel 0 of its tree of patches declares an invalid size");
    const place = Math.ceil(end / 64) * 64;
    check(offset === place, `map 0: its payload's offset is ${offset} instead of ${place}`);
    check(offset + stored <= bytes.length, `map 0: its payload of ${stored} bytes extends beyond the end`);
    check(bytes.subarray(end, place).every((byte) => byte === 0), "map 0: padding before its payload is not zero");
    check(offset + stored === bytes.length, `${bytes.length - offset - stored} bytes follow the last payload`);
    const packed = bytes.subarray(offset);
    check(payload.getBigUint64(24, true) === xxh3(packed),
          "map 0: the checksum of its payload does not match; copy the file again");
    return compression === 0 ? packed : unpack(packed, raw, decompress, "map 0: its payload");
}

export function openCollider(source, { decompress } = {}) {
    check(source instanceof ArrayBuffer || ArrayBuffer.isView(source),
          "openCollider() needs an ArrayBuffer or a Uint8Array");
    const bytes = source instanceof ArrayBuffer ? new Uint8Array(source) : bytesOf(source);
    const view = viewOf(bytes);
    const size = checkHeader(bytes, view);
    const end = kHeader + size;
    const metadata = bytes.subarray(kHeader, end);
    check(size >= 16 && view.getBigUint64(48, true) === xxh3(metadata),
          "the checksum of the metadata does not match; copy the file again");
    const described = readMetadata(viewOf(metadata));
    const bounds = checkDescription(described, decompress);
    const { maps: [map, ...others], unit } = described;
    check(map, "there are no maps; bake the mesh again");
    check(others.length === 0, `unsupported: ${1 + others.length} maps; bake again without --map and --paper`);
    const { transform, root } = checkFrame(map);
    const stored = readPayload(bytes, end, map, decompress);

    const height = Math.ceil(stored.length / 8 / kTextureWidth);
    const texels = new Uint16Array(4 * kTextureWidth * height);
    new Uint8Array(texels.buffer).set(stored);
    const words = new Uint32Array(texels.buffer);
    validateTree(words.subarray(0, stored.length / 4));
    const { roots, levels } = treeSize(words);
    const constants = new ArrayBuffer(80);
    const floats = new Float32Array(constants, 0, 16);
    const integers = new Int32Array(constants, 64, 4);
    floats.set([...transform, root, ...roots]);
    integers.set([0, roots[0], roots[0] * roots[1], levels]);
    return { constants, floats, integers, texels, words, width: kTextureWidth, height, bounds,
             unit: new TextDecoder().decode(unit) };
}
