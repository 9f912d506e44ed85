# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of drawn surfaces by the name of their material, for formats that need one."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Look:
    """Linear colour with opacity, and how metallic and rough it is."""

    rgba: tuple[float, float, float, float]
    metallic: float = 0.0
    roughness: float = 0.6


LOOKS = {
    "cortex": Look((0.62, 0.33, 0.28, 1), 0, 0.45),
    "insula": Look((0.55, 0.29, 0.25, 1), 0, 0.45),
    "bone": Look((0.75, 0.68, 0.53, 1), 0, 0.7),
    "dura": Look((0.60, 0.42, 0.36, 1), 0, 0.6),
    "skin": Look((0.60, 0.38, 0.28, 1), 0, 0.7),
    "drape": Look((0.02, 0.13, 0.11, 1), 0, 0.95),
    "artery": Look((0.50, 0.06, 0.05, 1), 0, 0.35),
    "vein": Look((0.14, 0.10, 0.30, 1), 0, 0.35),
}
OTHER = Look((0.55, 0.40, 0.35, 1))
METALS = ("steel", "steel_dark", "gold", "titanium", "clip")


def of_surface(material: str) -> Look:
    """The look of a surface; a plain one for a material that is not known here."""
    return LOOKS.get(material, OTHER)


def of_part(material: str, rgba) -> Look:
    """The look of a tool's part, whose colour its model states in sRGB."""
    linear = tuple(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgba[:3])
    metal = 1.0 if material in METALS else 0.0
    return Look((*linear, float(rgba[3])), metal, 0.3 if metal else 0.6)
