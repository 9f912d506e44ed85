#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""apt_repository.py SOURCE BUILD: the repository for apt that packaging/apt/repository.py makes, read by apt itself.

apt works in folders of this test, so it needs no rights and changes nothing. Small packages stand in for the real ones.
"""
import os
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from steps import run, that  # noqa: E402

TOOLS = ("apt-ftparchive", "gpg", "gpgv", "dpkg-deb", "apt-get", "apt-cache")


def package(work, version):
    tree = work / ("tree_" + version)
    (tree / "DEBIAN").mkdir(parents=True)
    (tree / "DEBIAN/control").write_text("Package: insula\nVersion: %s\nArchitecture: amd64\nMaintainer: none <a@b>\n"
                                         "Description: stands in for Insula\n" % version)
    made = work / ("insula_%s.deb" % version)
    run("dpkg-deb", "--root-owner-group", "--build", tree, made)
    return made


class Apt:
    """apt with folders of its own."""

    def __init__(self, work, repository, keyring):
        for name in ("etc/sources.list.d", "etc/preferences.d", "state/lists/partial", "cache/archives/partial"):
            (work / "apt" / name).mkdir(parents=True, exist_ok=True)
        (work / "apt/status").touch()
        (work / "apt/etc/sources.list.d/insula.sources").write_text(
            (repository / "insula.sources").read_text().replace("URIs: file:", "URIs: copy:")
            .replace("/usr/share/keyrings/insula-archive-keyring.gpg", str(keyring)))
        self.words = ["-o", "Dir::Etc=%s" % (work / "apt/etc"), "-o", "Dir::State=%s" % (work / "apt/state"),
                      "-o", "Dir::Cache=%s" % (work / "apt/cache"), "-o", "APT::Architecture=amd64",
                      "-o", "Dir::State::status=%s" % (work / "apt/status"), "-o", "APT::Sandbox::User=",
                      "-o", "Acquire::Languages=none", "-o", "APT::Update::Error-Mode=any"]

    def __call__(self, program, *words, status=0):
        return run(program, *self.words, *words, status=status, env={**os.environ, "LC_ALL": "C"})


def main():
    source, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]) / "tests/apt"
    missing = [t for t in TOOLS if not shutil.which(t)]
    if missing:
        print("skipped: no %s here (apt-utils, gnupg)" % ", ".join(missing))
        return 77
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    os.environ["XDG_DATA_HOME"] = str(work / "data")
    maker, repository = [sys.executable, "-B", source / "packaging/apt/repository.py"], work / "repository"
    run(*maker, repository, package(work, "1.0"))
    keyring = repository / "insula-archive-keyring.gpg"
    key = keyring.read_bytes()
    apt = Apt(work, repository, keyring)
    apt("apt-get", "update")
    that("Candidate: 1.0" in apt("apt-cache", "policy", "insula"), "apt does not offer version 1.0")
    run(*maker, repository, package(work, "1.1"))
    that(keyring.read_bytes() == key, "the second use made another key")
    apt("apt-get", "update")
    offered = apt("apt-cache", "policy", "insula")
    that("Candidate: 1.1" in offered and " 1.0 " in offered, "apt does not offer both versions:\n" + offered)
    apt("apt-get", "--download-only", "-y", "install", "insula")
    that((work / "apt/cache/archives/insula_1.1_amd64.deb").is_file(), "the package was not fetched")

    # What somebody else changes is refused.
    index = repository / "dists/stable/InRelease"
    signed = index.read_text()
    index.write_text(signed.replace("Label: Insula", "Label: Other"))
    (repository / "dists/stable/Release.gpg").unlink()
    that("invalid" in apt("apt-get", "update", status=100), "a changed index is accepted")
    index.write_text(signed)
    other = work / "other.gpg"
    os.environ["XDG_DATA_HOME"] = str(work / "other_data")
    run(*maker, work / "other_repository", work / "insula_1.0.deb")
    shutil.copyfile(work / "other_repository/insula-archive-keyring.gpg", other)
    that("NO_PUBKEY" in Apt(work, repository, other)("apt-get", "update", status=100), "another's key is accepted")

    # What cannot be done is said.
    text = run(*maker, repository, work / "insula_1.0.deb", "--key", "nobody", status=1)
    that("no secret key 'nobody'" in text, "an unknown key: " + text)
    changed = work / "changed.deb"
    shutil.rmtree(work / "tree_1.1")
    shutil.move(package(work, "1.1"), changed)
    changed.write_bytes(changed.read_bytes() + b"\n")
    text = run(*maker, repository, changed, status=1)
    that("Raise the version" in text, "a package with other contents: " + text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
