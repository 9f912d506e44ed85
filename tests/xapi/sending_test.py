#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""insula people send against a stand-in: killed, offline, refused, two at once.

    sending_test.py PROGRAM
"""
import json
import os
import pathlib
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
import uuid

import statement_check
from lrs_stand_in import StandIn

PROGRAM = ""
SCENE = str(pathlib.Path(__file__).resolve().parents[2] / "scenes/skills/1_touch_targets.xml")
LOGIN = "trainer:secret"


def wait_for(condition, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


class Sending(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="insula_xapi_")
        self.data = pathlib.Path(self.folder.name)
        self.login = self.data / "login"
        self.login.write_text(LOGIN + "\n")
        self.login.chmod(0o600)
        self.started = []

    def tearDown(self):
        for process in self.started:
            if process.poll() is None:
                process.kill()
            process.wait()
            process.stdout.close()
        self.folder.cleanup()

    def command(self, *words):
        return [PROGRAM, "people", *words, "--data", str(self.data)]

    def people(self, *words, status=0):
        done = subprocess.run(self.command(*words), capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def send(self, lrs, *words, status=0):
        return self.people("send", "--lrs", lrs.url, "--login", str(self.login), *words, status=status)

    def watch(self, url):
        command = self.command("send", "--lrs", url, "--login", str(self.login), "--watch")
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.started.append(process)
        return process

    def database(self):
        return sqlite3.connect(self.data / "training.sqlite", timeout=30)

    def fill(self, runs, person="P07"):
        """Runs of before there was an outbox, and then queued by hand. The C++ tests add runs as a session does."""
        self.people("send")
        with self.database() as db:
            db.execute(
                "INSERT OR IGNORE INTO persons (pseudonym, role, handedness, year, created_ms) VALUES (?,'other',"
                "'right',0,1)", (person,))
            who = db.execute("SELECT id FROM persons WHERE pseudonym = ?", (person,)).fetchone()[0]
            for k in range(runs):
                db.execute(
                    "INSERT INTO runs (uuid, person, scene, title, mode, began_ms, duration_s, state, goals, "
                    "goals_done, faults, step_rate_hz, seed, guided, report, recording, version) VALUES (?,?,?,?,?,?,"
                    "?,?,?,?,?,?,?,?,'','','1')",
                    (str(uuid.uuid4()), who, "scenes/skills/1_touch_targets.xml", "Touch",
                     ("practice", "test")[k % 2], 1_700_000_000_000 + 60_000 * ((k * 7) % runs), 12.5,
                     ("done", "failed", "running")[k % 3], 4, k % 5, k % 3, 60.0, k, 0))
        db.close()
        self.people("send", "--all")

    def states(self):
        db = self.database()
        found = dict(db.execute("SELECT state, count(*) FROM outbox GROUP BY state"))
        db.close()
        return found

    def expected(self):
        """Ids of the statements of all runs: as they are exported."""
        file = self.data / "statements.json"
        self.people("export", "--xapi", str(file))
        statements = json.loads(file.read_text())
        for s in statements:
            statement_check.check(s)
        ids = [s["id"] for s in statements]
        self.assertEqual(len(set(ids)), len(ids))
        return ids

    def arrived_in_order(self, lrs):
        times = [s["timestamp"] for s in lrs.kept.values() if s["verb"]["id"].endswith("/attempted")]
        self.assertEqual(times, sorted(times))

    def test_all_that_is_exported_arrives_once_and_in_order(self):
        self.fill(130)
        with StandIn(LOGIN) as lrs:
            self.assertIn("sent 130 runs", self.send(lrs))
            self.assertEqual(set(lrs.kept), set(self.expected()))
            self.assertEqual(lrs.repeated, 0)
            self.arrived_in_order(lrs)
            before = lrs.requests
            self.send(lrs)
            self.assertEqual(lrs.requests, before, "nothing is sent twice")

    def test_nothing_is_lost_or_doubled_when_the_sender_is_killed(self):
        self.fill(120)
        with StandIn(LOGIN) as lrs:
            for kept in (0, 1):  # killed while the store has the first batch, then while it has the second
                lrs.plan = [{}] * kept + [{"wait": 30}]
                before = len(lrs.kept)
                sender = self.watch(lrs.url)
                self.assertTrue(wait_for(lambda: not lrs.plan and len(lrs.kept) >= max(before, 1)))
                sender.send_signal(signal.SIGKILL)
                sender.wait()
                self.assertGreater(self.states()["pending"], 0)
            self.send(lrs)
            self.assertEqual(set(lrs.kept), set(self.expected()))
            self.assertGreater(lrs.repeated, 0, "what was not confirmed was sent again, and was known")
            self.assertEqual(self.states(), {"sent": 120})

    def test_two_senders_at_once(self):
        self.fill(200)
        with StandIn(LOGIN) as lrs:
            lrs.plan = [{"wait": 0.5}] * 4
            first = self.watch(lrs.url)
            self.assertTrue(wait_for(lambda: lrs.requests > 0))
            second = self.watch(lrs.url)
            self.assertTrue(wait_for(lambda: self.states() == {"sent": 200}))
            self.assertEqual(lrs.repeated, 0)
            self.assertEqual(lrs.requests, 4)
            self.assertIn("another program is sending", self.send(lrs))
            first.send_signal(signal.SIGKILL)  # the one that waits takes over
            first.wait()
            self.fill(1, "P08")
            self.assertTrue(wait_for(lambda: self.states() == {"sent": 201}))
            self.assertEqual(set(lrs.kept), set(self.expected()))
            self.assertIsNone(second.poll())

    def test_offline_for_a_while(self):
        self.fill(60)
        with socket.socket() as s:
            s.bind(("127.0.0.1", 0))
            port = s.getsockname()[1]
        sender = self.watch(f"http://127.0.0.1:{port}/xapi")
        self.assertIn("not all was sent: no answer", sender.stdout.readline())
        with StandIn(LOGIN, port) as lrs:
            lrs.plan = [{"status": 503, "retry_after": 1}, {"close": "before"}, {"close": "after"}]
            # Four failures in a row are followed by waits of at most 2, 4, 8 and 16 seconds.
            self.assertTrue(wait_for(lambda: self.states() == {"sent": 60}, 90))
            self.assertEqual(set(lrs.kept), set(self.expected()))
            self.arrived_in_order(lrs)
            self.assertIsNone(sender.poll())

    def test_a_bad_statement_and_a_conflict(self):
        self.fill(30)
        ids = self.expected()
        with StandIn(LOGIN) as lrs:
            lrs.refuse = lambda s: s["id"] == ids[10]
            lrs.kept[ids[20]] = {"id": ids[20], "actor": {}}
            self.assertIn("refused 2 runs", self.send(lrs, status=1))
            self.assertEqual(self.states(), {"sent": 28, "refused": 2})
            told = self.people("send")
            self.assertIn("this statement is not wanted", told)
            self.assertIn("another statement with the same id", told)
            lrs.refuse = lambda s: False
            del lrs.kept[ids[20]]
            self.assertIn("queued 2 runs", self.send(lrs, "--all"))
            self.assertEqual(set(lrs.kept), set(ids))

    def test_a_wrong_password_stops_it(self):
        self.fill(3)
        self.login.write_text("trainer:wrong\n")
        with StandIn(LOGIN) as lrs:
            self.assertIn("does not let this account in", self.send(lrs, status=1))
            watching = self.watch(lrs.url)
            self.assertEqual(watching.wait(30), 2)
            self.assertEqual(self.states(), {"pending": 3})
            self.login.chmod(0o644)
            self.assertIn("others may read", self.send(lrs, status=2))

    def certificate(self, name):
        """A certificate that signs itself, and its key, in one file."""
        file = self.data / f"{name}.pem"
        subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days",
             "2", "-subj", f"/CN={name}", "-addext", f"subjectAltName=DNS:{name}", "-keyout", str(file), "-out",
             str(file) + ".crt"], check=True, capture_output=True)
        file.write_text(file.read_text() + pathlib.Path(str(file) + ".crt").read_text())
        return str(file)

    def test_a_store_is_trusted_by_its_certificate_alone(self):
        self.fill(2)
        ours, other = self.certificate("localhost"), self.certificate("elsewhere.example")
        with StandIn(LOGIN, certificate=ours) as lrs:
            self.assertIn("certificate", self.send(lrs, status=1), "this machine does not know who signed it")
            self.send(lrs, "--ca", other, status=1)
            self.assertEqual((lrs.requests, self.states()), (0, {"pending": 2}))
            self.assertIn("cannot be read", self.send(lrs, "--ca", ours + ".none", status=2))
            self.send(lrs, "--ca", ours)
            self.assertEqual(self.states(), {"sent": 2})
            self.assertEqual(set(lrs.kept), set(self.expected()))
        self.fill(1, "P08")
        with StandIn(LOGIN, certificate=other) as lrs:
            self.send(lrs, "--ca", other, status=1)  # a certificate of another name
            self.assertEqual((lrs.requests, self.states()), (0, {"sent": 2, "pending": 1}))

    def sender_of(self, session):
        """Process id of a session's sender; None if it has none."""
        for folder in pathlib.Path("/proc").iterdir():
            if not folder.name.isdigit():
                continue
            try:
                words = (folder / "cmdline").read_bytes().split(b"\0")
                parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
            except (OSError, ValueError, IndexError):
                continue  # it has ended meanwhile
            if parent == session.pid and b"send" in words:
                return int(folder.name)
        return None

    def test_a_session_brings_its_sender_back(self):
        self.fill(1)
        with StandIn(LOGIN) as lrs:
            command = [PROGRAM, "play", SCENE, "--no-browser", "--no-reload", "--port", "0", "--data", str(self.data),
                       "--lrs", lrs.url, "--lrs-login", str(self.login)]
            bus = f"udpm://239.255.76.67:{20000 + os.getpid() % 20000}?ttl=0"
            with open(self.data / "session.log", "w") as log:
                session = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT,
                                           env={**os.environ, "LCM_DEFAULT_URL": bus})
            said = (self.data / "session.log").read_text
            try:
                self.assertTrue(wait_for(lambda: self.states() == {"sent": 1} or session.poll() is not None), said())
                if session.poll() is not None and "multicast" in said():
                    self.skipTest(said())
                self.assertIsNone(session.poll(), said())
                first = self.sender_of(session)
                os.kill(first, signal.SIGKILL)
                self.fill(2, "P08")
                self.assertTrue(wait_for(lambda: self.states() == {"sent": 3}), said())
                self.assertNotIn(self.sender_of(session), (None, first))
                self.assertEqual(set(lrs.kept), set(self.expected()))
            finally:
                session.send_signal(signal.SIGINT)
                session.wait(60)

    def test_who_is_forgotten_is_not_sent(self):
        self.fill(4)
        self.fill(2, "P08")
        self.people("forget", "P07", "--folder", str(self.data))
        with StandIn(LOGIN) as lrs:
            self.assertIn("sent 2 runs", self.send(lrs))
            self.assertEqual({s["actor"]["account"]["name"] for s in lrs.kept.values()}, {"P08"})

    def test_an_export_says_what_it_needs(self):
        self.fill(2)
        self.assertIn("--xapi FILE", self.people("export", status=2))
        self.people("export", "--xapi", str(self.data / "no folder/file.json"), status=1)
        file = self.data / "guests.json"
        self.people("forget", "P07", "--folder", str(self.data))
        self.people("export", "--xapi", str(file))
        self.assertEqual(json.loads(file.read_text()), [])

    def test_the_home_page_is_kept(self):
        self.fill(1)
        self.people("send", "--home-page", "training.example.org", status=2)
        self.people("send", "--home-page", "https://training.example.org")
        with StandIn(LOGIN) as lrs:
            self.send(lrs)
            accounts = [s["actor"]["account"] for s in lrs.kept.values()]
        self.assertEqual(accounts[0], {"homePage": "https://training.example.org", "name": "P07"})


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
