#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A learning record store for tests. It checks every statement, keeps what is right, and fails on request.

Use StandIn() as a context. `plan` is a list of what it does with the next requests, one after the other:
  {"status": 503, "retry_after": 1}   answers so and keeps nothing
  {"close": "before"}, {"close": "after"}   closes the connection before or after it has kept the statements
  {"wait": 5}                         keeps the statements, and answers only then
"""
import base64
import http.server
import json
import socket
import ssl
import threading
import time
import urllib.parse

import statement_check

IGNORED = ("stored", "authority", "version")


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def answer(self, status, body, headers=()):
        data = json.dumps(body).encode()
        self.send_response(status)
        for name, value in (("X-Experience-API-Version", "1.0.3"), ("Content-Length", str(len(data))), *headers):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)

    def drop(self):
        self.close_connection = True
        self.connection.shutdown(socket.SHUT_RDWR)

    def admitted(self):
        store = self.server.store
        if not self.headers.get("X-Experience-API-Version", "").startswith("1.0"):
            self.answer(400, "X-Experience-API-Version is missing")
            return False
        expected = "Basic " + base64.b64encode(store.login.encode()).decode()
        if store.login and self.headers.get("Authorization") != expected:
            self.answer(401, "who are you?")
            return False
        return True

    def do_GET(self):
        url = urllib.parse.urlsplit(self.path)
        wanted = urllib.parse.parse_qs(url.query).get("statementId", [""])[0]
        if not self.admitted():
            return
        found = self.server.store.kept.get(wanted)
        self.answer(200, found) if found else self.answer(404, "no such statement")

    def do_POST(self):
        store = self.server.store
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        if not self.admitted():
            return
        with store.lock:
            step = store.plan.pop(0) if store.plan else {}
            store.requests += 1
        if step.get("close") == "before":
            return self.drop()
        if "status" in step:
            wait = [("Retry-After", str(step["retry_after"]))] if "retry_after" in step else []
            return self.answer(step["status"], "on request", wait)
        status, said = store.keep(self.path, self.headers.get("Content-Type", ""), body)
        time.sleep(step.get("wait", 0))
        if step.get("close") == "after":
            return self.drop()
        self.answer(status, said)


class StandIn:
    def __init__(self, login="", port=0, certificate=None):
        """certificate: PEM file with certificate and key; the stand-in then serves by TLS as localhost."""
        self.login, self.plan, self.requests, self.repeated = login, [], 0, 0
        self.kept = {}  # by id, in order of arrival
        self.lock = threading.Lock()
        self.refuse = lambda statement: False  # what is a bad statement beside the rules
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.server.daemon_threads = True
        self.server.store = self
        self.port = self.server.server_address[1]
        self.url = f"http://127.0.0.1:{self.port}/xapi"
        if certificate:
            tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            tls.load_cert_chain(certificate)
            self.server.socket = tls.wrap_socket(self.server.socket, server_side=True)
            self.url = f"https://localhost:{self.port}/xapi"

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, args=(0.05,), daemon=True).start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def keep(self, path, content_type, body):
        """Keeps all statements of a request, or none."""
        if path != "/xapi/statements":
            return 404, "no such resource"
        try:
            if not content_type.startswith("application/json"):
                raise statement_check.Bad("the content is not said to be JSON")
            statements = json.loads(body)
            statements = statements if isinstance(statements, list) else [statements]
            for s in statements:
                statement_check.check(s)
                statement_check.need("id" in s, "this stand-in wants ids")
                statement_check.need(not self.refuse(s), "this statement is not wanted")
            ids = [s["id"] for s in statements]
            statement_check.need(len(set(ids)) == len(ids), "the same id twice")
        except (ValueError, TypeError) as bad:
            return 400, str(bad)
        with self.lock:
            for s in statements:
                there = self.kept.get(s["id"])
                if there and {k: v for k, v in there.items() if k not in IGNORED} != s:
                    return 409, f"another statement {s['id']} is there"
            for s in statements:
                self.repeated += s["id"] in self.kept
                now = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
                self.kept.setdefault(s["id"], {**s, "stored": now, "version": "1.0.3"})
        return 200, ids
