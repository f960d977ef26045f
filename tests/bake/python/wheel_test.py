# SPDX-License-Identifier: Apache-2.0
"""`pip install .` in a fresh virtual environment without a network: the installed package is complete and bakes."""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import zipfile

import pytest

BUILD = pathlib.Path(os.environ["RELIEF_BIN"]).parent
SOURCE = pathlib.Path(os.environ["RELIEF_SOURCE"])
BUNNY = "/usr/share/glmark2/models/bunny.obj"
VERSION = re.search(r"project\(Relief VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
# Hides this build and the package index.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | {
    "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_NO_CACHE_DIR": "1"}


@pytest.fixture(scope="module")
def python(tmp_path_factory):
    """The interpreter of an environment with Debian's numpy and with relief, installed by pip from the sources and this build."""
    folder = tmp_path_factory.mktemp("venv")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", folder], check=True)
    before = sorted(SOURCE.iterdir())
    subprocess.run([folder / "bin/python", "-m", "pip", "install", "-q", "--no-build-isolation", "--config-settings",
                    f"build-dir={BUILD}", SOURCE], check=True, env=ENVIRONMENT)
    assert sorted(SOURCE.iterdir()) == before
    return folder / "bin/python"


def test_works_from_any_folder(python, tmp_path):
    program = tmp_path / "program.py"
    program.write_text(f'''
import pathlib
import re
import relief
home = pathlib.Path(relief.__file__).parent
assert home.is_relative_to({str(python.parents[1])!r}), home
collider = relief.bake({BUNNY!r}, budget="100kB")
assert relief.check(collider, {BUNNY!r}, samples=1000).wrong_percent < 10
collider.save("own.relief")
print(sorted(path.name for path in home.iterdir() if path.is_file()))
''')
    said = subprocess.run([python, "-B", program], cwd=tmp_path, check=True, env=ENVIRONMENT, capture_output=True, text=True)
    files = eval(said.stdout)
    assert {"__init__.py", "_relief.pyi", "py.typed", "relief-import"} <= set(files) and len(files) <= 6
    subprocess.run([BUILD / "bin/relief", "bake", BUNNY, "-q", "--budget", "100kB", "-o", tmp_path / "tool.relief"], check=True)
    assert (tmp_path / "own.relief").read_bytes() == (tmp_path / "tool.relief").read_bytes()


def test_pip_shows_and_uninstalls(python):
    pip = [python, "-m", "pip"]
    shown = subprocess.run([*pip, "show", "-f", "relief-collider"], check=True, env=ENVIRONMENT, capture_output=True, text=True).stdout
    assert f"Version: {VERSION}" in shown and "Requires: numpy" in shown and "relief/relief-import" in shown
    subprocess.run([*pip, "uninstall", "-q", "-y", "relief-collider"], check=True, env=ENVIRONMENT)
    assert not list(python.parents[1].rglob("relief*"))


def test_wheels_are_valid_and_reproducible(tmp_path):
    sys.path.insert(0, str(SOURCE / "bake/python"))
    try:
        import build_wheel
    finally:
        sys.path.pop(0)
    names = []
    for folder in (tmp_path / "a", tmp_path / "b"):
        folder.mkdir()
        names.append(build_wheel.build_wheel(folder, {"build-dir": str(BUILD)}))
    assert names[0] == names[1] == f"relief_collider-{VERSION}-cp311-cp311-linux_x86_64.whl"
    assert (tmp_path / "a" / names[0]).read_bytes() == (tmp_path / "b" / names[0]).read_bytes()
    record = f"relief_collider-{VERSION}.dist-info/RECORD"
    with zipfile.ZipFile(tmp_path / "a" / names[0]) as wheel:
        rows = dict(row.split(",", 1) for row in wheel.read(record).decode().splitlines())
        assert rows.keys() == set(wheel.namelist())
        for name, row in rows.items():
            data = wheel.read(name)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            assert row == (f"sha256={digest},{len(data)}" if name != record else ",")
    with pytest.raises(SystemExit, match="no _relief.* was built"):
        broken = tmp_path / "broken"
        broken.mkdir()
        (broken / "cmake_install.cmake").write_text(
            'file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/relief" TYPE FILE FILES "%s")' %
            (SOURCE / "bake/python/relief/__init__.py"))
        build_wheel.build_wheel(tmp_path, {"build-dir": str(broken)})
