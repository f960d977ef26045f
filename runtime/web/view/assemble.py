#!/usr/bin/env python3
"""Assembles the page of `relief view` into one HTML file that needs nothing beside it.

    assemble.py VIEW_FOLDER RELIEF_JS RELIEF_WASM_MJS RELIEF_WASM FZSTD_MJS OUTPUT

The modules become functions of one inline module, in the order of what they import: a page that is opened from disk may
import no other file. The WebAssembly is gzip in base64.
"""
import base64
import gzip
import json
import pathlib
import re
import sys

IMPORT = re.compile(r'^import\s+(.+?)\s+from\s+"([^"]+)";[ \t]*\n', re.M | re.S)
DECLARED = re.compile(r"^export\s+(?:async\s+)?(?:const|let|var|class|function\*?)\s+([\w$]+)", re.M)
LISTED = re.compile(r"^export\s*\{([^}]*)\};?[ \t]*$", re.M)
DEFAULT = re.compile(r"^export\s+default\s+(\w+);?[ \t]*$", re.M)


def key(specifier):
    """What a module is called, however it is imported."""
    return pathlib.PurePosixPath(specifier).name


class Module:
    def __init__(self, path):
        text = path.read_text(encoding="utf-8")
        self.path = path
        self.imports = []
        head = []

        def take(found):
            names, source = found[1].strip(), key(found[2])
            self.imports.append(source)
            for part in re.findall(r"\{[^}]*\}|[^,{}\s][^,{}]*", names):
                part = part.strip()
                if part.startswith("{"):
                    bound = re.sub(r"(\w+)\s+as\s+(\w+)", r"\1: \2", part)
                elif part.startswith("* as "):
                    head.append(f'const {part[5:].strip()} = $modules["{source}"];')
                    continue
                else:
                    bound = "{ default: " + part + " }"
                head.append(f'const {re.sub(chr(10) + " *", " ", bound)} = $modules["{source}"];')
            return ""

        body = IMPORT.sub(take, text)
        exports = {name: name for name in DECLARED.findall(body)}
        for listed in LISTED.findall(body):
            for one in filter(None, (part.strip() for part in listed.split(","))):
                name, _, alias = one.partition(" as ")
                exports[(alias or name).strip()] = name.strip()
        for name in DEFAULT.findall(body):
            exports["default"] = name
        body = DEFAULT.sub("", LISTED.sub("", body))
        body = re.sub(r"^export\s+(?=(?:async\s+)?(?:const|let|var|class|function))", "", body, flags=re.M)
        left = re.search(r"^\s*(?:import|export)[\s{].*", body, re.M)
        if left:
            sys.exit(f"{path}: assemble.py does not understand '{left[0].strip()[:80]}'")
        returned = ", ".join(f"{alias}: {name}" if alias != name else name for alias, name in exports.items())
        self.text = "\n".join([*head, body.strip(), f"return {{ {returned} }};"])


def ordered(modules, name, done, path=()):
    if name in path:
        sys.exit(f"modules import each other in a circle: {' -> '.join([*path, name])}")
    if name not in modules:
        sys.exit(f"{path[-1]} imports {name}, which is not there")
    if name not in done:
        for imported in modules[name].imports:
            ordered(modules, imported, done, (*path, name))
        done.append(name)
    return done


def script(text):
    """JavaScript that may stand inside a script element."""
    return re.sub(r"</(?=script)", r"<\\/", re.sub(r"<!--", r"<\\!--", text), flags=re.I)


def main():
    folder, relief_js, wasm_mjs, wasm, fzstd, output = (pathlib.Path(one) for one in sys.argv[1:])
    modules = {path.name: Module(path) for path in sorted(folder.glob("*.js"))}
    modules["relief.js"] = Module(relief_js)
    modules["relief_wasm.mjs"] = Module(wasm_mjs)
    modules["fzstd"] = Module(fzstd)
    parts = ["const $modules = {};"]
    for name in ordered(modules, "main.js", []):
        parts.append(f"$modules[{json.dumps(name)}] = (() => {{\n{modules[name].text}\n}})();")
    unused = set(modules) - set(ordered(modules, "main.js", []))
    if unused:
        sys.exit(f"no module imports {', '.join(sorted(unused))}")
    packed = base64.b64encode(gzip.compress(wasm.read_bytes(), 9, mtime=0)).decode()
    page = (folder / "index.html").read_text(encoding="utf-8")
    for mark, text in (("/* style.css */", (folder / "style.css").read_text(encoding="utf-8")),
                       ("/* relief_wasm.wasm */", packed),
                       ("/* main.js */", script("\n".join(parts)))):
        if page.count(mark) != 1:
            sys.exit(f"index.html must hold '{mark}' once")
        page = page.replace(mark, text)
    placeholder = '<script type="application/json" id="relief-page-data">null</script>'
    if page.count(placeholder) != 1:
        sys.exit("index.html must hold the element for the page's data once")
    output.write_text(page, encoding="utf-8")


main()
