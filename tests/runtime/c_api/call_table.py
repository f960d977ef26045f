#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""relief_runtime.h as tables for C++: call_table.py RELIEF_H OUT_INC

Lists every function with its arguments and every structure with its fields, so that tests include new ones. Unknown syntax
is an error: extend this script.
"""
import pathlib
import re
import sys

header = re.sub(r'/\*.*?\*/', ' ', pathlib.Path(sys.argv[1]).read_text(), flags=re.S)
header = re.sub(r'^\s*#.*$', '', header, flags=re.M)
header = re.sub(r'extern "C" \{', '', header)


def taken(pattern):
    """Returns all matches and removes them from the header."""
    global header
    found = list(re.finditer(pattern, header, flags=re.S))
    header = re.sub(pattern, ' ', header, flags=re.S)
    return found


structures = []
for match in taken(r'typedef struct (\w+) \{(.*?)\} \1;'):
    fields = []
    for declaration in filter(None, (one.strip() for one in match[2].split(';'))):
        kind, names = re.fullmatch(r'(\w+)\s+(.+)', declaration, flags=re.S).groups()
        for name in names.split(','):
            name, _, count = re.fullmatch(r'\s*(\w+)\s*(\[(\d+)\])?\s*', name).groups()
            fields.append((kind, name, int(count or 1), count is not None))
    structures.append((match[1], fields))
taken(r'typedef struct (\w+) \1;')

functions = []
for match in taken(r'([\w ]+?[ *]+)(relief_\w+)\(([^()]*)\);'):
    arguments = []
    for argument in filter(lambda one: one != 'void', re.split(r'\s*,\s*', match[3].strip())):
        kind, name, array = re.fullmatch(r'(.*?[ *])(\w+)(\[\d*\])?', argument, flags=re.S).groups()
        arguments.append((' '.join(kind.split()) + ('*' if array else ''), name))
    functions.append((' '.join(match[1].split()), match[2], arguments))

if header.strip(' \n}'):
    sys.exit('call_table.py cannot parse this part of relief_runtime.h: ' + ' '.join(header.split()))

lines = ['const std::vector<Structure> kStructures{']
for name, fields in structures:
    lines.append(f'    {{"{name}", sizeof({name}), {{')
    for kind, field, count, is_array in fields:
        lines.append(f'        {{"{field}", Number<{kind}>::kKind, offsetof({name}, {field}), sizeof({kind}), {count}, '
                     f'{str(is_array).lower()}}},')
    lines.append('    }},')
lines += ['};', '', 'const std::vector<Function> kFunctions{']
for kind, name, arguments in functions:
    listed = ', '.join(f'{{"{argument}", "{of}"}}' for of, argument in arguments)
    given = ', '.join(f'a.get<{of}>({i})' for i, (of, _) in enumerate(arguments))
    call = f'{name}({given})'
    body = f'{call}; return Outcome::kNothing;' if kind == 'void' else f'return outcomeOf({call});'
    lines.append(f'    {{"{name}", {{{listed}}}, []([[maybe_unused]] Arguments& a) {{ {body} }}}},')
lines += ['};', '']
pathlib.Path(sys.argv[2]).write_text('\n'.join(lines))
