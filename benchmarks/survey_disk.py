"""What `survey_load.py` compares with: bare SQLite on the same disk, and a disk made as slow as another kind.

Run by `survey_load.py` as a program of its own, so that the slow disk is slow for it too: arguments are the kind, the
database file, the seconds; standard input the recorded transactions as JSON; it prints transactions/s.
"""

import json
import os
import platform
import shutil
import sqlite3
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

Transaction = list[tuple[str, list[object]]]
"""SQL and values of one transaction."""

SLOW_DISK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <time.h>

static int slowly(const char *name, int file) {
    int (*real)(int) = (int (*)(int))dlsym(RTLD_NEXT, name);
    int result = real(file);
    long us = atol(getenv("SLOW_DISK_US"));
    struct timespec left = {us / 1000000, us % 1000000 * 1000};
    while (nanosleep(&left, &left)) {}
    return result;
}
int fsync(int file) { return slowly("fsync", file); }
int fdatasync(int file) { return slowly("fdatasync", file); }
"""


def slow_disk(folder: Path, ms: float) -> dict[str, str]:
    """The environment of a program for which every wait for the disk takes `ms` longer; needs gcc."""
    if not ms:
        return {}
    library = folder / "slow_disk.so"
    if not library.exists():
        source = folder / "slow_disk.c"
        source.write_text(SLOW_DISK)
        subprocess.run(["gcc", "-O2", "-shared", "-fPIC", "-o", str(library), str(source), "-ldl"], check=True)
    return {"LD_PRELOAD": str(library), "SLOW_DISK_US": str(round(ms * 1000))}


def opened(path: Path) -> sqlite3.Connection:
    """A connection set as the survey sets its own."""
    connection = sqlite3.connect(path, isolation_level=None)
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", "secure_delete=ON"):
        connection.execute(f"PRAGMA {pragma}")
    return connection


def inserts_per_s(path: Path, seconds: float) -> float:
    """One row in each transaction."""
    connection = opened(path)
    connection.execute("CREATE TABLE IF NOT EXISTS bare (id INTEGER PRIMARY KEY, text TEXT)")
    done, began = 0, time.perf_counter()
    while time.perf_counter() - began < seconds:
        connection.execute("BEGIN IMMEDIATE")
        connection.execute("INSERT INTO bare (text) VALUES (?)", ("x" * 200,))
        connection.execute("COMMIT")
        done += 1
    passed = time.perf_counter() - began
    connection.close()
    return done / passed


def saves_per_s(before: Path, transactions: list[Transaction], seconds: float) -> float:
    """The survey's own statements on copies of the database as it was before the first; only saves are timed."""
    done, busy = 0, 0.0
    while busy < seconds:
        copy = before.with_suffix(".copy")
        for suffix in ("", "-wal", "-shm"):
            Path(f"{copy}{suffix}").unlink(missing_ok=True)
        shutil.copy(before, copy)
        connection = opened(copy)
        for statements in transactions:
            began = time.perf_counter()
            connection.execute("BEGIN IMMEDIATE")
            for sql, values in statements:
                connection.execute(sql, values).fetchall()
            connection.execute("COMMIT")
            if is_save(statements):
                busy += time.perf_counter() - began
                done += 1
        connection.close()
    return done / busy


def is_save(statements: Transaction) -> bool:
    """Whether ratings are stored in it."""
    return any("INTO ratings" in sql for sql, _ in statements)


def sync_ms(folder: Path) -> float:
    """What one fdatasync of a small write costs here: median of 200, ms."""
    waits = []
    with (folder / "sync").open("wb", buffering=0) as file:
        for _ in range(200):
            file.write(bytes(4096))
            began = time.perf_counter()
            os.fdatasync(file.fileno())
            waits.append((time.perf_counter() - began) * 1000)
    return statistics.median(waits)


def machine(folder: Path) -> dict[str, Any]:
    """Where this was measured."""
    model = next((line.split(": ")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), platform.machine())  # fmt: skip
    return {
        "processor": model,
        "cores": len(os.sched_getaffinity(0)),
        "python": platform.python_version(),
        "sqlite": sqlite3.sqlite_version,
        "sync_ms": round(sync_ms(folder), 3),
        "load_before": os.getloadavg()[0],
    }


if __name__ == "__main__":
    kind, path, seconds = sys.argv[1], Path(sys.argv[2]), float(sys.argv[3])
    if kind == "insert":
        print(inserts_per_s(path, seconds))
    else:
        print(saves_per_s(path, json.load(sys.stdin), seconds))
