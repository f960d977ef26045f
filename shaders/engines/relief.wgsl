// SPDX-License-Identifier: Apache-2.0
// Generated from relief.glsl by translate.py.
// Collides particles with a Relief collider in any shader:
//     ReliefSurface s = reliefDistance(texels, collider, p);                     // nearest surface of a point
//     ReliefMotion m = reliefCollide(texels, collider, p, v, radius, 0.4, 0.2);  // a particle after the contact
// texels: RGBA16UI without filtering, 2048 texels wide. collider: 80 bytes, laid out as std140. relief.h returns both.
// Lengths are in object units. formats/README.md specifies the arithmetic, formats/patch_tree.cpp is the C++ version.
const RELIEF_LOG2_WIDTH = 11u;
struct ReliefCollider {
    row_x: vec4f,  // object space to map space, whose unit is a root cell
    row_y: vec4f,
    row_z: vec4f,
    size: vec4f,   // edge of a root cell; number of root cells along x, y and z
    place: vec4i,  // index of the first texel; stride of roots along y and z, texels; levels below the roots
}
struct ReliefSurface {
    normal: vec3f,  // outwards, of unit length; zero outside the root cells
    distance: f32,  // positive outside, negative inside; 1.0e30 outside the root cells
}
struct ReliefMotion {
    position: vec3f,
    velocity: vec3f,
    normal: vec3f,    // of the surface that was hit, or zero
    distance: f32,    // negative: the particle hit; otherwise position and velocity are unchanged
}
struct ReliefLeaf {  // the leaf of a tree that contains a point
    record: vec2u,  // its own record, or that of its split parent if it has none
    q: vec3f,       // the point in the unit cube of the record's cell
    cell: f32,      // size of that cell, in roots
    inside: bool,   // for leaves without a patch
}
fn reliefDot(a: vec3f, b: vec3f) -> f32 {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
fn reliefRow(row: vec4f, p: vec3f) -> f32 {
    let sum = row.x * p.x + (row.y * p.y + (row.z * p.z + row.w));
    return sum;
}
fn reliefUnit(v: vec3f) -> vec3f {
    return v * inverseSqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}
// Returns the point of the octahedron with an index of 0 to 2 half_range in each direction, in index steps.
fn reliefFold(index: vec2f, half_range: f32) -> vec3f {
    let st = index - vec2f(half_range, half_range);
    let z = half_range - abs(st.x) - abs(st.y);
    let beyond = max(-z, 0.0);  // below the equator, both are reflected by their excess
    return vec3f(st.x - (select(beyond, -beyond, st.x < 0.0)), st.y - (select(beyond, -beyond, st.y < 0.0)), z);
}
// Returns the two words of a texel.
fn reliefPatchTexel(texels: texture_2d<u32>, index: i32) -> vec2u {
    let row = u32(index) >> u32(RELIEF_LOG2_WIDTH);
    let column = u32(index) - (row << u32(RELIEF_LOG2_WIDTH));
    let words = textureLoad(texels, vec2i(i32(column), i32(row)), 0);
    return vec2u(words.x | (words.y << 16u), words.z | (words.w << 16u));
}
fn reliefBitCount(bits: u32) -> i32 {
    let pairs = bits - ((bits >> 1u) & 0x55u);  // of a byte
    let nibbles = (pairs & 0x33u) + ((pairs >> 2u) & 0x33u);
    return i32((nibbles + (nibbles >> 4u)) & 0xfu);
}
// Transforms q into the frame of a patch: u, v and the depth w.
fn reliefPatchAcross(record: vec2u, q: vec3f) -> vec3f {
    let diagonal = (record.x >> 5u) & 3u;
    let axis = (record.x >> 7u) & 3u;
    let abc = select(select(q.zxy, q.yzx, axis == 1u), q, axis == 0u);
    let a = select(abc.x, 1.0 - abc.x, (record.x & 0x200u) != 0u);
    let b = select(abc.y, 1.0 - abc.y, (record.x & 0x400u) != 0u);
    var at = vec3f(b, abc.z, a);
    if (diagonal != 0u) {
        let v = select(0.25 * (a + b - 2.0 * abc.z + 2.0), abc.z, diagonal == 1u);
        let w = select(a + b + abc.z, a + b, diagonal == 1u);
        at = vec3f(0.5 * (a - b + 1.0), v, w);
    }
    return at;
}

// Returns byte i, below 16, of four words.
fn reliefPatchByte(words: vec4u, i: i32) -> u32 {
    let low = select(words.x, words.y, (i & 4) != 0);
    let high = select(words.z, words.w, (i & 4) != 0);
    let four = select(low, high, i > 7);
    return (four >> u32(8 * (i & 3))) & 0xffu;
}
// Returns the codes at the corners 00, 10, 01 and 11 of a grid square with the lowest corner `corner`.
fn reliefPatchCodes(texels: texture_2d<u32>, first: i32, record: vec2u, corner: vec2f, squares: f32) -> vec4f {
    let side = i32(squares) + 1;
    var at = i32(corner.y) * side + i32(corner.x);
    var end = side * side - 1;
    // The codes lie in two consecutive texels. For 2 by 2 heights, all codes except the last are in the record.
    var words = vec4u(record.y, 0u, 0u, 0u);
    if (side > 2) {
        let begin = at / 8;
        let next = min(begin + 1, (end - 1) / 8);
        let heights = first + i32(record.y & 0xffffffu);
        words = vec4u(reliefPatchTexel(texels, heights + begin), reliefPatchTexel(texels, heights + next));
        at = at - 8 * begin;
        end = end - 8 * begin;
    }
    let last = select(reliefPatchByte(words, at + side + 1), (record.x >> 23u) & 0xffu, at + side + 1 == end);
    return vec4f(f32(reliefPatchByte(words, at)), f32(reliefPatchByte(words, at + 1)),
        f32(reliefPatchByte(words, at + side)), f32(last));
}

// Returns the height of one code step.
fn reliefPatchStep(record: vec2u) -> f32 {
    let scale = record.y >> 24u;
    let power = bitcast<f32>(((scale >> 4u) + 115u) << 23u);  // 2^((scale >> 4) - 12); exp2() may round
    return (1.0 + f32(scale & 15u) * (1.0 / 16.0)) * power * (1.0 / 255.0);
}
// Returns xyz: the gradient in the cell, of unit length and outwards; w: the distance, in cells.
fn reliefPatch(texels: texture_2d<u32>, first: i32, record: vec2u, q: vec3f) -> vec4f {
    let diagonal = (record.x >> 5u) & 3u;
    let axis = (record.x >> 7u) & 3u;
    let at = reliefPatchAcross(record, q);
    let squares = f32(1u << ((record.x >> 2u) & 3u));  // along a side of the grid
    let place = at.xy * squares;
    let corner = clamp(floor(place), vec2f(0.0, 0.0), vec2f(squares - 1.0, squares - 1.0));
    let t = place - corner;
    let c = reliefPatchCodes(texels, first, record, corner, squares);
    let unit = reliefPatchStep(record);
    let lower = c.x + t.x * (c.y - c.x);
    let upper = c.z + t.x * (c.w - c.z);
    let base = (f32((record.x >> 11u) & 0xfffu) - 2048.0) * (1.0 / 512.0);  // height of code 0
    let height = base + unit * (lower + t.y * (upper - lower));
    let by_u = (unit * squares) * ((c.y - c.x) + t.y * ((c.w - c.z) - (c.y - c.x)));
    let by_v = (unit * squares) * (upper - lower);
    var g = vec3f(1.0, -by_u, -by_v);
    if (diagonal != 0u) {
        let v = select(0.25 * by_v, 0.0, diagonal == 1u);
        let w = select(1.0 + 0.5 * by_v, -by_v, diagonal == 1u);
        g = vec3f(1.0 - 0.5 * by_u - v, 1.0 + 0.5 * by_u - v, w);
    }
    g = vec3f(select(g.x, -g.x, (record.x & 0x200u) != 0u), select(g.y, -g.y, (record.x & 0x400u) != 0u), g.z);
    g = select(select(g.yzx, g.zxy, axis == 1u), g, axis == 0u);
    let per_length = inverseSqrt(reliefDot(g, g)) * (select(1.0, -1.0, (record.x & 16u) != 0u));
    return vec4f(per_length * g, (at.z - height) * per_length);
}

// p: map space, within the roots. place: of ReliefCollider.
fn reliefPatchLeaf(texels: texture_2d<u32>, place: vec4i, p: vec3f) -> ReliefLeaf {
    var leaf: ReliefLeaf;
    let root = floor(p);
    leaf.record = reliefPatchTexel(texels, place.x + 1 + i32(root.z) * place.z + i32(root.y) * place.y + i32(root.x));
    leaf.q = p - root;
    leaf.cell = 1.0;
    leaf.inside = (leaf.record.x & 3u) == 1u;
    var beside = false;
    for (var level = 0; level < place.w && (leaf.record.x & 3u) == 2u && !beside; level++) {
        let child = 2.0 * leaf.q;
        let upper = step(vec3f(1.0, 1.0, 1.0), child);
        let octant = u32(upper.x + 2.0 * upper.y + 4.0 * upper.z);
        let children = (leaf.record.x >> 2u) & 0xffu;
        beside = ((children >> octant) & 1u) == 0u;
        if (beside) {
            leaf.inside = ((leaf.record.x >> (10u + octant)) & 1u) != 0u;
        } else {
            let before = reliefBitCount(children & ((1u << octant) - 1u));
            leaf.record = reliefPatchTexel(texels, place.x + i32(leaf.record.y & 0xffffffu) + before);
            leaf.q = child - upper;
            leaf.cell = 0.5 * leaf.cell;
            leaf.inside = (leaf.record.x & 3u) == 1u;
        }
    }
    return leaf;
}

// Returns xyz: the normal in map space; w: the distance, in roots. Without `whole`, an outside cell without a patch
// returns 1.0e30, which is faster. p, place: as for reliefPatchLeaf().
fn reliefPatches(texels: texture_2d<u32>, place: vec4i, p: vec3f, whole: bool) -> vec4f {
    let leaf = reliefPatchLeaf(texels, place, p);
    var record = leaf.record;
    var vote = vec4f(0.0, 0.0, 0.0, 1.0e30);
    if ((record.x & 3u) == 3u) {
        let pair = (record.x & 15u) == 15u;
        let first = place.x + i32(record.y & 0xffffffu);
        if (pair) {
            record = reliefPatchTexel(texels, first);
        }
        vote = reliefPatch(texels, place.x, record, leaf.q);
        if (pair) {
            let other = reliefPatch(texels, place.x, reliefPatchTexel(texels, first + 1), leaf.q);
            vote = select(vote, other, (select((other.w < vote.w), (other.w > vote.w), (leaf.record.x & 16u) != 0u)));
        }
        vote.w = leaf.cell * vote.w;
    } else if (leaf.inside || whole) {
        let coarse = (record.x & 3u) == 2u;
        let s = select(record.x >> 24u, (record.x >> 18u) & 127u, coarse);
        let t = select((record.x >> 16u) & 255u, record.x >> 25u, coarse);
        let normal = reliefUnit(reliefFold(vec2f(f32(s), f32(t)), select(127.0, 63.0, coarse)));
        let along = reliefDot(normal, leaf.q - vec3f(0.5, 0.5, 0.5));
        let offset = (f32(record.y >> 24u) - 128.0) * (1.0 / 128.0);
        let d = select(bitcast<f32>(record.y) + leaf.cell * along, leaf.cell * (along + offset), coarse);
        let nearest = leaf.cell * (1.0 / 1024.0);
        vote = vec4f(normal, select(max(d, nearest), min(d, -nearest), leaf.inside));
    }
    return vote;
}

// q: map space. roots: number of root cells along x, y and z.
fn reliefInRoots(q: vec3f, roots: vec3f) -> bool {
    return q.x >= 0.0 && q.y >= 0.0 && q.z >= 0.0 && q.x < roots.x && q.y < roots.y && q.z < roots.z;
}
// As reliefDistance(), but extrapolates the surface up to `reach` beyond the root cells.
fn reliefNear(texels: texture_2d<u32>, collider: ReliefCollider, p: vec3f, reach: f32) -> ReliefSurface {
    var surface: ReliefSurface;
    surface.normal = vec3f(0.0, 0.0, 0.0);
    surface.distance = 1.0e30;
    let q = vec3f(reliefRow(collider.row_x, p), reliefRow(collider.row_y, p), reliefRow(collider.row_z, p));
    let held = clamp(q, vec3f(0.0, 0.0, 0.0), 0.99999994 * collider.size.yzw);  // in the root cells
    let to = collider.size.x * collider.size.x * (q - held);
    let way = collider.row_x.xyz * to.x + (collider.row_y.xyz * to.y + collider.row_z.xyz * to.z);
    let within = reliefInRoots(q, collider.size.yzw);
    if (within || (reach > 0.0 && reliefDot(way, way) < reach * reach)) {
        let vote = collider.size.x * reliefPatches(texels, collider.place, held, true);
        surface.normal = collider.row_x.xyz * vote.x + (collider.row_y.xyz * vote.y + collider.row_z.xyz * vote.z);
        let d = select(vote.w + reliefDot(way, surface.normal), vote.w, within);
        surface.distance = select(1.0e30, d, vote.w > -3.4e38);  // an overflow is not inside
    }
    return surface;
}
fn reliefDistance(texels: texture_2d<u32>, collider: ReliefCollider, p: vec3f) -> ReliefSurface {
    return reliefNear(texels, collider, p, 0.0);
}

// Returns a ball's motion after a step to position p with velocity v. If it overlaps the collider, it moves to the
// surface. A velocity into the surface is reflected: restitution (0 to 1) scales its normal component, and 1 - friction
// (0 to 1) its tangential component. With restitution 0 the ball slides; with friction 1 as well, it sticks.
fn reliefCollide(texels: texture_2d<u32>, collider: ReliefCollider, p: vec3f, v: vec3f, radius: f32, restitution: f32,
    friction: f32) -> ReliefMotion {
    let surface = reliefNear(texels, collider, p, radius);
    var motion: ReliefMotion;
    motion.position = p;
    motion.velocity = v;
    motion.normal = vec3f(0.0, 0.0, 0.0);
    motion.distance = surface.distance - radius;
    if (motion.distance < 0.0) {
        let speed = reliefDot(v, surface.normal);
        let along = v - speed * surface.normal;
        motion.position = p - motion.distance * surface.normal;
        motion.normal = surface.normal;
        motion.velocity = select(v, (1.0 - friction) * along - (restitution * speed) * surface.normal, speed < 0.0);
    }
    return motion;
}
