#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens lcm-spy's window on a screen of its own, beside a running engine: it finds every message type and goes on.

    run_spy.py SOURCE_FOLDER BUILD_FOLDER
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "docs"))
import bus  # noqa: E402

SKIPPED = 77
NEEDED = ("java", "javac", "jar", "lcm-gen", "Xvfb")
WATCHED_S = 4


def skip_if_a_program_is_missing():
    missing = [p for p in NEEDED if not shutil.which(p)] + [
        j for j in ("lcm", "jchart2d") if not pathlib.Path(f"/usr/share/java/{j}.jar").exists()
    ]
    if missing or not bus.works():
        print("skipped:", ", ".join(missing) + " not installed" if missing else "no multicast")
        sys.exit(SKIPPED)


def open_screen():
    """Starts a virtual screen. Returns its process and its name."""
    read, write = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24"], pass_fds=[write], stderr=subprocess.DEVNULL
    )
    os.close(write)  # otherwise the read below would wait forever if the screen does not open
    return screen, ":" + os.read(read, 16).decode().strip()


def text_of(log):
    log.seek(0)
    return log.read()


def watch(spy, log):
    """Waits for the window and a little longer. Returns whether the spy still runs, and its output."""
    end = time.monotonic() + 60
    # The spy lists the plugins last, just before its window opens.
    while time.monotonic() < end and spy.poll() is None and "plugins" not in text_of(log):
        time.sleep(0.2)
    time.sleep(WATCHED_S)
    return spy.poll() is None, text_of(log)


def main():
    source, build = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    skip_if_a_program_is_missing()
    written = {
        name
        for f in (source / "lcm_types").glob("*.lcm")
        for name in re.findall(r"^struct (\w+)", f.read_text(encoding="utf-8"), re.M)
    }
    port = bus.free_port()
    with tempfile.TemporaryDirectory(prefix="insula_spy_") as folder:
        screen, display = open_screen()
        bus_url = f"udpm://239.255.76.67:{port}?ttl=0"
        env = dict(os.environ, DISPLAY=display, LCM_DEFAULT_URL=bus_url, XDG_RUNTIME_DIR=folder)
        log = open(pathlib.Path(folder) / "spy.log", "w+")
        scene = str(source / "scenes/training/1_sylvian_fissure.xml")
        engine = subprocess.Popen(
            [str(build / "bin/insula"), "engine", scene, "--motion", "none"],
            cwd=folder,
            env=env,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        command = [str(source / "tools/spy/spy.sh"), str(pathlib.Path(folder) / "java")]
        spy = subprocess.Popen(command, env=env, stdout=log, stderr=subprocess.STDOUT)
        try:
            with bus.join(port) as listener:
                sent = bus.heard(listener, "RENDER_FRAME", 20, lambda: engine.poll() is None, 60)
            alive, said = watch(spy, log)
        finally:
            for p in (spy, engine, screen):
                p.terminate()
                p.wait(30)
    print(said)
    assert sent, "the engine sends nothing"
    assert alive, "the window is gone"
    assert f"Found {len(written)} LCM types" in said, f"{len(written)} types are written"
    assert "Exception" not in said


if __name__ == "__main__":
    main()
