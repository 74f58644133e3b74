# SPDX-License-Identifier: BSD-3-Clause
"""Turns the C++ snippets of a page into sources that can be compiled and run.

    snippets.py PAGE PRELUDES FOLDER

writes FOLDER/snippets.cpp, a program that runs one snippet after another, and FOLDER/program_<line>.cpp for each snippet that is a
whole program; prints the names of what it wrote. A comment before a snippet says more:

    <!-- snippet: prelude=box -->           PRELUDES/box.ipp goes before it, unseen by the reader
    <!-- snippet: continues -->             it goes on where the snippet before it ended
    <!-- snippet: declaration -->           it is declarations, at namespace scope
    <!-- snippet: not run: the reason -->   it is compiled, but not run

and one right behind it what must be true then:

    <!-- check: result.verdict == Verdict::good -->
"""

import json
import pathlib
import re
import sys

SNIPPET = re.compile(
    r"(?:<!-- snippet: (?P<how>[^\n]*) -->\n)?```cpp\n(?P<code>.*?)^```\n(?:<!-- check: (?P<check>[^\n]*) -->\n)?",
    re.DOTALL | re.MULTILINE,
)
INCLUDE = re.compile(r"^#include .*", re.MULTILINE)
KNOWN = re.compile(r"prelude=\w+|continues|declaration|not run: .+")


class Page:
    def __init__(self, path, preludes):
        self.path = path
        self.preludes = preludes
        self.includes = {}  # as an ordered set
        self.declarations = []
        self.functions = {}  # by line: the parts of a body
        self.run = []  # their lines
        self.programs = {}  # by line
        text = path.read_text()
        found = list(SNIPPET.finditer(text))
        for match in found:
            self.add(text.count("\n", 0, match.start("code")) + 1, **match.groupdict())
        for mark, n in (
            ("```cpp", len(found)),
            ("<!-- snippet:", sum(match["how"] is not None for match in found)),
            ("<!-- check:", sum(match["check"] is not None for match in found)),
        ):
            if text.count(mark) != n:
                sys.exit(f"{path}: {mark} where it means nothing")

    def add(self, line, how, code, check):
        if how and not KNOWN.fullmatch(how):
            sys.exit(f"{self.path}:{line}: what does '{how}' mean?")
        if "int main(" in code:
            self.programs[line] = f'#line {line} "{self.path}"\n{code}'
            return
        code = self.without_includes(code, line, self.path)
        if check:
            code += f"if (!({check})) {{\n    throw std::runtime_error({json.dumps(check)});\n}}\n"
        if how == "declaration":
            self.declarations.append(code)
        elif how == "continues":
            if not self.functions:
                sys.exit(f"{self.path}:{line}: there is nothing to go on from")
            self.functions[next(reversed(self.functions))].append(code)
        else:
            body = [code]
            if how and how.startswith("prelude="):
                prelude = self.preludes / (how.removeprefix("prelude=") + ".ipp")
                body.insert(0, self.without_includes(prelude.read_text(), 1, prelude))
            self.functions[line] = body
            if not (how and how.startswith("not run")):
                self.run.append(line)

    def without_includes(self, code, line, file):
        for include in INCLUDE.findall(code):
            self.includes[include.split("//")[0].strip()] = None
        return f'#line {line} "{file}"\n' + INCLUDE.sub("", code)

    def source(self):
        parts = ["#include <cstdio>", "#include <exception>", "#include <stdexcept>", *self.includes, ""]
        parts += [f"namespace {{\n{code}}}\n" for code in self.declarations]
        parts += [f"void line_{line}() {{\n{''.join(body)}}}\n" for line, body in self.functions.items()]
        parts += ["int main() {", '    const char* at = "";', "    try {"]
        for line in self.run:
            at = f"{self.path.name}:{line}"
            parts += [f'        std::puts(at = "{at}");', f"        line_{line}();"]
        parts += ["    } catch (const std::exception& error) {", '        std::fprintf(stderr, "%s: %s\\n", at, error.what());']
        parts += ["        return 1;", "    }", "}", ""]
        return "\n".join(parts)


def write(path, text):
    if not path.exists() or path.read_text() != text:  # what is as it was is not compiled again
        path.write_text(text)
    print(path.name)


def main():
    page, preludes, folder = map(pathlib.Path, sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    snippets = Page(page, preludes)
    if snippets.functions or snippets.declarations:
        write(folder / "snippets.cpp", snippets.source())
    for line, code in snippets.programs.items():
        write(folder / f"program_{line}.cpp", code)


main()
