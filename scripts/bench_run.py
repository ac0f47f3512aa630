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


def measure_often(*arguments):
    """Three runs, or one if that takes long."""
    runs = [measure(*arguments)]
    while len(runs) < 3 and runs[0][0] < LONG:
        runs.append(measure(*arguments))
    return runs


def reported(file, *arguments):
    measure(*arguments, "--report", file)
    return json.loads(file.read_text())


def run(model, work):
    """All figures of one model: the shortest times, and the most memory."""
    arguments = (model, "-o", work / "result.ply", "-D")
    runs = measure_often(*arguments)
    one_thread = min(seconds for seconds, _ in measure_often(*arguments, "-t", 1))
    # Of as many runs as were timed, or their stages would add up to more than the whole.
    reports = [reported(work / "report.json", *arguments) for _ in runs]
    told = min(reports, key=lambda report: report["seconds"])
    stages = {}
    for stage in told["stages"]:
        stages[stage["name"]] = stages.get(stage["name"], 0) + stage["seconds"]
    stages.pop("singularities", None)  # counted for the report alone
    return {"model": Path(model).stem, "vertices": told["input"]["vertices"],
            "faces": told["output"]["faces"], "seconds": min(seconds for seconds, _ in runs),
            "one_thread": one_thread, "peak": max(peak for _, peak in runs), "stages": stages}


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
