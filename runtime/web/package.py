#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the text files of the npm package.

    package.py SOURCE PACKAGE VERSION

README.md: links to the scene keys point to SCENE.md, which is included; links to files outside the package become plain text.
package.json: gets the version.
relief.d.ts: gets the scene types, generated from the JSON Schema of scenes.
"""
import json
import pathlib
import re
import sys

SCENE = "../scene/README.md"
TYPES = re.compile(r"^// Scene, with the keys of scene\.toml: package\.py .*\n", flags=re.M)


def typescript(schema, name, interfaces):
    """Returns the TypeScript type of a JSON Schema. Adds objects to `interfaces`, under `name`.

    A $ref in the items of a list refers to the table before it, which has the same name."""
    if "$ref" in schema:
        return name
    if "oneOf" in schema:
        return " | ".join(typescript(one, name, interfaces) for one in schema["oneOf"])
    if "enum" in schema or "const" in schema:
        return " | ".join(json.dumps(one) for one in schema.get("enum") or [schema["const"]])
    if schema["type"] == "array":
        item = typescript(schema["items"], name, interfaces)
        size = schema.get("minItems")
        if size is None or size != schema.get("maxItems"):
            return f"readonly ({item})[]" if " | " in item else f"readonly {item}[]"
        return "Vec3 | Numbers" if (item, size) == ("number", 3) else f"[{', '.join([item] * size)}]"
    if schema["type"] == "object":
        lines = []
        for key, field in schema["properties"].items():
            kind = typescript(field, name + key.title().replace("_", ""), interfaces)
            optional = "" if key in schema["required"] else "?"
            description = f"    /** {field['description']}. */\n" if "description" in field else ""
            lines.append(f"{description}    {key}{optional}: {kind};\n")
        interfaces[name] = f"export interface {name} {{\n{''.join(lines)}}}\n"
        return name
    return schema["type"].replace("integer", "number")


def scene_types(schema):
    interfaces = {}
    typescript(schema, "Scene", interfaces)
    return "\n".join(interfaces.values())


def within(text, files, renamed):
    """Replaces links by their text unless they point to files of the package, to headings or to the web."""

    def link(found):
        words, target = found[1], renamed.get(found[2], found[2])
        if re.match(r"https?:|#", target) or target.split("#")[0] in files:
            return f"[{words}]({target})"
        return words

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, text)


def main():
    source, package, version = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    about = json.loads((source / "package.json").read_text(encoding="utf-8"))
    about["version"] = version
    files = {*about["files"], "package.json"}
    schema = json.loads((source / "../scene/scene.schema.json").read_text(encoding="utf-8"))
    types = (source / "relief.d.ts").read_text(encoding="utf-8")
    texts = {
        "relief.d.ts": TYPES.sub(lambda _: scene_types(schema), types),
        "README.md": within((source / "README.md").read_text(encoding="utf-8"), files, {SCENE: "SCENE.md"}),
        "SCENE.md": within((source / SCENE).read_text(encoding="utf-8"), files, {}),
        "package.json": json.dumps(about, indent=4, ensure_ascii=False) + "\n",
    }
    package.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        file = package / name
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


main()
