#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compiles the HLSL of samples/unity/README.md and samples/unreal/README.md with glslangValidator.

A comment `<!-- hlsl: FILE ENTRY -->` precedes each block; without ENTRY, STUBS calls the function. Any path of
relief.hlsl or relief.ush becomes shaders/engines/relief.hlsl, and any path of an earlier block that block. Other
includes, which are those of the engines, are removed.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).parents[2]
PAGES = ["samples/unity/README.md", "samples/unreal/README.md"]
SNIPPET = re.compile(r"<!-- hlsl: (\S+)(?: (\w+))? -->\n```hlsl\n(.*?)```", re.S)
OUTPUT = "RWStructuredBuffer<float4> out_values;\n[numthreads(1, 1, 1)]\nvoid main() {\n"
# Declarations of the engine before a file, and a caller of its function.
ATTRIBUTES = "struct VFXAttributes {\n    float3 position;\n    float3 velocity;\n    bool alive;\n};\n"
STUBS = {
    "ReliefCollider.hlsl": ("", OUTPUT + """
    out_values[0].xyz = reliefDistance(relief_texels, relief_collider, out_values[1].xyz).normal;
}
"""),
    "ReliefBounce.hlsl": (ATTRIBUTES, OUTPUT + """
    VFXAttributes attributes;
    attributes.position = out_values[0].xyz;
    attributes.velocity = out_values[1].xyz;
    attributes.alive = true;
    ReliefBounce(attributes, 0.01, 0.1, float2(0.4, 0.2));
    out_values[0].xyz = attributes.position + attributes.velocity;
}
"""),
    "NiagaraDataInterfaceRelief.ush": ("", OUTPUT + """
    float3 position, velocity;
    bool hit;
    ReliefCollide_Relief(out_values[0].xyz, out_values[1].xyz, 0.1, 0.4, 0.2, position, velocity, hit);
    out_values[0] = float4(position + velocity, hit ? 1.0 : 0.0);
}
"""),
}


def included(path, blocks):
    name = re.sub("^relief\\.ush$", "relief.hlsl", path.split("/")[-1])
    return f'#include "{name}"' if name == "relief.hlsl" or name in blocks else ""


def main():
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        for page in PAGES:
            blocks = []
            text = (ROOT / page).read_text()
            snippets = SNIPPET.findall(text)
            if len(snippets) != text.count("```hlsl") or not snippets:
                sys.exit(f"{page}: a block of HLSL has no comment `<!-- hlsl: FILE ENTRY -->`")
            for name, entry, code in snippets:
                code = code.replace("{ParameterName}", "Relief")
                before, after = ("", "") if entry else STUBS[name]
                code = re.sub(r'#include "(.*)"', lambda match: included(match[1], blocks), code)
                pathlib.Path(folder, name).write_text(code)
                blocks.append(name)
                file = pathlib.Path(folder, "main.hlsl")
                file.write_text("#extension GL_GOOGLE_include_directive : require\n" + before + code + after)
                command = ["glslangValidator", "-D", "-V", "-S", "comp", "-e", entry or "main", "--auto-map-bindings",
                           f"-I{ROOT}/shaders/engines", "-o", file.with_suffix(".spv"), file]
                run = subprocess.run(command, text=True, stdout=subprocess.PIPE)
                if run.returncode != 0:
                    sys.exit(f"{page}: {name} does not compile:\n{run.stdout}")
                count += 1
    print(f"glslang compiles {count} shaders of {len(PAGES)} pages")


main()
