"""The picture of scripts/bench, as SVG: how far each stage is from what memory allows."""

import math

WIDTH, ROW, LEFT, RIGHT, TOP, BOTTOM = 720, 30, 130, 90, 44, 48
LIMIT, TIME = "#8a94a6", "#2f6db3"


def text(x, y, words, anchor="start", color="#222"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>'


def dot(x, y, color):
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="{color}"/>'


def picture(rows):
    """`rows`: name, least time and time of each stage, in nanoseconds a vertex."""
    least = math.floor(math.log10(min(low for _, low, _ in rows)))
    most = math.ceil(math.log10(max(high for _, _, high in rows)))
    bottom = TOP + ROW * len(rows)

    def x(time):
        return LEFT + (WIDTH - LEFT - RIGHT) * (math.log10(time) - least) / (most - least)

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{bottom + BOTTOM}"'
        ' font-family="sans-serif" font-size="13">',
        '<rect width="100%" height="100%" fill="white"/>',
        dot(LEFT, 18, LIMIT), text(LEFT + 12, 22, "its data read and written once"),
        dot(LEFT + 230, 18, TIME), text(LEFT + 242, 22, "measured"),
    ]
    for power in range(least, most + 1):
        at = x(10 ** power)
        parts.append(f'<line x1="{at:.1f}" y1="{TOP - 8}" x2="{at:.1f}" y2="{bottom}"'
                     ' stroke="#ddd"/>')
        parts.append(text(at, bottom + 16, f"{10 ** power:g}", "middle"))
    parts.append(text((LEFT + WIDTH - RIGHT) / 2, bottom + 36, "nanoseconds a vertex", "middle"))
    for k, (name, low, high) in enumerate(rows):
        y = TOP + ROW * (k + 0.5)
        parts.append(text(LEFT - 14, y + 4, name, "end"))
        parts.append(f'<line x1="{x(low):.1f}" y1="{y:.1f}" x2="{x(high):.1f}" y2="{y:.1f}"'
                     f' stroke="{LIMIT}" stroke-width="2"/>')
        parts += [dot(x(low), y, LIMIT), dot(x(high), y, TIME)]
        ratio = high / low
        parts.append(text(x(high) + 12, y + 4, f"× {ratio:.{0 if ratio >= 10 else 1}f}",
                          color="#666"))
    return "\n".join(parts + ["</svg>", ""])
