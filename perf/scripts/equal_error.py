#!/usr/bin/env python3
"""What equal_error.sh runs: renders by several methods for equal CPU time, judges them, and writes tables and a plot.

Every run is a row of runs.csv, kept and not repeated; all else is worked out from those rows.
"""
import argparse, csv, math, os, re, shlex, statistics, subprocess, sys
from pathlib import Path

RUN_FIELDS = ["scene", "size", "reference_spp", "method", "seconds", "pair", "spp", "cpu_s", "error", "variance", "bias_squared",
              "trimmed_error", "trimmed_variance", "trimmed_bias_squared", "mean_ratio"]
NEAR_ENOUGH = 0.15  # a run whose CPU time is off by more than this share is asked for other samples
TRIES_MAX = 8
GROWTH = 8
AT_DEFAULTS = 0.0  # in place of a time: pictures that end by themselves
DEFAULTS_SPP = 64  # of methods that do not
SPP_MAX = 1 << 20


def fail(text):
    sys.exit(f"equal_error: {text}")


# --- arithmetic ---

def interval_of_median(values):
    """Median, and the narrowest pair of order statistics that holds the true one with 90 % or more."""
    ordered, n = sorted(values), len(values)
    skipped, tail = 0, 0.5 ** n  # so many values at either end, and the chance that the median is among those
    while skipped < (n - 1) // 2:
        more = tail + math.comb(n, skipped + 1) * 0.5 ** n
        if 1.0 - 2.0 * more < 0.9:
            break
        tail, skipped = more, skipped + 1
    return statistics.median(ordered), ordered[skipped], ordered[n - 1 - skipped], max(0.0, 1.0 - 2.0 * tail)


def samples_for(seconds, tried):
    """Samples that should take so long, by tried runs [(spp, cpu_s)]: in a straight line through the two that took most
    nearly so long, but no more than some times what has been tried; loading and photons take their time at once. Times
    are noisy, so the answer stays between the most samples that were clearly too quick and the fewest clearly too slow."""
    near = []
    for spp, cpu in sorted(tried, key=lambda run: abs(math.log(run[1] / seconds))):
        if all(spp != other for other, _ in near):
            near.append((spp, cpu))
    spp, cpu = near[0]
    slope = (near[1][1] - cpu) / (near[1][0] - spp) if len(near) > 1 else 0.0
    most = GROWTH * max(spp for spp, _ in tried)
    if slope > 0.0:
        wanted = spp + (seconds - cpu) / slope
    else:
        wanted = most if cpu < seconds else min(spp for spp, _ in tried) / 2
    few = max((n for n, cpu in tried if cpu < (1.0 - NEAR_ENOUGH) * seconds), default=1)
    many = min((n for n, cpu in tried if cpu > (1.0 + NEAR_ENOUGH) * seconds), default=SPP_MAX)
    if few < many:
        wanted = min(max(wanted, few), many)
    return max(1, min(SPP_MAX, most, round(wanted)))


# --- runs ---

class Method:
    """A command with {scene} {out} {seed} {width} {height}, and {spp} or {seconds}. by_itself: one for pictures that end
    at the method's own defaults, if it has any."""

    def __init__(self, name, command, by_itself=None):
        self.name, self.command, self.by_itself = name, command, by_itself
        self.takes_samples = "{spp}" in command
        for needed in ("{scene}", "{out}", "{seed}"):
            if needed not in command:
                fail(f"the command of '{name}' has no {needed}")
        if not self.takes_samples and "{seconds}" not in command:
            fail(f"the command of '{name}' has neither {{seconds}} nor {{spp}}")

    def render(self, job, seed, out, seconds=0.0, spp=0):
        """CPU seconds, of all processes that it started and waited for. Without seconds and samples by its defaults."""
        values = {"scene": shlex.quote(str(job.scene)), "out": shlex.quote(str(out)), "seed": seed, "seconds": seconds,
                  "spp": spp, "width": job.width, "height": job.height}
        command = re.sub(r"\{(scene|out|seed|seconds|spp|width|height)\}", lambda m: str(values[m[1]]),
                         self.command if seconds > 0.0 or spp > 0 else self.by_itself)
        Path(out).unlink(missing_ok=True)
        process = subprocess.Popen(["sh", "-c", command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0 or not Path(out).is_file():
            fail(f"'{self.name}' failed with {process.returncode}: {command}")
        return usage.ru_utime + usage.ru_stime


class Job:
    """A scene: its name, its file, the size of its pictures."""

    def __init__(self, path, width):
        self.scene = Path(path).resolve()
        self.name = self.scene.parent.name if self.scene.stem == "scene" else self.scene.stem
        if re.search(r"[,\s]", self.name):
            fail(f"'{self.name}' has a comma or a blank in it")
        text = self.scene.read_text(errors="replace")
        edges = [re.search(rf'"integer {edge}resolution"\s*\[?\s*(\d+)', text) for edge in "xy"]
        x, y = (int(m[1]) for m in edges) if all(edges) else (1280, 720)
        self.width, self.height = width, max(1, round(width * y / x))
        self.size = f"{self.width}x{self.height}"


def picture_errors(bin_folder, pictures, references):
    done = subprocess.run([f"{bin_folder}/afterglow-pair-error", *map(str, pictures), *map(str, references)],
                          capture_output=True, text=True)
    if done.returncode != 0:
        fail(done.stderr.strip())
    e = done.stdout.strip().split(",")
    return dict(zip(RUN_FIELDS[RUN_FIELDS.index("error"):], e))


def make_references(options, job):
    """Two halves of a long path-traced picture, of seeds that no run has; kept in the build folder."""
    folder = Path(options.references)
    folder.mkdir(parents=True, exist_ok=True)
    out = []
    for half in (1, 2):
        file = folder / f"{job.name}-{job.size}-{options.reference_spp}-{half}.exr"
        if not file.is_file():
            print(f"equal_error: reference of {job.name}, half {half}: {options.reference_spp // 2} samples a pixel",
                  file=sys.stderr, flush=True)
            part = file.with_suffix(".part.exr")
            subprocess.run([options.program, "-q", "--progress", "none", "--noise", "0", "--integrator", "path", "--spp",
                            str(max(1, options.reference_spp // 2)), "--seed", str(1000000 + half), "--size",
                            job.size, "--type", "float", "-o", str(part), str(job.scene)], check=True)
            part.rename(file)
        out.append(file)
    return out


def run_pair(options, job, method, seconds, pair, known, references):
    """known: samples and CPU time of earlier runs of the method on the scene; the pair's own are added."""
    pictures = [Path(options.work) / f"{seed}.exr" for seed in "ab"]
    seeds = [2 * pair - 1, 2 * pair]
    if seconds == AT_DEFAULTS:
        spp = 0 if method.by_itself else DEFAULTS_SPP
        cpu = [method.render(job, seed, out, spp=spp) for seed, out in zip(seeds, pictures)]
    elif not method.takes_samples:
        cpu = [method.render(job, seed, out, seconds=seconds) for seed, out in zip(seeds, pictures)]
        spp = 0
    else:
        if not known:
            known.append((1, method.render(job, seeds[0], pictures[0], spp=1)))
        spp, cpu, asked = samples_for(seconds, known), None, set()
        for _ in range(TRIES_MAX):
            cpu = [method.render(job, seeds[0], pictures[0], spp=spp)]
            known.append((spp, cpu[0]))
            asked.add(spp)
            better = samples_for(seconds, known)
            if abs(cpu[0] / seconds - 1.0) <= NEAR_ENOUGH or better in asked:
                break
            spp = better
        else:
            spp = known[-1][0]
        cpu.append(method.render(job, seeds[1], pictures[1], spp=spp))
    row = {"scene": job.name, "size": job.size, "reference_spp": options.reference_spp, "method": method.name, "seconds": f"{seconds:g}", "pair": pair, "spp": spp,
           "cpu_s": f"{sum(cpu) / 2.0:.5g}", **picture_errors(options.bin, pictures, references)}
    for picture in pictures:
        picture.unlink()
    return row


# --- tables ---

def write_table(path, fields, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def number(value):
    return f"{value:.4g}"


def summarize(rows):
    """A row for each scene, method and time: medians over the pairs with their intervals, and path tracing's and the
    rivals' error times CPU time over the photon map's, pair by pair."""
    table = []
    key = lambda row: (row["scene"], row["seconds"], row["method"])
    groups = {}
    for row in rows:
        groups.setdefault(key(row), {})[int(row["pair"])] = row
    for (scene, seconds, method), pairs in groups.items():
        own = groups.get((scene, seconds, "photonmap"), {})
        line = {"scene": scene, "seconds": seconds, "method": method, "pairs": len(pairs),
                "cpu_s": number(statistics.median(float(r["cpu_s"]) for r in pairs.values())),
                "mean_ratio": f"{statistics.median(float(r['mean_ratio']) for r in pairs.values()):.5f}"}
        for prefix, short in (("", ""), ("trimmed_", "trimmed_")):
            for what in ("error", "variance", "bias_squared"):
                values = [float(r[prefix + what]) for r in pairs.values()]
                middle, low, high, sure = interval_of_median(values)
                line[short + what] = number(middle)
                if what == "error":
                    line[short + "error_low"], line[short + "error_high"] = number(low), number(high)
                    line["coverage"] = f"{sure:.3f}"
            ratios = [float(r[prefix + "error"]) * float(r["cpu_s"]) /
                      (float(own[p][prefix + "error"]) * float(own[p]["cpu_s"]))
                      for p, r in pairs.items() if p in own and float(own[p][prefix + "error"]) > 0.0]
            if ratios:
                middle, low, high, _ = interval_of_median(ratios)
                line[short + "over_photonmap"] = number(middle)
                line[short + "over_low"], line[short + "over_high"] = number(low), number(high)
        table.append(line)
    return table


TABLE_FIELDS = ["scene", "seconds", "method", "pairs", "coverage", "cpu_s", "mean_ratio", "error", "error_low",
                "error_high", "variance", "bias_squared", "over_photonmap", "over_low", "over_high", "trimmed_error",
                "trimmed_error_low", "trimmed_error_high", "trimmed_variance", "trimmed_bias_squared",
                "trimmed_over_photonmap", "trimmed_over_low", "trimmed_over_high"]


def write_markdown(path, table, options):
    lines = ["# Error at equal CPU time", "",
             f"Whole pictures at defaults, {options.width} pixels wide, by pairs of seeds, against path tracing of "
             f"{options.reference_spp} samples a pixel, whose own noise is taken off. Medians; in brackets what holds "
             "the true median with the coverage of equal_error.csv. \"times\": error times CPU time over the photon "
             "map's, so above 1 the photon map is ahead. Trimmed: without the worst hundredth of the pixels.", "",
             "| scene | s | method | CPU s | mean | error | times | trimmed error | trimmed times |",
             "|---|---|---|---|---|---|---|---|---|"]
    for row in table:
        def bracket(prefix):
            if prefix + "over_photonmap" not in row:
                return ""
            return f"{row[prefix + 'over_photonmap']} ({row[prefix + 'over_low']} to {row[prefix + 'over_high']})"
        seconds = row["seconds"] if float(row["seconds"]) != AT_DEFAULTS else "defaults"
        lines.append(f"| {row['scene']} | {seconds} | {row['method']} | {row['cpu_s']} | {row['mean_ratio']} | "
                     f"{row['error']} | {bracket('')} | {row['trimmed_error']} | {bracket('trimmed_')} |")
    Path(path).write_text("\n".join(lines) + "\n")


# --- plot ---

COLORS = ["#d62728", "#1f77b4", "#2ca02c", "#9467bd", "#8c564b", "#e377c2"]


def write_plot(path, table):
    """A panel for each scene: error against CPU time, both by logarithms; whole lines are of all pixels, dashed ones
    trimmed."""
    scenes = list(dict.fromkeys(row["scene"] for row in table))
    methods = list(dict.fromkeys(row["method"] for row in table))
    wide, high, margin, columns = 330, 250, 48, min(3, len(scenes))
    height = high * ((len(scenes) + columns - 1) // columns) + 30
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide * columns}" height="{height}" '
           'font-family="DejaVu Sans,Arial,sans-serif" font-size="11">',
           f'<rect width="{wide * columns}" height="{height}" fill="white"/>']
    for i, method in enumerate(methods):
        out.append(f'<text x="{10 + 130 * i}" y="18" fill="{COLORS[i % len(COLORS)]}">{method}</text>')
    for n, scene in enumerate(scenes):
        x0, y0 = n % columns * wide + margin, n // columns * high + 30
        w, h = wide - margin - 10, high - 55
        points = {}
        for row in (r for r in table if r["scene"] == scene):
            for kind in ("", "trimmed_"):
                if float(row[kind + "error"]) > 0.0 and float(row["cpu_s"]) > 0.0:
                    points.setdefault((row["method"], kind), []).append(
                        (math.log10(float(row["cpu_s"])), math.log10(float(row[kind + "error"]))))
        every = [p for line in points.values() for p in line]
        out.append(f'<text x="{x0}" y="{y0 + 12}" font-weight="bold">{scene}</text>')
        if not every:
            continue
        left, right = min(p[0] for p in every) - 0.1, max(p[0] for p in every) + 0.1
        bottom, top = min(p[1] for p in every) - 0.1, max(p[1] for p in every) + 0.1
        at = lambda p: (x0 + w * (p[0] - left) / (right - left), y0 + 18 + h * (top - p[1]) / (top - bottom))
        out.append(f'<rect x="{x0}" y="{y0 + 18}" width="{w}" height="{h}" fill="none" stroke="#555555"/>')
        for axis, (low, up) in enumerate(((left, right), (bottom, top))):
            for decade in range(math.ceil(low), math.floor(up) + 1):
                x, y = at((decade, bottom) if axis == 0 else (left, decade))
                label = f"{10.0 ** decade:g}"
                if axis == 0:
                    out.append(f'<path d="M{x:.1f} {y:.1f}V{y0 + 18}" stroke="#dddddd"/>')
                    out.append(f'<text x="{x:.1f}" y="{y + 14:.1f}" text-anchor="middle">{label} s</text>')
                else:
                    out.append(f'<path d="M{x:.1f} {y:.1f}H{x0 + w}" stroke="#dddddd"/>')
                    out.append(f'<text x="{x - 4:.1f}" y="{y + 4:.1f}" text-anchor="end">{label}</text>')
        for (method, kind), line in points.items():
            color, dash = COLORS[methods.index(method) % len(COLORS)], ' stroke-dasharray="5 3"' if kind else ""
            points = [at(p) for p in sorted(line)]
            out.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in points)}" fill="none" '
                       f'stroke="{color}" stroke-width="1.8"{dash}/>')
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{color}"/>' for x, y in points]
    out.append("</svg>")
    Path(path).write_text("\n".join(out) + "\n")


# ---

def own_command(program, integrator, threads, samples="--noise 0 --spp {spp}"):
    return (f"{shlex.quote(program)} -q --progress none {samples} --seed {{seed}} --integrator {integrator} "
            f"{f'-t {threads} ' if threads else ''}--size {{width}}x{{height}} --type float -o {{out}} {{scene}}")


def main():
    parser = argparse.ArgumentParser()
    for name in ("program", "bin", "work", "out", "references"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--seconds", required=True)
    for name in ("width", "pairs", "reference-spp", "threads"):
        parser.add_argument(f"--{name}", type=int, required=True)
    parser.add_argument("--rival", action="append", default=[])
    parser.add_argument("scenes", nargs="+")
    options = parser.parse_args()

    methods = [Method("photonmap", own_command(options.program, "photonmap", options.threads),
                      own_command(options.program, "photonmap", options.threads, samples="")),
               Method("path", own_command(options.program, "path", options.threads))]
    for rival in options.rival:
        name, _, command = rival.partition("=")
        if not re.fullmatch(r"[A-Za-z0-9_.-]+", name) or name in (m.name for m in methods) or not command:
            fail(f"--rival wants NAME=COMMAND, with a name that is not taken, not '{rival}'")
        methods.append(Method(name, command))
    jobs = [Job(path, options.width) for path in options.scenes]
    times = [float(t) for t in options.seconds.split(",")]
    for method in methods:
        if AT_DEFAULTS in times and not (method.by_itself or method.takes_samples):
            fail(f"the command of '{method.name}' has no {{spp}}, and ends by no defaults")

    runs = Path(options.out) / "runs.csv"
    rows = []
    if runs.is_file():
        with open(runs, newline="") as file:
            rows = list(csv.DictReader(file))
        if rows and list(rows[0]) != RUN_FIELDS:
            fail(f"{runs} is of another version: leave out --resume")
        sizes = {job.name: job.size for job in jobs}
        if any(r["size"] != sizes.get(r["scene"], r["size"]) or r["reference_spp"] != str(options.reference_spp)
               for r in rows):
            fail(f"{runs} is of other sizes or references: leave out --resume")
    else:
        write_table(runs, RUN_FIELDS, [])
    done = {(r["scene"], r["method"], r["seconds"], int(r["pair"])) for r in rows}
    known = {}
    for r in rows:
        if int(r["spp"]) > 0:
            known.setdefault((r["scene"], r["method"]), []).append((int(r["spp"]), float(r["cpu_s"])))

    for pair in range(1, options.pairs + 1):  # in turn, so that all methods see the same state of the machine
        for job in jobs:
            references = make_references(options, job)
            for seconds in times:
                for method in methods:
                    if (job.name, method.name, f"{seconds:g}", pair) in done:
                        continue
                    row = run_pair(options, job, method, seconds, pair,
                                   known.setdefault((job.name, method.name), []), references)
                    rows.append({field: str(row[field]) for field in RUN_FIELDS})
                    with open(runs, "a", newline="") as file:
                        csv.DictWriter(file, RUN_FIELDS, lineterminator="\n").writerow(row)

    asked = [r for r in rows if r["scene"] in {j.name for j in jobs} and float(r["seconds"]) in times and
             r["method"] in {m.name for m in methods} and int(r["pair"]) <= options.pairs]
    order = {name: i for i, name in enumerate([j.name for j in jobs] + [m.name for m in methods])}
    asked.sort(key=lambda r: (order[r["scene"]], float(r["seconds"]), order[r["method"]]))
    table = summarize(asked)
    write_table(Path(options.out) / "equal_error.csv", TABLE_FIELDS, table)
    write_markdown(Path(options.out) / "equal_error.md", table, options)
    write_plot(Path(options.out) / "equal_error.svg", table)


if __name__ == "__main__":
    main()
