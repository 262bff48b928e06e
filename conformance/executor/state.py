"""Pieces of long work that are done, one a line, so that what was interrupted goes on where it was."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from conformance.executor.jobs import Job, Result


class State:
    """A file of finished pieces; pieces done with other sources do not count."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._done: dict[tuple[str, str], dict[str, Any]] = {}
        text = path.read_text(encoding="utf-8") if path.exists() else ""
        self._cut_short = bool(text) and not text.endswith("\n")
        for line in text.splitlines():
            try:
                entry = json.loads(line)
            except json.JSONDecodeError:
                continue  # the line that was being written when the work was interrupted
            self._done[entry["source"], entry["job"]] = entry["data"]

    def find(self, job: Job, source: str) -> dict[str, Any] | None:
        """The data of a piece that is done, or None."""
        return self._done.get((source, job.identity))

    def add(self, result: Result, source: str) -> None:
        """Remember a piece, on disk before anything else happens."""
        job = result.job
        self._done[source, job.identity] = result.data
        self.path.parent.mkdir(parents=True, exist_ok=True)
        entry = {"source": source, "job": job.identity, "what": asdict(job), "data": result.data}
        with self.path.open("a", encoding="utf-8") as file:
            file.write("\n" * self._cut_short + json.dumps(entry) + "\n")
        self._cut_short = False
