# SPDX-License-Identifier: GPL-3.0-or-later
"""A Ray cluster. Rows come back to this process, so that the nodes need no common folder for results; they need the
package and the files of the scenes at the same paths.
"""

from __future__ import annotations

import collections
import importlib
from typing import Any

from insula.studies import running
from insula.studies.engines import ATTEMPTS, EngineError, Record, died
from insula.studies.engines.local import environment
from insula.studies.study import RunSpec, Study


def _ray() -> Any:
    try:
        return importlib.import_module("ray")
    except ImportError:
        raise EngineError("the engine ray needs Ray: pip install \"insula[ray]\"") from None


class RayEngine:
    """workers: runs at the same time; 0: as many as the cluster has CPUs. address: of a running cluster, "auto", or
    empty for one of this machine alone."""

    def __init__(self, workers: int, address: str = ""):
        self.ray = _ray()
        self.workers, self.address = workers, address

    def _connect(self) -> None:
        variables = {"PYTHONPATH": environment()["PYTHONPATH"], "OMP_NUM_THREADS": "1"}
        more: dict[str, object] = {"address": self.address} if self.address else {"include_dashboard": False}
        if not self.address and self.workers:
            more["num_cpus"] = self.workers
        try:
            self.ray.init(runtime_env={"env_vars": variables}, log_to_driver=False, logging_level="error", **more)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise EngineError("no Ray cluster at %s: %s" % (self.address or "this machine", error)) from None

    def run(self, study: Study, runs: list[RunSpec], record: Record) -> None:
        self._connect()
        try:
            self._all(study, runs, record)
        finally:
            self.ray.shutdown()

    def _all(self, study: Study, runs: list[RunSpec], record: Record) -> None:
        ray = self.ray
        # Attempts are counted here, for each way in which a worker can be lost.
        perform = ray.remote(num_cpus=1, max_retries=0)(running.perform)
        shared, waiting = ray.put(study), collections.deque(runs)
        attempts: dict[str, int] = collections.defaultdict(int)
        under_way: dict[Any, RunSpec] = {}
        lost = (ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError, ray.exceptions.OutOfMemoryError,
                ray.exceptions.ObjectLostError)
        while waiting or under_way:
            while waiting and len(under_way) < self._at_once():
                run = waiting.popleft()
                attempts[run.id] += 1
                under_way[perform.remote(shared, run)] = run
            ended, _ = ray.wait(list(under_way), num_returns=1, timeout=1.0)
            for task in ended:
                run = under_way.pop(task)
                try:
                    record(ray.get(task))
                except lost as error:
                    if attempts[run.id] < ATTEMPTS:
                        waiting.appendleft(run)
                    else:
                        record(running.failed(study, run, died(attempts[run.id], type(error).__name__)))

    def _at_once(self) -> int:
        """With one more in hand for each CPU, a worker does not wait for the next run."""
        if self.workers and self.address:
            return self.workers
        return max(1, 2 * int(self.ray.cluster_resources().get("CPU", 1)))
