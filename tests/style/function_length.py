#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""function_length.py SOURCE [--list]: no function of the C++ sources is over 60 lines without a reason.

A function's lines run from the line of its opening brace to the line of its closing brace. A longer function passes
when the comment above it says why, with the words "Long because". KNOWN names the long functions that wait to be split,
with their lines: none may grow, and one that has become short must leave the table. --list prints the table anew. """
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from sources import code_only, tracked  # noqa: E402

LIMIT = 60
REASON = "Long because"
KNOWN = pathlib.Path(__file__).with_name("long_functions.json")
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
    """(name, first line, last line) of each function of a source, lambdas within counted to it."""
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


def reasoned(lines, first):
    """Whether the comment above a function, or one in its first two lines, gives the reason."""
    at = first - 1

    def part_of_head(line):
        return line.strip() and not line.strip().startswith("//") and not line.rstrip().endswith(("}", ";"))

    while at > 0 and part_of_head(lines[at - 1]):
        at -= 1
    while at > 0 and lines[at - 1].strip().startswith("//"):
        at -= 1
    return any(REASON in line for line in lines[at : first + 2])


def long_functions(source):
    out = {}
    for path in tracked(source, ".cpp", ".h"):
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        for name, first, last in functions(text):
            length = last - first + 1
            if length > LIMIT and not reasoned(lines, first):
                out["%s: %s" % (path.relative_to(source).as_posix(), name)] = (length, first)
    return out


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    found = long_functions(source)
    if "--list" in sys.argv:
        print(json.dumps({k: v[0] for k, v in sorted(found.items())}, indent=2))
        return 0
    known = json.loads(KNOWN.read_text(encoding="utf-8"))
    # Files move: a function is known by its name, wherever its file is.
    limits = {k.split(": ", 1)[1]: v for k, v in known.items()}
    wrong = []
    for key, (length, first) in sorted(found.items()):
        path, name = key.split(": ", 1)
        allowed = limits.get(name, 0)
        if length > allowed:
            wrong.append("%s:%d: %s has %d lines; %d are allowed" % (path, first, name, length, max(LIMIT, allowed)))
    present = {k.split(": ", 1)[1] for k in found}
    for name in sorted(set(limits) - present):
        wrong.append("long_functions.json: %s is short now; take it out" % name)
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
