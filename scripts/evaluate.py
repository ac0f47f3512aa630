"""The work of scripts/evaluate: one table of figures, and a picture of each model."""

import sys
from pathlib import Path

from evaluate_options import evaluate_options
from evaluate_run import cell, run, stats

COUNTS = (500, 5000, 50000)
SUFFIXES = {".obj", ".ply", ".off", ".stl"}
COLUMNS = (
    ("faces", lambda s: s["faces"]),
    ("irregular", lambda s: s["irregular_vertices"]),
    ("area σ", lambda s: s["area"]["sigma"]),
    ("angle σ", lambda s: s["angle"]["sigma"]),
    ("inverted", lambda s: s["inverted_quads"]),
    ("Jacobian", lambda s: s["scaled_jacobian"]["min"]),
    ("distance", lambda s: s["distance_to_input"]["mean"]),
    ("farthest", lambda s: s["distance_from_input"]["max"]),
)
TOPOLOGY = ("euler", "components", "boundary_loops")

def main(folder, work, output):
    models = sorted(p for p in Path(folder).iterdir() if p.suffix.lower() in SUFFIXES)
    images = output.parent / "images" / output.stem
    images.mkdir(parents=True, exist_ok=True)
    lines = [
        "# Quality",
        "",
        "Made by `scripts/evaluate`: pure quads by default options. Irregular vertices are those of the",
        "inside without four neighbours; areas are relative to the mean; angles in degrees; Jacobian: the",
        "least scaled Jacobian of all quads; distances (from the result to the input, and the farthest",
        "that the input is from the result) relative to the diagonal of the bounding box. Topology: Euler",
        "number, pieces and border loops, and what the input had where that differs.",
    ]
    for count in COUNTS:
        lines += ["", f"## {count:,} quads", "",
                  "| model | " + " | ".join(name for name, _ in COLUMNS) + " | topology |",
                  "|---" * (len(COLUMNS) + 2) + "|"]
        sums = [0.0] * len(COLUMNS)
        for model in models:
            result = work / f"{model.stem}-{count}.ply"
            run(model, "-o", result, "-f", count)
            figures = stats(result, "--against", model)
            values = [get(figures) for _, get in COLUMNS]
            sums = [a + b for a, b in zip(sums, values)]
            before = stats(model)
            topology = ", ".join(str(figures[key]) for key in TOPOLOGY)
            if any(figures[key] != before[key] for key in TOPOLOGY):
                topology += " (" + ", ".join(str(before[key]) for key in TOPOLOGY) + ")"
            lines.append(f"| {model.stem} | " + " | ".join(map(cell, values)) + f" | {topology} |")
            if count == 5000:
                run("picture", result, images / f"{model.stem}.png", "--size", "440")
            print(lines[-1], flush=True)
        if models:
            means = (cell(total / len(models)) for total in sums)
            lines.append("| **mean** | " + " | ".join(means) + " | |")
    lines += evaluate_options(work, images, output.stem)
    lines += ["", "## Pictures", "", "At 5,000 quads.", ""]
    lines += [f"![{m.stem}](images/{output.stem}/{m.stem}.png)" for m in models]
    output.write_text("\n".join(lines) + "\n")


main(Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]))
