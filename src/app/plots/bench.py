"""bench.py FOLDER: draws FOLDER/bench.png of FOLDER/bench.json, a row of bars for each scene: rates
of every tracer for each kind of rays, with quartiles. With growth FOLDER/growth.png, too: the time
of a ray, building and memory against size, and the logarithm."""
import json
import math
import os
import sys
import textwrap

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

INK, QUIET = "#222222", "#707070"
COLORS = {"bvh": "#c0392b", "ray_query": "#e59866", "embree": "#2e5e8c", "embree 8": "#7fb3d5",
          "embree robust": "#a9b7c6"}
MORE = ["#6c3483", "#239b56", "#b7950b", "#117a65"]  # what --with brings

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "axes.edgecolor": "#999999",
    "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": "#555555",
    "axes.spines.top": False, "axes.spines.right": False,
})


def tracers_of(bench):
    names = []
    for scene in bench["scenes"]:
        for stream in scene["streams"]:
            names += [cell["tracer"] for cell in stream["tracers"]
                      if cell["tracer"] not in names and "rays_per_second" in cell]
    return names


def draw_scene(axes, scene, tracers, colors):
    width = 0.84 / max(1, len(tracers))
    streams = [stream for stream in scene["streams"]
               if any("rays_per_second" in cell for cell in stream["tracers"])]
    for i, stream in enumerate(streams):
        cells = {cell["tracer"]: cell for cell in stream["tracers"]}
        for k, tracer in enumerate(tracers):
            cell = cells.get(tracer, {})
            if "rays_per_second" not in cell:
                continue
            x = i + (k - (len(tracers) - 1) / 2) * width
            rate, low, high = (1e-6 * cell[key] for key in ("rays_per_second", "first_quartile",
                                                            "third_quartile"))
            axes.bar(x, rate, 0.92 * width, color=colors[tracer], linewidth=0, zorder=2)
            axes.plot([x, x], [low, high], color=INK, linewidth=0.8, zorder=3)
            if "ratio_to_embree" in cell and tracer != "embree":
                axes.annotate(f"{cell['ratio_to_embree']:.2f}×", (x, high), xytext=(0, 2),
                              textcoords="offset points", ha="center", va="bottom", fontsize=6.5,
                              color=INK if tracer == "bvh" else QUIET, rotation=90)
    axes.set_xticks(range(len(streams)), [stream["rays"] for stream in streams])
    axes.tick_params(axis="x", length=0)
    axes.margins(y=0.16)
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", color="#e6e6e6", linewidth=0.7, zorder=0)
    axes.set_ylabel("million rays a second")
    instances = f", {scene['instances']:,} instances" if scene["instances"] else ""
    axes.set_title(f"{os.path.basename(scene['scene'])}: {scene['primitives']:,} primitives"
                   + instances, loc="left", fontsize=10, color=INK)


def draw_growth(folder, bench, tracers, colors):
    figure, (times, builds, memory) = plt.subplots(
        1, 3, figsize=(11, 4), gridspec_kw={"width_ratios": [2, 1, 1]})
    scenes = bench["scenes"]
    sizes = [scene["primitives"] for scene in scenes]
    marks = {}
    for fit in bench["growth"]:
        mark = marks.setdefault(fit["rays"], "osD^vx"[len(marks) % 6])
        points = [(scene["primitives"], 1e9 / cell["rays_per_second"]) for scene in scenes
                  for stream in scene["streams"] if stream["rays"] == fit["rays"]
                  for cell in stream["tracers"]
                  if cell["tracer"] == fit["tracer"] and "rays_per_second" in cell]
        color = colors[fit["tracer"]]
        times.plot(*zip(*points), mark, color=color, markersize=5, zorder=3,
                   label=f"{fit['tracer']}, {fit['rays']}")
        times.plot(sizes, [fit["nanoseconds"] + fit["nanoseconds_per_doubling"] * math.log2(n)
                           for n in sizes], color=color, linewidth=1, alpha=0.7, zorder=2)
    for tracer in tracers:
        found = [(scene["primitives"], build) for scene in scenes for build in scene["builds"]
                 if build["tracer"] == tracer]
        if found:
            n = [size for size, _ in found]
            builds.plot(n, [build["seconds"] for _, build in found], "o-", color=colors[tracer],
                        linewidth=1, markersize=4)
            memory.plot(n, [build["bytes"] / size for size, build in found], "o-",
                        color=colors[tracer], linewidth=1, markersize=4)
    for axes, title in ((times, "nanoseconds a ray, and a + b·log n"), (builds, "seconds to build"),
                        (memory, "bytes a triangle")):
        axes.set_xscale("log")
        axes.set_title(title, loc="left", fontsize=10, color=INK)
        axes.set_xlabel("triangles")
        axes.grid(color="#e6e6e6", linewidth=0.7, zorder=0)
    builds.set_yscale("log")
    times.set_ylim(bottom=0)
    memory.set_ylim(bottom=0)
    times.legend(frameon=False, fontsize=8.5)
    caption(figure, bench, 190)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(os.path.join(folder, "growth.png"), dpi=130)


def caption(figure, bench, width):
    text = (f"{bench['device']}; {bench['driver']}; {bench['threads']} threads of {bench['cpu']}; "
            f"{bench['embree']}; turner {bench['version']}. The same rays for all, in turn: medians "
            f"of {bench['rounds']} rounds, lines from first to third quartile; N× is the ratio to "
            "embree.")
    figure.text(0.01, 0.004, textwrap.fill(text, width), fontsize=7, color=QUIET, va="bottom")


def main():
    folder = sys.argv[1]
    with open(os.path.join(folder, "bench.json"), encoding="utf-8") as file:
        bench = json.load(file)
    tracers, scenes = tracers_of(bench), bench["scenes"]
    if not tracers:
        return
    more = iter(MORE * 4)
    colors = {tracer: COLORS.get(tracer) or next(more) for tracer in tracers}
    figure, rows = plt.subplots(len(scenes), 1, figsize=(9, 2.7 * len(scenes) + 1), squeeze=False)
    for axes, scene in zip(rows[:, 0], scenes):
        draw_scene(axes, scene, tracers, colors)
    handles = [plt.Rectangle((0, 0), 1, 1, color=colors[tracer]) for tracer in tracers]
    rows[0, 0].legend(handles, tracers, loc="upper right", frameon=False, ncols=len(tracers),
                      bbox_to_anchor=(1, 1.22), fontsize=8.5, handlelength=1, columnspacing=1.2)
    caption(figure, bench, 150)
    figure.tight_layout(rect=(0, 0.35 / (2.7 * len(scenes) + 1), 1, 1))
    figure.savefig(os.path.join(folder, "bench.png"), dpi=130)
    if bench.get("growth"):
        draw_growth(folder, bench, tracers, colors)


if __name__ == "__main__":
    main()
