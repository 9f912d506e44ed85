#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""image_health.py SOURCE: the health check of the image says what a gateway on its port answers."""
import http.server
import os
import pathlib
import sys
import threading

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from steps import run, that  # noqa: E402


class Gateway(http.server.BaseHTTPRequestHandler):
    status, asked = 200, []

    def do_GET(self):
        Gateway.asked.append((self.path, self.headers["Host"]))
        self.send_response(Gateway.status)
        self.end_headers()

    def log_message(self, *_):
        pass


def main():
    health = pathlib.Path(sys.argv[1]) / "packaging/image/health"
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Gateway)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    port = str(server.server_address[1])
    env = {**os.environ, "INSULA_PORT": port}
    run(health, env=env)
    that(Gateway.asked == [("/healthz", "localhost:" + port)], "it asked for %s" % Gateway.asked)
    Gateway.status = 503
    that("503" in run(health, status=1, env=env), "it does not say what the gateway answers")
    server.shutdown()
    server.server_close()
    that("nothing answers on port " + port in run(health, status=1, env=env), "it does not say that nothing answers")
    return 0


if __name__ == "__main__":
    sys.exit(main())
