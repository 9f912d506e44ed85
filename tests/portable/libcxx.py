#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""libcxx.py SOURCE BUILD [--all | --tests]: core/ and plugins/ compile with clang and its own standard library, libc++.

Nothing is linked and no code is made: clang reads the sources and says what it refuses. Sources are read in batches,
since their common headers take most of the time. Files that use the same short names are in different batches.

A run reads all headers, the kernels, and one batch. The number of commits decides which batch, so a few commits later
all have been read.

--all    all batches, and the kernels for each instruction set
--tests  each test by itself; it takes several seconds a file

It needs clang++ (14 or newer), libc++ and a build folder with the generated headers, or else it is skipped (status 77).
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "style"))
from sources import code_only, tracked  # noqa: E402

BATCHES = 4  # at least; a file that clashes with all of them gets one of its own
# The name before the first mark of a declaration at the start of a line; not that of a member.
DECLARED = re.compile(r"^(?:\[\[\w+\]\] )?(?!namespace|template|extern|return|public|private)"
                      r"\w[^\n(={;\[:]*?(?:::[^\n(={;\[:]*?)*(?<!::)\b(\w+)\s*[({=;\[]", re.M)
INCLUDED = re.compile(r'^\s*#\s*include "([^"]+)"', re.M)
WITHIN_KERNELS = re.compile(r"\bKERNEL_\w+")
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wno-error=deprecated-declarations"]
LIBRARIES = ["/usr/include/eigen3", "/usr/include/suitesparse", "/usr/include/bullet"]
# As cmake/core.cmake: name, bytes of a vector, KERNEL_NV, KERNEL_NR, flags.
SETS = [
    ("sse2", 16, 2, 4, []),
    ("avx2", 32, 3, 4, ["-mavx2", "-mfma", "-mf16c"]),
    ("avx512", 64, 3, 8, ["-mavx512f", "-mavx512dq", "-mavx512vl", "-mavx2", "-mfma", "-mf16c"]),
]


def sources(root):
    """(ordinary sources, kernels, tests) of core/ and plugins/."""
    all_of_them = [p for p in tracked(root, ".cpp") if p.relative_to(root).parts[0] in ("core", "plugins")]
    tests = [p for p in all_of_them if p.name.endswith(("_test.cpp", "_fuzz.cpp"))]
    kernels = [p for p in all_of_them if p.name.endswith("kernels_impl.cpp")]
    # It replaces operator new for one program.
    alone = [p for p in all_of_them if p.name == "count_allocations.cpp"]
    return [p for p in all_of_them if p not in tests + kernels + alone], kernels, tests + alone


def command(compiler, root, build):
    places = [root, build / "generated/abi"]
    libraries = [build / "generated", *LIBRARIES]
    return [compiler, "-std=c++20", "-stdlib=libc++", "-fsyntax-only", "-ffp-contract=off", "-ferror-limit=0",
            "-DEIGEN_DONT_PARALLELIZE", '-DINSULA_SOURCE_DIR="%s"' % root, '-DINSULA_BINARY_DIR="%s"' % build,
            *["-I%s" % p for p in places], *[w for p in libraries for w in ("-isystem", str(p))]]


def kernel_flags(row):
    name, width, nv, nr, flags = row
    return ["-DKERNEL_NAME=" + name, "-DKERNEL_BYTES=%d" % width, "-DKERNEL_NV=%d" % nv, "-DKERNEL_NR=%d" % nr,
            "-fno-math-errno", "-Wno-psabi", *flags]


def names(path):
    """What a file declares at the start of a line."""
    return set(DECLARED.findall(code_only(path.read_text(encoding="utf-8"))))


def headers_of(path, root, known):
    """The project's headers that a file includes, directly or not."""
    if path not in known:
        known[path] = set()
        direct = {root / name for name in INCLUDED.findall(path.read_text(encoding="utf-8")) if (root / name).is_file()}
        known[path] = direct.union(*(headers_of(h, root, known) for h in direct))
    return known[path]


def batches(root, files):
    """The files in lists in which no file declares a name that another one, or a header of it, declares too."""
    known = {}
    headers = {f: headers_of(f, root, known) for f in files}
    declared = {f: names(f) for f in {*files, *known}}

    def names_of_headers(a, b):  # those that b includes and a does not
        return set().union(*(declared[h] for h in headers[b] - headers[a]))

    def clash(a, b):
        return (declared[a] & declared[b] or declared[a] & names_of_headers(a, b)
                or declared[b] & names_of_headers(b, a))

    out = [[] for _ in range(BATCHES)]
    for f in files:
        free = [b for b in out if not any(clash(f, other) for other in b)]
        if free:
            min(free, key=len).append(f)
        else:
            out.append([f])
    return out


def one_source(folder, name, files):
    """A source that includes all of them."""
    path = folder / (name + ".cpp")
    path.write_text("".join('#include "%s"\n' % f for f in files))
    return path


def turn(root):
    """How many commits there are; 0 without git."""
    counted = subprocess.run(["git", "-C", str(root), "-c", "safe.directory=*", "rev-list", "--count", "HEAD"],
                             capture_output=True, text=True)
    return int(counted.stdout) if counted.returncode == 0 else 0


def jobs(root, folder, words):
    """(file, flags) of the compilations."""
    ordinary, kernels, tests = sources(root)
    if "--tests" in words:
        return [(f, WARNINGS) for f in tests]
    whole = "--all" in words
    headers = [p for p in tracked(root, ".h") if p.relative_to(root).parts[0] in ("core", "plugins")
               and not WITHIN_KERNELS.search(p.read_text(encoding="utf-8"))]
    parts = batches(root, ordinary)
    chosen = parts if whole else [parts[turn(root) % len(parts)]]
    out = [(one_source(folder, "batch_%d" % k, b), WARNINGS) for k, b in enumerate(chosen)]
    out += [(one_source(folder, "headers", headers), WARNINGS)]
    return out + [(f, WARNINGS[:2] + kernel_flags(row)) for row in (SETS if whole else SETS[:1]) for f in kernels]


def compiles(base, job):
    done = subprocess.run(base + job[1] + [str(job[0])], capture_output=True, text=True)
    return done.returncode == 0, done.stderr


def lacking(compiler, build):
    if not compiler:
        return "clang++ is not installed"
    if not (build / "generated/abi/insula_headers.h").is_file():
        return "%s holds no generated headers: ./insula build" % build
    probe = subprocess.run([compiler, "-stdlib=libc++", "-fsyntax-only", "-x", "c++", "-"],
                           input="#include <version>\n", capture_output=True, text=True)
    return "" if probe.returncode == 0 else "libc++ is not installed (libc++-dev)"


def main(words):
    root, build = pathlib.Path(words[0]).resolve(), pathlib.Path(words[1]).resolve()
    compiler = shutil.which("clang++")
    missing = lacking(compiler, build)
    if missing:
        print("skipped: " + missing)
        return 77
    with tempfile.TemporaryDirectory() as folder:
        work = jobs(root, pathlib.Path(folder), words)
        base = command(compiler, root, build)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as several:
            results = list(several.map(lambda job: compiles(base, job), work))
    failed = [text for ok, text in results if not ok]
    print("\n".join(failed))
    print("%d compilations with clang and libc++, %d failed" % (len(results), len(failed)))
    return 1 if failed or not results else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
