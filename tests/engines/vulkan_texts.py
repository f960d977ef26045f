#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Executes relief.glsl and relief.hlsl in Vulkan on Mesa's lavapipe: vulkan_texts.py BIN FOLDER FILE.relief

Compares 100,000 queries of ten colliders, and of FILE.relief, with the CPU's field. Prints one line per shader; fails
if a sign, a distance, a normal or a motion differs by more than tests/engines/engine_cases.h states, or if the
validation layer prints a message.
"""
import glob
import os
import pathlib
import re
import subprocess
import sys

QUERIES = "100000"
# Shaders of tests/engines/CMakeLists.txt, and whether they are exact.
SHADERS = {"glsl": False, "glsl_precise": True, "hlsl": False, "hlsl_precise": True}


def main():
    programs, folder, collider = map(pathlib.Path, sys.argv[1:])
    drivers = glob.glob("/usr/share/vulkan/icd.d/lvp_icd.*.json")
    if not drivers:
        sys.exit("vulkan_texts.py: Mesa's lavapipe is missing; install mesa-vulkan-drivers")
    environment = os.environ | {"VK_ICD_FILENAMES": drivers[0], "VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation"}
    cases = programs / "relief_engine_cases"
    subprocess.run([cases, "write", folder, QUERIES, collider], check=True)
    failed = False
    for name, exact in SHADERS.items():
        device = ""
        for case in sorted(folder.glob("*.case")):
            command = [programs / "relief_vulkan_host", name[:4], programs / f"relief_{name}.spv", case,
                       case.with_suffix("." + name)]
            run = subprocess.run(command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            device = run.stdout.strip()
            if run.returncode != 0 or "\n" in device:
                sys.exit(f"vulkan_texts.py: {case.name} with {name} failed:\n{run.stdout}")
        run = subprocess.run([cases, "exact" if exact else "compare", folder, name, QUERIES, collider], text=True,
                             stdout=subprocess.PIPE)
        print(run.stdout, file=sys.stderr, end="")
        failed = failed or run.returncode != 0
        lines = run.stdout.splitlines()
        ulps = [float(ulp) for line in lines for ulp in re.findall(r"([\d.e+-]+) ulp at patches", line)]
        signs = sum(int(count) for line in lines for count in re.findall(r"(\d+) signs differ", line))
        words = r"(\d+) (?:within rounding|at borders)"
        rounded = sum(int(count) for line in lines for count in re.findall(words, line))
        print(f"{name} on {device}: {len(lines)} colliders of {QUERIES} queries, {signs} signs differ, "
              f"{rounded} by rounding of the point; distances to patches within {max(ulps):.3g} ulp"
              f"{'; FAILED' if run.returncode != 0 else ''}")
    sys.exit(1 if failed else 0)


main()
