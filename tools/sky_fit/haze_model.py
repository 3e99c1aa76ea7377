"""The sky model `hazy` in numpy, equation by equation as sky/hazy*.cpp has it, for fitting.

Fields are Fourier modes in the azimuth from the sun: I, Q go with cos(m az), U with sin(m az). A
direction is where light comes from; Q and U are about axis 1 (away from the zenith) and axis 2
(towards increasing azimuth). A tensor is the second moment of the electric field, by its parts
h (xx + yy)/2, v zz (mode 0), w xz (mode 1) and d (xx - yy)/2 (mode 2), x below the sun.
"""
import numpy as np
from numpy import pi

LEVELS = 16
ORDERS = 12
AIR_HEIGHT_M, HAZE_HEIGHT_M = 8000.0, 2000.0
DEPOLARIZATION = 0.0279
WATER_INDEX = 1.34
# Slopes over their deviation: towards the sun, and across it by Gauss and Hermite.
SLOPES = np.arange(-3, 3.125, 0.25)
SLOPE_WEIGHTS = np.exp(-0.5 * SLOPES**2) / np.exp(-0.5 * SLOPES**2).sum()
CROSS_SLOPES, CROSS_WEIGHTS = [-3**0.5, 0, 3**0.5], [1 / 6, 4 / 6, 1 / 6]
STREAMS, STREAM_WEIGHTS = np.polynomial.legendre.leggauss(8)
STREAMS, STREAM_WEIGHTS = 0.5 * (STREAMS + 1), 0.5 * STREAM_WEIGHTS


def rayleigh_depth(wavelength_nm, share):
    um = wavelength_nm / 1000.0
    return share * 0.008569 * um**-4 * (1 + 0.0113 * um**-2 + 0.00013 * um**-4)


def fresnel(cosine):
    across = np.sqrt(1 - (1 - cosine**2) / WATER_INDEX**2)
    s = (cosine - WATER_INDEX * across) / (cosine + WATER_INDEX * across)
    p = (WATER_INDEX * cosine - across) / (WATER_INDEX * cosine + across)
    return s, p


def project(m, parts, mu):
    """Stokes [3, level, mu] that a tensor per level shows along mu."""
    s = np.sqrt(1 - mu**2)
    if m == 0:
        h, v = (x[:, None] for x in parts)
        return np.stack([h * (1 + mu**2) + v * s**2, (v - h) * s**2, 0 * h * mu])
    x = parts[0][:, None]
    if m == 1:
        return np.stack([-2 * x * mu * s, -2 * x * mu * s, 2 * x * s])
    return np.stack([-x * s**2, x * (1 + mu**2), -2 * x * mu])


def moments(m, f, mu):
    """Tensor per level of a field f [3, level, mu] over one hemisphere."""
    i, q, u = f
    s = np.sqrt(1 - mu**2)
    w = STREAM_WEIGHTS
    if m == 0:
        return np.array([pi * (i * (1 - s**2 / 2) - q * s**2 / 2) @ w, pi * ((i + q) * s**2) @ w])
    if m == 1:
        return np.array([0.5 * pi * (-s * mu * (i + q) + s * u) @ w])
    return np.array([0.25 * pi * (-s**2 * i + (1 + mu**2) * q - 2 * mu * u) @ w])


def legendre(m, mu):
    """Functions of mu, their weights and orders in the addition theorem, and the azimuth's norm."""
    s = np.sqrt(1 - mu**2)
    if m == 0:
        return [1 + 0 * mu, mu, 1.5 * mu**2 - 0.5], [1, 3, 5], [0, 1, 2], 2 * pi
    if m == 1:
        return [s, s * mu], [3, 15], [1, 2], pi
    return [s**2], [3.75], [2], pi


class Field:
    """Sources of diffuse light in a hazy atmosphere over a sea."""

    def __init__(self, sun_elevation_rad, air_depth, haze_depth, p):
        self.p = p
        self.mu0 = mu0 = np.sin(sun_elevation_rad)
        self.across = across = np.cos(sun_elevation_rad)
        t = np.linspace(0, 1, LEVELS + 1)
        power = AIR_HEIGHT_M / HAZE_HEIGHT_M
        scaled = haze_depth * (1 - p['albedo'] * p['forward'])
        self.depth = air_depth * t + scaled * t**power
        air, haze = air_depth + 0 * t, scaled * power * t ** (power - 1)
        f = p['forward']
        self.air = air / (air + haze)
        self.haze = haze / (air + haze) * p['albedo'] * (1 - f) / (1 - p['albedo'] * f)
        self.g = [1.0, (p['g1'] - f) / (1 - f), (p['g2'] - f) / (1 - f)]
        self.g_polarized = (p['g_polarized'] - f) / (1 - f)
        self.rayleigh = (1 - DEPOLARIZATION) / (1 + DEPOLARIZATION / 2)
        self.direct = np.exp(-self.depth / mu0)
        self.steps = np.diff(self.depth)
        self.ex, self.a = self.attenuation(STREAMS)
        self.make_glint()
        self.modes = [self.solve(m) for m in range(3)]

    def attenuation(self, mu):
        x = np.maximum(self.steps[:, None] / mu, 1e-12)
        ex = np.exp(-x)
        return ex, (1 - ex) / x

    @staticmethod
    def sweep(source, ex, a, start=None):
        out = np.zeros_like(source)
        if start is not None:
            out[:, 0] = start
        for j in range(source.shape[1] - 1):
            out[:, j + 1] = (out[:, j] * ex[j] + source[:, j] * (a[j] - ex[j])
                             + source[:, j + 1] * (1 - a[j]))
        return out

    def make_glint(self):
        """Sunlight from the waves' facets: tensors and intensities per level and mode."""
        sigma = np.sqrt(self.p['slope_variance'] / 2)
        sun = np.array([self.across, 0, self.mu0])
        levels = len(self.depth)
        self.glint_tensor = [np.zeros((2, levels)), np.zeros((1, levels)), np.zeros((1, levels))]
        self.glint_legendre = [np.zeros((3, levels)), np.zeros((2, levels)), np.zeros((1, levels))]
        self.glint = np.zeros(levels)
        direction, across, total = np.zeros(3), 0.0, 0.0
        for a, wa in zip(SLOPES, SLOPE_WEIGHTS):
            for b, wb in zip(CROSS_SLOPES, CROSS_WEIGHTS):
                normal = np.array([-a * sigma, -b * sigma, 1])
                upright = 1 / np.linalg.norm(normal)
                normal *= upright
                cosine = sun @ normal
                if cosine <= 0:
                    continue
                weight = wa * wb * cosine / upright
                total += weight
                ray = 2 * cosine * normal - sun
                if ray[2] <= 0:
                    continue
                # Rays that graze the sea: held up, and fewer for the waves in their way.
                up = np.hypot(ray[2], self.p['grazing'])
                s, p = fresnel(cosine)
                es = np.cross(sun, normal)
                es = es / np.linalg.norm(es) if np.linalg.norm(es) > 1e-9 else np.array([0, 1.0, 0])
                ep = np.cross(es, ray)
                e = 0.5 * (s**2 * np.outer(es, es) + p**2 * np.outer(ep, ep)) * weight * ray[2] / up**2
                fade = self.direct[-1] * np.exp(-(self.depth[-1] - self.depth) / up)
                light = np.trace(e) * fade
                self.glint += light
                self.glint_tensor[0] += np.outer([0.5 * (e[0, 0] + e[1, 1]), e[2, 2]], fade)
                self.glint_tensor[1] += e[0, 2] * fade
                self.glint_tensor[2] += 0.5 * (e[0, 0] - e[1, 1]) * fade
                k = -ray
                flat = np.hypot(k[0], k[1])
                c = k[0] / flat if flat > 1e-9 else 1.0
                for m, cos_m in enumerate([1, c, 2 * c * c - 1]):
                    functions = legendre(m, np.array(k[2]))[0]
                    self.glint_legendre[m] += np.outer(functions, light) * cos_m
                direction += light[-1] * k
                across += light[-1] * (2 * e[1, 1] / np.trace(e) - 1)
        norm = self.mu0 / total
        self.glint *= norm
        self.glint_tensor = [x * norm for x in self.glint_tensor]
        self.glint_legendre = [x * norm for x in self.glint_legendre]
        self.glint_from = direction / np.linalg.norm(direction)
        self.glint_dop = across * norm / self.glint[-1]

    def source(self, m, tensor, light, haze_light, polarized, mu):
        out = self.rayleigh * 3 / (8 * pi) * self.air[:, None] * project(m, tensor, mu)
        q = 5 * self.g_polarized / (8 * pi) * self.haze[:, None] * project(m, polarized, mu)
        out[1:] += q[1:]
        functions, weights, orders, _ = legendre(m, mu)
        for fn, weight, order, part in zip(functions, weights, orders, haze_light):
            out[0] += (self.haze * self.g[order] * part)[:, None] * fn * weight / (4 * pi)
        if m == 0:
            out[0] += ((1 - self.rayleigh) * self.air * light[0])[:, None] / (4 * pi) + 0 * mu
        return out

    def solve(self, m):
        c, s, e = self.across, self.mu0, self.direct
        tensor = [np.stack([e * (0.5 - c**2 / 4), e * 0.5 * c**2]),
                  -0.5 * c * s * e[None], -0.25 * c**2 * e[None]][m] + self.glint_tensor[m]
        functions, _, _, norm = legendre(m, np.array(s))
        beam = np.array([f * e for f in functions])
        light = beam + self.glint_legendre[m]
        polarized = np.zeros_like(tensor)
        rs, rp = fresnel(np.minimum(1, np.sqrt(STREAMS**2 + self.p['slope_variance'])))
        down_fn, up_fn = legendre(m, STREAMS)[0], legendre(m, -STREAMS)[0]
        sums = [tensor, 0 * light, polarized, light]
        lit = self.mu0 * e[-1]
        for _ in range(ORDERS):
            down = self.sweep(self.source(m, tensor, light, light, polarized, STREAMS),
                              self.ex, self.a)
            i, q, u = down[:, -1]
            start = np.stack([0.5 * ((rp**2 + rs**2) * i + (rp**2 - rs**2) * q),
                              0.5 * ((rp**2 - rs**2) * i + (rp**2 + rs**2) * q), rs * rp * u])
            if m == 0:
                lit += 2 * pi * np.sum(STREAM_WEIGHTS * STREAMS * i)
                start[0] += self.p['water'] * lit / pi
                lit = 0.0
            up = self.sweep(self.source(m, tensor, light, light, polarized, -STREAMS)[:, ::-1],
                            self.ex[::-1], self.a[::-1], start)[:, ::-1]
            tensor = moments(m, down, STREAMS) + moments(m, up, -STREAMS)
            dq, uq = down.copy(), up.copy()
            dq[0], uq[0] = 0, 0
            polarized = moments(m, dq, STREAMS) + moments(m, uq, -STREAMS)
            light = norm * np.array([(down[0] * d + up[0] * u_) @ STREAM_WEIGHTS
                                     for d, u_ in zip(down_fn, up_fn)])
            sums = [sums[0] + tensor, sums[1] + light, sums[2] + polarized, sums[3] + light]
        return sums  # tensor, diffuse light without beam and glint, polarized tensor, all light

    def along(self, mu):
        """Stokes modes [m][3, n] at the ground, and sunlight and glint scattered once by haze."""
        ex, a = self.attenuation(mu)
        modes = []
        for m, (tensor, diffuse, polarized, light) in enumerate(self.modes):
            modes.append(self.sweep(self.source(m, tensor, light, diffuse, polarized, mu),
                                    ex, a)[:, -1])
        once = np.stack([(self.haze * x)[:, None] / (4 * pi) + 0 * mu
                         for x in (self.direct, self.glint)]) / (1 - self.p['forward'])
        return modes, self.sweep(once, ex, a)[:, -1]


def peak(cosine, p):
    return (p['peak'] / (p['peak_at'] - cosine))**2


def phase(cosine, p):
    return peak(cosine, p) + p['even0'] + (p['even1'] + p['even2'] * cosine) * cosine


def sky(sun_elevation_deg, wavelength_nm, aot_550, azimuth_rad, mu, p):
    """I, Q, U over the sun's irradiance, times pi."""
    p = dict(p, water=p['water_450'] * (wavelength_nm / 450.0) ** p['water_power'])
    elevation = np.radians(sun_elevation_deg)
    haze_depth = aot_550 * (wavelength_nm / 550.0) ** -p['angstrom']
    field = Field(elevation, rayleigh_depth(wavelength_nm, p['air']), haze_depth, p)
    each, inverse = np.unique(mu, return_inverse=True)
    modes, once = field.along(each)
    i = q = u = 0.0
    for m, f in enumerate(modes):
        f = f[:, inverse]
        i = i + f[0] * np.cos(m * azimuth_rad)
        q = q + f[1] * np.cos(m * azimuth_rad)
        u = u + f[2] * np.sin(m * azimuth_rad)
    sine = np.sqrt(1 - mu**2)
    k = np.stack([sine * np.cos(azimuth_rad), sine * np.sin(azimuth_rad), mu])
    sun = np.array([np.cos(elevation), 0, np.sin(elevation)])
    axis1 = np.stack([mu * np.cos(azimuth_rad), mu * np.sin(azimuth_rad), -sine])
    axis2 = np.stack([-np.sin(azimuth_rad), np.cos(azimuth_rad), 0 * mu])
    c = sun @ k
    beam, glint = once[:, inverse]
    s = (sun @ axis1 + 1j * (sun @ axis2)) ** 2
    y = (axis1[1] + 1j * axis2[1]) ** 2
    from_glint = glint * phase(field.glint_from @ k, p)
    turned = (wavelength_nm / 550.0) ** -p['across_power'] * (
        p['across0'] + p['across1'] * c + p['across_peak'] * peak(c, p))
    qu = from_glint * field.glint_dop * y - beam * turned * s
    return pi * (i + beam * phase(c, p) + from_glint), pi * (q + qu.real), pi * (u + qu.imag)
