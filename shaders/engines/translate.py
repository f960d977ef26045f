#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Translates relief.glsl to the other shading languages: translate.py [--check]

Writes relief.hlsl, relief.metal, relief.wgsl and relief.gdshaderinc beside it; with --check, fails if one differs.
relief.glsl uses only the GLSL that this script translates: one statement per line, no overloads, constructors with one
argument per component or vector, `?:` between parentheses, commas or the ends of a statement, unsigned shift counts.
"""
import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).parent
TYPES = ["float", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "ivec4", "uvec2", "uvec4"]
WGSL_TYPES = {"float": "f32", "int": "i32", "uint": "u32", "bool": "bool", "vec2": "vec2f", "vec3": "vec3f",
              "vec4": "vec4f", "ivec2": "vec2i", "ivec4": "vec4i", "uvec2": "vec2u", "uvec4": "vec4u"}
C_TYPES = {"vec2": "float2", "vec3": "float3", "vec4": "float4", "ivec2": "int2", "ivec4": "int4", "uvec2": "uint2",
           "uvec4": "uint4"}
FETCH = re.compile(r"texelFetch\((\w+), ivec2\((.*)\), 0\)")


def words(text, table):
    """Replaces whole words."""
    return re.sub(r"\b(%s)\b" % "|".join(table), lambda match: table[match[1]], text)


def without_precise(text):
    """Removes RELIEF_PRECISE, for languages without that qualifier."""
    text = re.sub(r"#ifndef RELIEF_PRECISE.*\n.*\n#endif\n", "", text)
    return text.replace("RELIEF_PRECISE ", "")


def aligned(text):
    """Aligns the comments of the members of each structure."""
    def align(match):
        lines = match[0].splitlines()
        width = max(len(line.split("  //")[0].rstrip()) for line in lines[1:])
        return "\n".join([lines[0]] + [re.sub(r"^( {4}.*?) *  //", lambda part: part[1].ljust(width) + "  //", line)
                                       for line in lines[1:]])
    return re.sub(r"^struct .*?(?=^})", lambda match: align(match) + "\n", text, flags=re.M | re.S)


def hlsl(text):
    text = FETCH.sub(r"\1.Load(int3(\2, 0))", text)
    text = text.replace("highp usampler2D", "Texture2D<uint4>")
    text = text.replace("#ifndef RELIEF_LOG2", "#pragma once\n#ifndef RELIEF_LOG2")
    return words(text, C_TYPES | {"inversesqrt": "rsqrt", "uintBitsToFloat": "asfloat"})


def metal(text):
    text = without_precise(text)
    text = FETCH.sub(lambda match: f"{match[1]}.read(uint2({match[2]}))", text)
    text = text.replace("highp usampler2D", "texture2d<uint>")
    text = re.sub(r"^(\w+ \w+\()", r"inline \1", text, flags=re.M)
    text = text.replace("#ifndef RELIEF_LOG2", "#pragma once\n#include <metal_stdlib>\nusing namespace metal;\n#ifndef RELIEF_LOG2")
    return words(text, C_TYPES | {"inversesqrt": "rsqrt", "uintBitsToFloat": "as_type<float>"})


def godot(text):
    return without_precise(text)  # Godot reads GLSL ES, but only includes files with this suffix


def ends_of(text, at, step):
    """Returns the index next to the parenthesis, comma or end of the expression around text[at]."""
    opens, closes = ("(", ")") if step > 0 else (")", "(")
    depth = 0
    at += step
    while 0 <= at < len(text):
        depth += (text[at] == opens) - (text[at] == closes)
        if depth < 0 or (depth == 0 and text[at] in ",;?:"):
            break
        at += step
    return at if step > 0 else at + 1


def argument(text):
    """Returns an argument of select(); WGSL reads `<` and a later `>` in a list of arguments as a template."""
    return f"({text})" if re.search(" [<>] ", text) else text


def without_choices(expression):
    """Replaces `c ? a : b` by select(b, a, c), from the last one to the first."""
    while "?" in expression:
        at = expression.rindex("?")
        begin = ends_of(expression, at, -1)
        colon = ends_of(expression, at, 1)
        end = ends_of(expression, colon, 1)
        condition, yes, no = (expression[begin:at].strip(), expression[at + 1:colon].strip(),
                              expression[colon + 1:end].strip())
        space = " " if expression[begin] == " " else ""
        choice = f"select({argument(no)}, {argument(yes)}, {condition})"
        expression = f"{expression[:begin]}{space}{choice}{expression[end:]}"
    return expression


def wgsl_statement(line, function):
    """Translates a statement; `function` is the text of its function, to find variables that change."""
    declared = re.fullmatch(r"(\s*)(\w+) (\w+)(?: = (.*))?;(.*)", line)
    if declared and declared[2] in TYPES + ["ReliefLeaf", "ReliefSurface", "ReliefMotion"]:
        space, kind, name, value, rest = declared.groups()
        changes = len(re.findall(rf"^\s*{name}(\.\w+)? = ", function, flags=re.M)) > 0 or not value
        if not value:
            return f"{space}var {name}: {WGSL_TYPES.get(kind, kind)};{rest}"
        return f"{space}{'var' if changes else 'let'} {name} = {without_choices(value)};{rest}"
    assigned = re.fullmatch(r"(\s*(?:return|[\w.]+ =)) (.*);(.*)", line)
    if assigned:
        return f"{assigned[1]} {without_choices(assigned[2])};{assigned[3]}"
    return re.sub(r"for \(int (\w+) = 0;", r"for (var \1 = 0;", line)


def joined(text):
    """Joins the lines of each statement and signature."""
    return re.sub(r"(,|[^\w]=|&&)\n +(?! *//)", r"\1 ", text)


def wrapped(line):
    """Breaks a line of more than 120 columns at the last fitting comma in the fewest parentheses."""
    if len(line) <= 120 or line.lstrip().startswith("//"):
        return line
    commas = [match.start() for match in re.finditer(", ", line[:120])]
    at = min(commas, key=lambda comma: (line.count("(", 0, comma) - line.count(")", 0, comma), -comma))
    indent = len(line) - len(line.lstrip()) + 4
    return line[:at + 1] + "\n" + wrapped(" " * indent + line[at + 2:])


def wgsl(text):
    text = joined(without_precise(text))
    text = re.sub(r"#ifndef \w+\n#define (\w+) (\S+)\n#endif\n", r"const \1 = \2;\n", text)
    text = FETCH.sub(r"textureLoad(\1, ivec2(\2), 0)", text)
    functions = re.split(r"(?<=^}\n)", text, flags=re.M)
    lines = []
    for function in functions:
        inside = None
        for line in function.splitlines():
            signature = re.fullmatch(r"(\w+) (\w+)\((.*)\) {", line)
            member = re.fullmatch(r"    (\w+) (\w+);(.*)", line)
            if line.startswith("struct"):
                inside = "struct"
            if signature:
                inside = "function"
                arguments = re.sub(r"(\w+) (\w+)(,|$)", r"\2: \1\3", signature[3].replace("highp ", ""))
                arguments = arguments.replace("usampler2D", "texture_2d<u32>")
                line = f"fn {signature[2]}({arguments}) -> {signature[1]} {{"
            elif inside == "struct" and member:
                line = f"    {member[2]}: {member[1]},{member[3]}"
            elif inside == "function":
                line = wgsl_statement(line, function)
            lines.append(line)
    text = "\n".join(lines) + "\n"
    text = re.sub(r"^};$", "}", text, flags=re.M)
    text = words(text, WGSL_TYPES | {"inversesqrt": "inverseSqrt", "uintBitsToFloat": "bitcast<f32>"})
    return "\n".join(wrapped(line) for line in text.splitlines()) + "\n"


def main():
    source = (FOLDER / "relief.glsl").read_text()
    differ = []
    for suffix, translate in {"hlsl": hlsl, "metal": metal, "wgsl": wgsl, "gdshaderinc": godot}.items():
        head, rest = source.split("\n", 1)
        text = f"{head}\n// Generated from relief.glsl by translate.py.\n" + aligned(translate(rest))
        file = FOLDER / f"relief.{suffix}"
        if "--check" not in sys.argv[1:]:
            file.write_text(text)
        elif not file.exists() or file.read_text() != text:
            differ.append(file.name)
    if differ:
        sys.exit(f"{', '.join(differ)} differ from relief.glsl; run shaders/engines/translate.py")


main()
