#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""repository.py DIR PACKAGE.deb... [--key KEY]: a signed repository for apt in a folder, for a web server or a stick.

Packages that the folder already holds stay in it, so that machines can go back to an older version. The index is made
by apt-ftparchive and signed by gpg. Without --key, it is signed by a key that is made at the first use and kept in
$XDG_DATA_HOME/insula/packaging/gnupg (default: ~/.local/share). Whoever has this key can sign packages: keep it.
"""
import argparse
import gzip
import lzma
import os
import pathlib
import re
import shutil
import subprocess
import sys

SUITE, PART, KEYRING = "stable", "main", "insula-archive-keyring.gpg"
OWN_KEY = "Insula packages <insula@localhost>"
SOURCES = """# For /etc/apt/sources.list.d/, with the address of this folder behind "URIs:".
Types: deb
URIs: %s
Suites: stable
Components: main
Architectures: %s
Signed-By: /usr/share/keyrings/insula-archive-keyring.gpg
"""


def fail(text):
    sys.exit("error: " + text)


def run(*command, text=None, cwd=None):
    try:
        return subprocess.run([str(c) for c in command], cwd=cwd, check=True, capture_output=True, input=text).stdout
    except FileNotFoundError:
        fail("%s is not installed: apt-get install apt-utils gnupg dpkg" % command[0])
    except subprocess.CalledProcessError as e:
        fail("%s failed:\n%s" % (" ".join(str(c) for c in command[:3]), e.stderr.decode(errors="replace").strip()))


class Signer:
    """gpg with the wanted key."""

    def __init__(self, wanted):
        self.command = ["gpg", "--batch", "--yes", "--no-tty"]
        if wanted is None:
            self.command += ["--homedir", str(self.own_ring())]
            wanted = "=" + OWN_KEY
            if not self.fingerprints(wanted):
                run(*self.command, "--pinentry-mode", "loopback", "--passphrase", "", "--quick-generate-key", OWN_KEY,
                    "ed25519", "sign", "never")
        found = self.fingerprints(wanted)
        if not found:
            fail("gpg has no secret key %r; gpg --list-secret-keys says which there are" % wanted)
        if len(found) > 1:
            fail("%r means several keys; name one of them by its fingerprint:\n  %s" % (wanted, "\n  ".join(found)))
        self.key = found[0]

    @staticmethod
    def own_ring():
        data = os.environ.get("XDG_DATA_HOME") or pathlib.Path.home() / ".local/share"
        ring = pathlib.Path(data) / "insula/packaging/gnupg"
        ring.mkdir(parents=True, exist_ok=True)
        ring.chmod(0o700)
        return ring

    def fingerprints(self, wanted):
        """Of the main keys that the words mean; none when there is no such secret key."""
        try:
            listed = subprocess.run([*self.command, "--with-colons", "--list-secret-keys", wanted], capture_output=True)
        except FileNotFoundError:
            fail("gpg is not installed: apt-get install gnupg")
        return re.findall(r"^sec:.*\nfpr:+([0-9A-F]+):$", listed.stdout.decode(), re.M)

    def sign(self, how, source, target):
        run(*self.command, "--local-user", self.key, "--digest-algo", "SHA512", "--armor", "--output", target, how,
            source)

    def export(self, target):
        target.write_bytes(run(*self.command, "--export", self.key))


def put_into_pool(folder, packages):
    """Copies the packages; one that is there already must be the same file."""
    for package in packages:
        name, version, machine = (run("dpkg-deb", "--field", package, f).decode().strip()
                                  for f in ("Package", "Version", "Architecture"))
        place = folder / "pool" / PART / name[0] / name / ("%s_%s_%s.deb" % (name, version.split(":")[-1], machine))
        if place.exists() and place.read_bytes() != package.read_bytes():
            fail("%s is in the repository with other contents: machines that have it would not get the new one. Raise "
                 "the version, or remove %s" % (place.name, place))
        place.parent.mkdir(parents=True, exist_ok=True)
        if not place.exists():
            shutil.copyfile(package, place)


def write_index(folder):
    """Packages and Release of all that the pool holds; returns the architectures."""
    machines = sorted({p.stem.rsplit("_", 1)[1] for p in (folder / "pool").rglob("*.deb")} - {"all"}) or ["all"]
    suite = folder / "dists" / SUITE
    shutil.rmtree(suite, ignore_errors=True)
    for machine in machines:
        place = suite / PART / ("binary-" + machine)
        place.mkdir(parents=True)
        index = run("apt-ftparchive", "--arch", machine, "packages", "pool", cwd=folder)
        (place / "Packages").write_bytes(index)
        (place / "Packages.gz").write_bytes(gzip.compress(index, mtime=0))
        (place / "Packages.xz").write_bytes(lzma.compress(index))
    said = {"Origin": "Insula", "Label": "Insula", "Suite": SUITE, "Codename": SUITE, "Components": PART,
            "Architectures": " ".join(machines), "Description": "Insula: aneurysm surgery with two-handed haptics"}
    options = [w for name, value in said.items() for w in ("-o", "APT::FTPArchive::Release::%s=%s" % (name, value))]
    release = run("apt-ftparchive", *options, "release", suite)
    (suite / "Release").write_bytes(release)
    return machines


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0].split(": ", 1)[1])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("packages", type=pathlib.Path, nargs="+")
    parser.add_argument("--key", help="secret key of gpg that signs: fingerprint, or what is unique in its name")
    given = parser.parse_args()
    for package in given.packages:
        if not package.is_file():
            fail("%s is no file" % package)
    signer = Signer(given.key)
    folder = given.folder.resolve()
    put_into_pool(folder, given.packages)
    machines = write_index(folder)
    suite = folder / "dists" / SUITE
    signer.sign("--clear-sign", suite / "Release", suite / "InRelease")
    signer.sign("--detach-sign", suite / "Release", suite / "Release.gpg")
    signer.export(folder / KEYRING)
    (folder / "insula.sources").write_text(SOURCES % (folder.as_uri(), " ".join(machines)))
    print("The repository %s is signed by %s. On each machine, as root, with its address in the file:\n"
          "  install -m 644 %s /usr/share/keyrings/\n  install -m 644 insula.sources /etc/apt/sources.list.d/\n"
          "  apt-get update && apt-get install insula" % (folder, signer.key, KEYRING))


if __name__ == "__main__":
    main()
