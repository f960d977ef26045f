// SPDX-License-Identifier: Apache-2.0
// The closest point of a triangle mesh, by a tree of boxes. runtime/bench/mesh_tree.h documents the textures, which are
// RELIEF_TREE_WIDTH texels wide.
uniform highp usampler2D u_nodes;
uniform highp usampler2D u_triangles;
uniform highp usampler2D u_vertices;  // per corner
uniform highp sampler2D u_normals;    // per vertex

// Features of a triangle; edge i leads from corner i to the next.
#define RELIEF_FACE 0u
#define RELIEF_EDGE 1u
#define RELIEF_CORNER 4u
// Squared distance above that of every point
#define RELIEF_UNBOUNDED 1e30

struct MeshPoint {
    vec3 from;         // from the closest point of the mesh to the query
    float distance2;   // its squared length
    uint triangle;
    uint feature;      // that the closest point lies on
};

ivec2 treeTexel(uint i) {
    return ivec2(int(i % uint(RELIEF_TREE_WIDTH)), int(i / uint(RELIEF_TREE_WIDTH)));
}

uvec4 nodeTexel(uint i) {
    return texelFetch(u_nodes, treeTexel(i), 0);
}

vec3 cornerAt(uint i) {
    return uintBitsToFloat(texelFetch(u_triangles, treeTexel(i), 0).xyz);
}

vec4 bytesOf(uint word) {
    return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 0xffu);
}

// Returns the squared distances from offset q to the extents of four boxes along an axis.
vec4 gaps2(float q, float unit, uint lower, uint upper) {
    vec4 gap = max(max(bytesOf(lower) * unit - q, q - bytesOf(upper) * unit), 0.0);
    return gap * gap;
}

// Ericson, "Real-Time Collision Detection" (2005), section 5.1.5: finds the feature whose Voronoi region contains p.
void visitTriangle(vec3 p, uint triangle, inout MeshPoint best) {
    vec3 a = cornerAt(3u * triangle);
    vec3 b = cornerAt(3u * triangle + 1u);
    vec3 c = cornerAt(3u * triangle + 2u);
    vec3 ab = b - a;
    vec3 ac = c - a;
    vec3 ap = p - a;
    vec3 bp = p - b;
    vec3 cp = p - c;
    float d1 = dot(ab, ap);
    float d2 = dot(ac, ap);
    float d3 = dot(ab, bp);
    float d4 = dot(ac, bp);
    float d5 = dot(ab, cp);
    float d6 = dot(ac, cp);
    float v = 0.0;
    float w = 0.0;
    vec3 from = vec3(0.0);
    uint feature = RELIEF_FACE;
    if (d1 <= 0.0 && d2 <= 0.0) {
        feature = RELIEF_CORNER;
    } else if (d3 >= 0.0 && d4 <= d3) {
        v = 1.0;
        feature = RELIEF_CORNER + 1u;
    } else if (d6 >= 0.0 && d5 <= d6) {
        w = 1.0;
        feature = RELIEF_CORNER + 2u;
    } else {
        float va = d3 * d6 - d5 * d4;
        float vb = d5 * d2 - d1 * d6;
        float vc = d1 * d4 - d3 * d2;
        if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
            v = d1 / (d1 - d3);
            feature = RELIEF_EDGE;
        } else if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
            w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            v = 1.0 - w;
            feature = RELIEF_EDGE + 1u;
        } else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
            w = d2 / (d2 - d6);
            feature = RELIEF_EDGE + 2u;
        } else {
            // Barycentric coordinates would be less accurate.
            vec3 n = cross(ab, ac);
            from = (dot(n, ap) / dot(n, n)) * n;
        }
    }
    if (feature != RELIEF_FACE) {
        from = ap - v * ab - w * ac;
    }
    float distance2 = dot(from, from);
    if (distance2 < best.distance2) {
        best = MeshPoint(from, distance2, triangle, feature);
    }
}

// Returns the closest point if its squared distance is below `within2`; otherwise distance2 is `within2`, and from is
// zero. The search visits near children first.
MeshPoint closestPoint(vec3 p, float within2) {
    MeshPoint best = MeshPoint(vec3(0.0), within2, 0u, RELIEF_FACE);
    // A key is a lower bound of a squared distance as bits, which sort like the numbers. A reference is a node, or a
    // leaf: bit 31, number of triangles, first triangle.
    uint keys[RELIEF_TREE_STACK];
    uint references[RELIEF_TREE_STACK];
    int top = 0;
    uint reference = 0u;
    bool going = true;
    while (going) {
        bool descends = false;
        if (reference < 0x80000000u) {
            uvec4 head = nodeTexel(3u * reference);
            uvec4 links = nodeTexel(3u * reference + 1u);
            uvec4 rest = nodeTexel(3u * reference + 2u);
            vec3 q = p - uintBitsToFloat(head.xyz);
            vec3 unit = uintBitsToFloat((uvec3(head.w, head.w >> 8u, head.w >> 16u) & 0xffu) << 23u);
            vec4 bounds2 = gaps2(q.x, unit.x, links.z, rest.y) + gaps2(q.y, unit.y, links.w, rest.z) +
                           gaps2(q.z, unit.z, rest.x, rest.w);
            // The number of the child replaces the lowest bits of a key.
            uvec4 key = (floatBitsToUint(bounds2) & ~3u) | uvec4(0u, 1u, 2u, 3u);
            uvec4 kind = uvec4(links.x >> 24u, links.x >> 28u, links.y >> 24u, links.y >> 28u) & 15u;
            uint node = links.x & 0xffffffu;
            uint triangle = links.y & 0xffffffu;
            uvec4 child;
            for (int i = 0; i < 4; ++i) {
                bool inner = kind[i] == 15u;
                child[i] = inner ? node : 0x80000000u | (kind[i] << 24u) | triangle;
                node += inner ? 1u : 0u;
                triangle += inner ? 0u : kind[i];
                key[i] = kind[i] == 0u ? 0xffffffffu : key[i];
            }
            key = uvec4(min(key.xz, key.yw), max(key.xz, key.yw)).xzyw;
            key = uvec4(min(key.xy, key.zw), max(key.xy, key.zw));
            key.yz = uvec2(min(key.y, key.z), max(key.y, key.z));
            uint limit = floatBitsToUint(best.distance2);
            for (int i = 3; i > 0; --i) {
                if (key[i] < limit) {
                    keys[top] = key[i];
                    references[top] = child[key[i] & 3u];
                    ++top;
                }
            }
            descends = key.x < limit;
            reference = child[key.x & 3u];
        } else {
            uint triangle = reference & 0xffffffu;
            uint end = triangle + ((reference >> 24u) & 15u);
            for (; triangle < end; ++triangle) {
                visitTriangle(p, triangle, best);
            }
        }
        while (!descends && top > 0) {
            --top;
            reference = references[top];
            descends = keys[top] < floatBitsToUint(best.distance2);
        }
        going = descends;
    }
    return best;
}

vec3 faceNormal(uint triangle) {
    vec3 a = cornerAt(3u * triangle);
    return normalize(cross(cornerAt(3u * triangle + 1u) - a, cornerAt(3u * triangle + 2u) - a));
}

// Returns the pseudonormal at the closest point, not of unit length.
vec3 pseudonormal(MeshPoint at) {
    vec3 normal;
    if (at.feature >= RELIEF_CORNER) {
        uint corner = 3u * at.triangle + (at.feature - RELIEF_CORNER);
        uint vertex = texelFetch(u_vertices, treeTexel(corner), 0).r;
        normal = texelFetch(u_normals, treeTexel(vertex), 0).xyz;
    } else {
        normal = faceNormal(at.triangle);
        if (at.feature != RELIEF_FACE) {
            uint side = 3u * at.triangle + (at.feature - RELIEF_EDGE);
            normal += faceNormal(texelFetch(u_triangles, treeTexel(side), 0).w);
        }
    }
    return normal;
}

// Returns the signed distance, and the normal, which has unit length and points outwards. If the search found no point,
// returns its positive bound.
float meshDistance(MeshPoint at, out vec3 normal) {
    normal = pseudonormal(at);
    float distance = sqrt(at.distance2);
    distance = dot(at.from, normal) < 0.0 ? -distance : distance;
    normal = distance != 0.0 ? at.from / distance : normalize(normal);
    return distance;
}
