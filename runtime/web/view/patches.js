// SPDX-License-Identifier: Apache-2.0
// The tree of a patch map; formats/patch_tree.h describes it.

const kKinds = ["outside", "inside", "split", "patch"];

/** Returns { roots, levels, words }. */
export function treeOf(collider, map) {
    const words = collider.tree(map);
    return { roots: [words[0] & 0xffff, words[0] >>> 16, words[1] & 0xffff], levels: words[1] >>> 16, words };
}

/** Calls visit(kind, corner, size, level) for each leaf. kind: outside, inside or patch; corner and size: in roots. */
export function visitLeaves({ roots, words }, visit) {
    const cell = (at, corner, size, level) => {
        const [low, high] = [words[2 * at], words[2 * at + 1]];
        if ((low & 3) !== 2) {
            visit(kKinds[low & 3], corner, size, level);
            return;
        }
        let next = high & 0xffffff;
        for (let octant = 0; octant < 8; ++octant) {
            const place = corner.map((from, k) => from + ((octant >> k) & 1) * size / 2);
            if ((low >>> (2 + octant)) & 1) {
                cell(next++, place, size / 2, level + 1);
            } else {
                visit(kKinds[(low >>> (10 + octant)) & 1], place, size / 2, level + 1);
            }
        }
    };
    for (let i = 0; i < roots[0] * roots[1] * roots[2]; ++i) {
        cell(1 + i, [i % roots[0], Math.floor(i / roots[0]) % roots[1], Math.floor(i / roots[0] / roots[1])], 1, 0);
    }
}
