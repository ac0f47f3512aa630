"""The work of scripts/bench: tables of figures, and a picture."""

import os
import platform
import sys
from pathlib import Path

from bench_picture import picture
from bench_run import benchmarks, run, slope

STAGES = ("read", "clean", "order", "coarsen", "graph", "hierarchy", "orientation field",
          "position field", "extraction", "smoothing", "write")
GIB, MIB = 2 ** 30, 2 ** 20


def processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def cores():
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count()


def table(header, rows):
    return ["", "| " + " | ".join(header) + " |", "|---" + "|---:" * (len(header) - 1) + "|",
            *("| " + " | ".join(row) + " |" for row in rows), ""]


def machine(times):
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / GIB

    def rates(name, counter):
        return [f"{times[name][threads][counter] / 1e9:.1f}" for threads in (1, 0)]

    return [
        f"{processor()}, {cores()} cores, {memory:.0f} GiB of memory, {platform.system()}.", "",
        "The most that it does, in thousands of millions a second, measured by",
        "`benchmarks/machine_benchmark.cpp`: bytes of memory (a triad over arrays larger than the",
        "caches), and fused multiplications and additions in single precision. (The solvers fuse none,",
        "so that their bytes are the same with all instruction sets: half of that is in their",
        "reach.)",
        *table(["", "1 thread", "all threads"],
               [["bytes", *rates("triad", "bytes/s")],
                ["multiply-adds", *rates("multiply-add", "multiply-adds/s")]]),
    ]


def was_busy(times):
    """A note if the cores were not free: then arithmetic does not get faster with each of them."""
    counter = "multiply-adds/s"
    gain = times["multiply-add"][0][counter] / times["multiply-add"][1][counter]
    if gain > 0.75 * cores():
        return []
    return [f"**Measured beside other work**, so that times are too long (all {cores()} cores multiplied"
            f" {gain:.1f} times as fast as one).", ""]


def whole_runs(runs):
    rows = [[r["model"], f"{r['vertices']:,}", f"{r['faces']:,}", f"{r['seconds']:.2f}",
             f"{r['vertices'] / r['seconds'] / 1e6:.2f}", f"{r['one_thread']:.2f}",
             f"{r['one_thread'] / r['seconds']:.2f}", f"{r['peak'] / MIB:,.0f}",
             f"{r['peak'] / r['vertices']:,.0f}"] for r in runs]
    lines = table(["input", "vertices", "faces of the result", "seconds", "million vertices a second",
                   "seconds, 1 thread", "times as fast", "peak MiB", "bytes a vertex"], rows)
    exponent = slope(runs)
    if exponent is not None:
        lines += [f"Time grows as the number of vertices to the power of {exponent:.2f}"
                  " (least squares over the logarithms).", ""]
    return lines


def stages_of_runs(runs):
    names = list(dict.fromkeys(name for r in runs for name in r["stages"]))

    def cell(r, name):
        return f"{1e9 * r['stages'][name] / r['vertices']:.0f}" if name in r["stages"] else ""

    return table(["stage"] + [f"{r['vertices']:,}" for r in runs],
                 [[name, *(cell(r, name) for r in runs)] for name in names])


def stages_alone(times, image):
    bandwidth = {threads: times["triad"][threads]["bytes/s"] for threads in (1, 0)}
    rows, bars = [], []
    for name in STAGES:
        one = times[name][1]
        threads = 0 if 0 in times[name] else 1
        every = times[name][threads]
        least = every["bytes"] / bandwidth[threads]
        rows.append([name, f"{1e3 * one['seconds']:.1f}", f"{1e3 * every['seconds']:.1f}",
                     f"{every['vertices/s'] / 1e6:.1f}", f"{every['bytes/s'] / 1e9:.2f}",
                     f"{100 * least / every['seconds']:.1f}"])
        bars.append((name, 1e9 * least / every["vertices"],
                     1e9 * every["seconds"] / every["vertices"]))
    image.parent.mkdir(parents=True, exist_ok=True)
    image.write_text(picture(bars))
    return table(["stage", "ms, 1 thread", "ms, all threads", "million vertices a second",
                  "GB a second", "% of the memory's rate"], rows)


def main(work, output, models):
    times = benchmarks(work / "stages.json")
    runs = []
    for model in models:
        print(f"Measuring {Path(model).name} ...", flush=True)
        runs.append(run(model, work))
    image = output.parent / "images" / (output.stem + ".svg")
    made = all(Path(model).parent == work for model in models)
    vertices = f"{times['graph'][1]['vertices']:,.0f}"
    lines = [
        "# Performance", "",
        "Made by `scripts/bench`, which measures the machine that it runs on.", "",
        "## The machine", "", *was_busy(times), *machine(times),
        "## Whole runs", "",
        "`meshgrain INPUT -o result.ply -D`, from the start of the process to its end, with a sixteenth as",
        "many faces as vertices. The result is a binary PLY file. The best of three runs (one, where it",
        "takes ten seconds or more); the same with `-t 1` for one thread.",
        *(["`meshgrain sample blob --resolution R -o blob-R.ply` makes the inputs, binary PLY files too."]
          if made else []),
        *whole_runs(runs),
        "## Stages of these runs", "",
        "In nanoseconds a vertex of the input, all threads; from the file of `--report`, which as many",
        "more runs write, of which the fastest counts.",
        *stages_of_runs(runs),
        "## Stages alone", "",
        f"Each stage called by itself over a blob of {vertices} vertices, by the programs in `benchmarks/`",
        "(`build/release/benchmarks/meshgrain_benchmarks`, which `scripts/bench` builds). The last column",
        "says how much of its time a stage would need if it did nothing but read what it takes and write",
        "what it makes, once, as fast as the triad does. Writing uses one thread.",
        *stages_alone(times, image),
        f"![Time of each stage, beside the least that memory allows](images/{image.name})",
    ]
    output.write_text("\n".join(lines) + "\n")


main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:])
