#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes manual pages from --help of the tools and --manual of their verbs, without a date: pages.py FOLDER TOOL…"""
import pathlib
import re
import subprocess
import sys


def help_of(*command, option="--help"):
    return subprocess.run([*command, option], stdout=subprocess.PIPE, text=True, check=True).stdout.rstrip("\n")


def escaped(text):
    """Escapes text for roff: backslashes, hyphens that stay hyphens when copied, and lines that look like requests."""
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", "\\e").replace("-", "\\-"), flags=re.M)


def page(name, version, text, codes):
    summary = next(part for part in text.split("\n\n") if not part.startswith("Examples:")).split("\n")[0]
    return (f'.TH "{escaped(name)}" 1 "" "Relief {version}" "Relief manual"\n.SH NAME\n'
            f"{escaped(name)} \\- {escaped(summary[0].lower() + summary[1:])}\n.SH DESCRIPTION\n.nf\n{escaped(text)}\n.fi\n"
            f".SH EXIT STATUS\n" + "".join(f".TP\n.B {code}\n{escaped(what)}\n" for code, what in codes))


def main(folder, *tools):
    folder = pathlib.Path(folder)
    folder.mkdir(exist_ok=True)
    for tool in map(pathlib.Path, tools):
        text = help_of(tool)
        version = subprocess.run([tool, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout.split()[-1]
        codes = re.findall(r"(\d) ([^,]+)", re.search(r"^Exit codes: (.*)", text, flags=re.M | re.S)[1].replace("\n", " "))
        codes.append(("128 + n", "ended by signal n"))
        (folder / f"{tool.name}.1").write_text(page(tool.name, version, text, codes))
        listed = re.search(r"^Subcommands:\n(.*?)(?:\n\n|\Z)", text, flags=re.M | re.S)
        for verb in re.findall(r"^  (\w+) ", listed[1], flags=re.M) if listed else []:
            name = f"{tool.name}-{verb}"
            (folder / f"{name}.1").write_text(page(name, version, help_of(tool, verb, option="--manual"), codes))


main(*sys.argv[1:])
