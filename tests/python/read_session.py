#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records a run, and reads the file with the package mcap as a stranger would: its summary, topics, attachments and
messages must agree with what the program says of it.

    read_session.py SOURCE_FOLDER BUILD_FOLDER LCM_GEN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from packages import environment

SCENE = """<scene title="Stylus" time_step="10 ms">
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="mm"><corotational_fem/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface/></soft_body>
</scene>
"""
READ = """
import hashlib, json, sys
from mcap.reader import make_reader
sys.path.insert(0, sys.argv[2])
from insula_lcm import session_step_t
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True)
    summary = reader.get_summary()
    steps = [session_step_t.decode(m.data) for _, _, m in reader.iter_messages(topics=["STEP"])]
    about = {m.name: m.metadata for m in reader.iter_metadata()}
    texts = {a.name: hashlib.sha256(a.data).hexdigest() for a in reader.iter_attachments()}
    schemas = [s.name + " " + str(b"struct" in s.data) for s in summary.schemas.values()]
    channels = [json.loads(m.data) for _, _, m in reader.iter_messages(topics=["CHANNELS"])]
    count = lambda topic: sum(1 for _ in reader.iter_messages(topics=[topic]))
    late = sum(1 for _ in reader.iter_messages(topics=["STEP"], start_time=10**9, end_time=2 * 10**9))
    print(json.dumps({
        "messages": summary.statistics.message_count, "schemas": schemas, "about": about, "texts": texts,
        "last": steps[-1].number, "hash": "%016x" % (steps[-1].state_hash % 2**64), "late": late,
        "pictures": [count("FRAME"), count("GEOMETRY")], "channels": len(channels), "channel_time": channels[-1][0],
        "rising": all(a.number <= b.number for a, b in zip(steps, steps[1:]))}))
"""
PARQUET = """
import sys
from pyarrow import parquet
table = parquet.read_table(sys.argv[1])
times = table.column("time_s")
print(table.num_rows, times.type, times[-1])
"""


def expect(what, good):
    if not good:
        sys.exit("FAILED: " + what)


def main(source, build, lcm_gen):
    python = environment(build)
    insula = str(build / "bin/insula")
    with tempfile.TemporaryDirectory(prefix="insula_session_") as name:
        folder = pathlib.Path(name)
        (folder / "meshes").mkdir()
        (folder / "meshes/block.msh").write_bytes((source / "meshes/examples/block.msh").read_bytes())
        (folder / "scene.xml").write_text(SCENE, encoding="utf-8")
        types = folder / "types"
        messages = [str(f) for f in (source / "lcm_types").glob("*.lcm")]
        subprocess.run([lcm_gen, "-p", "--ppath", str(types), *messages], check=True)
        file = folder / "run.insula"
        run = [insula, "run", str(folder / "scene.xml"), "--duration", "3 s", "--record", str(file)]
        said = subprocess.run(run, check=True, capture_output=True, text=True).stdout
        info = json.loads(subprocess.run([insula, "session", "info", "--json", str(file)], check=True,
                                         capture_output=True, text=True).stdout)
        got = subprocess.run([python, "-c", READ, str(file), str(types)], capture_output=True, text=True)
        expect("the package mcap reads the file:\n" + got.stderr, got.returncode == 0)
        read = json.loads(got.stdout)
        expect("as many steps", read["last"] == info["steps"] == 300)
        expect("in order", read["rising"])
        expect("a second of steps by time", read["late"] == 100)
        expect("channels ten times a second", read["channels"] == 30 and abs(read["channel_time"] - 3) < 1e-6)
        expect("the hash that the run prints: " + said, "state_hash " + read["hash"] in said)
        expect("its title", read["about"]["session"]["title"] == info["title"] == "Stylus")
        declared = [name + " True" for name in
                    ("session_step_t", "sim_event_t", "device_state_t", "servo_ticks_t", "render_frame_t")]
        expect("declarations of messages", read["schemas"] == declared)
        expect("the scene's text", read["texts"]["scene/scene.xml"] == read["about"]["files"]["scene.xml"])
        expect("the viewer's bundle", "bundle/scene.json.zst" in read["texts"])
        expect("pictures ten times a second", read["pictures"] == [30, 30])
        expect("the mesh by its hash", set(read["about"]["files"]) == {"scene.xml", "meshes/block.msh"})
        tables = [insula, "session", "export", str(file), "--format", "parquet", "-o", str(folder / "tables")]
        own = os.environ | {"INSULA_PYTHON": str(python)}
        exported = subprocess.run(tables, capture_output=True, text=True, env=own)
        expect("tables as Parquet:\n" + exported.stderr, exported.returncode == 0)
        rows = subprocess.run([python, "-c", PARQUET, str(folder / "tables/channels.parquet")], check=True,
                              capture_output=True, text=True).stdout
        expect("thirty rows of channels: " + rows, rows.split() == ["30", "double", "3.0"])
        path = {"PATH": os.pathsep.join([str(pathlib.Path(python).parent), os.environ["PATH"]])}
        found = subprocess.run(tables, capture_output=True, text=True, env=os.environ | path)
        expect("the Python of PATH is found:\n" + found.stderr, found.returncode == 0)
        without = os.environ | {"INSULA_PYTHON": "/bin/false"}
        none = subprocess.run(tables, capture_output=True, text=True, env=without)
        expect("a Python that fails is said", none.returncode == 2 and "error: /bin/false" in none.stderr)
        expect("rerun", subprocess.run([insula, "rerun", str(file)], capture_output=True).returncode == 0)
    print("read as it was written")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3])
