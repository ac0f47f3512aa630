"""Measured runs of the program for scripts/bench."""

import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

meshgrain = os.environ["MESHGRAIN"]
LONG = 10  # seconds: what takes longer is not run three times


def measure(*arguments):
    """Seconds from the start of the process to its end, and the most bytes it had in memory."""
    start = time.perf_counter()
    with subprocess.Popen([meshgrain, *map(str, arguments), "--quiet"]) as process:
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"bench: meshgrain failed on {arguments[0]}")
    unit = 1 if sys.platform == "darwin" else 1024
    return seconds, usage.ru_maxrss * unit


def best(*arguments):
    """The shortest time of three runs, or of one if that takes long, and the most memory."""
    runs = [measure(*arguments)]
    while len(runs) < 3 and runs[0][0] < LONG:
        runs.append(measure(*arguments))
    return min(seconds for seconds, _ in runs), max(peak for _, peak in runs)


def run(model, work):
    """All figures of one model."""
    result, report = work / "result.ply", work / "report.json"
    seconds, peak = best(model, "-o", result, "-D")
    one_thread, _ = best(model, "-o", result, "-D", "-t", 1)
    measure(model, "-o", result, "-D", "--report", report)
    told = json.loads(report.read_text())
    stages = {}
    for stage in told["stages"]:
        stages[stage["name"]] = stages.get(stage["name"], 0) + stage["seconds"]
    stages.pop("singularities", None)  # counted for the report alone
    return {"model": Path(model).stem, "vertices": told["input"]["vertices"],
            "faces": told["output"]["faces"], "threads": told["threads"], "seconds": seconds,
            "one_thread": one_thread, "peak": peak, "stages": stages}


def slope(runs):
    """Of the line of least squares through the times over the sizes, both as logarithms."""
    points = [(math.log(r["vertices"]), math.log(r["seconds"])) for r in runs]
    x, y = (sum(column) / len(points) for column in zip(*points))
    spread = sum((p - x) ** 2 for p, _ in points)
    return sum((p - x) * (q - y) for p, q in points) / spread if spread > 0 else None


def benchmarks(file):
    """Of what ran alone: {name: {1 or 0 (all threads): counters and "seconds"}}."""
    times = {}
    for entry in json.loads(Path(file).read_text())["benchmarks"]:
        name, *rest = entry["name"].split("/")
        threads = int(rest[0].removeprefix("threads:"))
        entry["seconds"] = entry["real_time"] / 1e3  # the benchmarks tell milliseconds
        times.setdefault(name, {})[threads] = entry
    return times
