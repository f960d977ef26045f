# SPDX-License-Identifier: Apache-2.0
# Ninja and Make read the depfiles: a second build does nothing, and a change of any file that the mesh references bakes
# it again. cmake_package.sh covers CMake.
. "$(dirname "$0")/lib.sh"

# The mesh is a glTF tetrahedron with a buffer file, in a folder whose name needs every escape.
odd='a b#c$d:e'
mkdir -p "$odd" rocks
python3 - "$odd" <<'P'
import json, struct, sys
folder = sys.argv[1]
points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
data = b''.join(struct.pack('<3f', *p) for p in points) + struct.pack('<12H', 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3)
open(f'{folder}/buffer.bin', 'wb').write(data)
json.dump({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
           'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}]}],
           'buffers': [{'uri': 'buffer.bin', 'byteLength': len(data)}],
           'bufferViews': [{'buffer': 0, 'byteLength': 48}, {'buffer': 0, 'byteOffset': 48, 'byteLength': 24}],
           'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3',
                          'min': [0, 0, 0], 'max': [1, 1, 1]},
                         {'bufferView': 1, 'componentType': 5123, 'count': 12, 'type': 'SCALAR'}]},
          open(f'{folder}/m.gltf', 'w'))
for i in (1, 2):
    with open(f'rocks/r{i}.obj', 'w') as obj:
        obj.write(f'mtllib r.mtl\nv 0 0 0\nv {i} 0 0\nv 0 {i} 0\nv 0 0 {i}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n')
open('rocks/r.mtl', 'w').write('newmtl a\n')
open('r.toml', 'w').write('version = 1\n[[asset]]\nmesh = "rocks/*.obj"\noutput = "{stem}.relief"\n'
                          'map = "cube:size=16"\n')
P
expect 0 "$relief" bake "$odd/m.gltf" -o m.relief --map cube:size=16 --depfile m.d --json
json stdout "[i['file'] for i in d['inputs']] == ['$odd/m.gltf', '$odd/buffer.bin']"
json stdout "d['inputs'][0]['hash'] == d['provenance']['mesh_hash'] and len(d['inputs'][1]['hash']) == 32"
rm m.relief
echo 'old' >m.d
expect_error 2 'missing' "$relief" bake missing.obj -o m.relief --depfile m.d
[ "$(cat m.d)" = old ] || die "a failed bake wrote a depfile"
expect_error 1 'depfile' "$relief" bake "$odd/m.gltf" -o - --depfile m.d
expect_error 1 'two outputs' "$relief" bake "$odd/m.gltf" -o m.relief --depfile m.relief

# check_rebuilds BUILD IDLE: BUILD bakes first, then prints IDLE, and bakes again after each change of a dependency.
check_rebuilds() {
    local build=$1 idle=$2 changed
    for changed in '' "$odd/m.gltf" "$odd/buffer.bin" rocks/r.mtl rocks/r1.obj r.toml new; do
        sleep 0.1
        case $changed in
            '') ;;
            new) cp rocks/r1.obj rocks/r3.obj ;;
            *) touch "$changed" ;;
        esac
        expect 0 bash -c "$build"
        ! grep -q "$idle" stdout || die "$build: no bake after '$changed' changed"
        expect 0 bash -c "$build"
        grep -q "$idle" stdout || die "$build: not idle after '$changed': $(cat stdout)"
    done
    [ -f r3.relief ] || die "$build: a new file was not detected"
    rm -f rocks/r3.obj ./*.relief ./*.d stamp .relief-cache.json
}

cat >build.ninja <<N
rule bake
  command = $relief bake \$in -o \$out --map cube:size=16 --depfile \$out.d -q
  depfile = \$out.d
rule recipe
  command = $relief bake --recipe \$in --stamp \$out --depfile \$out.d -q
  depfile = \$out.d
build m.relief: bake a\$ b#c\$\$d\$:e/m.gltf
build stamp: recipe r.toml
N
check_rebuilds ninja 'ninja: no work to do'

cat >Makefile <<M
all: m.relief stamp
m.relief:
	$relief bake 'a b#c\$\$d:e/m.gltf' -o m.relief --map cube:size=16 --depfile m.relief.d -q
stamp:
	$relief bake --recipe r.toml --stamp stamp --depfile stamp.d -q
-include m.relief.d stamp.d
M
sed -i "s/b#c/b\\\\#c/" Makefile
sed -i "s/^\(\t.*\)b\\\\#c/\1b#c/" Makefile
check_rebuilds make "Nothing to be done for 'all'"
