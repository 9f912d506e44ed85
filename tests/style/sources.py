# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's sources, and their code without comments and literals."""
import pathlib
import re
import subprocess

# Folders of files that generators write.
GENERATED = ("meshes/", "build/", "viewer/page/node_modules/", "viewer/page/dist/", "viewer/page/src/lcm.ts")
_TOKEN = re.compile(r"""
    //[^\n]* | /\*.*?\*/                           # comments
  | R"(?P<mark>[^(\s]{0,16})\(.*?\)(?P=mark)"      # raw literals
  | "(?:\\.|[^"\\\n])*"                           # texts
  | (?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'           # characters, and not the ' within a number
""", re.S | re.X)


def _blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def code_only(text):
    """The text with comments and literals made blank; each line keeps its number and each character its place."""
    return _TOKEN.sub(_blank, text)


def tracked(source, *endings):
    """The files that git knows, or that it would take, with one of these endings; all that are there without git."""
    try:
        command = ["git", "-C", str(source), "-c", "safe.directory=*"]
        command += ["ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, capture_output=True, check=True).stdout.decode().split("\0")
    except (OSError, subprocess.CalledProcessError):
        listed = [p.relative_to(source).as_posix() for p in pathlib.Path(source).rglob("*") if p.is_file()]
    return [pathlib.Path(source) / f for f in sorted(set(listed))
            if f.endswith(endings) and not f.startswith(GENERATED) and (pathlib.Path(source) / f).is_file()]
