# SPDX-License-Identifier: Apache-2.0
# The JSON Schemas of the build are valid, closed and complete. Real outputs of each verb satisfy them; documents with
# additions, omissions or changes do not.
. "$(dirname "$0")/lib.sh"

cat >validate.py <<'P'
import copy, json, pathlib, sys
from jsonschema import Draft202012Validator

folder = pathlib.Path(sys.argv[1])
schemas = {path.name.removesuffix('.schema.json'): json.load(open(path)) for path in folder.glob('*.schema.json')}

def closed(schema, path):
    """Every object is closed, every property described."""
    if isinstance(schema, list):
        for i, one in enumerate(schema):
            closed(one, f'{path}/{i}')
    elif isinstance(schema, dict):
        if schema.get('type') == 'object' or isinstance(schema.get('properties'), dict):
            assert schema.get('additionalProperties') is False, f'{path} is open'
            for name, one in schema['properties'].items():
                assert one.get('description'), f'{path}/{name} has no description'
            assert set(schema['required']) <= set(schema['properties']), path
        for name, one in schema.items():
            closed(one, f'{path}/{name}')

for name, schema in schemas.items():
    Draft202012Validator.check_schema(schema)
    closed(schema, name)

def places(document, path=()):
    yield path, document
    for key, value in (document.items() if isinstance(document, dict) else
                       enumerate(document) if isinstance(document, list) else ()):
        yield from places(value, path + (key,))

def with_change(document, path, change):
    document = copy.deepcopy(document)
    at = document
    for key in path:
        at = at[key]
    change(at)
    return document

used = set()
for entry in sys.argv[2:]:
    name, file = entry.split(':')
    used.add(name)
    validator = Draft202012Validator(schemas[name])
    documents = [json.loads(line) for line in open(file)] if file.endswith('.jsonl') else [json.load(open(file))]
    assert documents, file
    for document in documents:
        errors = list(validator.iter_errors(document))
        assert not errors, f'{file} by {name}: {errors[0].json_path}: {errors[0].message[:300]}'
    document = documents[0]
    mutations = 0
    for path, value in places(document):
        if isinstance(value, dict):
            changes = [lambda at: at.update(unknown_key=1)]
            if value:
                key = next(iter(value))
                changes.append(lambda at, key=key: at.update({key: {'nested': [None]}}))
            for change in changes:
                mutations += 1
                assert not validator.is_valid(with_change(document, path, change)), f'{file} changed at {path}'
    for key in document:
        mutations += 1
        assert not validator.is_valid(with_change(document, (), lambda at: at.pop(key))), f'{file} without {key}'
    assert mutations > 4, file

# Documents of diff exist only if the verb does.
missing = set(schemas) - used - ({'diff'} if 'diff:diff.json' not in sys.argv else set())
assert not missing, f'no output is held against {missing}'
P

outputs=()
# document SCHEMA CODE COMMAND…: standard output is a document of this schema
document() {
    local file=out${#outputs[@]}.json
    expect "$2" "${@:3}"
    cp stdout "$file"
    outputs+=("$1:$file")
}
cp "$models/OBJ/box.obj" .
document bake 0 "$relief" bake box.obj -o b.relief --budget 20kB --json
document bake 0 "$relief" bake box.obj -o c.relief --max-error 20 --budget 60kB --json
document bake 0 "$relief" bake box.obj -o p.relief --paper --resolution 16 --compress 3 --json
document info 0 "$relief" info p.relief --json
document check 0 "$relief" check b.relief --mesh box.obj --samples 500 --json
document check 7 "$relief" check p.relief --mesh box.obj --samples 500 --max-error 0 --json
"$relief" bake box.obj -o r.relief --budget 20kB --repair wrap=0.3 -q
document check 0 "$relief" check r.relief --mesh box.obj --samples 500 --json
document check-file 0 "$relief" check b.relief --json
printf 'DAMAGE' | dd of=p.relief bs=1 seek=1000 conv=notrunc status=none
document check-file 3 "$relief" check p.relief --json
document check-file 3 "$relief" check box.obj --json

mkdir recipe
cp box.obj recipe/
echo nonsense >recipe/zbad.obj
printf 'version = 1\n[[asset]]\nmesh = "*.obj"\noutput = "{stem}.relief"\npaper = true\nresolution = 8\n' >recipe/recipe.toml
document recipe 3 "$relief" bake --recipe recipe/recipe.toml --events events.jsonl --json
echo '# changed' >>recipe/box.obj
document recipe 0 "$relief" bake --recipe recipe/recipe.toml --dry-run --json

level level.gltf
document world-bake 0 "$relief" bake level.gltf --world w --budget 100kB --json
document world-check 0 "$relief" check w/world.json --json
document world-check 0 "$relief" check w/world.json --mesh level.gltf --samples 500 --json
document world-info 0 "$relief" info w/world.json --json
python3 "$RELIEF_SOURCE/tests/cli/heights.py" heights.png 70
document ground-bake 0 "$relief" bake heights.png --heights low=0,high=9,tile=64 --world g --json
document ground-check 0 "$relief" check g/world.json --mesh heights.png --heights low=0,high=99,tile=64 --samples 500 --max-error 100 --json

# A scene with all features.
python3 -c "import struct; open('flow.raw', 'wb').write(struct.pack('<24f', *range(24)))"
echo '0,1,0' >points.csv
cat >scene.toml <<'T'
collider = [
    { file = "b.relief" },
    { file = "c.relief", key = [{ time = 0, position = [0, 0, 0] }, { time = 1, position = [1, 0, 0], axis = [0, 1, 0], angle = 90 }] },
    { mesh = "box.obj", resolution = 32, deform = { amplitude = 0.1, frequency = 1.0 } },
]
particles = { capacity = 500 }
emitter = [
    { shape = "disc", center = [0, 1, 0], radius = 0.5, cone = 10, speed = [1, 2], burst = 10, rate = 10, burst_every = 0.1 },
    { shape = "points", points = "points.csv", type = 1, rate = 10 },
    { box_min = [-1, 1, -1], box_max = [1, 2, 1], duration = 2, rate = 100 },
    { point = [0, 2, 0], rate = 10, attach = 0, inherit = 1, key = [{ time = 0 }, { time = 1, angle = 90 }] },
]
forces = { viscosity = 0.1 }
flow = { raw = "flow.raw", size = [2, 2, 2], components = 3, box_min = [-1, -1, -1], box_max = [1, 1, 1] }
curl_noise = { amplitude = 0.1, scale = 1 }
attractor = [{ position = [0, 0, 0], strength = 1, radius = 1, reach = 5 }]
vortex = [{ center = [0, 0, 0], axis = [0, 1, 0], strength = 1, radius = 1 }]
type = [
    { name = "flake", size = [[0, 0.01], [1, 0.02]], color = [[0, 1, 1, 1], [1, 0, 0, 1]], opacity = [[0, 1], [1, 0]], on_collision = "die" },
    { mass = 2, gravity = 0.5, collides_with = [0] },
]
camera = { target = [0, 0, 0], key = [{ time = 0, eye = [0, 1, 5] }, { time = 1, eye = [5, 1, 0] }] }
spawn = [{ on = "collision" }]
render = { size = [32, 24], steps_per_frame = 20, sprite = "quad" }
T
document sim-report 0 "$relief_sim" scene.toml --steps 40 --frames frames --events hits.jsonl --json
[ -s hits.jsonl ] || die "there are no hits"
document sim-report 0 "$relief_sim" b.relief --steps 2 --json
document sim-check 0 "$relief_sim" scene.toml --check --json
echo nonsense >bad.toml
document sim-check 3 "$relief_sim" bad.toml --check --json
outputs+=(sim-events:hits.jsonl recipe-events:events.jsonl world:w/world.json)

"$RELIEF_BIN/relief-generate" --schemas schemas
python3 validate.py schemas "${outputs[@]}" || die "schemas and outputs differ"

# The schema of scenes, for completion in editors: every sample satisfies it, and a wrong key or value does not.
python3 - "$RELIEF_SOURCE" <<'P' || die "the schema of scenes and the samples differ"
import json, pathlib, sys, tomllib
from jsonschema import Draft202012Validator
root = pathlib.Path(sys.argv[1])
schema = json.load(open(root / 'runtime/scene/scene.schema.json'))
Draft202012Validator.check_schema(schema)
validator = Draft202012Validator(schema)
for path in (root / 'samples').glob('*.toml'):
    validator.validate(tomllib.load(open(path, 'rb')))
for wrong in ('colider.file = "a"', 'time.dt = 2', 'emitter.speed = "fast"', 'emitter.shape = "cube"', '[[vortex]]'):
    assert not validator.is_valid(tomllib.loads(wrong)), wrong
P
