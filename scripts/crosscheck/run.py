# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes the surfaces, has all measurements taken that are not in the store yet, and compares."""
import concurrent.futures
import contextlib
import dataclasses
import fcntl
import pathlib
import shutil
import tempfile

import numpy as np

from . import compare_masking, compare_normals, compare_reflection, maps, measure, store

IDENTITY = np.eye(2)


@dataclasses.dataclass
class Job:
    """One measurement: its kind and key in the store, its share of the work, and how to take it."""
    kind: str
    key: str
    weight: float
    label: str
    take: object


def parallel(threads, calls):
    """Results in order, threads at a time; the first failure stops the rest."""
    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        waiting = [pool.submit(call) for call in calls]
        try:
            return [future.result() for future in waiting]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


class Run:
    def __init__(self, plan, core, povray_version, folder, steps, threads):
        self.plan, self.core, self.povray, self.folder = plan, core, povray_version, folder
        self.steps, self.threads, self.jobs, self.heights = steps, threads, {}, {}

    def add(self, kind, weight, label, inputs, take):
        """The key of a measurement; the job is kept for measure()."""
        version = (measure.VERSION, self.povray) if kind != "facets" else (measure.VERSION,)
        key = store.digest(kind, version, inputs)
        self.jobs[kind, key] = Job(kind, key, weight, label, take)
        return kind, key

    def got(self, name):
        return self.core.store.get(*name, lambda: (_ for _ in ()).throw(KeyError(name)))

    def make_surfaces(self):
        wanted = [(s, k) for s in self.plan.surfaces for k in range(max(self.plan.plain, self.plan.seen, self.plan.mirrors))]
        made = parallel(self.threads, [lambda s=s, k=k: s.heights(self.core, k) for s, k in wanted])
        self.heights = {(s.name, k): h for (s, k), h in zip(wanted, made)}

    def bits(self, spec, number, name, m, views, **how):
        h = self.heights[spec.name, number][0]
        label = f"{spec.name}-{number}-{name}-{how.pop('label', '')}".replace(" ", "_").replace("^", "").replace("/", "_")
        weight = h.size * (1 if how.get("fine") == 1 else 4) / 65536
        inputs = [h, spec.alpha, m, [*views], [list(w) for w in how.get("lights", [])], sorted((k, v) for k, v in how.items() if k != "lights")]
        return self.add("bits", weight, f"{spec.name}, surface {number + 1}, {name}", inputs,
                        lambda: measure.bits(h, spec.alpha, m, views, self.folder, label + store.digest(inputs)[:8], **how))

    def enumerate(self):
        """The measurements of every comparison, {comparison: keys}."""
        plan, self.needs = self.plan, {}
        for spec in plan.surfaces:
            totals = {name: m @ spec.base for name, m in plan.maps.items()}
            every = [v for _, views, _ in plan.looks for v in views]
            for look, views, names in plan.looks:
                seen = range(plan.seen)
                originals = [self.bits(spec, k, "original", IDENTITY, views, field=True) for k in seen]
                for name in names:
                    self.needs["masking", spec, look, name] = (originals, [self.bits(spec, k, name, totals[name], views) for k in seen])
            for name, m in totals.items():
                self.needs["normals", spec, name] = [
                    self.add("facets", 0.3, f"{spec.name}, normals, {name}", [self.heights[spec.name, k][0], spec.alpha, m, every],
                             lambda k=k, m=m, spec=spec: measure.facets(self.heights[spec.name, k][0], spec.alpha, m,
                                                                        [maps.carried(m, v) for v in every]))
                    for k in range(plan.plain)]
            for name, m in plan.mirror_maps.items():
                for view in plan.mirror_views:
                    self.needs["mirrors", spec, name, tuple(view)] = [self.mirror(spec, k, name, m @ spec.base, view)
                                                                      for k in range(plan.mirrors)]
        self.wrong_directions()

    def mirror(self, spec, number, name, m, view):
        h = self.heights[spec.name, number][0]
        label = f"{spec.name}-{number}-{name}-mirror".replace(" ", "_").replace("/", "_")
        inputs = [h, m, view, self.plan.resolution]
        return self.add("mirrors", 1.5 + 4 * (self.plan.resolution / 401) ** 2, f"{spec.name}, surface {number + 1}, reflections, {name}",
                        inputs, lambda: measure.mirrors(h, m, view, self.plan.resolution, self.folder,
                                                        label + store.digest(inputs)[:8]))

    def wrong_directions(self):
        """The first surface lit from v and from M^-1 v instead of M v: negative controls."""
        spec, (_, views, _) = self.plan.surfaces[0], self.plan.looks[0]
        for name, m in self.plan.maps.items():
            total = m @ spec.base
            if np.allclose(total, IDENTITY):
                continue
            for wrong, lights in (("v", views), ("M^-1 v", [maps.carried(np.linalg.inv(total), v) for v in views])):
                key = self.bits(spec, 0, name, total, views, lights=lights, fine=1, label="wrong")
                plain = self.bits(spec, 0, "original", IDENTITY, views, lights=views, fine=1)
                self.needs["control", spec, name, wrong] = (key, plain)

    def measure(self):
        missing = [job for job in self.jobs.values() if not self.core.store.has(job.kind, job.key)]
        self.steps.total = sum(job.weight for job in missing)
        if len(missing) < len(self.jobs):
            self.steps.say(f"{len(self.jobs) - len(missing)} of {len(self.jobs)} measurements were taken before")

        def take(job):
            self.core.store.get(job.kind, job.key, job.take)
            self.steps.advance(job.label, job.weight)

        parallel(self.threads, [lambda job=job: take(job) for job in missing])
        return len(missing)

    def compare(self):
        """All rows in the plan's order, and the shares of normals for the pictures."""
        views = {look: v for look, v, _ in self.plan.looks}
        shares, calls = {}, []
        self.steps.total, self.steps.done = len(self.needs), 0
        for need, keys in self.needs.items():
            calls.append(lambda need=need, keys=keys: self.rows(need, keys, views, shares))
        found = parallel(self.threads, calls)
        return [row for rows in found for row in rows], dict(sorted(shares.items()))

    def rows(self, need, keys, views, shares):
        kind, spec, *rest = need
        m = self.plan.mirror_maps[rest[0]] if kind == "mirrors" else self.plan.maps[rest[-1 if kind != "control" else 0]]
        m = m @ spec.base
        core, name = self.core, rest[0]
        limit = self.heights[spec.name, 0][1]
        if kind == "masking":
            look, name = rest
            originals, jobs = ([self.got(key) for key in some] for some in keys)
            first = [self.got(key) for key in next(k[1] for n, k in self.needs.items() if n[:3] == ("masking", spec, look))]
            rows = [*compare_masking.invariance(spec, look, views[look], name, jobs, originals, first),
                    *compare_masking.joint(spec, core, views[look], name, m, jobs)]
            if look == "views":
                rows += compare_masking.smith(spec, core, views[look], name, m, jobs, limit)
        elif kind == "normals":
            jobs, every = [self.got(key) for key in keys], [v for look in views.values() for v in look]
            row, table = compare_normals.distribution(spec, core, name, m, jobs)
            if table:
                shares[spec.name, name] = table
            rows = [*compare_normals.identity(spec, core, name, m, self.heights[spec.name, 0][0]), *([row] if row else []),
                    *compare_masking.sigma(spec, core, every, name, m, jobs, limit)]
        elif kind == "mirrors":
            rows = compare_reflection.reflection(spec, core, name, m, np.array(rest[1]), [self.got(key) for key in keys])
        else:
            look = views[self.plan.looks[0][0]]
            rows = compare_masking.control(spec, look, name, m, rest[1], *(self.got(key) for key in keys))
        rows = list(rows)
        self.steps.advance(f"comparing: {spec.name}, {name}", 1)
        return rows


@contextlib.contextmanager
def alone(folder):
    """Holds the folder: two runs would take away each other's files. The lock goes with the process, however it ends."""
    with open(folder / "lock", "w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise OSError(f"{folder}: another validation writes there") from None
        for old in folder.glob("povray.*"):  # what a killed run left
            shutil.rmtree(old, ignore_errors=True)
        for old in (folder / "store").glob("*.npz.*"):
            old.unlink(missing_ok=True)
        yield pathlib.Path(tempfile.mkdtemp(prefix="povray.", dir=folder))
