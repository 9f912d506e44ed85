#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the manual against the project: links, files, scenes, printed messages, commands, names of tests, stated
defaults.

    check_docs.py SOURCE_FOLDER INSULA_PROGRAM [HAPTIC_SERVER_PROGRAM]
"""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import defaults  # noqa: E402
import pages  # noqa: E402

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`]+)`")
PATH = re.compile(r"[A-Za-z0-9_.\-]+(/[A-Za-z0-9_.\-*]+)+/?")
TEST = re.compile(r"([A-Z]\w+)\.([A-Z]\w+)")
DECLARED = re.compile(r"\b(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)")
LONGEST_PAGE = 240


class Checker:
    def __init__(self, source, insula, haptic_server):
        self.source, self.insula, self.haptic_server = source, insula, haptic_server
        self.failures = 0
        self.counts = {}
        self.help = {}
        self.declared = defaults.Declared(source, insula, haptic_server)
        made = ("build", "dist")
        self.folders = {p.name for p in source.iterdir() if p.is_dir() and p.name not in made}
        self.tests = set()
        for folder in ("core", "plugins", "haptic_server", "engine", "viewer/gateway", "tests", "tools"):
            for file in [*(source / folder).rglob("*.cpp"), *(source / folder).rglob("*_for_test.h")]:
                self.tests.update(DECLARED.findall(file.read_text(encoding="utf-8", errors="replace")))
        script = (source / "insula").read_text(encoding="utf-8")
        self.script_usage = [l for l in script.split("\n") if l.startswith("  ./insula ")]
        self.script_words = set(re.findall(r"^  ([a-z|\-]+)\)", script, re.M))
        self.script_words = {w for words in self.script_words for w in words.split("|")}

    def that(self, ok, where, text):
        if not ok:
            self.failures += 1
            print("FAILED: %s:%d: %s" % (where[0].relative_to(self.source), where[1], text))

    def count(self, what):
        self.counts[what] = self.counts.get(what, 0) + 1

    def run(self, *arguments, cwd=None):
        done = subprocess.run([str(a) for a in arguments], cwd=cwd, capture_output=True, text=True, timeout=300)
        return done.returncode, done.stdout + done.stderr

    # --- text -------------------------------------------------------------------------------------------------------
    def links(self, page, outside):
        for number, line in outside:
            for target in LINK.findall(line):
                if re.match(r"[a-z]+:", target) or target.startswith("#"):
                    continue
                self.count("links")
                self.that(
                    (page.parent / target.split("#")[0]).exists(), (page, number), "link to %s leads nowhere" % target
                )

    def named_files(self, page, outside, promised):
        """`core/sim/simulation.cpp`: paths that begin with a folder of the project. What a page brings is fine."""
        for number, line in outside:
            for code in CODE.findall(line):
                name = code.strip()
                if not PATH.fullmatch(name) or name.split("/")[0] not in self.folders:
                    continue
                if name in promised or any(p.startswith(name.rstrip("/") + "/") for p in promised):
                    continue
                self.count("files")
                found = any(self.source.glob(name)) if "*" in name else (self.source / name).exists()
                self.that(found, (page, number), "`%s` does not exist" % name)

    def test_names(self, page, outside):
        for number, line in outside:
            for code in CODE.findall(line):
                name = TEST.fullmatch(code.strip())
                if not name:
                    continue
                self.count("tests")
                self.that(name.groups() in self.tests, (page, number), "there is no test %s" % code)

    def stated_defaults(self, page, outside):
        for number, text in defaults.texts(outside):
            claims, wrong = self.declared.check(text)
            for _ in range(claims):
                self.count("defaults")
            for what in wrong:
                self.that(False, (page, number), what)

    # --- commands ---------------------------------------------------------------------------------------------------
    def help_of(self, *command):
        if command not in self.help:
            status, text = self.run(*command, "--help")
            self.help[command] = text if status == 0 else ""
        return self.help[command]

    def subcommands(self):
        listed = self.help_of(self.insula).split("Subcommands:")[-1]
        return set(re.findall(r"^  ([a-z-]+)\s", listed, re.M))

    def options(self, where, words, help_text):
        for word in words:
            if word.startswith("--") and len(word) > 2:
                known = re.search(r"(?<![\w-])%s(?![\w-])" % re.escape(word.split("=")[0]), help_text)
                self.that(known, where, "%s is no option of this command" % word)

    def command_line(self, where, line):
        try:
            words = shlex.split(line, comments=True)
        except ValueError as e:
            return self.that(False, where, "no command line: %s" % e)
        while words and "=" in words[0]:  # variables of the environment
            words.pop(0)
        if words and words[0] == "sudo":
            words.pop(0)
        if not words:
            return
        program = words.pop(0)
        if program.endswith("haptic_server"):
            self.count("commands")
            if self.haptic_server:
                self.options(where, words, self.help_of(self.haptic_server))
            return
        if program not in ("insula", "./insula") and not program.endswith("/bin/insula"):
            return
        self.count("commands")
        while words and words[0].startswith("--"):
            self.options(where, words[:1], self.help_of(self.insula))
            words = words[2:]
        self.that(words, where, "a command is missing")
        if not words:
            return
        command = words.pop(0)
        if program == "./insula" and command in self.script_words - self.subcommands():
            return
        self.that(command in self.subcommands(), where, "insula has no command %s" % command)
        if command in self.subcommands():
            own = "\n".join(
                l for l in self.script_usage if program == "./insula" and l.startswith("  ./insula %s " % command)
            )
            self.options(where, words, self.help_of(self.insula, command) + own)

    # --- scenes -----------------------------------------------------------------------------------------------------
    def project(self, folder):
        """What scenes may name, as hard links where the file system allows it."""

        def put(a, b):
            try:
                pathlib.Path(b).hardlink_to(a)
            except OSError:
                shutil.copyfile(a, b)

        for name in ("curricula", "meshes", "scenes", "plugins"):
            shutil.copytree(self.source / name, folder / name, copy_function=put)

    def scenes(self, page, blocks, foreign):
        """Complete scenes pass; printed output is what is printed. `foreign`: needs plugins that this program lacks."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name).resolve()
            self.project(folder)
            to_check = []
            for block in blocks:
                path = block.value if block.role in ("file", "bad") else ""
                complete = block.language == "xml" and re.match(r"\s*(<\?xml|<scene|<curriculum)", block.text)
                if not path and complete:
                    path = "scenes/cases/snippet_%d.xml" % block.line
                if path:
                    (folder / path).parent.mkdir(parents=True, exist_ok=True)
                    (folder / path).unlink(missing_ok=True)
                    (folder / path).write_text(block.text, encoding="utf-8")
                if complete and block.role != "bad" and path not in foreign:
                    to_check.append((block.line, path))
            for line, path in to_check:
                self.count("scenes")
                status, text = self.run(self.insula, "check", path, cwd=folder)
                # That this machine is too slow for a scene just now says nothing of the page.
                rest = re.sub(r".*: warning: too slow for this machine.*\n", "", text)
                self.that(status == 0 and "warning" not in rest, (page, line), "the scene is not right:\n" + text)
            for block in blocks:
                if block.role != "output":
                    continue
                self.count("outputs")
                words = shlex.split(block.value)
                self.that(words[0] == "insula", (page, block.line), "output of an unknown program")
                _, text = self.run(self.insula, *words[1:], cwd=folder)
                self.that(
                    text.strip() == block.text.strip(), (page, block.line), "`%s` prints:\n%s" % (block.value, text)
                )

    def page(self, page):
        blocks, outside = pages.read(page)
        length = len(page.read_text(encoding="utf-8").split("\n"))
        self.that(length <= LONGEST_PAGE, (page, length), "longer than %d lines" % LONGEST_PAGE)
        promised = {b.value for b in blocks if b.role in ("file", "bad")}
        self.links(page, outside)
        self.named_files(page, outside, promised)
        self.test_names(page, outside)
        self.stated_defaults(page, outside)
        for block in blocks:
            if block.language == "sh":
                for number, line in pages.commands(block):
                    self.command_line((page, number), line)
        if any(b.language == "xml" or b.role == "output" for b in blocks):
            # A page that brings a plugin shows scenes for it; the build of that plugin checks them.
            brought = {p.rsplit("/", 1)[0] for p in promised if p.endswith(".cpp")}
            foreign = {p for p in promised if p.rsplit("/", 1)[0] in brought}
            self.scenes(page, blocks, foreign)


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    check = Checker(
        source, pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
    )
    if not check.subcommands():
        print("FAILED: %s --help lists no commands" % check.insula)
        return 1
    for page in pages.all_pages(source):
        check.page(page)
    for what in ("links", "files", "scenes", "outputs", "commands", "tests", "defaults"):
        if not check.counts.get(what):
            check.failures += 1
            print("FAILED: no %s were found in the manual; is it read rightly?" % what)
    print(", ".join("%d %s" % (n, what) for what, n in sorted(check.counts.items())) + "; %d failures" % check.failures)
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main())
