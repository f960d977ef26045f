# --root DIR: scenes and recipes may name files of one folder more than their own, and of no other.
. "$(dirname "$0")/lib.sh"

# assets/meshes, assets/colliders; scenes; elsewhere
mkdir -p assets/meshes/more assets/colliders assets/plans scenes recipes elsewhere out
cp "$models/OBJ/box.obj" assets/meshes/box.obj
cp assets/meshes/box.obj assets/meshes/more/old.obj
cp assets/meshes/box.obj assets/meshes/more/new.obj
cp assets/meshes/box.obj elsewhere/box.obj
"$relief" bake assets/meshes/box.obj -o assets/colliders/box.relief --map cube:size=16 -q
cp assets/colliders/box.relief elsewhere/box.relief

# Scenes.
printf '[collider]\nfile = "../assets/colliders/box.relief"\n' >scenes/scene.toml
expect_error 3 "scene\.toml:2:[0-9]+: collider\.file = .*leads out of the scene's folder;" "$relief_sim" scenes/scene.toml --check
for root in assets assets/colliders "$work/assets" . /; do
    expect 0 "$relief_sim" scenes/scene.toml --check --root "$root"
done
(cd scenes && expect 0 "$relief_sim" scene.toml --check --root ../assets)
expect 0 "$relief_sim" scenes/scene.toml --root assets --steps 3
expect_error 3 "leads out of the scene's folder and of --root 'elsewhere'" "$relief_sim" scenes/scene.toml --check --root elsewhere
# The own folder stays allowed, a name that only begins like the root's does not, nor a link that leads out of both.
cp assets/colliders/box.relief scenes/own.relief
printf '[collider]\nfile = "own.relief"\n' >scenes/own.toml
expect 0 "$relief_sim" scenes/own.toml --check --root elsewhere
mkdir assets_too && cp elsewhere/box.relief assets_too/
printf '[collider]\nfile = "../assets_too/box.relief"\n' >scenes/other.toml
expect_error 3 'leads out of' "$relief_sim" scenes/other.toml --check --root assets
ln -s ../../elsewhere/box.relief assets/colliders/link.relief
printf '[collider]\nfile = "../assets/colliders/link.relief"\n' >scenes/link.toml
expect_error 3 'leads out of' "$relief_sim" scenes/link.toml --check --root assets
printf '[collider]\nfile = "%s/assets/colliders/box.relief"\n' "$work" >scenes/absolute.toml
expect_error 3 'is an absolute path' "$relief_sim" scenes/absolute.toml --check --root assets
expect_error 2 "--root 'missing' is no folder" "$relief_sim" scenes/scene.toml --check --root missing
expect_error 2 "--root '.*box\.relief' is no folder" "$relief_sim" scenes/scene.toml --check --root elsewhere/box.relief

# Recipes: patterns, exclusions and plans.
"$relief" bake assets/meshes/box.obj -o elsewhere/plan.relief --budget 20kB --plan-out assets/plans/plan.toml -q
recipe() { printf 'version = 1\n[[asset]]\n' >recipes/recipe.toml; printf '%s\n' "$@" >>recipes/recipe.toml; }
recipe 'mesh = "../assets/meshes/**/*.obj"' 'exclude = "../assets/meshes/more/old*"' 'output = "{stem}.relief"' \
    'plan = "../assets/plans/plan.toml"'
expect_error 3 'recipe\.toml:2.*leads upwards' "$relief" bake --recipe recipes/recipe.toml -o out
for root in assets . "$work/assets"; do
    rm -rf out
    expect 0 "$relief" bake --recipe recipes/recipe.toml -o out --root "$root" --depfile out.d --stamp out.stamp
    [ "$(cd out && echo *.relief)" = "box.relief new.relief" ] || die "baked $(ls out)"
    grep -q 'assets/meshes/more/new.obj' out.d || die "the depfile lacks a mesh: $(cat out.d)"
done
cmp out/box.relief elsewhere/plan.relief || die "the plan of another folder bakes other bytes"
expect 0 "$relief" bake --recipe recipes/recipe.toml -o out --root assets --dry-run
[ "$(grep -c 'up to date' stdout)" -eq 2 ] || die "a second run bakes again: $(cat stdout)"
# A root that holds the meshes alone, and nothing else: the plan is refused; and so are other folders.
expect_error 3 "plan '\.\./assets/plans/plan\.toml' leads out of the recipe's folder and of --root 'assets/meshes'" \
    "$relief" bake --recipe recipes/recipe.toml -o out --root assets/meshes
recipe 'mesh = "../elsewhere/*.obj"' 'output = "{stem}.relief"'
expect_error 3 "recipe\.toml:3.*mesh '\.\./elsewhere/' leads out of" "$relief" bake --recipe recipes/recipe.toml -o out --root assets
recipe 'mesh = "../*/box.obj"' 'output = "{stem}.relief"'
expect_error 3 "mesh '\.\./' leads out of" "$relief" bake --recipe recipes/recipe.toml -o out --root assets
# Outputs stay where they were allowed.
recipe 'mesh = "../assets/meshes/box.obj"' 'output = "{dir}/{stem}.relief"'
expect_error 3 'the output .* leads out of the output folder' "$relief" bake --recipe recipes/recipe.toml -o out --root .
recipe 'mesh = "../assets/meshes/box.obj"' 'output = "one.relief"'
expect 0 "$relief" bake --recipe recipes/recipe.toml -o out --root assets
[ -s out/one.relief ] || die "a single mesh was not baked"
expect_error 2 "--root 'missing' is no folder" "$relief" bake --recipe recipes/recipe.toml -o out --root missing
expect_error 1 'root.*recipe' "$relief" bake assets/meshes/box.obj -o x.relief --root assets
recipe 'mesh = "../assets/meshes/box.obj"' 'output = "one.relief"' 'root = "../assets"'
expect_error 3 "unknown key 'root'" "$relief" bake --recipe recipes/recipe.toml -o out
