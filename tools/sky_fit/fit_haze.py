"""Fits the constants of sky/hazy to a grid of skylight from the radiative transfer code OSOAA.

    python3 fit_haze.py osoaa_sky.csv.gz [--fit] [--validate] [--table]

Needs numpy and scipy, which building and testing Polnav do not. --fit prints the constants that
haze_constants.h holds; --table the residuals of docs/hazy_sky.md; --validate repeats the fit
without one case, one sun, one aerosol depth or one wavelength and prints the errors there.
"""
import argparse
import gzip
import json
import pathlib

import numpy as np
from scipy.optimize import least_squares

import haze_model

# The phase function's height nearly repeats the albedo; grazing only keeps the sum over facets smooth.
FIXED = ('albedo', 'grazing')
NEUTRAL = 3
EXPONENTS = ('angstrom', 'across_power')
CLEAR = ('air', 'slope_variance', 'water_450', 'water_power')  # fitted to clear air, then kept

HERE = pathlib.Path(__file__).parent


def load(path):
    cases = {}
    with gzip.open(path, 'rt') as file:
        for line in file:
            if line[0] in '#w':
                continue
            x = [float(v) for v in line.split(',')]
            if x[5] > 0.5:  # the row of the sun itself holds its disc
                cases.setdefault(tuple(x[:3]), []).append(x[3:])
    return {k: np.array(v) for k, v in cases.items()}


def model(case, rows, p):
    wavelength, elevation, aot = case
    return haze_model.sky(elevation, wavelength, aot, np.radians(rows[:, 0]),
                          np.sin(np.radians(rows[:, 1])), p)


def residuals(case, rows, p):
    i, q, u = model(case, rows, p)
    ref_q, ref_u = rows[:, 4] / rows[:, 3], rows[:, 5] / rows[:, 3]
    # Between an error of the degree and one of the angle, which counts by 1 / degree.
    weight = 0.35 / (0.08 + np.hypot(ref_q, ref_u))
    # Where neutral points are: in the sun's vertical plane a degree is worth 0.001 to 0.003 of Q/I.
    weight[(rows[:, 0] % 180 == 0) & (np.abs(ref_q) < 0.02) & (rows[:, 1] > 2)] *= NEUTRAL
    return np.concatenate([(q / i - ref_q) * weight, (u / i - ref_u) * weight,
                           0.05 * np.log(np.maximum(i, 1e-6) / rows[:, 3])])


def fit(cases, p, names, **options):
    x0 = np.array([p[n] for n in names])

    def all_residuals(x):
        return np.concatenate([residuals(k, r, dict(p, **dict(zip(names, x))))
                               for k, r in cases.items()])

    s = least_squares(all_residuals, x0, x_scale=np.maximum(np.abs(x0), 0.02), diff_step=1e-4,
                      **options)
    return dict(p, **dict(zip(names, map(float, s.x)))), s


def errors(case, rows, p):
    i, q, u = model(case, rows, p)
    dop, ref = np.hypot(q, u) / i, np.hypot(rows[:, 4], rows[:, 5]) / rows[:, 3]
    turn = 0.5 * (np.arctan2(u, q) - np.arctan2(rows[:, 5], rows[:, 4]))
    turn = np.degrees((turn + np.pi / 2) % np.pi - np.pi / 2)[ref > 0.05]
    rms = lambda x: np.sqrt(np.mean(np.square(x)))
    return rms(dop - ref), rms(turn), rms(np.log(i / rows[:, 3])), len(turn), len(ref)


def print_errors(label, cases, p):
    rows = [errors(k, r, p) for k, r in cases.items()]
    for k, e in zip(cases, rows):
        print(label, '%g nm, sun %g, aot %g: DoP %.4f, AoP %.3f deg, radiance %.3f' % (k + e[:3]),
              flush=True)
    e = np.array(rows)
    print(label, 'all: DoP %.4f, AoP %.3f deg, radiance %.3f' %
          (np.sqrt(np.sum(e[:, 0]**2 * e[:, 4]) / e[:, 4].sum()),
           np.sqrt(np.sum(e[:, 1]**2 * e[:, 3]) / e[:, 3].sum()),
           np.sqrt(np.sum(e[:, 2]**2 * e[:, 4]) / e[:, 4].sum())), flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('grid')
    parser.add_argument('--start', default=HERE / 'haze_constants.json')
    parser.add_argument('--clear', action='store_true', help='air and sea, from clear air alone')
    parser.add_argument('--fit', action='store_true')
    parser.add_argument('--validate', action='store_true')
    parser.add_argument('--table', action='store_true')
    a = parser.parse_args()
    cases = load(a.grid)
    p = json.load(open(a.start))
    names = [n for n in p if n not in FIXED + (() if a.clear else CLEAR)]
    if a.clear:
        names = list(CLEAR)
        cases = {k: r for k, r in cases.items() if k[2] == 0}
    if a.fit:
        p, s = fit(cases, p, names, max_nfev=7, verbose=2)
        print(json.dumps(p, indent=1), flush=True)
        print('sigma', dict(zip(names, np.sqrt(np.diag(np.linalg.inv(s.jac.T @ s.jac)) * 2 * s.cost
                                                / len(s.fun)))))
    if a.table:
        print_errors('fit', cases, p)
    if a.validate:
        validate(cases, p, names)


def validate(cases, p, names):
    """Gauss-Newton from the fit to all cases, with its Jacobian, without those left out."""
    x = np.array([p[n] for n in names])
    blocks = {}
    for k, r in cases.items():
        at = residuals(k, r, p)
        steps = 1e-4 * np.maximum(np.abs(x), 0.02)
        jac = [(residuals(k, r, dict(p, **{n: v + h})) - at) / h
               for n, v, h in zip(names, x, steps)]
        blocks[k] = (at, np.array(jac).T)
    groups = [('one case', [[k] for k in cases])]
    for label, axis in (('one sun', 1), ('one depth', 2), ('one wavelength', 0)):
        groups.append((label, [[k for k in cases if k[axis] == v]
                               for v in sorted({k[axis] for k in cases})]))
    for label, outs in groups:
        pooled = []
        for out in outs:
            kept = [b for k, b in blocks.items() if k not in out]
            jtj = sum(j.T @ j for _, j in kept)
            jtr = sum(j.T @ r for r, j in kept)
            if label == 'one wavelength':  # one wavelength alone says nothing of exponents
                for n in EXPONENTS:
                    i = names.index(n)
                    jtj[i], jtj[:, i], jtr[i] = 0, 0, 0
            scale = np.diag(1 / np.sqrt(np.diag(jtj) + 1e-12))
            step = -scale @ np.linalg.lstsq(scale @ jtj @ scale, scale @ jtr, rcond=1e-9)[0]
            q = dict(p, **dict(zip(names, x + step)))
            for k in out:
                e = errors(k, cases[k], q)
                pooled.append(e)
                print('without', label, k, 'DoP %.4f, AoP %.3f deg' % e[:2], flush=True)
        e = np.array(pooled)
        print('without', label, 'all: DoP %.4f, AoP %.3f deg' % (
            np.sqrt(np.sum(e[:, 0]**2 * e[:, 4]) / e[:, 4].sum()),
            np.sqrt(np.sum(e[:, 1]**2 * e[:, 3]) / e[:, 3].sum())), flush=True)


if __name__ == '__main__':
    main()
