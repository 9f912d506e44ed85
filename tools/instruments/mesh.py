# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes: closedness, orientation, mass properties, creased normals and OBJ output."""
import math

from vec import add, cross, dot, mul, norm, sub


class Mesh:
    """Indexed triangles. `colours` is either empty or holds one (r, g, b) in 0..1 a vertex."""

    def __init__(self):
        self.vertices = []
        self.faces = []
        self.colours = []

    def vertex(self, p, colour=None):
        self.vertices.append((float(p[0]), float(p[1]), float(p[2])))
        if colour is not None:
            self.colours.append(colour)
        return len(self.vertices) - 1

    def quad(self, a, b, c, d):
        """Split along the shorter diagonal, so that bent strips shade evenly."""
        v = self.vertices
        if norm(sub(v[a], v[c])) <= norm(sub(v[b], v[d])) + 1e-9:  # a tie is not decided by the last bits
            self.faces += [(a, b, c), (a, c, d)]
        else:
            self.faces += [(a, b, d), (b, c, d)]

    def append(self, other):
        base = len(self.vertices)
        self.vertices += other.vertices
        self.colours += other.colours
        self.faces += [(a + base, b + base, c + base) for a, b, c in other.faces]

    def mirrored(self, axis):
        out = Mesh()
        out.vertices = [tuple(-x if i == axis else x for i, x in enumerate(p)) for p in self.vertices]
        out.colours = list(self.colours)
        out.faces = [(a, c, b) for a, b, c in self.faces]
        return out

    def volume(self):
        v = self.vertices
        return sum(dot(v[a], cross(v[b], v[c])) for a, b, c in self.faces) / 6.0

    def orient_outward(self):
        if self.volume() < 0.0:
            self.faces = [(a, c, b) for a, b, c in self.faces]
        return self

    def check_closed(self, name):
        """Raise unless every directed edge occurs once and its reverse once."""
        seen = set()
        for f in self.faces:
            for i in range(3):
                e = (f[i], f[(i + 1) % 3])
                if e in seen or e[0] == e[1]:
                    raise ValueError(f"{name}: edge {e} is used twice in the same direction")
                seen.add(e)
        for a, b in seen:
            if (b, a) not in seen:
                raise ValueError(f"{name}: edge {(a, b)} has one triangle only")
        if self.volume() <= 0.0:
            raise ValueError(f"{name}: the surface is turned inside out")

    def second_moments(self):
        """Volume, first moments and the 3x3 matrix of second moments (integral of x_i x_j).

        Sum over the tetrahedra (origin, a, b, c), exact for a polyhedron:
        integral x x^T = V/20 (a a^T + b b^T + c c^T + s s^T) with s = a + b + c.
        """
        volume, first = 0.0, (0.0, 0.0, 0.0)
        second = [[0.0] * 3 for _ in range(3)]
        v = self.vertices
        for ia, ib, ic in self.faces:
            a, b, c = v[ia], v[ib], v[ic]
            vol = dot(a, cross(b, c)) / 6.0
            s = add(add(a, b), c)
            volume += vol
            first = add(first, mul(s, vol / 4.0))
            for i in range(3):
                for j in range(3):
                    second[i][j] += vol / 20.0 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j])
        return volume, first, second

    def corner_normals(self, crease_deg):
        """One normal a face corner: angle-weighted mean of the neighbours less than the crease angle away."""
        v = self.vertices
        flat, around = [], [[] for _ in v]
        for k, f in enumerate(self.faces):
            n = cross(sub(v[f[1]], v[f[0]]), sub(v[f[2]], v[f[0]]))
            length = norm(n)
            flat.append(mul(n, 1.0 / length) if length > 0.0 else (0.0, 0.0, 0.0))
            for i in range(3):
                p, q = sub(v[f[(i + 1) % 3]], v[f[i]]), sub(v[f[(i + 2) % 3]], v[f[i]])
                lp, lq = norm(p), norm(q)
                angle = math.acos(max(-1.0, min(1.0, dot(p, q) / (lp * lq)))) if lp > 0.0 and lq > 0.0 else 0.0
                around[f[i]].append((k, angle))
        limit = math.cos(math.radians(crease_deg))
        out = []
        for k, f in enumerate(self.faces):
            corner = []
            for i in range(3):
                n = (0.0, 0.0, 0.0)
                for other, angle in around[f[i]]:
                    if dot(flat[k], flat[other]) >= limit:
                        n = add(n, mul(flat[other], angle))
                length = norm(n)
                corner.append(mul(n, 1.0 / length) if length > 0.0 else flat[k])
            out.append(corner)
        return out


def number(x, digits=3):
    """Fixed notation without a negative zero: the same value always gives the same text.

    Rounding first to nine digits keeps the last bits of the machine's sines away from a tie.
    """
    text = f"{round(x, 9):.{digits}f}"
    return text[1:] if text.startswith("-") and float(text) == 0.0 else text


def obj_text(mesh, name, head, crease_deg=34.0):
    """Wavefront OBJ with one normal a corner (and vertex colours, when the mesh has them)."""
    lines = ["# " + line for line in head] + [f"o {name}"]
    for i, p in enumerate(mesh.vertices):
        line = "v " + " ".join(number(x, 4) for x in p)
        if mesh.colours:
            line += " " + " ".join(number(x) for x in mesh.colours[i])
        lines.append(line)
    index, normals, faces = {}, [], []
    for f, corner in zip(mesh.faces, mesh.corner_normals(crease_deg)):
        refs = []
        for vertex, n in zip(f, corner):
            key = "vn " + " ".join(number(x) for x in n)
            if key not in index:
                index[key] = len(index) + 1
                normals.append(key)
            refs.append(f"{vertex + 1}//{index[key]}")
        faces.append("f " + " ".join(refs))
    return "\n".join(lines + normals + faces) + "\n"


def convex_hull(points, eps=1e-9):
    """Triangulated hull by insertion; points within eps of the growing hull are dropped."""
    pts = sorted(set(points))
    base = [0]
    base.append(max(range(len(pts)), key=lambda i: norm(sub(pts[i], pts[0]))))
    d = sub(pts[base[1]], pts[0])
    base.append(max(range(len(pts)), key=lambda i: norm(cross(d, sub(pts[i], pts[0])))))
    n = cross(d, sub(pts[base[2]], pts[0]))
    base.append(max(range(len(pts)), key=lambda i: abs(dot(n, sub(pts[i], pts[0])))))
    if abs(dot(n, sub(pts[base[3]], pts[0]))) <= eps:
        raise ValueError("the points of a hull lie in one plane")
    a, b, c, e = base
    if dot(n, sub(pts[e], pts[0])) > 0.0:
        b, c = c, b
    faces = [(a, b, c), (a, c, e), (c, b, e), (b, a, e)]

    def height(f, p):
        m = cross(sub(pts[f[1]], pts[f[0]]), sub(pts[f[2]], pts[f[0]]))
        return dot(m, sub(p, pts[f[0]])) / norm(m)

    for i, p in enumerate(pts):
        seen = [f for f in faces if height(f, p) > eps]
        if i in base or not seen:
            continue
        edges = {(f[k], f[(k + 1) % 3]) for f in seen for k in range(3)}
        horizon = sorted(e2 for e2 in edges if (e2[1], e2[0]) not in edges)
        faces = [f for f in faces if f not in seen] + [(x, y, i) for x, y in horizon]
    hull, used = Mesh(), sorted({i for f in faces for i in f})
    where = {i: hull.vertex(pts[i]) for i in used}
    hull.faces = sorted(tuple(where[i] for i in f) for f in faces)
    hull.check_closed("hull")
    return hull
