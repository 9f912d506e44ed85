# SPDX-License-Identifier: GPL-3.0-or-later
"""A small shaded picture (SVG) of a clip, half open, for lists to choose from."""
import math

from vec import add, cross, dot, mul, norm, sub, unit

WIDTH, HEIGHT, MARGIN, LARGEST = 160.0, 96.0, 6.0, 9.0  # px; largest scale in px/mm
OPEN = 0.4  # of the full opening


def _axes(azimuth_deg, tilt_deg):
    """Screen axes (right, up, towards the eye): the clip lies with its tip to the left, turned about its length."""
    a, e = math.radians(azimuth_deg), math.radians(tilt_deg)
    eye = unit((math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)))
    right = unit(sub((0.0, 0.0, 1.0), mul(eye, eye[2])))
    return right, cross(eye, right), eye


def _colour(rgba, shade):
    return "#" + "".join(f"{max(0, min(255, round(255.0 * c * shade))):02x}" for c in rgba[:3])


def _text(x):
    return (
        f"{x:.1f}".rstrip("0").rstrip(".").replace("-0", "0") if abs(x) < 0.05 else f"{x:.1f}".rstrip("0").rstrip(".")
    )


def svg(clip, colours, title):
    """`colours`: rgba of each link. Faces away from the eye are left out, the others drawn from far to near."""
    right, up, eye = _axes(-52.0, 14.0)
    light = unit(add(add(eye, mul(up, 0.9)), mul(right, -0.5)))
    faces = []
    for name, rings in clip.rings(fine=False).items():
        rings = [[clip.open_point(name, p, OPEN * clip.opening_max) for p in ring] for ring in rings]
        middles = [mul((sum(p[0] for p in r), sum(p[1] for p in r), sum(p[2] for p in r)), 1.0 / len(r)) for r in rings]
        count = len(rings[0])
        quads = [
            ((a[k], a[(k + 1) % count], b[(k + 1) % count], b[k]), mul(add(m, n), 0.5))
            for a, b, m, n in zip(rings, rings[1:], middles, middles[1:])
            for k in range(count)
        ]
        quads += [(tuple(rings[0]), middles[1]), (tuple(rings[-1]), middles[-2])]
        for quad, inside in quads:
            centre = mul((sum(p[0] for p in quad), sum(p[1] for p in quad), sum(p[2] for p in quad)), 1.0 / len(quad))
            n = (
                cross(sub(quad[2], quad[0]), sub(quad[3], quad[1]))
                if len(quad) == 4
                else cross(sub(quad[2], quad[0]), sub(quad[4], quad[0]))
            )
            if norm(n) < 1e-9:
                continue
            n = unit(n)
            if dot(n, sub(centre, inside)) < 0.0:
                n = mul(n, -1.0)
            if dot(n, eye) <= 0.0:
                continue
            shade = 0.42 + 0.75 * max(0.0, dot(n, light)) ** 1.5
            faces.append(
                (round(dot(centre, eye), 6), _colour(colours[name], shade), [(dot(p, right), dot(p, up)) for p in quad])
            )
    faces.sort(key=lambda f: f[0])
    xs, ys = [p[0] for f in faces for p in f[2]], [p[1] for f in faces for p in f[2]]
    scale = min((WIDTH - 2.0 * MARGIN) / (max(xs) - min(xs)), (HEIGHT - 2.0 * MARGIN) / (max(ys) - min(ys)), LARGEST)
    x0, y0 = 0.5 * (WIDTH - scale * (max(xs) + min(xs))), 0.5 * (HEIGHT + scale * (max(ys) + min(ys)))
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}" '
        f'width="{WIDTH:.0f}" height="{HEIGHT:.0f}" stroke-width=".4" stroke-linejoin="round">'
        f"<!-- SPDX-License-Identifier: GPL-3.0-or-later --><title>{title}</title>"
    ]
    for _, colour, points in faces:
        path = "L".join(f"{_text(x0 + scale * x)} {_text(y0 - scale * y)}" for x, y in points)
        out.append(f'<path fill="{colour}" stroke="{colour}" d="M{path}z"/>')
    return "\n".join(out + ["</svg>"]) + "\n"
