#!/usr/bin/env python3
"""Writes what of the npm package is text: a package is read far from the sources, so no link may leave it.

    package.py SOURCE PACKAGE VERSION [HOMEPAGE [REPOSITORY]]

README.md keeps its words; a link to the scene's keys goes to SCENE.md, which comes along, and any other link out of the
package becomes its text. package.json gets the version, and `homepage` and `repository` where there are addresses.
"""
import json
import pathlib
import re
import sys

SCENE = "../scene/README.md"


def within(text, files, renamed):
    """The text, whose links lead to files of the package, to its own headings or into the web."""

    def link(found):
        words, target = found[1], renamed.get(found[2], found[2])
        if re.match(r"https?:|#", target) or target.split("#")[0] in files:
            return f"[{words}]({target})"
        return words

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, text)


def main():
    source, package, version, *addresses = sys.argv[1:]
    source, package = pathlib.Path(source), pathlib.Path(package)
    homepage, repository = (*addresses, "", "")[:2]
    about = json.loads((source / "package.json").read_text(encoding="utf-8"))
    about["version"] = version
    if homepage:
        about["homepage"] = homepage
    if repository:
        about["repository"] = {"type": "git", "url": repository, "directory": "runtime/web"}
    files = {*about["files"], "package.json"}
    texts = {
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
