# SPDX-License-Identifier: GPL-3.0-or-later
"""Snippets of the manual through what reads them: scenes and curricula through `insula check`, C++ through the
compiler, Python and JSON through theirs. One that is only a part of something names the file of the project that it
stands in (<!-- in: PATH -->).
"""
import json
import re
import shlex


FOLDERS = {"scene": "scenes/cases", "curriculum": "curricula"}  # where a file of that root stands


def placed(runner, block):
    """The text of a block, within what it stands in."""
    if block.role != "in":
        return block.text
    frame = (runner.source / block.value).read_text(encoding="utf-8")
    runner.that(frame.count("@SNIPPET@") == 1, block.line, "%s has no @SNIPPET@" % block.value)
    return frame.replace("@SNIPPET@", block.text)


def scene(runner, block):
    if re.match(r"\s*(<\?xml[^>]*>\s*)?(<!--.*?-->\s*)?<part", block.text, re.S):
        return runner.that(
            block.role == "file",
            block.line,
            "a part that no scene of the page includes: give it a name (<!-- file: PATH -->)",
        )
    if block.role == "file" and re.match(r"\s*<study[\s>]", block.text):
        return None  # a command of its page runs it
    root = re.search(r"<(scene|curriculum)[\s>/]", placed(runner, block))
    if not root:
        return runner.that(False, block.line, "a part of a scene; say what it stands in (<!-- in: PATH -->)")
    if block.role == "file" and any(name in block.value for name in ("tether", "pia_membrane", "suture/")):
        return None  # an example of the page's own plugin: its build checks it (manual_plugin_scene, install_plugins)
    path = block.value if block.role == "file" else "%s/snippet_%d.xml" % (FOLDERS[root[1]], block.line)
    (runner.folder / path).write_text(placed(runner, block), encoding="utf-8")
    return runner.run(["insula", "check", path], block.line, "insula check " + path)


def compiled(runner, block):
    """Whether it compiles as a source of a plugin does: with the command of one."""
    if block.role == "file":
        return None  # tether and pia_membrane: built and tested (manual_plugin_tests, install_plugins)
    commands = json.loads((runner.build / "compile_commands.json").read_text(encoding="utf-8"))
    like = next(c for c in commands if "insula_plugins.dir/" in c["command"])
    source = runner.folder / ("snippet_%d.cpp" % block.line)
    source.write_text(placed(runner, block), encoding="utf-8")
    words = [w for w in shlex.split(like["command"]) if w != like["file"] and not w.endswith("ccache")]
    at = words.index("-o")
    words = words[:at] + words[at + 2 :] + ["-fsyntax-only", str(source)]
    words.remove("-c")
    for i, word in enumerate(words):  # folders are named from the build's
        if i > 0 and words[i - 1] in ("-I", "-isystem"):
            words[i] = str((runner.build / word).resolve())
        elif word.startswith("-I"):
            words[i] = "-I" + str((runner.build / word[2:]).resolve())
    return runner.run(words, block.line, "compiling the snippet of line %d" % block.line)


def parsed(runner, block):
    try:
        json.loads(block.text)
        runner.done += 1
    except ValueError as e:
        runner.that(False, block.line, "no JSON: %s" % e)


def python(runner, block):
    try:
        compile(placed(runner, block), "%s:%d" % (runner.name, block.line), "exec")
    except SyntaxError as e:
        return runner.that(False, block.line, "no Python: %s" % e)
    words = ["python3", "-c", placed(runner, block)]
    if re.search(r"^(import insula|from insula import .*|import pyarrow\S*)$", words[2], re.M):
        if not list((runner.build / "python/insula").glob("_core*.so")):
            runner.skipped += 1
            return print("the Python package is not built, not run: the Python of line %d" % block.line)
        words[0] = runner.source / "build/python-env/bin/python"
    return runner.run(words, block.line, "the Python of line %d" % block.line)


def configured(runner, block):
    """CMake of a plugin builds its library; or is what `insula new-plugin` has written."""
    if block.role == "in":
        folder = runner.folder / ("snippet_%d" % block.line)
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(placed(runner, block), encoding="utf-8")
        defines = ["-DINSULA_SOURCE_DIR=%s" % runner.source, "-DINSULA_BUILD_DIR=%s" % runner.build]
        runner.run(
            ["cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", *defines],
            block.line,
            "cmake of line %d" % block.line,
        )
        return runner.run(["cmake", "--build", folder / "build"], block.line, "building what line %d says" % block.line)
    runner.that(
        block.role == "lines of", block.line, "say what it stands in (<!-- in: PATH --> or <!-- lines of: PATH -->)"
    )
    there = (runner.folder / block.value).read_text(encoding="utf-8").split("\n") if block.value else []
    for line in block.text.strip().split("\n"):
        runner.that(line in there, block.line, "%s does not say: %s" % (block.value, line))
    runner.done += 1
    return None


READERS = {"xml": scene, "cpp": compiled, "json": parsed, "python": python, "cmake": configured}


def check(runner, block):
    if block.language in READERS:
        READERS[block.language](runner, block)
