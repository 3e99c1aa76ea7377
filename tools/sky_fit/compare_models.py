"""Compares Polnav's sky models with a grid of skylight from OSOAA: the tables of docs/hazy_sky.md.

    python3 compare_models.py build/release/polnav osoaa_sky.csv.gz

Runs `polnav sky --directions` for every case; needs nothing but Python. The row of the sun itself,
which holds its disc, is left out. Neutral points: sign changes of Q in the sun's vertical plane.
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


def rms(x):
    return math.sqrt(sum(v * v for v in x) / len(x)) if x else float('nan')


def main():
    polnav, path = sys.argv[1:]
    pooled = {m: ([], [], []) for m in MODELS}
    print('| nm | sun | AOT | ' + ' | '.join('%s DoP | AoP' % m for m in MODELS) +
          ' | radiance | neutral points: OSOAA | hazy |')
    print('|' + '---|' * 12)
    for case, rows in load(path).items():
        cells = []
        points = [neutral_points(rows, [r[2:] for r in rows])]
        for model in MODELS:
            ours = run(polnav, model, case, rows)
            errors = compare(rows, ours)
            for all_errors, e in zip(pooled[model], errors):
                all_errors += e
            cells += ['%.4f' % rms(errors[0]), '%.2f' % rms(errors[1])]
            if model == 'hazy':
                cells.append('%.3f' % rms(errors[2]))
                points.append(neutral_points(rows, ours))
        cells += [', '.join('%.1f' % x for x in p) for p in points]
        print('| %g | %g | %g | ' % case + ' | '.join(cells) + ' |', flush=True)
    for model, (dop, turn, log_i) in pooled.items():
        print('%s, all cases: DoP RMS %.4f, AoP RMS %.3f deg where DoP > 0.05, radiance %.3f' %
              (model, rms(dop), rms(turn), rms(log_i)))


if __name__ == '__main__':
    main()
