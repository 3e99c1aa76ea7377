"""The sky model `hazy` in numpy, as sky/haze_*.cpp has it but for the polynomials, for fitting.

Fields are Fourier modes in the azimuth from the sun: I, Q go with cos(m az), U with sin(m az). A
direction is where light comes from; Q and U are about axis 1 (away from the zenith) and axis 2
(towards increasing azimuth). Moments of order l are sums of A I over directions, with A = [p 0 0; 0 r
t; 0 t r] of generalized spherical functions.
"""
import numpy as np
from numpy import pi

import haze_optics
from haze_optics import ORDERS, wigner

LEVELS, MODES, MOST = 12, 5, 15
PROFILE_POWER = 4  # scale height of air, 8 km, over that of haze
DEPOLARIZATION = 0.0279
WATER_INDEX, GRAZING = 1.34, 0.03
# Slopes over their deviation: towards the sun, and across it by Gauss and Hermite, on one side.
SLOPES = np.arange(-3, 3.125, 0.25)
CROSS_SLOPES = ((0.0, 2 / 3), (3**0.5, 1 / 3))
STREAMS, STREAM_WEIGHTS = np.polynomial.legendre.leggauss(8)
STREAMS, STREAM_WEIGHTS = 0.5 * (STREAMS + 1), 0.5 * STREAM_WEIGHTS


def rayleigh_depth(wavelength_nm, share):
    um = wavelength_nm / 1000.0
    return share * 0.008569 * um**-4 * (1 + 0.0113 * um**-2 + 0.00013 * um**-4)


def rayleigh_moments():
    share = (1 - DEPOLARIZATION) / (1 + DEPOLARIZATION / 2)
    moments = np.zeros((4, ORDERS + 1))
    moments[0, 0] = 1
    moments[:3, 2] = share * np.array([0.5, -0.5 * 6**0.5, 3])
    return moments


def fresnel(cosine):
    across = np.sqrt(1 - (1 - cosine**2) / WATER_INDEX**2)
    s = (cosine - WATER_INDEX * across) / (cosine + WATER_INDEX * across)
    p = (WATER_INDEX * cosine - across) / (WATER_INDEX * cosine + across)
    return s, p


class Basis:
    def __init__(self, m, sines):
        same, turned = wigner(m, 2, ORDERS, sines)[m:], wigner(m, -2, ORDERS, sines)[m:]
        self.p, self.r, self.t = wigner(m, 0, ORDERS, sines)[m:], (same + turned) / 2, (turned - same) / 2

    def shown(self, x):
        return np.stack([self.p.T @ x[0], self.r.T @ x[1] + self.t.T @ x[2],
                         self.t.T @ x[1] + self.r.T @ x[2]])

    def moments(self, x):
        return np.stack([self.p @ x[0], self.r @ x[1] + self.t @ x[2], self.t @ x[1] + self.r @ x[2]])


def glint_rays(sun_elevation, slope_variance):
    """Rays from the sea's facets: sine of elevation, azimuth, sine for the air, Stokes."""
    sigma = np.sqrt(slope_variance / 2)
    sun = np.array([np.cos(sun_elevation), 0, np.sin(sun_elevation)])
    rays, total = [], 0.0
    for a in SLOPES:
        for b, weight in CROSS_SLOPES:
            facet = np.array([-a * sigma, -b * sigma, 1])
            area = weight * np.exp(-0.5 * a * a) * (sun @ facet)
            normal = facet / np.linalg.norm(facet)
            cosine = sun @ normal
            if cosine <= 0:
                continue
            total += area
            ray = 2 * cosine * normal - sun
            if ray[2] <= 0:
                continue
            up = np.hypot(ray[2], GRAZING)
            s, p = fresnel(cosine)
            across = np.cross(sun, normal)
            across = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-9 else np.eye(3)[1]
            flat = np.hypot(ray[0], ray[1])
            x, y = (-ray[0] / flat, -ray[1] / flat) if flat > 1e-9 else (1.0, 0.0)
            axis1, axis2 = np.array([-ray[2] * x, -ray[2] * y, -flat]), np.array([-y, x, 0])
            e = complex(across @ axis1, across @ axis2)**2 * 0.5 * (s * s - p * p)
            rays.append((-ray[2], np.arctan2(y, x), up, np.array([0.5 * (s * s + p * p), e.real, e.imag])
                         * area * ray[2] / up**2))
    return [(mu, az, up, stokes * sun[2] / total) for mu, az, up, stokes in rays]


class Field:
    def __init__(self, sun_elevation, wavelength_nm, aot, p):
        self.p, self.sine = p, np.sin(sun_elevation)
        o = haze_optics.optics(wavelength_nm)
        kept = 1 - o['albedo'] * o['forward']
        air_depth, haze_depth = rayleigh_depth(wavelength_nm, p['air']), aot * o['extinction'] * kept
        t = np.linspace(0, 1, LEVELS + 1)
        self.depth = air_depth * t + haze_depth * t**PROFILE_POWER
        haze = haze_depth * PROFILE_POWER * t**(PROFILE_POWER - 1)
        self.air = air_depth / (air_depth + haze)
        self.haze = haze / (air_depth + haze) * o['albedo'] * (1 - o['forward']) / kept
        self.sun = np.exp(-self.depth / self.sine)
        self.kernels = [0.5 * m[:, :, None] * share for m, share in
                        ((rayleigh_moments(), self.air), (o['moments'], self.haze))]
        self.water = p['water_450'] * (wavelength_nm / 450.0)**p['water_power']
        self.rays = glint_rays(sun_elevation, p['slope_variance'])
        self.through, self.mean = self.layers(STREAMS)
        self.modes = [self.solve(m) for m in range(MODES)]

    def layers(self, mu):
        x = np.maximum(np.diff(self.depth)[:, None] / mu, 1e-12)
        return np.exp(-x), (1 - np.exp(-x)) / x

    @staticmethod
    def sweep(source, through, mean, start=0.0):
        """Source and result [3, ray, level], from the first level on."""
        out = np.zeros_like(source)
        out[..., 0] = start
        for j in range(source.shape[2] - 1):
            out[..., j + 1] = (out[..., j] * through[j] + source[..., j] * (mean[j] - through[j])
                               + source[..., j + 1] * (1 - mean[j]))
        return out

    def scattered(self, m, x, which):
        k = self.kernels[which][:, m:]
        return np.stack([k[0] * x[0] + k[1] * x[1], k[1] * x[0] + k[2] * x[1], k[3] * x[2]])

    def solve(self, m):
        share = (0.5 if m == 0 else 1.0) / pi
        none = np.zeros((1, LEVELS + 1))
        sun = Basis(m, np.array([self.sine])).moments(np.stack([share * self.sun[None], none, none]))
        mu, az, up, stokes = (np.array(x) for x in zip(*self.rays))
        turn = np.stack([np.cos(m * az), np.cos(m * az), np.sin(m * az)])
        fade = share * self.sun[-1] * np.exp((self.depth - self.depth[-1]) / up[:, None])
        glint = Basis(m, mu).moments((stokes.T * turn)[:, :, None] * fade)
        sent = self.scattered(m, sun, 0) + self.scattered(m, glint, 0) + self.scattered(m, glint, 1)
        source = sent + self.scattered(m, sun, 1)
        down, rising = Basis(m, STREAMS), Basis(m, -STREAMS)
        rs, rp = fresnel(np.minimum(1, np.sqrt(STREAMS**2 + self.p['slope_variance'])))
        lit = self.sine * self.sun[-1]
        w = STREAM_WEIGHTS[:, None]
        for _ in range(MOST):
            falling = self.sweep(down.shown(source), self.through, self.mean)
            i, q, u = falling[..., -1]
            across, along = 0.5 * rs**2 * (i - q), 0.5 * rp**2 * (i + q)
            start = np.stack([along + across, along - across, rs * rp * u])
            if m == 0:
                start[0] += self.water * (lit + 2 * pi * np.sum(STREAM_WEIGHTS * STREAMS * i)) / pi
                lit = 0.0
            risen = self.sweep(rising.shown(source)[..., ::-1], self.through[::-1], self.mean[::-1],
                               start)[..., ::-1]
            light = down.moments(w * falling) + rising.moments(w * risen)
            source = self.scattered(m, light, 0) + self.scattered(m, light, 1)
            sent = sent + source
            if np.abs(light[0]).max() < 1e-6:
                break
        return sent

    def along(self, mu):
        through, mean = self.layers(mu)
        modes = [self.sweep(Basis(m, mu).shown(sent), through, mean)[..., -1]
                 for m, sent in enumerate(self.modes)]
        once = np.zeros((1, len(mu), 1)) + self.haze * self.sun / (4 * pi)
        return modes, self.sweep(once, through, mean)[0, :, -1]


def sky(sun_elevation_deg, wavelength_nm, aot, azimuth_rad, mu, p):
    """I, Q, U over the sun's irradiance, times pi."""
    elevation = np.radians(sun_elevation_deg)
    each, inverse = np.unique(mu, return_inverse=True)
    modes, once = Field(elevation, wavelength_nm, aot, p).along(each)
    i = q = u = 0.0
    for m, f in enumerate(modes):
        f = f[:, inverse]
        i = i + f[0] * np.cos(m * azimuth_rad)
        q = q + f[1] * np.cos(m * azimuth_rad)
        u = u + f[2] * np.sin(m * azimuth_rad)
    flat, flat_sun = np.sqrt(1 - mu**2), np.cos(elevation)
    c = np.clip(flat * flat_sun * np.cos(azimuth_rad) + mu * np.sin(elevation), -1, 1)
    s = (flat_sun * np.cos(azimuth_rad) * mu - np.sin(elevation) * flat
         - 1j * flat_sun * np.sin(azimuth_rad))
    o = haze_optics.optics(wavelength_nm)
    x = haze_optics.bend(np.arccos(c))
    qu = once[inverse] * np.polyval(o['polarized'], x) * s**2
    i = i + once[inverse] * np.polyval(o['phase'], x)
    return pi * i, pi * (q + qu.real), pi * (u + qu.imag)
