"""chart.py FOLDER: draws FOLDER/chart-METRIC.png and .svg for each chart of FOLDER/chart.json.

Error against time, both logarithmic: every point with the quartiles of its time, the front that no
point beats in both, and what bounds the errors from below.
"""
import json
import math
import os
import sys
import textwrap

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

INK, QUIET, FRONT, OWN = "#222222", "#707070", "#c0392b", "#5a7d9a"
MORE_LABELS = 6  # beside those of the front
FLOAT_ULP = 2.0 ** -24

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "axes.edgecolor": "#999999",
    "axes.labelcolor": INK, "xtick.color": "#555555", "ytick.color": "#555555",
    "axes.spines.top": False, "axes.spines.right": False, "svg.hashsalt": "turner",
    "svg.fonttype": "none",
})


class Point:
    def __init__(self, point, metric, scene_methods):
        self.methods = point["methods"]
        on_demand = float(self.methods.get("error", 0)) > 0
        self.aa = "error" if on_demand else self.methods["aa"]
        self.label = point["label"]
        seconds = point["seconds"]
        self.time = seconds["median"]
        self.low, self.high = seconds["first_quartile"], seconds["third_quartile"]
        self.error = point["error"][metric]
        self.front = metric in point["front"]
        self.is_scene = self.methods == scene_methods


# ---- colours: one for each kind of anti-aliasing ----

def aa_order(aa):
    if aa == "error":
        return (2,)
    return (int("adaptive" in aa), [float(x) for x in aa.replace("adaptive:", "").split(",")][::-1])


def aa_styles(points):
    kinds = sorted({p.aa for p in points}, key=aa_order)
    regular = [kind for kind in kinds if "adaptive" not in kind and kind != "error"]
    other = [kind for kind in kinds if "adaptive" in kind]
    cool, warm = matplotlib.colormaps["viridis"], matplotlib.colormaps["autumn"]
    styles = {}
    for i, kind in enumerate(regular):
        styles[kind] = (cool(0.85 * i / max(1, len(regular) - 1)), "o")
    for i, kind in enumerate(other):
        styles[kind] = (warm(0.15 + 0.6 * i / max(1, len(other) - 1)), "D")
    if "error" in kinds:
        styles["error"] = ("#c0178a", "*")
    return styles


def aa_name(kind):
    if kind == "error":
        return "error on demand"
    if "adaptive" in kind:
        threshold, most = kind.replace("adaptive:", "").split(",")
        return f"adaptive: over {float(threshold):g}, ≤ {most}"
    return f"{kind} sample{'s' if kind != '1' else ''} a pixel"


# ---- axes ----

def time_text(seconds, _=None):
    for limit, scale, unit in ((1, 1, "s"), (1e-3, 1e3, "ms"), (0, 1e6, "µs")):
        if seconds >= limit * 0.9999:
            return f"{seconds * scale:g} {unit}"
    return ""


def set_log_axis(axis, low, high, text):
    """Powers of ten, and between them what is needed so that there are at least three labels."""
    axis.set_minor_formatter(NullFormatter())
    decades = math.log10(high / low)
    subs = (1,) if decades > 3 else (1, 3) if decades > 1.6 else (1, 2, 5)
    axis.set_major_locator(LogLocator(10, subs=subs, numticks=50))
    axis.set_major_formatter(FuncFormatter(text))
    axis.set_minor_locator(LogLocator(10, subs=range(2, 10), numticks=50)
                           if decades < 4 else NullLocator())


def limits_of(chart, metric, points):
    times = [t for p in points for t in (p.low, p.high)]
    errors = [p.error for p in points if p.error > 0] or [1e-6]
    low, high = min(errors), max(errors)
    own = chart["reference"]["error"][metric]
    step = 1 / 255 if metric in ("rmse", "largest") else None
    for line in (own, step, float_limit(chart, metric)):
        if line and low / 20 < line < low:  # near enough to be worth the room
            low = line
        if line and high < line < high * 3:
            high = line
    return (min(times) / 1.35, max(times) * 1.5), (low / 1.8, high * 1.7)


def float_limit(chart, metric):
    """What rounding the truth to 32 bits alone would make of it, by this metric; None for FLIP."""
    rms = chart["reference"]["rms"]
    return {"rmse": FLOAT_ULP * rms, "relative_mse": FLOAT_ULP ** 2, "largest": FLOAT_ULP * rms
            }.get(metric)


# ---- labels that keep out of each other's way ----

def boxes_overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def overlap_area(a, b):
    width = min(a[2], b[2]) - max(a[0], b[0])
    height = min(a[3], b[3]) - max(a[1], b[1])
    return width * height if width > 0 and height > 0 else 0


class Labels:
    def __init__(self, figure, axes, taken, line):
        self.figure, self.axes = figure, axes
        self.frame = axes.get_window_extent().extents
        self.markers = taken      # boxes of points, in pixels
        self.line = line          # boxes along the front
        self.placed = []          # boxes of labels
        self.scale = figure.dpi / 100

    def candidates(self, x, y, width, height):
        for radius in (9, 14, 22, 32, 44, 58, 74, 92, 112, 134):
            r = radius * self.scale
            for step in range(16):
                # right above first: a front falls to the right, its upper right is empty
                angle = math.pi / 4 + math.pi / 8 * (step // 2 + 1) * (-1 if step % 2 else 1)
                if step == 0:
                    angle = math.pi / 4
                cx, cy = x + r * math.cos(angle), y + r * math.sin(angle)
                left = cx - width * (0.5 - 0.5 * math.cos(angle))
                left = min(max(left, self.frame[0] + 4), self.frame[2] - width - 4)
                bottom = cy - height * (0.5 - 0.5 * math.sin(angle))
                yield radius, (left - 2, bottom - 1, left + width + 2, bottom + height + 1)

    def leader(self, x, y, box):
        """Small boxes along the line from the point to the label."""
        near = (min(max(x, box[0]), box[2]), min(max(y, box[1]), box[3]))
        steps = [k / 8 for k in range(1, 8)]
        return [(x + t * (near[0] - x) - 1, y + t * (near[1] - y) - 1,
                 x + t * (near[0] - x) + 1, y + t * (near[1] - y) + 1) for t in steps]

    def cost(self, x, y, radius, box):
        frame = self.frame
        if (box[0] < frame[0] or box[1] < frame[1] or box[2] > frame[2] or box[3] > frame[3]
                or any(boxes_overlap(box, other) for other in self.placed)):
            return math.inf
        hidden = sum(overlap_area(box, other) for other in self.markers)
        crossed = sum(overlap_area(box, other) for other in self.line)
        through = sum(boxes_overlap(piece, other) for piece in self.leader(x, y, box)
                      for other in self.placed)
        return radius + (4 * hidden + crossed) / self.scale ** 2 + 25 * through

    def put(self, point, x, y, text, most=math.inf, **style):
        probe = self.axes.text(0, 0, text, **style)
        extent = probe.get_window_extent(self.figure.canvas.get_renderer())
        probe.remove()
        best, box = min(((self.cost(x, y, r, b), b) for r, b in
                         self.candidates(x, y, extent.width, extent.height)), key=lambda c: c[0])
        if best == math.inf or best > most:
            return
        self.placed.append(box)
        to_points = 72 / self.figure.dpi
        near = (min(max(x, box[0]), box[2]), min(max(y, box[1]), box[3]))
        far = math.hypot(near[0] - x, near[1] - y) > 9 * self.scale
        self.axes.annotate(
            text, (point.time, point.shown), textcoords="offset points",
            xytext=((box[0] + 2 - x) * to_points, (box[1] + 1 - y) * to_points),
            ha="left", va="bottom", zorder=6,
            arrowprops={"arrowstyle": "-", "color": "#aaaaaa", "linewidth": 0.6,
                        "shrinkA": 1, "shrinkB": 4,
                        "relpos": ((near[0] - box[0]) / (box[2] - box[0]),
                                   (near[1] - box[1]) / (box[3] - box[1]))} if far else None,
            **style)


def distance_to_front(point, front):
    """In factors of ten, to the nearest corner of what the front covers."""
    return min((math.hypot(max(0, math.log10(point.time / p.time)),
                           max(0, math.log10(point.shown / p.shown))) for p in front), default=0)


def put_labels(figure, axes, points, front, texts):
    figure.canvas.draw()
    to_pixels = axes.transData.transform
    radius = 5 * figure.dpi / 100
    places = {id(p): to_pixels((p.time, p.shown)) for p in points}
    markers = [(x - radius, y - radius, x + radius, y + radius) for x, y in places.values()]
    line = []
    for p in points:
        (x0, y), (x1, _) = to_pixels((p.low, p.shown)), to_pixels((p.high, p.shown))
        line.append((x0, y - 1, x1, y + 1))
    for a, b in zip(front, front[1:]):
        (xa, ya), (xb, yb) = places[id(a)], places[id(b)]
        line += [(xa, ya - 1, xb, ya + 1), (xb - 1, yb, xb + 1, ya)]
    if front:
        x, y = places[id(front[-1])]
        line.append((x, y - 1, axes.get_window_extent().extents[2], y + 1))
    labels = Labels(figure, axes, markers, line)
    labels.placed += [tuple(text.get_window_extent().extents) for text in texts]
    for p in front:
        labels.put(p, *places[id(p)], p.label, color=INK, fontsize=8.5,
                   fontweight="bold" if p.is_scene else "normal")
    named = list(front)
    rest = [p for p in points if not p.front]
    rest.sort(key=lambda p: (not p.is_scene, -distance_to_front(p, front)))
    for p in rest:
        crowded = any(abs(math.log10(p.time / q.time)) < 0.06
                      and abs(math.log10(p.shown / q.shown)) < 0.06 for q in named)
        if len(named) == len(front) + MORE_LABELS or crowded and not p.is_scene:
            continue
        named.append(p)
        labels.put(p, *places[id(p)], p.label, most=math.inf if p.is_scene else 70,
                   color=QUIET, fontsize=8,
                   fontweight="bold" if p.is_scene else "normal")


# ---- the picture ----

def draw_bounds(axes, chart, metric, ylim):
    """Returns the texts, which labels have to leave free."""
    texts = []

    def line(value, text, color, style, above=True, left=False):
        if not value:
            return
        if value < ylim[0]:
            texts.append(axes.annotate(f"{text} {value:.1g} ↓", (0.995, 0.012),
                                       xycoords="axes fraction", ha="right", va="bottom",
                                       fontsize=7.5, color=color))
            return
        if value > ylim[1]:
            return
        axes.axhline(value, color=color, linewidth=1, linestyle=style, zorder=1)
        texts.append(axes.annotate(text.rstrip(":"), (0.005 if left else 0.995, value),
                                   xycoords=("axes fraction", "data"),
                                   ha="left" if left else "right", va="bottom" if above else "top",
                                   xytext=(0, 2 if above else -2), textcoords="offset points",
                                   fontsize=7.5, color=color))

    own = chart["reference"]["error"][metric]
    if own:
        axes.axhspan(ylim[0], max(own, ylim[0]), color=OWN, alpha=0.10, linewidth=0, zorder=0)
        line(own, "the reference's own error: nothing below can be told", OWN, "--", False)
    if metric in ("rmse", "largest"):
        line(1 / 255, "1/255, a step of 8 bits", QUIET, ":", left=True)
    line(float_limit(chart, metric), "rounding to 32 bits:", "#8e6bbf", "-.")
    return texts


def draw_points(axes, points, styles, own):
    for p in points:
        color, marker = styles[p.aa]
        told = not own or p.error > own
        axes.plot([p.low, p.high], [p.shown, p.shown], color=color, linewidth=1.4, alpha=0.6,
                  zorder=3, solid_capstyle="butt")
        axes.plot([p.time], [p.shown], marker=marker, markersize=7 if p.front else 5.5,
                  color=color if told else "white", markeredgecolor=color if not told else "white",
                  markeredgewidth=1.2 if not told else 0.7, linestyle="none",
                  alpha=1 if p.front else 0.8, zorder=5 if p.front else 4)
        if p.is_scene:
            axes.plot([p.time], [p.shown], marker="o", markersize=13, color="none",
                      markeredgecolor=INK, markeredgewidth=1, zorder=4)


def draw_front(axes, front, xlim):
    if not front:
        return
    xs, ys = [], []
    for p in front:
        xs += [p.time, p.time]
        ys += [ys[-1] if ys else p.shown, p.shown]
    axes.plot(xs + [xlim[1]], ys + [ys[-1]], color=FRONT, linewidth=1.3, alpha=0.85, zorder=2)


def legend(axes, points, styles):
    handles = [Line2D([], [], marker=marker, color=color, linestyle="none", markersize=6.5,
                      label=aa_name(kind)) for kind, (color, marker) in styles.items()]
    handles.append(Line2D([], [], color=FRONT, linewidth=1.3,
                          label="nothing is quicker\nand nearer the truth"))
    if any(p.is_scene for p in points):
        handles.append(Line2D([], [], marker="o", color="none", markeredgecolor=INK,
                              markersize=11, linestyle="none", label="as the scene says"))
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False,
                fontsize=8.5, labelspacing=0.75, handletextpad=0.6)


AGAINST = {
    "pixel": "the mean over each pixel's square",
    "samples": "the same samples, light followed to its end",
    "arithmetic": "the same samples, depth, cutoff and Fresnel formula",
}


def caption(chart, metric, points, dropped):
    reference = chart["reference"]
    methods = chart["methods"]
    text = (f"{chart['device']}; {chart['driver']}; {chart['threads']} threads"
            + (f" of {chart['cpu']}" if chart["cpu"] else "")
            + f"; turner {chart['version']}. Medians of {chart['runs']} runs in turn, bars from "
            f"first to third quartile; tracing alone, without compiling, building and uploading. ")
    text += f"Truth: {AGAINST[reference['against']]}, in extended precision"
    if reference["against"] == "pixel":
        text += f", {reference['spp']} samples in two independent halves"
    if "depth" in reference:
        text += f", depth {reference['depth']}, cutoff {reference['cutoff']:g}"
    text += (f". Not named: as the scene says (depth {methods['depth']}, cutoff "
             f"{float(methods['cutoff']):.4g}).")
    own = reference["error"][metric]
    if own and any(p.error <= own for p in points):
        text += " Hollow: below the reference's own error."
    if dropped:
        text += f" Not drawn: {dropped} point{'s' if dropped > 1 else ''} (chart.md says why)."
    return text


def error_text(value, _=None):
    return f"{value:g}" if value >= 1e-3 else f"{value:.0e}".replace("e-0", "e-")


def draw(chart, metric, title, folder):
    kept = [p for p in chart["points"] if "seconds" in p and p["error"][metric] is not None]
    points = [Point(p, metric, chart["methods"]) for p in kept]
    if not points:
        print(f"turner: warning: no point has a {title}; nothing is drawn", file=sys.stderr)
        return
    xlim, ylim = limits_of(chart, metric, points)
    for p in points:
        p.shown = max(p.error, ylim[0] * 1.2)  # no error at all has no place on this axis
    front = sorted((p for p in points if p.front), key=lambda p: p.time)

    figure, axes = plt.subplots(figsize=(10, 6.3), dpi=120)
    figure.subplots_adjust(left=0.08, right=0.775, top=0.92, bottom=0.19)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*xlim)
    axes.set_ylim(*ylim)
    set_log_axis(axes.xaxis, *xlim, time_text)
    set_log_axis(axes.yaxis, *ylim, error_text)
    axes.grid(True, which="major", color="#e4e4e4", linewidth=0.8, zorder=0)
    axes.set_axisbelow(True)
    texts = draw_bounds(axes, chart, metric, ylim)
    draw_front(axes, front, xlim)
    draw_points(axes, points, aa_styles(points), chart["reference"]["error"][metric])
    legend(axes, points, aa_styles(points))
    put_labels(figure, axes, points, front, texts)

    name = os.path.splitext(os.path.basename(chart["scene"]))[0] or "scene"
    counted = {"pixel": "", "samples": " but for anti-aliasing", "arithmetic": " of rounding alone"}
    axes.set_title(f"{name}, {chart['size'][0]}×{chart['size'][1]}: {title}"
                   f"{counted[chart['reference']['against']]} against time",
                   loc="left", fontsize=12, color=INK, pad=12)
    axes.set_xlabel("time to trace (less is better)")
    axes.set_ylabel(f"{title} (less is better)")
    figure.text(0.015, 0.095, textwrap.fill(
        caption(chart, metric, points, len(chart["points"]) - len(points)), 168),
        fontsize=7.2, color="#555555", va="top", linespacing=1.35)
    for ending, metadata in (("png", {"Software": None}), ("svg", {"Date": None})):
        path = os.path.join(folder, f"chart-{metric}.{ending}")
        figure.savefig(path + ".part", format=ending, metadata=metadata)
        os.replace(path + ".part", path)
    plt.close(figure)


def main():
    folder = sys.argv[1]
    with open(os.path.join(folder, "chart.json"), encoding="utf-8") as file:
        chart = json.load(file)
    for one in chart["charts"]:
        draw(chart, one["metric"], one["title"], folder)


main()
