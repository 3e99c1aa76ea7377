"""Fits the constants of air and sea of sky/hazy to clear skies of the radiative transfer code OSOAA.

    /usr/bin/python3 fit_haze.py osoaa_sky.csv.gz [--fit] [--validate] [--table]

Needs numpy and scipy, which building and testing Polnav do not. --fit prints the four constants that
haze_constants.h holds, from the cases without haze; --validate fits them without one case, one sun or
one wavelength, and prints the errors there and, with those constants, in the hazy cases that were
left out with them; --table prints the residuals of all cases. Haze has no constants to fit: all cases
with haze are predictions.
"""
import argparse
import gzip
import json
import pathlib

import numpy as np
from scipy.optimize import least_squares

import haze_model

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
    return np.concatenate([(q / i - ref_q) * weight, (u / i - ref_u) * weight,
                           0.05 * np.log(np.maximum(i, 1e-6) / rows[:, 3])])


def fit(cases, p):
    names = list(p)
    start = np.array([p[n] for n in names])
    at = lambda x: np.concatenate([residuals(k, r, dict(zip(names, x))) for k, r in cases.items()])
    s = least_squares(at, start, x_scale=np.abs(start), diff_step=1e-3, max_nfev=6)
    return dict(zip(names, map(float, s.x)))


def errors(case, rows, p):
    i, q, u = model(case, rows, p)
    dop, ref = np.hypot(q, u) / i, np.hypot(rows[:, 4], rows[:, 5]) / rows[:, 3]
    turn = 0.5 * (np.arctan2(u, q) - np.arctan2(rows[:, 5], rows[:, 4]))
    turn = np.degrees((turn + np.pi / 2) % np.pi - np.pi / 2)[ref > 0.05]
    return dop - ref, turn, np.log(i / rows[:, 3])


def print_errors(label, cases, p, each=False):
    all_errors = {k: errors(k, r, p) for k, r in cases.items()}
    rms = lambda x: np.sqrt(np.mean(np.square(x)))
    form = 'DoP %.4f, AoP %.3f deg, radiance %.3f'
    for k, e in all_errors.items() if each else ():
        print(label, '%g nm, sun %g, aot %g:' % k, form % tuple(map(rms, e)), flush=True)
    print(label, 'all:', form % tuple(rms(np.concatenate(x)) for x in zip(*all_errors.values())),
          flush=True)


def validate(cases, p):
    clear = [k for k in cases if k[2] == 0]
    for label, groups in (('one clear case', [[k] for k in clear]),
                          ('one sun', [[k for k in cases if k[1] == s] for s in (10, 30, 60, 75)]),
                          ('one wavelength', [[k for k in cases if k[0] == w] for w in (450, 550)])):
        for out in groups:
            q = fit({k: cases[k] for k in clear if k not in out}, p)
            print({n: round(v, 4) for n, v in q.items()})
            print_errors('without %s, of %s:' % (label, out[0][:2]), {k: cases[k] for k in out}, q)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('grid')
    parser.add_argument('--start', default=HERE / 'haze_constants.json')
    parser.add_argument('--fit', action='store_true')
    parser.add_argument('--validate', action='store_true')
    parser.add_argument('--table', action='store_true')
    a = parser.parse_args()
    cases = load(a.grid)
    p = json.load(open(a.start))
    if a.fit:
        p = fit({k: r for k, r in cases.items() if k[2] == 0}, p)
        print(json.dumps(p, indent=1), flush=True)
    if a.table:
        print_errors('clear', {k: r for k, r in cases.items() if k[2] == 0}, p, each=True)
        print_errors('hazy', {k: r for k, r in cases.items() if k[2] > 0}, p, each=True)
    if a.validate:
        validate(cases, p)


if __name__ == '__main__':
    main()
