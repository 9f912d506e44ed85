# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker process of the local engine: python -m insula.studies.worker FILE_DESCRIPTOR

It gets a study and then runs, and answers each with its row. It ends with the process that started it.
"""

from __future__ import annotations

import os
import signal
import sys
from multiprocessing.connection import Connection

from insula.studies.copies import end_with_parent, perform

def main() -> None:
    end_with_parent(os.getppid())
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started this one
    with Connection(int(sys.argv[1])) as pipe:
        try:
            study = pipe.recv()
            while True:
                pipe.send(perform(study, pipe.recv()))
        except (EOFError, BrokenPipeError, ConnectionResetError):
            pass  # nobody asks any more


if __name__ == "__main__":
    main()
