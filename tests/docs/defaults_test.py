#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""defaults_test.py SOURCE INSULA [HAPTIC_SERVER]: sentences with right and wrong defaults, made from declared ones."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import defaults  # noqa: E402


def main():
    declared = defaults.Declared(pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:4])
    failures = 0

    def expect(text, claims, wrong):
        nonlocal failures
        got = declared.check(text)
        if (got[0], len(got[1])) != (claims, wrong):
            failures += 1
            print("FAILED: %s: %d claims and %s in place of %d and %d" % (text, got[0], got[1], claims, wrong))

    # A length of an element that no other element declares, as it stands there.
    alone = [(n, *next(iter(f.items()))) for n, f in sorted(declared.parameters.items())
             if len(f) == 1 and n not in declared.others]
    lengths = [p for p in alone if p[2].endswith(" mm") and p[2][0] in "123456789" and " " not in p[2][:-3]]
    name, element, value = lengths[0]
    number = float(value[:-3])
    um, other = "%.10g um" % (1000 * number), "%.10g mm" % (number + 1)
    for form in ("`{n}` (default {v})", "The default of `{n}` is {v}.", "`{n}` is {v} by default.",
                 "{v}, the default of `{n}`, is right for most.", "| `{n}` | {v} (default) | a row |",
                 "`<{e}>` has `{n}` (default {v})."):
        expect(form.format(n=name, v=value, e=element), 1, 0)
        expect(form.format(n=name, v=um, e=element), 1, 0)
        expect(form.format(n=name, v=other, e=element), 1, 1)
        expect(form.format(n=name, v="%.10g" % number, e=element), 1, 1)   # without its unit
        expect(form.format(n=name, v="%.10g s" % number, e=element), 1, 1)
    expect("`nobody_declares_this` (default 3 mm)", 1, 1)
    expect("`%s` is often %s." % (name, other), 0, 0)
    choice, where, text = next(p for p in alone if p[2] in ("triangles", "hinges"))
    expect("`%s=\"%s\"` (default) of `<%s>`" % (choice, text, where), 1, 0)
    expect("`%s=\"other\"` (default) of `<%s>`" % (choice, where), 1, 1)
    print("%d parameters, %d other names; %d failures" % (len(declared.parameters), len(declared.others), failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
