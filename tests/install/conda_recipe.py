#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""conda_recipe.py SOURCE: the recipe for conda-forge, read by rattler-build, which builds such recipes, and by
conda-smithy, conda-forge's linter, where it is installed. It must also name this version and the files that there are.
"""
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from steps import run, that  # noqa: E402

# conda-forge gives these to each recipe.
VARIANTS = "c_compiler: [gcc]\ncxx_compiler: [gxx]\nc_stdlib: [sysroot]\nc_stdlib_version: ['2.17']\n"
# What cmake/dependencies.cmake looks for, by conda-forge's names.
NAMES = {"Eigen3": "eigen", "fmt": "fmt", "spdlog": "spdlog", "CLI11": "cli11", "nlohmann_json": "nlohmann_json",
         "EXPAT": "libexpat", "Boost": "libboost-headers", "ZLIB": "zlib", "SQLite3": "libsqlite", "CURL": "libcurl",
         "OpenSSL": "openssl", "assimp": "assimp", "avahi-core": "avahi", "libzstd": "zstd", "libzip": "libzip",
         "urdfdom": "urdfdom", "console_bridge": "console_bridge", "lcm": "lcm", "cholmod": "suitesparse"}
OF_THE_SYSTEM = {"Threads", "PkgConfig", "GTest"}


def wanted(cmake):
    """The libraries that CMake looks for, without those of tests alone."""
    text = re.sub(r"if\(BUILD_TESTING\).*?endif\(\)", "", cmake, flags=re.S)
    found = re.findall(r"^find_package\((\w+)", text, re.M) + re.findall(r"IMPORTED_TARGET ([\w-]+)", text)
    return set(found + re.findall(r"^find_library\(\w+ (\w+)", text, re.M)) - OF_THE_SYSTEM


def main():
    source = pathlib.Path(sys.argv[1])
    folder = source / "packaging/conda/recipe"
    text = (folder / "recipe.yaml").read_text()
    version = re.search(r"project\(insula VERSION ([\d.]+)", (source / "CMakeLists.txt").read_text())[1]
    that('version: "%s"' % version in text, "the recipe is not of version " + version)
    host = re.search(r"^  host:\n((?:    - .*\n)+)", text, re.M)[1]
    for library in sorted(wanted((source / "cmake/dependencies.cmake").read_text())):
        that(library in NAMES, "cmake/dependencies.cmake looks for %s: add it to the recipe and here" % library)
        that("    - %s\n" % NAMES[library] in host, "the recipe's host section lacks " + NAMES[library])
    linted = False
    try:
        import rattler_build
    except ImportError:
        print("rattler-build is not installed (py-rattler-build)")
    else:
        recipe = rattler_build.Stage0Recipe.from_file(folder / "recipe.yaml")
        made = recipe.render(rattler_build.VariantConfig.from_yaml(VARIANTS))
        that(len(made) == 1, "rattler-build makes %d packages of the recipe" % len(made))
        linted = True
    smithy = shutil.which("conda-smithy")
    if smithy:
        run(smithy, "recipe-lint", folder)
        linted = True
    else:
        print("conda-smithy is not installed")
    return 0 if linted else 77


if __name__ == "__main__":
    sys.exit(main())
