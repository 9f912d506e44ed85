# SPDX-License-Identifier: GPL-3.0-or-later
"""The laws of elasticity that the programs use, written once in NumPy. No code of a program that is compared is used.

Each law gives the energy density psi(F) and the first Piola-Kirchhoff stress P = dpsi/dF, for deformation gradients F
of shape (elements, 3, 3). mu and lam are the constants of Lame.
"""

from __future__ import annotations

import numpy as np

EYE = np.eye(3)


def lame(young: float, poisson: float) -> tuple[float, float]:
    """mu and lambda, Pa."""
    return young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))


def trace(a: np.ndarray) -> np.ndarray:
    return np.trace(a, axis1=-2, axis2=-1)


class Corotational:
    """SOFA: mu |S - I|^2 + lam / 2 tr(S - I)^2, where F = R S is the polar decomposition."""

    name = "corotational Hooke"

    @staticmethod
    def _parts(f: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """U, s, V^T of a singular value decomposition with U V^T a rotation: a reflection goes into the least s."""
        u, s, vt = np.linalg.svd(f)
        flip = np.sign(np.linalg.det(u @ vt))
        s, u = s.copy(), u.copy()
        s[:, 2] *= flip
        u[:, :, 2] *= flip[:, None]
        return u, s, vt

    def _of_stretches(self, s: np.ndarray, mu: float, lam: float) -> tuple[np.ndarray, np.ndarray]:
        """Energy density of principal stretches, and its derivatives by them."""
        e = s - 1
        total = e.sum(axis=1)
        return mu * (e * e).sum(axis=1) + lam / 2 * total**2, 2 * mu * e + lam * total[:, None]

    def density(self, f: np.ndarray, mu: float, lam: float) -> np.ndarray:
        return self._of_stretches(self._parts(f)[1], mu, lam)[0]

    def stress(self, f: np.ndarray, mu: float, lam: float) -> np.ndarray:
        u, s, vt = self._parts(f)
        return u @ (self._of_stretches(s, mu, lam)[1][:, :, None] * vt)


class StiffeningCorotational(Corotational):
    """Insula: in addition 30 E / 2 (0.4 - s)^2 for each principal stretch s below 0.4, by its defaults."""

    name = "corotational Hooke, stiffer below a stretch of 0.4"
    least, times = 0.4, 30.0

    def _of_stretches(self, s: np.ndarray, mu: float, lam: float) -> tuple[np.ndarray, np.ndarray]:
        energy, slope = super()._of_stretches(s, mu, lam)
        k = self.times * mu * (3 * lam + 2 * mu) / (lam + mu)
        short = np.maximum(self.least - s, 0)
        return energy + k / 2 * (short * short).sum(axis=1), slope - k * short


class SaintVenantKirchhoff:
    """MuJoCo: mu tr(G^2) + lam / 2 tr(G)^2 with Green's strain G = (F^T F - I) / 2."""

    name = "Saint Venant-Kirchhoff"

    @staticmethod
    def _strain(f: np.ndarray) -> np.ndarray:
        return (np.swapaxes(f, 1, 2) @ f - EYE) / 2

    def density(self, f: np.ndarray, mu: float, lam: float) -> np.ndarray:
        g = self._strain(f)
        return mu * (g * g).sum(axis=(1, 2)) + lam / 2 * trace(g) ** 2

    def stress(self, f: np.ndarray, mu: float, lam: float) -> np.ndarray:
        g = self._strain(f)
        return f @ (2 * mu * g + lam * trace(g)[:, None, None] * EYE)


Law = Corotational | SaintVenantKirchhoff  # with the laws made from them


class Elastic:
    """A mesh of linear tetrahedra of one material under one law."""

    def __init__(self, rest: np.ndarray, elements: np.ndarray, young: float, poisson: float, law: Law):
        edges = rest[elements[:, 1:]] - rest[elements[:, :1]]  # rows: edges from the first node
        self.elements, self.law = elements, law
        self.volume = np.linalg.det(edges) / 6
        if (self.volume <= 0).any():
            raise ValueError("element %d of the mesh is flat or turned inside out" % int(np.argmin(self.volume)))
        inverse = np.linalg.inv(edges)  # columns: gradients of the shape functions of the nodes 1 to 3
        self.gradients = np.concatenate([-inverse.sum(axis=2, keepdims=True), inverse], axis=2)
        self.mu, self.lam = lame(young, poisson)

    def deformation(self, x: np.ndarray) -> np.ndarray:
        return np.einsum("eni,ejn->eij", x[self.elements], self.gradients)

    def energy(self, x: np.ndarray) -> float:
        """J."""
        return float(self.volume @ self.law.density(self.deformation(x), self.mu, self.lam))

    def force(self, x: np.ndarray) -> np.ndarray:
        """Of the elements on each node, N."""
        p = self.law.stress(self.deformation(x), self.mu, self.lam)
        out = np.zeros_like(x)
        np.add.at(out, self.elements, -np.einsum("e,eij,ejn->eni", self.volume, p, self.gradients))
        return out

    def stiffness_times(self, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """K v at x, by a central difference of the force."""
        size = float(np.abs(v).max())
        if size == 0:
            return np.zeros_like(v)
        step = 1e-7 / size  # moves the fastest node by 0.1 um
        return (self.force(x - step * v) - self.force(x + step * v)) / (2 * step)

    def stretches(self, x: np.ndarray) -> tuple[float, float]:
        """The least and the greatest principal stretch."""
        s = np.linalg.svd(self.deformation(x), compute_uv=False)
        return float(s.min()), float(s.max())
