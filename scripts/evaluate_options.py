"""The part of scripts/evaluate on features, density, symmetry and guides, over made shapes whose
right answer is known."""

import math
from pathlib import Path

from evaluate_run import cell, run, stats

PARTS = ("bracket", "cube", "cylinder", "fused-boxes", "shaft", "twisted-cube")
COUNTS = (500, 5000, 50000)


def percent(share):
    return f"{100 * share:.1f}"


def table(header, rows):
    return ["", "| " + " | ".join(header) + " |", "|---" * len(header) + "|",
            *("| " + " | ".join(row) + " |" for row in rows), ""]


def read_obj(path):
    vertices, faces = [], []
    for line in Path(path).read_text().splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            vertices.append(tuple(map(float, words[:3])))
        elif kind in "fl" and kind:
            faces.append([int(word) - 1 for word in words])
    return vertices, faces


def features(work, images, noise):
    """Creases that are followed, and corners that are kept, of the shape without noise."""
    rows = []
    for part in PARTS:
        # 4 is a dense sampling: some 50,000 vertices, so that the finest count is as fine as it.
        clean, scan = work / f"{part}.ply", work / f"{part}-scan.ply"
        run("sample", part, "-o", clean, "--resolution", 4)
        run("sample", part, "-o", scan, "--resolution", 4, "--noise", noise)
        row = [part]
        for count in COUNTS:
            result = work / f"{part}-lines.ply"
            run(scan, "-o", result, "-f", count)
            figures = stats(result, "--against", clean)
            row.append(percent(figures["creases_followed"]))
            corners = figures.get("corners", 0)
            row.append(f"{figures['corners_kept']} of {corners}" if corners else "")
            if noise and count == 5000 and part == "bracket":
                run("picture", scan, images / "scan.png", "--size", "440")
                run("picture", result, images / "sharpened.png", "--size", "440")
        rows.append(row)
    header = ["part"]
    for count in COUNTS:
        header += [f"creases, {count:,}", "corners"]
    return table(header, rows)


def density(work, images):
    rows = []
    for shape in ("bracket", "blob", "three-holes"):
        model = work / f"{shape}-dense.ply"
        run("sample", shape, "-o", model, "--resolution", 2)
        row = [shape]
        for adaptive in (0, 1):
            result = work / f"{shape}-adaptive.ply"
            run(model, "-o", result, "-f", 3000, "--adaptive", adaptive)
            figures = stats(result, "--against", model)
            row += [str(figures["faces"]), cell(figures["distance_to_input"]["mean"]),
                    cell(figures["distance_from_input"]["max"])]
            if adaptive and shape == "bracket":
                run("picture", result, images / "adaptive.png", "--size", "440")
        rows.append(row)
    return table(["shape", "quads", "distance", "farthest", "adaptive: quads", "distance",
                  "farthest"], rows)


def symmetry(work):
    """The share of vertices and faces whose mirror image is there, to the last digit."""
    rows = []
    for shape in ("torus", "cube", "cylinder", "bracket"):
        model, result = work / f"{shape}-whole.obj", work / f"{shape}-mirrored.obj"
        run("sample", shape, "-o", model)
        axis = "z" if shape == "bracket" else "x"
        run(model, "-o", result, "-f", 1000, "--symmetry", axis, "--quiet")
        vertices, faces = read_obj(result)
        k = "xyz".index(axis)
        middle = (max(v[k] for v in vertices) + min(v[k] for v in vertices)) / 2
        scale = max(max(map(abs, v)) for v in vertices)

        def key(vertex, mirrored):
            return tuple(round(((2 * middle - c) if mirrored and i == k else c) / scale, 5) + 0.0
                         for i, c in enumerate(vertex))

        here = {key(v, False): i for i, v in enumerate(vertices)}
        image = [here.get(key(v, True)) for v in vertices]
        known = {frozenset(face) for face in faces}
        kept = sum(frozenset(image[v] for v in face) in known for face in faces)
        rows.append([shape, axis, percent(sum(i is not None for i in image) / len(image)),
                     percent(kept / len(faces))])
    return table(["shape", "across", "vertices", "faces"], rows)


def guides(work, images):
    """The share of the length of a guide that edges follow."""
    spiral = Path(__file__).parent.parent / "examples" / "spiral.obj"
    model = work / "guided.obj"
    run("sample", "sphere", "-o", model, "--resolution", 2)
    points, curves = read_obj(spiral)
    rows = []
    for count in (1000, 5000):
        result = work / f"guided-{count}.obj"
        run(model, "-o", result, "-f", count, "--guides", spiral)
        if count == 5000:
            run("picture", result, images / "guided.png", "--size", "440")
        rows.append([f"{count:,}", percent(share_followed(points, curves, *read_obj(result)))])
    return table(["quads", "followed"], rows)


def share_followed(points, curves, vertices, faces):
    """Within a quarter of an edge and 10 degrees."""
    edges = {tuple(sorted((face[k - 1], face[k]))) for face in faces for k in range(len(face))}
    segments = [(vertices[a], vertices[b]) for a, b in edges]
    edge = sum(math.dist(p, q) for p, q in segments) / len(segments)
    length = followed = 0.0
    for curve in curves:
        for a, b in zip(curve, curve[1:]):
            p, q = points[a], points[b]
            # The guide lies near the sphere, not on it.
            middle = [(x + y) / 2 for x, y in zip(p, q)]
            middle = [x / math.hypot(*middle) for x in middle]
            along = [(y - x) / math.dist(p, q) for x, y in zip(p, q)]
            length += math.dist(p, q)
            if any(is_along(middle, along, edge, *segment) for segment in segments):
                followed += math.dist(p, q)
    return followed / length


def is_along(point, along, edge, a, b):
    if math.dist(point, a) > 2 * edge:
        return False
    d = [y - x for x, y in zip(a, b)]
    norm = math.hypot(*d)
    share = sum((p - x) * c for p, x, c in zip(point, a, d)) / norm ** 2
    share = min(max(share, 0), 1)
    nearest = [x + share * c for x, c in zip(a, d)]
    cosine = abs(sum(x * y for x, y in zip(along, d))) / norm
    return math.dist(point, nearest) < edge / 4 and cosine > math.cos(math.radians(10))


def evaluate_options(work, images, stem):
    def pictures(*names):
        return [" ".join(f"![{name}](images/{stem}/{name}.png)" for name in names)]

    return [
        "", "## Creases", "",
        "In percent of the length of the part's creases, and the corners where these meet.",
        *features(work, images, 0),
        "The same in noisy scans, whose vertices are moved by a fifth of an edge, measured against the",
        "part without noise. At the last count the result's edges are as short as the scan's.",
        *features(work, images, 0.2),
        *pictures("scan", "sharpened"), "",
        "## Density", "",
        "3,000 quads of one size, and with `--adaptive 1`; distances as above.",
        *density(work, images),
        *pictures("adaptive"), "",
        "## Symmetry", "",
        "Vertices and faces, in percent, whose mirror image is there, of 1,000 quads.",
        *symmetry(work),
        "## Guides", "",
        "A spiral around a sphere (`examples/spiral.obj`): in percent of its length, how much edges follow",
        "within a quarter of an edge and 10 degrees.",
        *guides(work, images),
        *pictures("guided"),
    ]
