# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel for `pip install .`: the PEP 517 backend named in pyproject.toml.

CMake builds and installs the component `python`; the wheel contains its files and their metadata. Only the standard library
is used, so that pip needs no network. README.md in this folder describes its use.
"""
import base64
import hashlib
import pathlib
import re
import subprocess
import sysconfig
import tempfile
import tomllib
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build/wheel"


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def built_folder(settings):
    """Returns the build folder of the setting build-dir without building it; without the setting, builds its own."""
    if "build-dir" in settings:
        return pathlib.Path(settings["build-dir"]).resolve()
    run("cmake", "--preset", "packages", "-S", SOURCE, "-B", BUILD, "-DRELIEF_BUILD_OPENVDB=OFF")
    run("cmake", "--build", BUILD, "--target", "relief_python", "relief-import")
    return BUILD


def metadata(project, version):
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
             f"License: {project['license']['text']}", f"Requires-Python: {project['requires-python']}",
             *(f"Requires-Dist: {other}" for other in project["dependencies"])]
    return "\n".join(lines) + "\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project = tomllib.loads((SOURCE / "pyproject.toml").read_text())["project"]
    version = re.search(r"project\(Relief VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
    folder = built_folder(config_settings or {})
    with tempfile.TemporaryDirectory() as stage:
        run("cmake", "--install", folder, "--prefix", stage, "--component", "python", "--strip")
        package = next(pathlib.Path(stage).rglob("__init__.py")).parent
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        module = package / f"_relief{suffix}"
        if not module.exists():
            raise SystemExit(f"no {module.name} was built: the module requires Debian's Python; use /usr/bin/python3 -m pip")
        python = "cp" + sysconfig.get_config_var("py_version_nodot")
        tag = f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
        distribution = f"{project['name'].replace('-', '_')}-{version}"
        about = f"{distribution}.dist-info"
        files = {f"relief/{path.name}": (path.read_bytes(), path.stat().st_mode) for path in sorted(package.iterdir())}
        texts = {"METADATA": metadata(project, version),
                 "WHEEL": f"Wheel-Version: 1.0\nGenerator: relief\nRoot-Is-Purelib: false\nTag: {tag}\n"}
        files |= {f"{about}/{name}": (text.encode(), 0o100644) for name, text in texts.items()}
        files[f"{about}/LICENSE"] = ((SOURCE / "LICENSE").read_bytes(), 0o100644)
    name = f"{distribution}-{tag}.whl"
    write(pathlib.Path(wheel_directory) / name, files, f"{about}/RECORD")
    return name


def write(path, files, record):
    """Writes a reproducible zip file of {name: (bytes, mode)} and their hashes."""
    rows = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}\n"
            for name, (data, _) in files.items()]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, (data, mode) in [*files.items(), (record, (("".join(rows) + f"{record},,\n").encode(), 0o100644))]:
            entry = zipfile.ZipInfo(name)
            entry.external_attr = mode << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("Relief has no source package for pip; clone its repository and run `pip install .` there")
