#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""function_length.py SOURCE: no function of the C++ and Python sources is over 60 lines without a reason.

A function's lines run from the line of its opening brace, in Python from its def, to its last line. A longer function
passes when the comment directly above it has a sentence that begins with "Long because". ESLint has the same limit for
TypeScript (viewer/page/eslint.config.js).
"""
import ast
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from sources import code_only, tracked  # noqa: E402

LIMIT = 60
REASON = re.compile(r"^\s*(?:///?<?|#)\s*(?:.*[.:;]\s+)?Long because \w+")
NOT_FUNCTIONS = re.compile(r"^\s*(?:inline\s+)?(?:namespace|class|struct|union|enum|extern\s+\"\")")
CONTROL = re.compile(r"\b(?:if|for|while|switch|catch|else|do|try)\b")


def head_before(code, brace):
    """The text between the previous ';', '{' or '}' outside of parentheses and this brace."""
    depth, at = 0, brace - 1
    while at >= 0:
        c = code[at]
        if c in ")]":
            depth += 1
        elif c in "([":
            depth -= 1
            if depth < 0:
                return None  # inside an argument list: a lambda or an initialiser
        elif depth == 0 and c in ";{}":
            if c == "}" and re.match(r"\s*,", code[at + 1 : brace]):
                at -= 1  # a braced initialiser of a member
                continue
            break
        at -= 1
    return code[at + 1 : brace]


def function_name(head):
    """The name of the function that this head declares; None when it declares none."""
    head = re.sub(r"^(?:\s*(?:public|private|protected)\s*:)+", "", head)
    head = re.sub(r"^\s*#.*$", "", head, flags=re.M)
    if NOT_FUNCTIONS.match(re.sub(r"^\s*template\s*<[^{]*?>\s*(?=class|struct)", "", head)) or "(" not in head:
        return None
    before = head[: head.index("(")]
    if "=" in before.replace("operator=", "").replace("==", "") or CONTROL.search(before):
        return None
    found = re.search(r"([~\w:]+|operator\s*\S+)\s*$", before)
    if not found:
        return None
    if found[1].startswith("INSULA_") and found[1] != "INSULA_PLUGIN":
        return None  # a macro that repeats a block of declarations
    if found[1] in ("TEST", "TEST_F", "TEST_P", "TYPED_TEST"):
        return found[1] + head[head.index("(") :].strip().replace("\n", " ")
    return found[1]


def functions(text):
    """(name, first line, last line) of each function of a C++ source, with the lambdas in it."""
    code = code_only(text)
    line_of, line = [], 1
    for c in code:
        line_of.append(line)
        line += c == "\n"
    stack, out = [], []
    for at, c in enumerate(code):
        if c == "{":
            inside = any(name for name, _ in stack)
            head = None if inside else head_before(code, at)
            stack.append((function_name(head) if head else None, at))
        elif c == "}" and stack:
            name, begin = stack.pop()
            if name:
                out.append((name, line_of[begin], line_of[at]))
    return out


def python_functions(text):
    """(name, first line, last line) of each function of a Python source, with the functions in it."""
    out = []

    def visit(node):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)):
                out.append((child.name, child.lineno, child.end_lineno))
            else:
                visit(child)

    visit(ast.parse(text))
    return out


def reasoned(lines, first):
    """Whether the comment directly above the function that begins in line `first` gives the reason."""
    at = first - 1

    def part_of_head(line):
        return line.strip() and not line.strip().startswith(("//", "# ")) and not line.rstrip().endswith(("}", ";"))

    while at > 0 and part_of_head(lines[at - 1]):
        at -= 1
    end = at
    while at > 0 and lines[at - 1].strip().startswith(("//", "# ")):
        at -= 1
    return any(REASON.match(line) for line in lines[at:end])


def long_functions(path):
    """(name, first line, lines) of the functions of a file that are over the limit without a reason."""
    text = path.read_text(encoding="utf-8")
    found = python_functions(text) if path.suffix == ".py" else functions(text)
    lines = text.split("\n")
    return [(name, first, last - first + 1) for name, first, last in found
            if last - first >= LIMIT and not reasoned(lines, first)]


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    wrong = 0
    for path in tracked(source, ".cpp", ".h", ".py"):
        for name, first, length in long_functions(path):
            wrong += 1
            print("%s:%d: %s has %d lines; %d are allowed"
                  % (path.relative_to(source).as_posix(), first, name, length, LIMIT))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
