#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""libcxx.py SOURCE BUILD [--all]: core/ and plugins/ compile with clang and its own standard library, libc++.

Nothing is linked and no code is made: clang reads the sources and says what it refuses. Sources are read in batches,
since their common headers take most of the time. A batch holds every n-th source, so files of one folder, which may use
the same short names, are seldom together.

--all  each source and each test by itself, with all warnings. It takes several seconds a file.

It needs clang++ (14 or newer), libc++ and a build folder with the generated headers, or else it is skipped (status 77).
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "style"))
from sources import tracked  # noqa: E402

BATCHES = 4
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


def batch(folder, number, files):
    """One source that includes all of them."""
    path = folder / ("batch_%d.cpp" % number)
    path.write_text("".join('#include "%s"\n' % f for f in files))
    return path


def jobs(root, folder, each_alone):
    """(file, flags) of the compilations."""
    ordinary, kernels, tests = sources(root)
    if each_alone:
        yield from ((f, [*WARNINGS, "-Wshadow"]) for f in ordinary + tests)
    else:
        yield from ((batch(folder, k, ordinary[k::BATCHES]), WARNINGS) for k in range(BATCHES))
    for row in SETS if each_alone else SETS[:2]:
        yield from ((f, WARNINGS[:2] + kernel_flags(row)) for f in kernels)


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
        work = list(jobs(root, pathlib.Path(folder), "--all" in words))
        base = command(compiler, root, build)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as several:
            results = list(several.map(lambda job: compiles(base, job), work))
    failed = [text for ok, text in results if not ok]
    print("\n".join(failed))
    print("%d compilations with clang and libc++, %d failed" % (len(results), len(failed)))
    return 1 if failed or not results else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
