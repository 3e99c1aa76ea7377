"""Scattering by maritime haze, from Mie's theory: writes the table sky/haze_table.cpp.

    /usr/bin/python3 haze_optics.py > ../../sky/haze_table.cpp

Needs numpy. Shettle and Fenn's maritime haze at 70 % humidity, as OSOAA's grid has it: of the
particles 99 % rural and 1 % sea salt, each log-normal in the radius. Nothing here is fitted to the
grid. A matrix of scattering [[p11, p12, 0], [p12, p11, 0], [0, 0, p33]] acts on I, Q, U about the
plane of scattering; the mean of p11 over the sphere is 1. As in OSOAA, log p11 is continued from 20
degrees down to 0 as a straight line of the angle, the other elements go with it, and the light that
this leaves out counts as not scattered.
"""
import functools
import math

import numpy as np
from numpy import pi

ORDERS = 8  # of the expansions
PHASE_DEGREE, POLARIZED_DEGREE = 18, 20
WAVELENGTHS = range(400, 701, 50)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(80)  # cosines of the angle of scattering
LINE_FROM, LINE_TO = 0.8, 0.94  # cosines between which the line's slope is taken

# [Shettle1979]: share, radius [um], decimal logarithm's deviation, largest size parameter;
# wavelength [um], refractive index and absorption at 70 % humidity.
RURAL = (0.99, 0.02846, 0.35, 70,
         [(0.4, 1.502, 0.00504), (0.488, 1.501, 0.00504), (0.5145, 1.501, 0.00504),
          (0.55, 1.501, 0.00563), (0.6328, 1.501, 0.00563), (0.6943, 1.501, 0.00623),
          (0.86, 1.492, 0.00922)])
SALT = (0.01, 0.2041, 0.4, 200,
        [(0.4, 1.417, 0), (0.488, 1.415, 0), (0.5145, 1.414, 0), (0.55, 1.413, 0),
         (0.6328, 1.408, 0), (0.6943, 1.408, 0), (0.86, 1.402, 0)])


def mie(x, index):
    """Efficiencies times x^2 / 2 of extinction and scattering, and S1, S2 [x, angle]."""
    last = int(x.max() + 4 * x.max()**(1 / 3) + 2)
    y = index * x
    log_derivative = np.zeros((last + 17, len(x)), complex)
    for n in range(last + 16, 0, -1):
        log_derivative[n - 1] = n / y - 1 / (log_derivative[n] + n / y)
    psi_before, psi = np.cos(x), np.sin(x)
    chi_before, chi = -np.sin(x), np.cos(x)
    s1, s2 = np.zeros((2, len(x), len(NODES)), complex)
    extinction, scattering = np.zeros((2, len(x)))
    pi_before, pi_n = np.zeros(len(NODES)), np.ones(len(NODES))
    for n in range(1, last + 1):
        wanted = n <= x + 4 * x**(1 / 3) + 2
        with np.errstate(all='ignore'):
            psi_before, psi = psi, (2 * n - 1) / x * psi - psi_before
            chi_before, chi = chi, (2 * n - 1) / x * chi - chi_before
            xi_before, xi = psi_before - 1j * chi_before, psi - 1j * chi
            d = log_derivative[n] / index + n / x
            a = np.where(wanted, (d * psi - psi_before) / (d * xi - xi_before), 0)
            d = log_derivative[n] * index + n / x
            b = np.where(wanted, (d * psi - psi_before) / (d * xi - xi_before), 0)
        extinction += (2 * n + 1) * (a + b).real
        scattering += (2 * n + 1) * (abs(a)**2 + abs(b)**2)
        tau = n * NODES * pi_n - (n + 1) * pi_before
        f = (2 * n + 1) / (n * (n + 1))
        s1 += f * (np.outer(a, pi_n) + np.outer(b, tau))
        s2 += f * (np.outer(a, tau) + np.outer(b, pi_n))
        pi_before, pi_n = pi_n, ((2 * n + 1) * NODES * pi_n - (n + 1) * pi_before) / n
    return extinction, scattering, s1, s2


def sizes(largest):
    """Size parameters and the steps that they stand for, as OSOAA has them: the light that is left
    near neutral points changes with the steps by as much as by anything else."""
    grids = [(0.01, 0.1, 0.001), (0.1, 1, 0.005), (1, 10, 0.02), (10, 30, 0.05), (30, 100, 0.1),
             (100, 200, 1.0)]
    x = np.concatenate([np.arange(a, b - 1e-9, step) + step * (0.5 if b <= 10 else 1)
                        for a, b, step in grids])
    steps = np.concatenate([np.full(len(np.arange(a, b - 1e-9, step)), step)
                            for a, b, step in grids])
    return x[x <= largest], steps[x <= largest]


@functools.lru_cache(None)
def particles(wavelength_nm):
    """Extinction and scattering per particle [um^2], and p11, p12, p33 at the nodes."""
    wave = 2000 * pi / wavelength_nm
    extinction = scattering = p11 = p12 = p33 = 0.0
    for share, radius, deviation, largest, indices in (RURAL, SALT):
        um, real, absorbing = np.array(indices).T
        index = complex(round(np.interp(wavelength_nm / 1000, um, real), 3),
                        round(np.interp(wavelength_nm / 1000, um, absorbing), 5))
        deviation *= math.log(10)
        x_all, steps = sizes(largest)
        count = (share * np.exp(-0.5 * (np.log(x_all / wave / radius) / deviation)**2) /
                 (deviation * math.sqrt(2 * pi)) * steps / x_all)
        for i in range(0, len(x_all), 100):
            n = count[i:i + 100]
            ext, sca, s1, s2 = mie(x_all[i:i + 100], index)
            extinction += 2 * pi / wave**2 * (n @ ext)
            scattering += 2 * pi / wave**2 * (n @ sca)
            p11 = p11 + 2 * pi / wave**2 * (n @ (abs(s2)**2 + abs(s1)**2))
            p12 = p12 + 2 * pi / wave**2 * (n @ (abs(s2)**2 - abs(s1)**2))
            p33 = p33 + 4 * pi / wave**2 * (n @ (s1.conj() * s2).real)
    return extinction, scattering, p11 / scattering, p12 / scattering, p33 / scattering


def wigner(m, n, orders, x):
    """d^l_mn of the angle whose cosine is x [l, x], l from 0 to orders."""
    d = np.zeros((orders + 1, len(x)))
    low = max(abs(m), abs(n))
    if low > orders:
        return d
    f = math.factorial
    d[low] = ((1 if n >= m else (-1)**(m - n)) * 2.0**-low *
              math.sqrt(f(2 * low) / (f(abs(m - n)) * f(abs(m + n)))) *
              (1 - x)**(abs(m - n) / 2) * (1 + x)**(abs(m + n) / 2))
    for l in range(low, orders):
        if l == 0:
            d[1] = x
            continue
        before = d[l - 1] if l > low else 0.0
        d[l + 1] = (((2 * l + 1) * (l * (l + 1) * x - m * n) * d[l] -
                     (l + 1) * math.sqrt((l * l - m * m) * (l * l - n * n)) * before) /
                    (l * math.sqrt(((l + 1)**2 - m * m) * ((l + 1)**2 - n * n))))
    return d


def expansion(p11, p12, p22, p33, orders=ORDERS):
    """Coefficients of I from I, of I from Q (and Q from I), of Q from Q, of U from U [4, l]."""
    weights = (2 * np.arange(orders + 1) + 1) / 2
    of = lambda m, n, f: weights * (wigner(m, n, orders, NODES) @ (WEIGHTS * f))
    same, turned = of(2, 2, p22 + p33), of(2, -2, p22 - p33)
    return np.stack([of(0, 0, p11), of(0, 2, p12), (same + turned) / 2, (same - turned) / 2])


def between_nodes(values, x):
    """Interpolates from the nodes by the four next to x."""
    i = np.clip(np.searchsorted(NODES_X, x) - 2, 0, len(NODES_X) - 4)
    total = 0.0
    for a in range(4):
        w = 1.0
        for b in range(4):
            if b != a:
                w = w * (x - NODES_X[i + b]) / (NODES_X[i + a] - NODES_X[i + b])
        total = total + w * values[i + a]
    return total


def bend(angle):
    """What the polynomials of the angle of scattering go with, from -1 to 1."""
    return np.sin(angle / 2) - np.cos(angle / 2)


NODES_X = bend(np.arccos(NODES[::-1]))


def polynomials(p11, p12):
    """p11 and p12 over sin^2, as powers of bend(angle), highest first. Errors count against p11;
    those of p12 within 60 degrees of the sun more, where neutral points are."""
    angle = np.linspace(0.005, pi - 0.005, 2500)
    x = bend(angle)
    phase = np.exp(between_nodes(np.log(p11[::-1]), x))
    polarized = between_nodes((p12 / (1 - NODES**2))[::-1], x)
    weight = 1 / phase
    fits = []
    for values, degree in ((phase, PHASE_DEGREE), (polarized, POLARIZED_DEGREE)):
        t = np.polynomial.chebyshev.chebvander(x, degree) * weight[:, None]
        fit = np.linalg.lstsq(t, values * weight, rcond=None)[0]
        fits.append(np.polynomial.chebyshev.cheb2poly(fit)[::-1])
        weight = np.sin(angle)**2 * (1 + 20 * np.exp(-angle / 0.6)) / phase
    return fits


@functools.lru_cache(None)
def optics(wavelength_nm):
    extinction, scattering, p11, p12, p33 = particles(wavelength_nm)
    angle = np.arccos(NODES)
    a, b = np.flatnonzero(NODES <= LINE_FROM)[-1], np.flatnonzero(NODES <= LINE_TO)[-1]
    slope = np.log(p11[b] / p11[a]) / (angle[b] - angle[a])
    line = np.where(NODES > NODES[b], p11[b] * np.exp(slope * (angle - angle[b])), p11)
    kept = 0.5 * WEIGHTS @ line
    p12, p33 = p12 * line / p11 / kept, p33 * line / p11 / kept
    p11 = line / kept
    phase, polarized = polynomials(p11, p12)
    return dict(extinction=extinction / particles(550)[0], albedo=scattering / extinction,
                forward=1 - kept, moments=expansion(p11, p12, p11, p33), phase=phase,
                polarized=polarized)


def main():
    row = lambda values: '{' + ', '.join('%.9g' % v for v in values) + '}'
    print('''// Written by tools/sky_fit/haze_optics.py from [Shettle1979] by Mie's theory.
#include "sky/haze_optics.h"

namespace polnav::sky {

extern const std::array<HazeOptics, kHazeWavelengths> kHazeTable;
const std::array<HazeOptics, kHazeWavelengths> kHazeTable = {{''')
    for wavelength in WAVELENGTHS:
        o = optics(wavelength)
        print('// %d nm' % wavelength)
        print('{.extinction = %.7g, .albedo = %.7g, .forward = %.7g,' %
              (o['extinction'], o['albedo'], o['forward']))
        for name, values in zip(('ii', 'iq', 'qq', 'uu'), o['moments']):
            print('.%s = {%s},' % (name, row(values)))
        for name in ('phase', 'polarized'):
            print('.%s = {%s},' % (name, row(o[name])))
        print('},')
    print('''}};

}  // namespace polnav::sky''')


if __name__ == '__main__':
    main()
