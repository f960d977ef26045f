// SPDX-License-Identifier: Apache-2.0
// Reads a FlatBuffers table with the schema formats/collider.fbs. Performs the checks of the C++ library's verifier.
import { check } from "./bytes.js";

const kTablesMax = 1_000_000;

const struct = (size, align) => ({ kind: "struct", size, align });
const number = (read, size, value = 0) => ({ kind: "number", read, size, value });
const vector = (item, most = Infinity) => ({ kind: "vector", item, most });
const table = (...fields) => ({ kind: "table", fields });
const needs = (type) => ({ ...type, required: true });

const kByte = number("getUint8", 1);
const kWord = number("getUint32", 4);
const kLong = number("getBigUint64", 8, 0n);
const kFloat = number("getFloat32", 4);
const kVec3 = struct(12, 4);
const kString = { kind: "string" };

// Fields in the order of the schema, each with its name.
const kMap = table(["format", kByte], ["compare", kByte], ["width", kWord], ["height", kWord],
                   ["objectToMap", needs(struct(48, 4))], ["objectPerMap", needs(kVec3)], ["encloses", kByte],
                   ["emptyIsOutside", kByte], ["compression", kByte], ["payload", needs(struct(32, 8))],
                   ["decode", kByte]);
const kOption = table(["name", needs(kString)], ["value", needs(kString)]);
const kProvenance = table(["meshName", needs(kString)], ["meshHash", needs(kString)], ["triangles", kLong],
                          ["toolVersion", needs(kString)], ["options", vector(kOption)]);
const kMaterial = table(["name", needs(kString)], ["restitution", number("getFloat32", 4, 1)], ["friction", kFloat],
                        ["lifetimeLoss", kFloat], ["areaFraction", kFloat]);
const kMaterials = table(["list", needs(vector(kMaterial, 255))], ["sides", vector(struct(3, 1))], ["origin", needs(kVec3)],
                         ["size", kFloat], ["nodes", vector(struct(1, 1))], ["compression", kByte], ["nodesSize", kWord]);
const kCollider = table(["boundsMin", needs(kVec3)], ["boundsMax", needs(kVec3)], ["unit", needs(kString)],
                        ["provenance", needs(kProvenance)], ["maps", needs(vector(kMap, 1024))],
                        ["animation", vector(struct(1, 1))], ["materials", kMaterials]);

/** Returns the root table as an object. Structures and strings are DataViews; absent ones are undefined. */
export function readMetadata(view) {
    let tables = 0;
    const verify = (valid) => check(valid, "the metadata at byte 64 is not a FlatBuffers table of a collider");
    const contain = (at, size, align = 1) => verify(at % align === 0 && at + size <= view.byteLength);
    const slice = (at, size) => new DataView(view.buffer, view.byteOffset + at, size);
    const follow = (at) => {
        contain(at, 4, 4);
        const offset = view.getInt32(at, true);
        verify(offset > 0);
        return at + offset;
    };
    const readVector = (at, size) => {
        contain(at, 4, 4);
        const count = view.getUint32(at, true);
        contain(at, 4 + size * count);
        return count;
    };
    const read = {
        number: (type, at) => {
            contain(at, type.size, type.size);
            return view[type.read](at, true);
        },
        struct: (type, at) => {
            contain(at, type.size, type.align);
            return slice(at, type.size);
        },
        string: (type, from) => {
            const at = follow(from);
            const size = readVector(at, 1);
            contain(at + 4 + size, 1);
            verify(view.getUint8(at + 4 + size) === 0);
            return slice(at + 4, size);
        },
        vector: ({ item, most }, from) => {
            const at = follow(from);
            const size = item.kind === "table" ? 4 : item.size;
            const count = readVector(at, size);
            verify(count <= most);
            if (item.kind !== "table") {
                return slice(at + 4, size * count);
            }
            return Array.from({ length: count }, (_, i) => {
                const place = at + 4 + 4 * i;
                return readTable(item, place + view.getUint32(place, true));
            });
        },
        table: (type, from) => readTable(type, follow(from)),
    };
    const readTable = ({ fields }, at) => {
        verify(++tables <= kTablesMax);
        contain(at, 4, 4);
        const places = at - view.getInt32(at, true);
        verify(places >= 0);
        contain(places, 2, 2);
        const size = view.getUint16(places, true);
        verify(size % 2 === 0);
        contain(places, size);
        const values = {};
        fields.forEach(([name, type], i) => {
            const entry = 4 + 2 * i;
            const offset = entry < size ? view.getUint16(places + entry, true) : 0;
            verify(offset !== 0 || !type.required);
            values[name] = offset !== 0 ? read[type.kind](type, at + offset) : type.value;
        });
        return values;
    };
    contain(0, 10);
    verify(view.getUint32(4, true) === 0x32464c52); // "RLF2"
    return readTable(kCollider, follow(0));
}
