# SPDX-License-Identifier: BSD-3-Clause
"""python3 sizes.py <include>: no header has more than 350 lines, and no function in one more than 80, from the first line of its
head, without template parameters, to the brace that closes it (CONTRIBUTING.md)."""
import pathlib
import re
import sys

HEADER_LINES = 350
FUNCTION_LINES = 80

# What is no code, as blanks of the same length: comments, strings, characters, preprocessor lines.
NO_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
    r'|^[ \t]*#(?:\\\n|[^\n])*', re.DOTALL | re.MULTILINE)
ACCESS = re.compile(r'(?:public|private|protected)\s*:')
TEMPLATE = re.compile(r'template\s*<')
SCOPE = re.compile(r'\b(?:namespace|struct|class|union|enum|extern)\b')
CONCEPT = re.compile(r'concept\b')


def blanked(match):
    return re.sub(r'[^\n]', ' ', match.group())


def start_of(code, begin, end):
    """Where a declaration begins, behind spaces, `public:` and template parameters."""
    while True:
        while begin < end and code[begin].isspace():
            begin += 1
        if access := ACCESS.match(code, begin, end):
            begin = access.end()
        elif template := TEMPLATE.match(code, begin, end):
            begin = template.end()
            depth = 1
            while depth > 0 and begin < end:
                depth += {'<': 1, '>': -1}.get(code[begin], 0)
                begin += 1
        else:
            return begin


def is_scope(head):
    """Whether a brace after this head opens a namespace or a class."""
    while (inner := re.sub(r'\([^()]*\)', '', head)) != head:
        head = inner
    return SCOPE.search(head) is not None


def functions(code):
    """First line, last line and name of each function that is not within another."""
    begin = 0  # of the declaration that the next brace may belong to
    parentheses = 0
    depth = 0  # of braces below classes: in functions and initialisers
    start = None  # of the function that these are of
    for at, character in enumerate(code):
        if character == '{' and depth == 0 and parentheses == 0:
            start = start_of(code, begin, at)
            if is_scope(code[start:at]):
                start = None
                begin = at + 1
                continue
            if '(' not in code[start:at] or CONCEPT.match(code, start):
                start = None
        if character == '{':
            depth += 1
        elif character == '}' and depth > 0:
            depth -= 1
            if depth > 0 or parentheses > 0 or code[at + 1:at + 200].lstrip()[:1] in (',', '{'):
                continue  # a member's initialiser: the function goes on
            if start is not None:
                name = ' '.join(code[start:code.index('(', start)].split())
                yield code.count('\n', 0, start) + 1, code.count('\n', 0, at) + 1, name
                begin = at + 1
            start = None
        elif depth == 0 and character in '()':
            parentheses += 1 if character == '(' else -1
        elif depth == 0 and parentheses == 0 and character in ';}':
            begin = at + 1


def main():
    include = pathlib.Path(sys.argv[1])
    headers = sorted(path for path in include.rglob('*') if path.suffix in ('.hpp', '.ipp'))
    n_functions = 0
    wrong = []
    for path in headers:
        text = path.read_text()
        name = path.relative_to(include)
        lines = text.count('\n')
        if lines > HEADER_LINES:
            wrong.append(f'{name}: {lines} lines, at most {HEADER_LINES}')
        for first, last, function in functions(NO_CODE.sub(blanked, text)):
            n_functions += 1
            if last - first + 1 > FUNCTION_LINES:
                wrong.append(f'{name}:{first}: {last - first + 1} lines, at most {FUNCTION_LINES}: {function}')
    print(f'{n_functions} functions in {len(headers)} headers')
    if len(headers) < 100 or n_functions < 1000:
        sys.exit(f'these are too few: not {include} of springfit, or written in a way that this program cannot read')
    if wrong:
        sys.exit('Too long; split it along what it is about:\n' + '\n'.join(wrong))


if __name__ == '__main__':
    main()
