"""Compares Polnav's sky models with a grid of skylight from OSOAA: the tables of docs/hazy_sky.md.

    python3 compare_models.py build/release/polnav osoaa_sky.csv.gz

Runs `polnav sky --directions` for every case; needs nothing but Python. The row of the sun itself,
which holds its disc, is left out. Neutral points: sign changes of Q / I in the sun's vertical plane,
a straight line between the grid's rows, found the same way in both.
"""
import gzip
import math
import subprocess
import sys
import tempfile

MODELS = ('rayleigh', 'berry', 'hazy')


def load(path):
    cases = {}
    with gzip.open(path, 'rt') as file:
        for line in file:
            if line[0] in '#w':
                continue
            wavelength, sun, aot, azimuth, elevation, from_sun, i, q, u = map(float, line.split(','))
            if from_sun > 0.5:
                cases.setdefault((wavelength, sun, aot), []).append((azimuth, elevation, i, q, u))
    return cases


def run(polnav, model, case, rows):
    wavelength, sun, aot = case
    with tempfile.NamedTemporaryFile('w', suffix='.csv') as file:
        file.write(''.join('%r,%r\n' % row[:2] for row in rows))
        file.flush()
        text = subprocess.run(
            [polnav, 'sky', '--sun-elevation-deg', str(sun), '--sun-azimuth-deg', '0', '--model',
             model, '--aot', str(aot), '--wavelength-nm', str(wavelength), '--directions',
             file.name], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            text=True).stdout
    return [tuple(map(float, line.split(',')))[2:5] for line in text.splitlines()[1:]]


def compare(rows, ours):
    dop, turn, log_i = [], [], []
    scale = {}
    for (_, elevation, i, q, u), (i2, q2, u2) in zip(rows, ours):
        ref, got = math.hypot(q, u) / i, math.hypot(q2, u2) / i2
        dop.append(got - ref)
        log_i.append(math.log(i2 / i))
        if ref > 0.05:
            t = math.degrees(0.5 * (math.atan2(u2, q2) - math.atan2(u, q)))
            turn.append((t + 90) % 180 - 90)
    mean = sum(log_i) / len(log_i)
    return dop, turn, [x - mean for x in log_i]


def neutral_points(rows, stokes):
    """Angles from the horizon below the sun, over the zenith."""
    line = sorted((e if a == 0 else 180 - e, q / i)
                  for (a, e, *_), (i, q, _) in zip(rows, stokes) if a in (0, 180))
    line = [p for n, p in enumerate(line) if n == 0 or p[0] > line[n - 1][0]]
    return [a + (b - a) * qa / (qa - qb) for (a, qa), (b, qb) in zip(line, line[1:]) if qa * qb < 0]


def pairs(reference, ours):
    """Each neutral point of the one with the nearest of the other, or None."""
    left = list(ours)
    matched = []
    for point in reference:
        near = min(left, key=lambda x: abs(x - point), default=None)
        if near is not None and abs(near - point) < 3 and \
                point == min(reference, key=lambda x: abs(x - near)):
            left.remove(near)
        else:
            near = None
        matched.append((point, near))
    return matched + [(None, x) for x in left]


def name(point, points, sun):
    """By its place among the points of its sky."""
    near_sun = [x for x in points if x < sun + 90]
    if point not in near_sun:
        return 'Arago' if point == min(x for x in points if x not in near_sun) else 'fourth'
    if len(near_sun) == 1:
        return 'Babinet' if point > sun else 'Brewster'
    return {near_sun[0]: 'Brewster', near_sun[-1]: 'Babinet'}.get(point, 'inner')


def neutral_cells(sun, reference, ours):
    cells = {n: [] for n in ('Brewster', 'inner', 'Babinet', 'Arago', 'fourth')}
    for point, found in pairs(reference, ours):
        if point is None:
            cells[name(found, ours, sun)].append('extra at %.1f' % found)
        else:
            cells[name(point, reference, sun)].append(
                '%.1f: missing' % point if found is None else '%.1f: %+.1f' % (point, found - point))
    return [', '.join(c) for c in cells.values()]


def rms(x):
    return math.sqrt(sum(v * v for v in x) / len(x)) if x else float('nan')


def main():
    polnav, path = sys.argv[1:]
    pooled = {m: ([], [], []) for m in MODELS}
    print('| nm | sun | AOT | ' + ' | '.join('%s DoP | AoP' % m for m in MODELS) + ' | radiance |')
    print('|' + '---|' * 10)
    neutral = []
    for case, rows in load(path).items():
        cells = []
        reference = neutral_points(rows, [r[2:] for r in rows])
        for model in MODELS:
            ours = run(polnav, model, case, rows)
            errors = compare(rows, ours)
            for all_errors, e in zip(pooled[model], errors):
                all_errors += e
            cells += ['%.4f' % rms(errors[0]), '%.2f' % rms(errors[1])]
            if model == 'hazy':
                cells.append('%.3f' % rms(errors[2]))
                neutral.append((case, neutral_cells(case[1], reference,
                                                    neutral_points(rows, ours))))
        print('| %g | %g | %g | ' % case + ' | '.join(cells) + ' |', flush=True)
    print()
    print('| nm | sun | AOT | Brewster | inner pair | Babinet | Arago | fourth |')
    print('|' + '---|' * 8)
    for case, cells in neutral:
        print('| %g | %g | %g | ' % case + ' | '.join(cells) + ' |')
    print()
    for model, (dop, turn, log_i) in pooled.items():
        print('%s, all cases: DoP RMS %.4f, AoP RMS %.3f deg where DoP > 0.05, radiance %.3f' %
              (model, rms(dop), rms(turn), rms(log_i)))


if __name__ == '__main__':
    main()
