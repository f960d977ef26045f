# SPDX-License-Identifier: Apache-2.0
# --root DIR: scenes can name files in one folder besides their own, and in no other.
. "$(dirname "$0")/lib.sh"

# assets; scenes; elsewhere
mkdir -p assets/meshes assets/colliders scenes elsewhere
cp "$models/OBJ/box.obj" assets/meshes/box.obj
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
# The scene's own folder is still allowed. A name that only starts like the root is not, nor is a link out of both.
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
expect_error 2 "--root 'missing' is not a folder" "$relief_sim" scenes/scene.toml --check --root missing
expect_error 2 "--root '.*box\.relief' is not a folder" "$relief_sim" scenes/scene.toml --check --root elsewhere/box.relief
