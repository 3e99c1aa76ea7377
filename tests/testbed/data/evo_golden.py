#!/usr/bin/env python3
"""Makes the golden trajectories and errors next to it: evo_truth.tum, evo_estimate.tum,
evo_golden.json. Needs numpy.

The formulas are those of evo (github.com/MichaelGrupp/evo: core/sync, geometry, filters, metrics,
lie_algebra), written down again with 4x4 matrices and independent of Polnav's code. Run it only to
change the golden data, in a commit of its own.
"""
import json
import math
from pathlib import Path

import numpy as np


def rotation(axis, angle):
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def quaternion(r):  # x y z w, w > 0 is assumed by no one
    w = math.sqrt(max(0.0, 1 + np.trace(r))) / 2
    if w > 0.1:
        v = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (4 * w)
        return np.append(v, w)
    i = int(np.argmax(np.diag(r)))
    j, k = (i + 1) % 3, (i + 2) % 3
    v = np.zeros(4)
    v[i] = math.sqrt(1 + r[i, i] - r[j, j] - r[k, k]) / 2
    v[j] = (r[j, i] + r[i, j]) / (4 * v[i])
    v[k] = (r[k, i] + r[i, k]) / (4 * v[i])
    v[3] = (r[k, j] - r[j, k]) / (4 * v[i])
    return v


def matrix(x, y, z, w):
    n = np.array([x, y, z, w]) / math.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = n
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def make():
    """Two laps of 2 pi 25 m at varying speed, with hills; the estimate drifts, is noisy, has its
    own rate, a time offset, gaps, and a frame of its own."""
    rng = np.random.default_rng(20201111)
    truth, estimate = [], []
    for i in range(650):
        t = 0.1 * i
        s = 5.2 * t + 1.5 * math.sin(0.4 * t)
        a = s / 25
        p = np.array([25 * math.cos(a) - 25, 25 * math.sin(a), 0.4 * math.sin(2.5 * a)])
        r = rotation([0, 0, 1], a + math.pi / 2) @ rotation([1, 0.3, 0], 0.05 * math.sin(3 * a))
        truth.append((t, p, r))
    frame = rotation([0.02, -0.01, 1], 0.03)
    for i in range(620):
        if 200 <= i < 215:
            continue
        t = 0.1 * i + 0.003 + 0.004 * rng.uniform(-1, 1)
        _, p, r = truth[i]
        p = frame @ p * (1 + 2e-5 * i) + [0.3, -0.2, 0.1] + rng.normal(0, 0.02, 3)
        r = frame @ r @ rotation(rng.normal(0, 1, 3), rng.normal(0, 0.004))
        estimate.append((t, p, r))
    return truth, estimate


def write(path, poses, what):
    with open(path, "w") as f:
        f.write(f"# {what}, made by evo_golden.py; t x y z qx qy qz qw\n")
        for t, p, r in poses:
            q = quaternion(r)
            f.write("%.4f %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n" % (t, *p, *q))


def read(path):
    rows = np.loadtxt(path)
    poses = []
    for row in rows:
        m = np.eye(4)
        m[:3, :3] = matrix(*row[4:])
        m[:3, 3] = row[1:4]
        poses.append(m)
    return rows[:, 0], poses


def associate(t_ref, ref, t_est, est, max_diff=0.01):
    est_longer = len(t_est) > len(t_ref)
    short, long_ = (t_ref, t_est) if est_longer else (t_est, t_ref)
    i_short, i_long = [], []
    for i, t in enumerate(short):
        diffs = np.abs(long_ - t)
        j = int(np.argmin(diffs))
        if diffs[j] <= max_diff:
            i_short.append(i)
            i_long.append(j)
    i_ref, i_est = (i_short, i_long) if est_longer else (i_long, i_short)
    return [ref[i] for i in i_ref], [est[i] for i in i_est]


def umeyama(x, y):  # 3xn, without scale
    mx, my = x.mean(axis=1), y.mean(axis=1)
    cov = sum(np.outer(y[:, i] - my, x[:, i] - mx) for i in range(x.shape[1])) / x.shape[1]
    u, _, v = np.linalg.svd(cov)
    s = np.eye(3)
    if np.linalg.det(u) * np.linalg.det(v) < 0:
        s[2, 2] = -1
    r = u @ s @ v
    return r, my - r @ mx


def inverse(m):
    r = np.eye(4)
    r[:3, :3] = m[:3, :3].T
    r[:3, 3] = -m[:3, :3].T @ m[:3, 3]
    return r


def relative(a, b):
    return inverse(a) @ b


def angle_deg(m):
    r = m[:3, :3]
    v = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / 2
    return math.degrees(math.atan2(np.linalg.norm(v), (np.trace(r) - 1) / 2))


def pairs_by_path(poses, delta):
    ids, previous, path = [], poses[0], 0.0
    for i, current in enumerate(poses):
        path += np.linalg.norm(current[:3, 3] - previous[:3, 3])
        previous = current
        if path >= delta:
            ids.append(i)
            path = 0.0
    return list(zip(ids, ids[1:]))


def statistics(error):
    error = np.asarray(error)
    return {"rmse": math.sqrt(np.mean(error ** 2)), "mean": float(np.mean(error)),
            "median": float(np.median(error)), "std": float(np.std(error)),
            "min": float(np.min(error)), "max": float(np.max(error)),
            "sse": float(np.sum(error ** 2)), "count": len(error)}


def main():
    here = Path(__file__).parent
    truth, estimate = make()
    write(here / "evo_truth.tum", truth, "truth")
    write(here / "evo_estimate.tum", estimate, "estimate")
    ref, est = associate(*read(here / "evo_truth.tum"), *read(here / "evo_estimate.tum"))
    golden = {"about": "made by evo_golden.py with evo's formulas; tolerance 1e-6 of each value",
              "pairs": len(ref)}

    def absolute(name, poses):
        golden["ape_trans_m_" + name] = statistics(
            [np.linalg.norm(e[:3, 3] - q[:3, 3]) for q, e in zip(ref, poses)])
        golden["ape_rot_deg_" + name] = statistics(
            [angle_deg(relative(e, q)) for q, e in zip(ref, poses)])

    absolute("none", est)
    r, t = umeyama(np.array([e[:3, 3] for e in est]).T, np.array([q[:3, 3] for q in ref]).T)
    align = np.eye(4)
    align[:3, :3], align[:3, 3] = r, t
    absolute("se3", [align @ e for e in est])
    for delta in (1.0, 10.0, 100.0):
        errors = [relative(relative(ref[i], ref[j]), relative(est[i], est[j]))
                  for i, j in pairs_by_path(est, delta)]
        golden["rpe_trans_m_%g" % delta] = statistics([np.linalg.norm(e[:3, 3]) for e in errors])
        golden["rpe_rot_deg_%g" % delta] = statistics([angle_deg(e) for e in errors])
    with open(here / "evo_golden.json", "w") as f:
        json.dump(golden, f, indent=1)
        f.write("\n")


main()
