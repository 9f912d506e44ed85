# SPDX-License-Identifier: GPL-3.0-or-later
"""Python with the packages from PyPI that the tests of Python programs need."""
import re
import shutil
import subprocess
import sys

SKIPPED = 77
PACKAGES = ["lcm", "mcap", "pyarrow", "zstandard"]


def skip(why):
    print("SKIPPED:", why)
    sys.exit(SKIPPED)


def environment(build):
    """Python of a virtual environment with the packages; kept from one run to the next."""
    folder = build / "python_venv"
    python = folder / "bin" / "python"
    imports = "import " + ", ".join(PACKAGES)
    if python.exists() and subprocess.run([python, "-c", imports], capture_output=True).returncode == 0:
        return python
    shutil.rmtree(folder, ignore_errors=True)
    made = subprocess.run([sys.executable, "-m", "venv", str(folder)], capture_output=True, text=True)
    if made.returncode != 0:
        sys.exit("error: no virtual environment (package python3-venv):\n" + made.stdout + made.stderr)
    got = subprocess.run(
        [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PACKAGES],
        capture_output=True,
        text=True,
    )
    if got.returncode != 0:
        if re.search(
            r"NewConnectionError|ConnectionError|Temporary failure|timed out|No matching distribution"
            r"|ProxyError|SSLError",
            got.stdout + got.stderr,
        ):
            shutil.rmtree(folder, ignore_errors=True)
            skip("PyPI cannot be reached, so there are no packages:\n" + got.stderr[-500:])
        sys.exit("error: pip install " + " ".join(PACKAGES) + ":\n" + got.stdout + got.stderr)
    return python
